"""Which names are public, read from the sources: nothing is imported.

A module is public if no part of its name begins with an underscore; so is a name in it. A name that
a package or the top-level package lists in `__all__` is described there, where users import it,
every other name in the module that defines it.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCES = {
    "photograd": ROOT / "python/photograd",
    "photograd_course": ROOT / "python/photograd_course/src/photograd_course",
}
COMMANDS = ("photograd.commands", "photograd_course.cli")
"""Described by the pages of the command line instead."""

FUNCTION, CLASS, DATA = "function", "class", "data"


@dataclass
class Module:
    """What the source of one module says about itself.

    Attributes:
        name: with dots.
        is_package: whether it is an `__init__.py`.
        kinds: the public names that it defines, in order, each with its kind.
        constants: of those that are data: annotation, value and docstring as written, "" if absent.
        imports: names taken from other modules, each with the module and the name there.
        exported: its `__all__`, or None where it has none.
        docstring: of the module.
    """

    name: str
    is_package: bool
    kinds: dict[str, str] = field(default_factory=dict)
    constants: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    imports: dict[str, tuple[str, str]] = field(default_factory=dict)
    exported: list[str] | None = None
    docstring: str = ""

    @property
    def package(self) -> str:
        """The package that this module is or stands in."""
        return self.name if self.is_package else self.name.rpartition(".")[0]


def is_public(name: str) -> bool:
    """Whether no part of a dotted name begins with an underscore."""
    return not any(part.startswith("_") for part in name.split("."))


def read_module(name: str, path: Path) -> Module:
    """The module in a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    module = Module(name, path.name == "__init__.py", docstring=ast.get_docstring(tree) or "")
    body = list(_statements(tree.body))
    for node, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(node, ast.ImportFrom):
            origin = _origin(module.package, node)
            for alias in node.names:
                module.imports[alias.asname or alias.name] = (origin, alias.name)
        elif isinstance(node, ast.FunctionDef):
            module.kinds[node.name] = FUNCTION
        elif isinstance(node, ast.ClassDef):
            module.kinds[node.name] = CLASS
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                if isinstance(target, ast.Name):
                    module.kinds.setdefault(target.id, DATA)
                    module.constants[target.id] = _constant(node, after)
    if "__all__" in module.kinds:
        module.exported = next(
            ast.literal_eval(node.value)
            for node in tree.body
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
        )
    module.kinds = {name: kind for name, kind in module.kinds.items() if is_public(name)}
    return module


def _constant(node: ast.Assign | ast.AnnAssign, after: ast.stmt | None) -> tuple[str, str, str]:
    """Annotation, value and docstring of an assignment."""
    annotation = ast.unparse(node.annotation) if isinstance(node, ast.AnnAssign) else ""
    value = ast.unparse(node.value) if node.value is not None else ""
    if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
        return annotation, value, inspect.cleandoc(str(after.value.value))
    return annotation, value, ""


def _statements(body: Iterable[ast.stmt]) -> Iterable[ast.stmt]:
    """Statements of a module, those below a top-level `if` or `try` included."""
    for node in body:
        yield node
        if isinstance(node, ast.If | ast.Try):
            yield from _statements(node.body)


def _origin(package: str, node: ast.ImportFrom) -> str:
    """The module that `from ... import` names; relative ones start at the package."""
    if not node.level:
        return node.module or ""
    parts = package.split(".")
    base = parts[: len(parts) - node.level + 1]
    return ".".join([*base, node.module] if node.module else base)


@cache
def modules() -> dict[str, Module]:
    """Every module of both distributions by name, private ones included."""
    found = {}
    for root, folder in SOURCES.items():
        for path in sorted(folder.rglob("*.py")):
            parts = [root, *path.relative_to(folder).with_suffix("").parts]
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name] = read_module(name, path)
    return found


def definition(module: str, name: str) -> tuple[str, str]:
    """The module that defines a name, and the name there, along a chain of imports."""
    known = modules()
    while module in known and known[module].imports.get(name, (module, name)) != (module, name):
        module, name = known[module].imports[name]
    return module, name


def is_documented(module: str) -> bool:
    """Whether a module has a place in the reference."""
    return is_public(module) and not any(
        module == root or module.startswith(root + ".") for root in COMMANDS
    )


@cache
def homes() -> dict[tuple[str, str], str]:
    """Every public definition (module, name), and the dotted name under which it is described."""
    known = modules()
    found: dict[tuple[str, str], str] = {}
    by_depth = sorted(known.values(), key=lambda module: (module.name.count("."), module.name))
    for module in by_depth:
        if not is_documented(module.name) or not module.exported:
            continue
        for name in module.exported:
            origin, own = definition(module.name, name)
            # Documentation of a constant stands where it is assigned.
            if origin in known and known[origin].kinds.get(own) in {FUNCTION, CLASS}:
                found.setdefault((origin, own), f"{module.name}.{name}")
    for module in by_depth:
        if is_documented(module.name):
            for name in module.kinds:
                found.setdefault((module.name, name), f"{module.name}.{name}")
    return found


def described_at(module: str) -> list[tuple[str, str]]:
    """(kind, dotted name) of what is described in the section of a module."""
    known = modules()
    return [
        (known[origin].kinds[own], home)
        for (origin, own), home in homes().items()
        if home.rpartition(".")[0] == module
    ]


def doors(module: str) -> list[str]:
    """Homes of the names in a module's `__all__` that are described elsewhere."""
    found = []
    for name in modules()[module].exported or []:
        home = homes().get(definition(module, name))
        if home is not None and home.rpartition(".")[0] != module:
            found.append(home)
    return found
