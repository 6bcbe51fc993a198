"""Import the submission from memory: its files exist nowhere on disk, and shadow nothing."""

from __future__ import annotations

import ast
import importlib.abc
import importlib.machinery
import importlib.util
import linecache
import sys
from collections.abc import Mapping, Sequence
from types import CodeType, ModuleType

from .refused import StandIn
from .screen import STAND_IN


class SourceFinder(importlib.abc.MetaPathFinder, importlib.abc.InspectLoader):
    """Finds the given modules, and only those; installed after all others, so it shadows none.

    Args:
        sources: module name to text.
        trees: what is run instead of the texts of some.
    """

    def __init__(
        self, sources: Mapping[str, str], trees: Mapping[str, ast.Module] | None = None
    ) -> None:
        self._sources = dict(sources)
        self._trees = dict(trees or {})
        for name, text in self._sources.items():  # so that tracebacks can quote lines
            linecache.cache[f"{name}.py"] = (len(text), None, text.splitlines(True), f"{name}.py")

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """The spec of one of our modules, else None."""
        del path, target
        if fullname not in self._sources:
            return None
        return importlib.util.spec_from_loader(fullname, self, origin=f"{fullname}.py")

    def get_source(self, fullname: str) -> str:
        """The text of a module."""
        return self._sources[fullname]

    def get_code(self, fullname: str) -> CodeType:
        """The compiled module."""
        code = self._trees.get(fullname, self._sources[fullname])
        return compile(code, f"{fullname}.py", "exec", dont_inherit=True)

    def exec_module(self, module: ModuleType) -> None:
        """Run a module, which finds under one more name what makes stand-ins.

        Args:
            module: as it was made by its spec.
        """
        setattr(module, STAND_IN, StandIn)
        super().exec_module(module)

    def remove(self) -> None:
        """Forget the modules, so that others of the same names can be imported."""
        if self in sys.meta_path:
            sys.meta_path.remove(self)
        for name in self._sources:
            sys.modules.pop(name, None)


def line_of(error: BaseException, names: Sequence[str]) -> tuple[str, int] | None:
    """The innermost line in a traceback of the first of these modules that occurs in it."""
    files = [f"{name}.py" for name in names]
    if isinstance(error, SyntaxError) and error.filename in files:
        return error.filename, error.lineno or 0
    lines, trace = {}, error.__traceback__
    while trace is not None:
        lines[trace.tb_frame.f_code.co_filename] = trace.tb_lineno
        trace = trace.tb_next
    # The student's own module comes first, what runs beside it later.
    return next(((file, lines[file]) for file in files if file in lines), None)
