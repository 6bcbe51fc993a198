"""Files read whole, with errors that name the reader and the file.

An input is a regular file; links to one are followed. A FIFO, a socket or a device would block the
reader or never end, so it is refused before it is opened.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from .errors import IoError, message

_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a FIFO",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def require_file(function: str, path: str | os.PathLike[str]) -> int:
    """The size in bytes of a regular file.

    Args:
        function: reader on whose behalf errors speak.
        path: the file, or a link to it.

    Raises:
        IoError: there is none, it cannot be reached, or it is a folder, a FIFO or a device.
    """
    try:
        status = Path(path).stat()
    except FileNotFoundError as failure:
        raise IoError(message(function, f"{path}", "a file", "none")) from failure
    except (OSError, ValueError) as failure:  # ValueError: a NUL in the name
        raise IoError(message(function, f"{path}", "a readable file", failure)) from failure
    if not stat.S_ISREG(status.st_mode):
        kind = _KINDS.get(stat.S_IFMT(status.st_mode), "something else")
        raise IoError(message(function, f"{path}", "a file", kind))
    return status.st_size


def read_file(function: str, path: Path, most: int = -1) -> bytes:
    """The bytes of a regular file.

    Args:
        function: reader on whose behalf errors speak.
        path: the file, or a link to it.
        most: so many from its start; -1 for all.

    Raises:
        IoError: `require_file` refuses it, or it cannot be read.
    """
    require_file(function, path)
    try:
        with path.open("rb") as stream:
            return stream.read(most)
    except OSError as failure:
        raise IoError(message(function, f"{path}", "a readable file", failure)) from failure


def read_text(function: str, path: Path) -> str:
    """The UTF-8 text of a regular file, lines ending in a line feed.

    Raises:
        IoError: `read_file` refuses it, or it is not UTF-8.
    """
    try:
        text = read_file(function, path).decode("utf-8")
    except UnicodeDecodeError as failure:
        raise IoError(message(function, f"{path}", "UTF-8 text", failure)) from failure
    return text.replace("\r\n", "\n").replace("\r", "\n")
