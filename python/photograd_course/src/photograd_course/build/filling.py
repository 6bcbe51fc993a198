"""An alternative holds its own functions only; here they are filled into the starter."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from typing import TypeAlias

Edit: TypeAlias = "tuple[int, int, list[str]]"  # first and last line, from 1, and the new lines


def fill(starter: str, own: str, module: str) -> str:
    """The starter with the definitions of an alternative.

    A definition takes the place of the starter's of the same name; in a class this holds for each
    member. What has no such place, imports among it, stands before the last definition that has
    one. ``from <module> import ...`` in the alternative says which given names it uses, and falls
    away, as do its docstring and imports from ``__future__``.

    Args:
        starter: text of the module as students get it.
        own: text of the alternative.
        module: name of the graded module.
    """
    given = _by_name(ast.parse(starter).body)
    edits: list[Edit] = []
    fresh: list[str] = []
    above = 1  # the last statement of the starter that gives way begins here
    for node, text in _statements(own, module):
        place = given.get(_name(node))
        if place is None:
            fresh += ["", *text]
            continue
        above = max(above, _span(place)[0])
        if isinstance(node, ast.ClassDef) and isinstance(place, ast.ClassDef):
            edits += _members(place, node, own.splitlines())
        else:
            edits.append((*_span(place), text))
    edits.append((above, above - 1, [*fresh, "", ""]))
    lines = starter.splitlines()
    for first, last, text in sorted(edits, reverse=True):
        lines[first - 1 : last] = text
    return "\n".join(lines) + "\n"


def _statements(own: str, module: str) -> Iterator[tuple[ast.stmt, list[str]]]:
    """Statements of the alternative that count, each with its lines."""
    lines = own.splitlines()
    for node in ast.parse(own).body:
        if isinstance(node, ast.ImportFrom) and node.module in {"__future__", module}:
            continue
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue  # the docstring
        first, last = _span(node)
        yield node, lines[first - 1 : last]


def _members(place: ast.ClassDef, node: ast.ClassDef, lines: list[str]) -> list[Edit]:
    """Members of a class of the starter that give way to the alternative's; new ones at its end."""
    given = _by_name(place.body)
    edits: list[Edit] = []
    fresh: list[str] = []
    for member in node.body:
        if isinstance(member, ast.Expr):
            continue  # the docstring
        first, last = _span(member)
        old = given.get(_name(member))
        if old is None:
            fresh += ["", *lines[first - 1 : last]]
        else:
            edits.append((*_span(old), lines[first - 1 : last]))
    end = place.end_lineno or place.lineno
    return [*edits, (end + 1, end, fresh)]


def _by_name(body: Iterable[ast.stmt]) -> dict[str, ast.stmt]:
    return {_name(node): node for node in body if _name(node)}


def _name(node: ast.stmt) -> str:
    """What a statement defines: a function, a class or one variable; otherwise ""."""
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        return node.name
    targets = node.targets if isinstance(node, ast.Assign) else []
    if isinstance(node, ast.AnnAssign):
        targets = [node.target]
    single = targets[0] if len(targets) == 1 else None
    return single.id if isinstance(single, ast.Name) else ""


def _span(node: ast.stmt) -> tuple[int, int]:
    """First and last line, decorators among them."""
    above = [each.lineno for each in getattr(node, "decorator_list", [])]
    return min([node.lineno, *above]), node.end_lineno or node.lineno
