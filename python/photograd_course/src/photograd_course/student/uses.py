"""Which functions of earlier modules a submission uses, read from its text."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from types import CodeType, FunctionType

from ..grading.check import Check
from .source_code import parsed

Name = tuple[str, str]  # of a module, and of what it defines at its top level


class Uses:
    """Who uses whom among the modules of a submission and its adapters."""

    def __init__(self, sources: Mapping[str, str], graded: str) -> None:
        """Read the texts; a module that is no Python uses nothing.

        Args:
            sources: module name to text.
            graded: name of the graded module.
        """
        self._graded = graded
        self._used: dict[Name, set[Name]] = {}
        self._imported: dict[Name, Name] = {}
        for module, text in sources.items():
            tree = parsed(text)
            if tree is not None:
                self._read(module, tree, sources)

    def reached(self, names: Iterable[str]) -> frozenset[Name]:
        """All that is used, directly or not, by functions of these names, themselves included.

        Args:
            names: such as "gltf" of the graded module, "Value.exp", or "module.name".
        """
        todo = [found for name in names if (found := self._found(name)) is not None]
        seen: set[Name] = set()
        while todo:
            name = todo.pop()
            name = self._imported.get(name, name)
            if name not in seen:
                seen.add(name)
                todo += self._used.get(name, ())
        return frozenset(seen)

    def reached_by(self, check: Check) -> frozenset[Name]:
        """What the functions use that a check calls, needs, or asks for by their names."""
        return self.reached([*check.calls, *check.needs, *_texts_of(check.body)])

    def everything(self) -> frozenset[Name]:
        """What the graded module, and what runs beside it, use or import."""
        own = (self._graded, "adapters")
        starts = [name for name in (*self._used, *self._imported) if name[0] in own]
        return self.reached(".".join(name) for name in starts)

    def names(self) -> dict[Name, Name]:
        """Each name of a module to what it stands for: where it is defined, or imported from."""
        return {**{name: name for name in self._used}, **self._imported}

    def _found(self, name: str) -> Name | None:
        first, _, rest = name.partition(".")
        own, other = (self._graded, first), (first, rest.partition(".")[0])
        known = (each for each in (other, own) if each in self._used or each in self._imported)
        return next(known, None)

    def _read(self, module: str, tree: ast.Module, sources: Mapping[str, str]) -> None:
        aliases: dict[str, str] = {}  # names of whole modules
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (source := node.module or "") in sources:
                for alias in node.names:
                    self._imported[module, alias.asname or alias.name] = source, alias.name
            elif isinstance(node, ast.Import):
                names = {each.asname or each.name: each.name for each in node.names}
                aliases |= {short: name for short, name in names.items() if name in sources}
        for name, statement in _definitions(tree):
            used = self._used.setdefault((module, name), set())
            for node in ast.walk(statement):
                if isinstance(node, ast.Name):
                    used.add((module, node.id))
                elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                    whole = aliases.get(node.value.id)  # of `import reflectance`
                    used |= {(whole, node.attr)} if whole else set()
            used.discard((module, name))


def _definitions(tree: ast.Module) -> Iterator[tuple[str, ast.stmt]]:
    """What a module defines: functions, classes, and names that are assigned at its top level."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield node.name, node
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                for inner in ast.walk(target):
                    if isinstance(inner, ast.Name):
                        yield inner.id, node


def _texts_of(body: object) -> set[str]:
    """The texts in the code of a check and of its helpers: names of functions among them."""
    todo, seen, texts = [body], set(), set()
    package = str(getattr(body, "__module__", "")).partition(".")[0]  # the checks of one assignment
    while todo:
        function = todo.pop()
        if not isinstance(function, FunctionType) or function in seen:
            continue
        if function.__module__.partition(".")[0] != package:
            continue
        seen.add(function)
        for code in _codes(function.__code__):
            texts |= {each for each in code.co_consts if isinstance(each, str) and len(each) < 80}
            todo += [function.__globals__.get(name) for name in code.co_names]
    return texts


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _codes(inner)
