"""A grader that no debugger enters, of its own account or through Python itself."""

from __future__ import annotations

import contextlib
import os
import sys


def close_to_debuggers() -> None:
    """Keep other processes of this account out of this one; may start the interpreter again.

    Python 3.14 runs a file that another process names (`sys.remote_exec`); that can be switched off
    only at the start. Call it first thing in a program: what has been read or written is lost.
    """
    is_enabled = getattr(sys, "is_remote_debug_enabled", None)
    if os.name == "posix" and is_enabled is not None and is_enabled():
        words = ["-X", "disable-remote-debug", *sys.orig_argv[1:]]
        os.execv(sys.executable, [sys.executable, *words])
    if sys.platform == "linux":
        from . import kernel

        with contextlib.suppress(OSError):
            kernel.prctl(kernel.PR_SET_DUMPABLE, 0)
