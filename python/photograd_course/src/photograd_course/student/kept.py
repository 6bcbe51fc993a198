"""Files that a student may have edited are never replaced without a copy beside them."""

from __future__ import annotations

from pathlib import Path

from ..atomic_io import atomic_write
from ..errors import IoError, message


def keep_copy(path: Path) -> Path:
    """Copy a file to "name.kept-1.py" beside it, or the next free number; a like copy is enough.

    Args:
        path: an existing file.

    Returns:
        Where the copy lies.

    Raises:
        IoError: it cannot be read, or the copy not be written.
    """
    content = read_file(path)
    number = 1
    while True:
        place = path.with_name(f"{path.stem}.kept-{number}{path.suffix}")
        if not place.exists():
            return atomic_write(place, content)
        if place.is_file() and place.read_bytes() == content:
            return place
        number += 1


def write_keeping(path: Path, content: bytes) -> Path | None:
    """Write a file; what another content it had is kept beside it.

    Args:
        path: the file.
        content: all of it.

    Returns:
        Where the earlier content lies now; None where there was none, or the same.

    Raises:
        IoError: a file cannot be written; then the earlier one is as it was.
    """
    kept = None
    if path.is_file():
        if path.read_bytes() == content:
            return None
        kept = keep_copy(path)
    atomic_write(path, content)
    return kept


def read_file(path: Path) -> bytes:
    """The bytes of a file.

    Args:
        path: of the file.

    Raises:
        IoError: it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        got = error.strerror or str(error)
        expected = "a file that can be read"
        raise IoError(message("photograd course", str(path), expected, got)) from error
