"""Which hand-ins resemble each other more than chance and the starter explain: a report only.

Winnowing [Schleimer2003]: hashes of runs of tokens, of each window of which the smallest is kept.
Names, numbers and strings all count as one, layout and comments as nothing, so that renaming and
padding change nothing; functions may come in any order. What the starter holds is taken away, and
what most hand-ins share, which is the assignment's own shape.
"""

from __future__ import annotations

import hashlib
import io
import keyword
import tokenize
from collections import Counter
from collections.abc import Mapping
from itertools import combinations

RUN = 12  # tokens in one hash: about two lines, so that idioms alone do not match
WINDOW = 8
COMMON = 0.5  # prints in more than this share of hand-ins are the assignment's own
FEWEST = 8  # hand-ins from which that share means anything
LEAST = 0.3  # of the shorter one's prints, to be listed

_SILENT = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
    tokenize.ENDMARKER, tokenize.ENCODING,
}  # fmt: skip


def similar_pairs(sources: Mapping[str, str], starter: str = "") -> list[tuple[str, str, float]]:
    """Pairs of students whose code overlaps, the most alike first.

    Args:
        sources: text of the graded module by student.
        starter: what all were given.

    Returns:
        (student, student, shared prints / prints of the shorter one).
    """
    given = prints(starter)
    found = {student: prints(text) - given for student, text in sources.items()}
    if len(found) >= FEWEST:
        counts = Counter(each for marks in found.values() for each in marks)
        common = {each for each, count in counts.items() if count > COMMON * len(found)}
        found = {student: marks - common for student, marks in found.items()}
    pairs = []
    for one, two in combinations(sorted(found), 2):
        least = min(len(found[one]), len(found[two]))
        share = len(found[one] & found[two]) / least if least else 0.0
        if share >= LEAST:
            pairs.append((one, two, share))
    return sorted(pairs, key=lambda pair: (-pair[2], pair[0], pair[1]))


def prints(source: str) -> set[int]:
    """The winnowed hashes of a text."""
    tokens = normalised(source)
    hashes = [_hash(tokens[k : k + RUN]) for k in range(len(tokens) - RUN + 1)]
    if not hashes:
        return set()
    return {min(hashes[k : k + WINDOW]) for k in range(max(1, len(hashes) - WINDOW + 1))}


def normalised(source: str) -> list[str]:
    """Tokens without names, values and layout; docstrings vanish as well."""
    words: list[str] = []
    fresh = True  # at the start of a statement
    try:
        for token in tokenize.generate_tokens(io.StringIO(source).readline):
            if token.type in _SILENT:
                fresh = fresh or token.type in {tokenize.NEWLINE, tokenize.INDENT}
                continue
            if token.type == tokenize.STRING:
                words += [] if fresh else ["S"]
            elif token.type == tokenize.NUMBER:
                words.append("0")
            elif token.type == tokenize.NAME and not keyword.iskeyword(token.string):
                words.append("n")
            else:
                words.append(token.string)
            fresh = False
    except (tokenize.TokenError, SyntaxError, ValueError):
        pass  # what could be read still counts
    return words


def _hash(run: list[str]) -> int:
    data = "\0".join(run).encode("utf-8", errors="replace")
    return int.from_bytes(hashlib.blake2b(data, digest_size=8).digest(), "big")
