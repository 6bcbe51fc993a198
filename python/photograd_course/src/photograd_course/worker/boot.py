"""The worker's first lines: no site-packages, no working folder; NumPy alone can be imported.

``python -S -s -B .../photograd_worker/boot.py folder-of-numpy``. Not ``-I``, which would ignore
PYTHONHASHSEED; the environment holds only what the grader has put there.
"""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType


class NumpyAlone(importlib.abc.MetaPathFinder):
    """Finds NumPy in its folder, and none of its neighbors."""

    def __init__(self, folder: str) -> None:
        self._folder = folder

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """The spec of the package itself; its parts are found through it."""
        del path, target
        if fullname != "numpy":
            return None
        return importlib.machinery.PathFinder.find_spec(fullname, [self._folder])


def start(program: str, numpy_folder: str) -> None:
    """Import the worker, which serves until its pipe closes."""
    sys.path[0] = program  # instead of this file's folder
    sys.meta_path.append(NumpyAlone(numpy_folder))
    sys.argv[:] = ["submission"]
    importlib.import_module("photograd_worker.__main__")


if __name__ == "__main__":
    start(sys.path[0][: -len("/photograd_worker")], sys.argv[1])
