"""Automatic mutants: small changes of the solution's syntax tree, each of which checks must notice.

Changed are operators, signs, indices by one, constants, terms left out, ``+=`` to ``=``, swapped
arguments, comparisons, statements left out, and call sites (a keyword left out, a call of the
module's own function left out); only inside of solution regions, and not in
messages of exceptions, annotations and docstrings, which no check looks at.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from .operators import expressions_of, statements_of
from .regions import find_regions, solution_parts


@dataclass(frozen=True)
class AutoMutant:
    """One change.

    Attributes:
        function: that it is in, "" at module level.
        line: the line of the source without layout, the first one where a statement has several.
        mutation: what was changed, such as "a + b -> a - b"; with " [2]" where the same change can
            be made a second time in such a line of the function.
        number: of the line, for messages only; what identifies the mutant is the rest.
        text: the whole module with the change.
        task: of the solution that it is in.
    """

    function: str
    line: str
    mutation: str
    number: int
    text: str
    task: str


def automatic_mutants(source: str, file: str = "source") -> list[AutoMutant]:
    """All of them, in the order of the source, no text twice.

    Raises:
        RegionError: a marker is wrong.
    """
    regions = [r for r in find_regions(source, file) if r.kind == "solution"]
    parts = solution_parts(source, file)
    text = _Text(source)
    found: list[AutoMutant] = []
    times: Counter[tuple[str, str, str]] = Counter()
    tree = ast.parse(source)
    parsed = _Parsed(source, tree)
    own = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    for node in _changeable(tree):
        line = getattr(node, "lineno", 0)
        where = [p for r, p in zip(regions, parts, strict=True) if r.first < line < r.last]
        if not where:
            continue
        changes = statements_of(node) if isinstance(node, ast.stmt) else expressions_of(node, own)
        for old, new in changes:
            written = f"({new})" if isinstance(node, ast.expr) else new
            mutated = text.replace(node, written)
            if not parsed.is_new(mutated, line):
                continue
            place = (where[0].function, text.line(line), f"{old} -> {new}")
            times[place] += 1
            again = f" [{times[place]}]" if times[place] > 1 else ""
            found.append(AutoMutant(*place[:2], place[2] + again, line, mutated, where[0].task))
    return found


def _changeable(node: ast.AST) -> Iterator[ast.AST]:
    """Nodes in the order of the source, without those that no check can observe."""
    if isinstance(node, (ast.Raise, ast.JoinedStr, ast.arg, ast.Import, ast.ImportFrom)):
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in {"annotation", "returns", "decorator_list"}:
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not _is_docstring(child):
                yield from _changeable(child)


def _is_docstring(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


class _Parsed:
    """The trees of the texts so far, told apart by the statement of the module that differs."""

    def __init__(self, source: str, tree: ast.Module) -> None:
        self._lines = len(source.splitlines())
        self._spans = [
            (
                min([node.lineno, *(each.lineno for each in getattr(node, "decorator_list", ()))]),
                end,
            )
            for node in tree.body
            if (end := node.end_lineno) is not None
        ]
        self._seen = {
            (span, ast.dump(node)) for span, node in zip(self._spans, tree.body, strict=True)
        }

    def is_new(self, text: str, line: int) -> bool:
        """Whether a text that differs at this line is Python, and differs from all before."""
        first, last = next(span for span in self._spans if span[0] <= line <= span[1])
        lines = text.splitlines(keepends=True)
        part = "".join(lines[first - 1 : len(lines) - (self._lines - last)])
        try:
            (statement,) = ast.parse(part).body
        except (SyntaxError, ValueError):
            return False
        key = ((first, last), ast.dump(statement))
        is_new = key not in self._seen
        self._seen.add(key)
        return is_new


class _Text:
    """A source whose nodes can be replaced; columns of the tree count bytes."""

    def __init__(self, source: str) -> None:
        self._bytes = source.encode("utf-8")
        self._starts = [0]
        for line in self._bytes.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))

    def replace(self, node: ast.AST, new: str) -> str:
        """The source with other text in the place of a node."""
        where = (getattr(node, n) for n in ("lineno", "col_offset", "end_lineno", "end_col_offset"))
        line, column, end_line, end_column = where
        start, stop = self._starts[line - 1] + column, self._starts[end_line - 1] + end_column
        return (self._bytes[:start] + new.encode("utf-8") + self._bytes[stop:]).decode("utf-8")

    def line(self, number: int) -> str:
        """A line without comment and surplus spaces."""
        line = self._bytes[self._starts[number - 1] : self._starts[number]].decode("utf-8")
        return " ".join(line.partition("  #")[0].split())
