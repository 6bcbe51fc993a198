"""On a laptop nothing is enforced; honest submissions still see there what they see in grading.

This is a courtesy and no boundary: an audit hook can be got round.
"""

from __future__ import annotations

import os
import sys
from typing import Any

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
FILES = frozenset(
    f"os.{name}"
    for name in (
        "chmod",
        "chown",
        "link",
        "mkdir",
        "remove",
        "rename",
        "rmdir",
        "symlink",
        "truncate",
    )
)
PROCESSES = frozenset(
    (
        "os.exec",
        "os.fork",
        "os.forkpty",
        "os.posix_spawn",
        "os.spawn",
        "os.system",
        "subprocess.Popen",
        "os.kill",
    )
)


def behave() -> None:
    """From now on writing files, sockets and processes raise PermissionError."""
    sys.addaudithook(refuse)


def refuse(event: str, args: tuple[Any, ...]) -> None:
    """The audit hook."""
    if event == "open" and len(args) == 3 and isinstance(args[2], int) and args[2] & WRITING:
        raise PermissionError("a graded module can write no files")
    if event in FILES:
        raise PermissionError("a graded module can change no files")
    if event in PROCESSES:
        raise PermissionError("a graded module can start and signal no processes")
    if event == "socket.__new__":
        raise PermissionError("a graded module has no network")
