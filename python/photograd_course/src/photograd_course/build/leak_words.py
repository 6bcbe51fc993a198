"""What would give a solution away: the names it introduces, and runs of five tokens.

A *shingle* is five consecutive tokens of Python without comments, docstrings and layout; names and
numbers are kept as they are, texts become one token. It is evidence only if it holds at least three
different names that carry meaning, one of them longer than an index: no keywords, no builtins, not
``np``, ``numpy``, ``linalg`` or ``self``.
What the starter, code in the handout, or well-known sources (a fixed list of modules of Python and
NumPy) say as well is no evidence either.
"""

from __future__ import annotations

import ast
import builtins
import io
import keyword
import re
import tokenize
from collections.abc import Iterable
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

LENGTH = 5
NAMES = 3
SHORTEST = 3  # a name of one or two characters is an index or a symbol of the formula
COMMON = frozenset({*keyword.kwlist, *dir(builtins), "np", "numpy", "linalg", "self"})
WELL_KNOWN = (
    "bisect",
    "collections",
    "colorsys",
    "fractions",
    "functools",
    "graphlib",
    "heapq",
    "itertools",
    "operator",
    "queue",
    "random",
    "statistics",
    "numpy._core.numeric",
    "numpy._core.fromnumeric",
    "numpy._core.shape_base",
    "numpy.lib._function_base_impl",
    "numpy.lib._index_tricks_impl",
    "numpy.lib._shape_base_impl",
    "numpy.lib._twodim_base_impl",
    "numpy.linalg._linalg",
)
_LAYOUT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
_FENCE = re.compile(r"^```(?:python|py)?\n(.*?)^```", re.MULTILINE | re.DOTALL)
_WORD = re.compile(r"[A-Za-z_]\w*")

Shingle = tuple[str, ...]


def tokens_of(text: str) -> list[str]:
    """The tokens of Python source or of a part of it, as far as they can be read."""
    found: list[str] = []
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.STRING:
                # A text that begins a statement is a docstring.
                if token.line[: token.start[1]].strip():
                    found.append("''")
            elif token.type not in _LAYOUT:
                found.append(token.string)
    except (tokenize.TokenError, SyntaxError):
        pass
    return found


def shingles_of(text: str) -> set[Shingle]:
    """All runs of five tokens."""
    tokens = tokens_of(text)
    return {tuple(tokens[at : at + LENGTH]) for at in range(len(tokens) - LENGTH + 1)}


def says_something(shingle: Shingle) -> bool:
    """Whether it holds enough names of its own."""
    names = {each for each in shingle if each.isidentifier() and each not in COMMON}
    return len(names) >= NAMES and any(len(each) >= SHORTEST for each in names)


def fenced_code(markdown: str) -> str:
    """Python that a handout gives in fences."""
    return "\n".join(_FENCE.findall(markdown))


@lru_cache(maxsize=4096)
def words_of(text: str) -> frozenset[str]:
    """Everything in a text that looks like a name."""
    return frozenset(_WORD.findall(text))


def shingles_in(telling: set[Shingle], code: str) -> set[Shingle]:
    """Those of ``telling`` that occur in a text; most texts lack their words and are not cut up."""
    words = words_of(code)
    possible = {
        each for each in telling if all(word in words for word in each if word.isidentifier())
    }
    return possible & shingles_of(code) if possible else set()


def bound_names(module: str, parts: Iterable[tuple[int, int]]) -> set[str]:
    """Names that a module gives to something on the lines between the given ones."""
    spans = list(parts)
    found: set[str] = set()
    for node in ast.walk(ast.parse(module)):
        line = getattr(node, "lineno", 0)
        if not any(first < line < last for first, last in spans):
            continue
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            found.add(node.attr)
        elif isinstance(node, ast.arg):
            found.add(node.arg)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found.add(node.name)
        elif isinstance(node, ast.alias):
            found.add(node.asname or node.name.partition(".")[0])
        elif isinstance(node, ast.ExceptHandler) and node.name:
            found.add(node.name)
    return {name for name in found if len(name) >= SHORTEST and name not in COMMON}


@lru_cache(maxsize=1)
def well_known_shingles() -> frozenset[Shingle]:
    """Those of the fixed list of modules, as far as this Python has them."""
    found: set[Shingle] = set()
    for name in WELL_KNOWN:
        try:
            spec = find_spec(name)
        except ModuleNotFoundError:
            continue
        if spec is not None and spec.origin and spec.origin.endswith(".py"):
            found |= shingles_of(Path(spec.origin).read_text(encoding="utf-8"))
    return frozenset(found)
