"""Import the submission from memory: its files exist nowhere on disk, and shadow nothing."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import importlib.util
import linecache
import sys
from collections.abc import Mapping, Sequence
from types import CodeType, ModuleType


class SourceFinder(importlib.abc.MetaPathFinder, importlib.abc.InspectLoader):
    """Finds the given modules, and only those; installed after all others, so it shadows none."""

    def __init__(self, sources: Mapping[str, str]) -> None:
        self._sources = dict(sources)
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
        return compile(self._sources[fullname], f"{fullname}.py", "exec", dont_inherit=True)

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
