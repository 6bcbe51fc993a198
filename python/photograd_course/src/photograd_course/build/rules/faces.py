"""Public names, signatures and docstrings are the same in the solution and in the starter."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ..assignment_build import AssignmentBuild


def check_faces(build: AssignmentBuild) -> Iterator[str]:
    """See the module."""
    full, stripped = _faces(build.source), _faces(build.starter)
    for name in sorted(set(full) | set(stripped)):
        if name not in stripped:
            yield f"{name} is public in the solution and missing from the starter"
        elif name not in full:
            yield f"{name} is public in the starter and missing from the solution"
        elif full[name][0] != stripped[name][0]:
            yield f"{name} has another signature in the starter"
        elif full[name][1] != stripped[name][1]:
            yield f"{name} has another docstring in the starter"
    for task in build.manifest.tasks:
        for function in task.functions:
            if function not in full:
                yield f"task {task.id} names {function}, which the module does not define"


def _faces(text: str) -> dict[str, tuple[str, str | None]]:
    """Signature and docstring of each public function, class and constant, by dotted name."""
    tree = ast.parse(text)
    found: dict[str, tuple[str, str | None]] = {
        "module": ("", ast.get_docstring(tree, clean=False))
    }
    _collect(tree, "", found)
    return found


def _collect(node: ast.AST, prefix: str, found: dict[str, tuple[str, str | None]]) -> None:
    for child in getattr(node, "body", []):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            name = f"{prefix}{child.name}"
            if child.name.startswith("_") and not child.name.startswith("__"):
                continue
            decorators = [ast.unparse(each) for each in child.decorator_list]
            if isinstance(child, ast.ClassDef):
                face = [ast.unparse(each) for each in child.bases]
                _collect(child, f"{name}.", found)
            else:
                returns = ast.unparse(child.returns) if child.returns else ""
                face = [ast.unparse(child.args), returns]
            found[name] = (repr((decorators, face)), ast.get_docstring(child, clean=False))
        elif isinstance(child, (ast.Assign, ast.AnnAssign)):
            targets = child.targets if isinstance(child, ast.Assign) else [child.target]
            for target in targets:
                if isinstance(target, ast.Name) and not target.id.startswith("_"):
                    found[f"{prefix}{target.id}"] = ("constant", None)
