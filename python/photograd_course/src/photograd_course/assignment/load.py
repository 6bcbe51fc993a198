"""Load modules from their texts: our own code, run in this process."""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.util
import itertools
import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import CodeType, ModuleType

from ..worker.modules import SourceFinder

_LOADED = itertools.count()


def load_module(name: str, text: str, extra: Mapping[str, object] | None = None) -> ModuleType:
    """Run source text as a module of its own, without entering it into `sys.modules`."""
    module = ModuleType(name)
    module.__dict__.update(extra or {})
    exec(compile(text, f"{name}.py", "exec", dont_inherit=True), module.__dict__)
    return module


def load_beside(name: str, text: str, brought: Mapping[str, str]) -> ModuleType:
    """`load_module` for a text that may import the brought modules while it is loaded."""
    finder = SourceFinder(brought)
    for each in brought:
        sys.modules.pop(each, None)
    sys.meta_path.insert(0, finder)
    try:
        return load_module(name, text)
    finally:
        finder.remove()


def load_figure_script(folder: Path) -> ModuleType:
    """An assignment's `figures.py`, which may import from `figure_parts.py` beside it."""
    parts = folder / "figure_parts.py"
    beside = {parts.stem: parts.read_text("utf-8")} if parts.exists() else {}
    return load_beside("figures", (folder / "figures.py").read_text("utf-8"), beside)


def load_package(name: str, texts: Mapping[str, str]) -> dict[str, ModuleType]:
    """Run the files of a package, which import each other relatively, from their texts.

    Nothing is read from the disk, no bytecode either, and no other module can take a file's place:
    while it is loaded the package has a name that occurs once in a process, afterwards it has left
    `sys.modules`, so imports belong at the top of its files.

    Args:
        name: for messages and tracebacks.
        texts: path inside the package, such as "hidden/task_1.py", to text.

    Returns:
        path to module, in the order of ``texts``.
    """
    finder = _PackageFinder(name, f"{name}_{next(_LOADED)}", texts)
    sys.meta_path.insert(0, finder)
    try:
        return {path: importlib.import_module(finder.names[path]) for path in texts}
    finally:
        sys.meta_path.remove(finder)
        for module in [finder.top, *finder.names.values()]:
            sys.modules.pop(module, None)


class _PackageFinder(importlib.abc.MetaPathFinder, importlib.abc.InspectLoader):
    """Finds the files of one package by its name of one loading."""

    def __init__(self, name: str, top: str, texts: Mapping[str, str]) -> None:
        self.top = top
        self.names = {path: _dotted(top, path) for path in texts}
        self._name = name
        self._paths = {module: path for path, module in self.names.items()}
        self._texts = texts

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The spec of one of our modules, else None."""
        del path, target
        if fullname not in self._paths:
            return None
        inside = self._paths[fullname]
        package = inside.rpartition("/")[2] == "__init__.py"
        return importlib.util.spec_from_loader(fullname, self, is_package=package)

    def get_source(self, fullname: str) -> str:
        """The text of a module."""
        return self._texts[self._paths[fullname]]

    def get_code(self, fullname: str) -> CodeType:
        """The compiled module."""
        file = f"{self._name}/{self._paths[fullname]}"
        return compile(self.get_source(fullname), file, "exec", dont_inherit=True)


def _dotted(top: str, path: str) -> str:
    parts = [top, *path.removesuffix(".py").split("/")]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
