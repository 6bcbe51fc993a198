"""What a graded module may import: NumPy and the standard modules that the assignment lists.

This is advice, given early and with a line number, and not the boundary: the boundary is that the
worker has nothing else to import.
"""

from __future__ import annotations

import ast
from collections.abc import Collection

OF_ANNOTATIONS = frozenset({"__future__", "collections", "typing"})
"""Modules that annotations need; every graded module may import them."""


def forbidden_imports(
    name: str, text: str, allowed: Collection[str], own: Collection[str]
) -> list[dict[str, object]]:
    """Imports of a module that are not allowed, as ``{"file", "line", "module"}``.

    Args:
        name, text: the module and its source.
        allowed: top-level modules that may be imported.
        own: modules of the submission itself.

    Raises:
        SyntaxError, ValueError, RecursionError, MemoryError: the text is no Python.
    """
    found: list[dict[str, object]] = []
    permitted = {*allowed, *own, *OF_ANNOTATIONS}
    for node in ast.walk(ast.parse(text, f"{name}.py")):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            modules = ["." * node.level + (node.module or "")]
        else:
            continue
        found += [
            {"file": f"{name}.py", "line": node.lineno, "module": module}
            for module in modules
            if module.split(".")[0] not in permitted
        ]
    return found
