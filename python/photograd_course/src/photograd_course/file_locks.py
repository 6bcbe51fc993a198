"""Locks on files that end with the process that holds them, however it ends.

The kernel holds them (flock), so that a killed process leaves none behind, whatever file it leaves.
Where the system has no such locks (Windows, some network file systems), nothing is locked.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]


class HeldElsewhereError(Exception):
    """Another process, or another part of this one, holds the lock."""


def open_locked(path: Path, *, wait: bool = False) -> BinaryIO:
    """The file at ``path``, opened to read and write, made if need be, and locked.

    The lock ends when the file is closed. A file may be removed while its lock is held: who
    waited for it opens the path again.

    Args:
        path: the file; its content is kept.
        wait: wait until the lock is free.

    Raises:
        HeldElsewhereError: it is not free, and ``wait`` is false.
        OSError: the file cannot be opened.
    """
    while True:
        file = open(path, "r+b", opener=_create)  # noqa: SIM115  it keeps its name
        try:
            _lock(file, wait=wait)
            if fcntl is None or _still_at(path, file):
                return file
        except BaseException:
            file.close()
            raise
        file.close()


def _create(path: str, _flags: int) -> int:
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0)  # binary, on Windows
    return os.open(path, flags, 0o666)


def is_locked(path: Path) -> bool:
    """Whether a running process holds the lock of a file, or nobody may ask."""
    if fcntl is None:
        return False
    try:
        with path.open("r+b") as file:  # network file systems lock nothing that is only read
            _lock(file, wait=False)
    except FileNotFoundError:
        return False
    except (OSError, HeldElsewhereError):
        return True
    return False


def _lock(file: BinaryIO, *, wait: bool) -> None:
    if fcntl is None:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError as held:
        raise HeldElsewhereError(file.name) from held
    except OSError:  # a file system without locks
        pass


def _still_at(path: Path, file: BinaryIO) -> bool:
    """Whether the path still leads to the file; it may have been removed before it was locked."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False
