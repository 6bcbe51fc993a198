"""Files that are written whole or not at all: checkpoints, captures, figures.

The bytes go to a hidden neighbor of the target, reach the disk (fsync) and only then take the
target's name, which a file system does in one step. A reader sees the old file or the new one; a
full disk, an exception or a killed process leaves the old one as it was. What a killed process
leaves beside it, the next write to the same target removes.
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from .errors import IoError, message
from .file_locks import is_locked, open_locked

Writer = Callable[[BinaryIO], object]

_ROOM_ERRORS = {errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)}


def atomic_write(path: Path, content: bytes | Writer) -> Path:
    """Replace the file at ``path`` by ``content`` in one step.

    Args:
        path: the target; a symbolic link is followed, the link itself stays.
        content: the bytes, or a function that writes them into the binary file it is given.

    Returns:
        ``path``.

    Raises:
        IoError: no folder, no permission, or no room left; the old file is untouched and the
            half-written neighbor is removed. Whatever ``content`` raises is passed on, likewise.
    """
    target = Path(path).resolve()
    remove_leftovers(target)
    neighbor = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        _write_and_sync(neighbor, content)
        neighbor.replace(target)
        _sync_folder(target.parent)
    except OSError as error:
        _remove(neighbor)
        if isinstance(error, IoError):  # raised by the writer itself, already in our words
            raise
        kept = os.path.exists(target)  # noqa: PTH110  false, too, for a name that is too long
        raise IoError(_explain(path, error, kept=kept)) from error
    except BaseException:  # also on Ctrl-C: nothing half-written stays behind
        _remove(neighbor)
        raise
    return path


def remove_leftovers(path: Path) -> int:
    """Delete hidden neighbors that killed processes left next to ``path``; how many there were.

    One that a running process is writing stays.
    """
    target = Path(path).resolve()
    start, end = f".{target.name}.", ".tmp"
    removed = 0
    with contextlib.suppress(OSError):
        for name in os.listdir(target.parent):  # noqa: PTH208  names are all that is asked for
            ours = name.startswith(start) and name.endswith(end)
            if not (ours and name[len(start) : -len(end)].isdigit()):
                continue
            entry = target.with_name(name)
            if not is_locked(entry):
                _remove(entry)
                removed += 1
    return removed


def _write_and_sync(neighbor: Path, content: bytes | Writer) -> None:
    with open_locked(neighbor, wait=True) as file:
        file.truncate()
        if isinstance(content, bytes):
            file.write(content)
        else:
            content(file)
        file.flush()
        os.fsync(file.fileno())  # a full disk may show itself only here


def _sync_folder(folder: Path) -> None:
    """Make the new name itself durable, where the system lets a folder be synced."""
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        # Some network file systems refuse to sync a folder; the data itself is already safe.
        with contextlib.suppress(OSError):
            os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _remove(file: Path) -> None:
    with contextlib.suppress(OSError):
        file.unlink()


def _explain(path: Path, error: OSError, *, kept: bool) -> str:
    state = "the old file is unchanged" if kept else "no file was written"
    if error.errno in _ROOM_ERRORS:
        return message(
            "atomic_write",
            "path",
            f"room on the disk for {path}",
            f"'{error.strerror}'",
            f"free some space; {state}",
        )
    return message(
        "atomic_write",
        "path",
        "a file that can be written in an existing folder",
        f"{path}: {error.strerror or error}",
        state,
    )
