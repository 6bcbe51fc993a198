"""What a graded module may import: NumPy, pure modules, and what the assignment lists.

A statement that imports something else binds what `refused` makes: the module loads, and only what
uses the name fails. This is advice, and not the boundary: the boundary is that the worker has
nothing else to import.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator

PURE = frozenset(
    {
        "__future__",
        "abc",
        "bisect",
        "collections",
        "dataclasses",
        "enum",
        "functools",
        "heapq",
        "itertools",
        "math",
        "numbers",
        "operator",
        "typing",
    }
)
"""Modules that compute, and reach nothing outside; every graded module may import them."""

STAND_IN = "_refused_import"  # the name under which a module finds what makes stand-ins
CAUGHT = frozenset({"ImportError", "ModuleNotFoundError", "Exception", "BaseException"})
Problem = dict[str, object]


def forbidden_imports(
    name: str, text: str, allowed: Collection[str], own: Collection[str]
) -> list[Problem]:
    """Imports of a module that are not allowed, as ``{"file", "line", "module"}``.

    Args:
        name, text: the module and its source.
        allowed: top-level modules that may be imported.
        own: modules of the submission itself.

    Raises:
        SyntaxError, ValueError, RecursionError, MemoryError: the text is no Python.
    """
    return without_forbidden(name, text, allowed, own)[1]


def without_forbidden(
    name: str, text: str, allowed: Collection[str], own: Collection[str]
) -> tuple[ast.Module, list[Problem]]:
    """The tree of a module whose imports that are not allowed bind stand-ins, and these imports.

    Args:
        name, text, allowed, own: as for `forbidden_imports`.

    Raises:
        SyntaxError, ValueError, RecursionError, MemoryError: the text is no Python.
    """
    editor = _Editor(f"{name}.py", {*allowed, *own, *PURE})
    tree = editor.visit(ast.parse(text, f"{name}.py"))
    return ast.fix_missing_locations(tree), editor.problems


class _Editor(ast.NodeTransformer):
    """Puts stand-ins in the place of imports."""

    def __init__(self, file: str, permitted: Collection[str]) -> None:
        self.problems: list[Problem] = []
        self._file = file
        self._permitted = permitted
        self._caught = False  # whether an ImportError here has a handler

    def visit_Try(self, node: ast.Try) -> ast.AST:
        """What a student's own handler is for, it gets."""
        before = self._caught
        self._caught = before or any(_catches(each) for each in node.handlers)
        node.body = self._edited(node.body)
        self._caught = before
        node.handlers = [self.visit(each) for each in node.handlers]
        node.orelse, node.finalbody = self._edited(node.orelse), self._edited(node.finalbody)
        return node

    def visit_Import(self, node: ast.Import) -> list[ast.stmt]:
        """`import a.b`, `import a as c`, several at a time."""
        kept = [alias for alias in node.names if self._may(alias.name)]
        found: list[ast.stmt] = [ast.Import(names=kept)] if kept else []
        for alias in node.names:
            if alias not in kept:
                bound = alias.asname or alias.name.split(".")[0]
                found.append(self._stand_in(node, alias.name, bound))
        return [ast.copy_location(each, node) for each in found]

    def visit_ImportFrom(self, node: ast.ImportFrom) -> ast.stmt | list[ast.stmt]:
        """`from a import b as c`, `from . import a`; of `*` nothing is bound."""
        module = "." * node.level + (node.module or "")
        if self._may(module):
            return node
        found = [self._stand_in(node, module, each.asname or each.name) for each in node.names[:1]]
        found += [self._bound(module, each.asname or each.name, node) for each in node.names[1:]]
        return [ast.copy_location(each, node) for each in found]

    def _may(self, module: str) -> bool:
        return module.split(".", maxsplit=1)[0] in self._permitted

    def _stand_in(self, node: ast.stmt, module: str, bound: str) -> ast.stmt:
        self.problems.append({"file": self._file, "line": node.lineno, "module": module})
        return self._bound(module, bound, node)

    def _bound(self, module: str, bound: str, node: ast.stmt) -> ast.stmt:
        said = f"{module} ({self._file}, line {node.lineno})"
        if self._caught:
            call = ast.Call(ast.Name("ImportError", ast.Load()), [ast.Constant(said)], [])
            return ast.Raise(exc=call)
        if bound == "*":
            return ast.Pass()
        call = ast.Call(ast.Name(STAND_IN, ast.Load()), [ast.Constant(said)], [])
        return ast.Assign(targets=[ast.Name(bound, ast.Store())], value=call)

    def _edited(self, body: list[ast.stmt]) -> list[ast.stmt]:
        return list(_flat(self.visit(each) for each in body))


def _flat(parts: Iterator[ast.stmt | list[ast.stmt]]) -> Iterator[ast.stmt]:
    for part in parts:
        yield from part if isinstance(part, list) else [part]


def _catches(handler: ast.ExceptHandler) -> bool:
    """Whether a handler is for an ImportError, among others."""
    if handler.type is None:
        return True
    return any(isinstance(n, ast.Name) and n.id in CAUGHT for n in ast.walk(handler.type))
