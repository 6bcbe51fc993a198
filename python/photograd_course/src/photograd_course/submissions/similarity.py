"""Which submissions resemble each other more than chance and the starter explain: a report only.

Winnowing [Schleimer2003]: hashes of runs of tokens, of each window of which the smallest is kept.
Names, numbers and strings all count as one, layout and comments as nothing, so that renaming and
padding change nothing; functions may come in any order. Neither do statements of up to three
tokens count, nor how arithmetic is written: `a + b` is `np.add(a, b)`. What the starter holds is
taken away, and what most submissions share, which is the assignment's own shape.
"""

from __future__ import annotations

import hashlib
import keyword
from collections import Counter
from collections.abc import Mapping
from itertools import combinations

from ..assignment.tokens import END, LAYOUT, NAME, NUMBER, OPERATOR, STRING, Token, tokens

RUN = 12  # tokens in one hash: two or three lines, so that idioms alone do not match
WINDOW = 8
COMMON = 0.5  # fingerprints in more than this share of submissions are the assignment's own
FEWEST = 8  # submissions from which that share means anything
# To be listed. Solutions and alternatives of all assignments, pair by pair: differently written
# modules share up to 0.17 of the shorter one's fingerprints, 0.37 where two functions are the
# same; disguised copies 0.97 and more. Of single functions, differently written, 7 at most.
LEAST = 0.4
FEWEST_SHARED = 8

SHORTEST = 4  # tokens of a statement that counts; `pass`, `0` and `x = 0` have fewer
_ARITHMETIC = {"+", "-", "*", "/", "//", "%", "**", "@", "(", ")", ","}
_UFUNCS = {
    "add",
    "subtract",
    "multiply",
    "divide",
    "true_divide",
    "floor_divide",
    "mod",
    "remainder",
    "negative",
    "power",
    "matmul",
}


def similar_pairs(sources: Mapping[str, str], starter: str = "") -> list[tuple[str, str, float]]:
    """Pairs of students whose code overlaps, the most alike first.

    Args:
        sources: text of the graded module by student.
        starter: what all were given.

    Returns:
        (student, student, shared fingerprints / fingerprints of the shorter one).
    """
    given = fingerprints(starter)
    found = {student: fingerprints(text) - given for student, text in sources.items()}
    if len(found) >= FEWEST:
        counts = Counter(each for marks in found.values() for each in marks)
        common = {each for each, count in counts.items() if count > COMMON * len(found)}
        found = {student: marks - common for student, marks in found.items()}
    pairs = []
    for one, two in combinations(sorted(found), 2):
        least = min(len(found[one]), len(found[two]))
        shared = len(found[one] & found[two])
        if shared >= max(FEWEST_SHARED, LEAST * least):
            pairs.append((one, two, shared / least))
    return sorted(pairs, key=lambda pair: (-pair[2], pair[0], pair[1]))


def fingerprints(source: str) -> set[int]:
    """The winnowed hashes of a text."""
    words = normalized(source)
    hashes = [_hash(words[k : k + RUN]) for k in range(len(words) - RUN + 1)]
    if not hashes:
        return set()
    return {min(hashes[k : k + WINDOW]) for k in range(max(1, len(hashes) - WINDOW + 1))}


def normalized(source: str) -> list[str]:
    """Tokens without names, values, layout and arithmetic; short statements vanish as well."""
    words: list[str] = []
    statement: list[Token] = []
    for token in (*tokens(source), Token(END, "")):
        if token.kind == END or token == Token(OPERATOR, ";"):
            if len(statement) >= SHORTEST:
                words += _words(statement)
            statement = []
        elif token.kind != LAYOUT:
            statement.append(token)
    return words


def _words(statement: list[Token]) -> list[str]:
    words: list[str] = []
    texts = [token.text for token in statement]
    at = 0
    while at < len(statement):
        kind, text = statement[at]
        if text in {"np", "numpy"} and texts[at + 1 : at + 2] == ["."]:
            at += 2  # its function follows; one that is an operator counts as that
            if at < len(texts) and texts[at] not in _UFUNCS:
                words += ["n", ".", "n"]
        elif kind == NAME:
            words.append(text if keyword.iskeyword(text) else "n")
        elif kind in {NUMBER, STRING}:
            words.append(kind)
        elif text not in _ARITHMETIC:
            words.append(text)
        at += 1
    return words


def _hash(run: list[str]) -> int:
    data = "\0".join(run).encode("utf-8", errors="replace")
    return int.from_bytes(hashlib.blake2b(data, digest_size=8).digest(), "big")
