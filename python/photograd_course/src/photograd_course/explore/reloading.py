"""An edited file of the student is read again before the next cell of a notebook."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

from .environment import kernel
from .other_code import set_again


def watch_own_modules() -> None:
    """From now on read edited modules again before each cell; nothing where no notebook runs."""
    shell = kernel()
    if shell is None:
        return
    sys.dont_write_bytecode = True  # a file written twice in a second would be taken for its cache
    reloader = Reloader(Path.cwd())
    shell.events.register("pre_run_cell", lambda *_: reloader.reload_edited())
    shell.events.register("post_run_cell", lambda *_: reloader.note_new())


class Reloader:
    """Reads the modules of a folder again where one of them has been edited."""

    def __init__(self, folder: Path) -> None:
        """Look at modules in ``folder``, and in its ``data``."""
        self._folders = (folder.resolve(), folder.resolve() / "data")
        self._read: dict[str, tuple[int, int]] = {}

    def note_new(self) -> None:
        """Remember the state of the files whose modules have been loaded meanwhile."""
        for name, module in self._own().items():
            self._read.setdefault(name, _stamp(module))

    def reload_edited(self) -> None:
        """Compare all files with what was read; where one differs, reload all that are loaded.

        All, because one may have taken names out of another.
        """
        own, known = self._own(), self._read
        self._read = {name: _stamp(module) for name, module in own.items()}
        if all(known.get(name, stamp) == stamp for name, stamp in self._read.items()):
            return
        for name in reversed(own):  # what a module imports has entered after it
            try:
                importlib.reload(own[name])
            except Exception as error:
                told = f"{type(error).__name__}: {error}"
                sys.stderr.write(f"{name}.py cannot be read again, the last version runs: {told}\n")
            set_again(own[name])

    def _own(self) -> dict[str, ModuleType]:
        return {
            name: module
            for name, module in list(sys.modules.items())
            if (file := getattr(module, "__file__", None))
            and getattr(module, "__spec__", None) is not None
            and Path(file).resolve().parent in self._folders
            and Path(file).is_file()
        }


def _stamp(module: ModuleType) -> tuple[int, int]:
    state = Path(str(module.__file__)).stat()
    return state.st_mtime_ns, state.st_size
