"""The files that run inside a worker, where NumPy lies, and how to start both."""

from __future__ import annotations

import os
import py_compile
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

from ..one_thread import ONE_THREAD

PROGRAM = (
    "__init__.py",
    "__main__.py",
    "adjoint_probes.py",
    "adjoint_rule.py",
    "adjoint_trace.py",
    "adjoint_types.py",
    "adjoint_values.py",
    "adjoint_watch.py",
    "boot.py",
    "channel.py",
    "codec.py",
    "confine.py",
    "courtesy.py",
    "kernel.py",
    "landlock.py",
    "layouts.py",
    "modules.py",
    "preload.py",
    "refused.py",
    "screen.py",
)
# One thread: a mathematics library that starts more would meet the limits on memory and processes.
ENVIRONMENT = {
    **ONE_THREAD,
    "PYTHONHASHSEED": "0",
    "PYTHON_DISABLE_REMOTE_DEBUG": "1",
    "PYTHONUTF8": "1",
}


def install_program(folder: Path) -> Path:
    """Copy the worker program to ``folder/photograd_worker``, compiled, and return ``folder``."""
    target = folder / "photograd_worker"
    target.mkdir(parents=True)
    for name in PROGRAM:
        shutil.copyfile(Path(__file__).parent / name, target / name)
        py_compile.compile(str(target / name), doraise=True)
    return folder


def interpreter() -> str:
    """The interpreter behind a virtual environment's link; the environment is not wanted."""
    base = getattr(sys, "_base_executable", None) or sys.executable
    return os.path.realpath(base)


def plain_command(folder: Path) -> list[str]:
    """How to start the worker installed in ``folder`` without any isolation."""
    boot = folder / "photograd_worker" / "boot.py"
    return [interpreter(), "-S", "-s", "-B", str(boot), str(numpy_parent())]


def numpy_parent() -> Path:
    """The folder in which NumPy lies, with much that is none of a submission's business."""
    return Path(np.__file__).resolve().parent.parent


def plain_environment() -> dict[str, str]:
    """The whole environment of a worker. Windows cannot start a process without SYSTEMROOT."""
    kept = {name: os.environ[name] for name in ("SYSTEMROOT",) if name in os.environ}
    return {**ENVIRONMENT, **kept}


def scratch_folder() -> tempfile.TemporaryDirectory[str]:
    """A folder for one worker, removed even where a file in it resists."""
    return tempfile.TemporaryDirectory(prefix="photograd-", ignore_cleanup_errors=True)
