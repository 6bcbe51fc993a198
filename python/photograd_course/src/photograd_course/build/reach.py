"""Which checks a change of the solution can reach: those that enter a function that it changes."""

from __future__ import annotations

import ast
from collections.abc import Iterator

Function = ast.FunctionDef | ast.AsyncFunctionDef


def changed_functions(old: str, new: str) -> frozenset[str] | None:
    """Names such as "descend" and "Value.exp" of functions whose bodies differ in two texts.

    Returns:
        None where something else differs too: a signature, or what runs when the module is
        imported.
    """
    try:
        before, after = ast.parse(old), ast.parse(new)
    except SyntaxError:
        return None
    bodies = [_bodies_taken_out(tree) for tree in (before, after)]
    if ast.dump(before) != ast.dump(after):
        return None
    return frozenset(name for name in bodies[0] if bodies[0][name] != bodies[1][name])


def function_names(text: str) -> frozenset[str]:
    """The functions of a module and the methods of its classes, such as "Value.exp"."""
    return frozenset(name for name, _ in _functions(ast.parse(text), ""))


def _bodies_taken_out(tree: ast.Module) -> dict[str, list[str]]:
    """The bodies by name; the tree keeps the rest."""
    found: dict[str, list[str]] = {}
    for name, node in _functions(tree, ""):
        found.setdefault(name, []).extend(map(ast.dump, node.body))
        node.body = []
    return found


def _functions(tree: ast.Module | ast.ClassDef, prefix: str) -> Iterator[tuple[str, Function]]:
    """Those of the module and of its classes; what is defined inside of one belongs to it."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield prefix + node.name, node
        elif isinstance(node, ast.ClassDef):
            yield from _functions(node, f"{prefix}{node.name}.")
