"""Files read whole, with errors that name the reader and the file."""

from __future__ import annotations

from pathlib import Path

from photograd_course.errors import IoError, message


def read_file(function: str, path: Path, most: int = -1) -> bytes:
    """The bytes of a file.

    Args:
        function: reader on whose behalf errors speak.
        path: the file.
        most: so many from its start; -1 for all.

    Raises:
        IoError: no file, or one that cannot be read.
    """
    try:
        if path.is_file():
            with path.open("rb") as stream:
                return stream.read(most)
    except (OSError, ValueError) as failure:
        raise IoError(message(function, f"{path}", "a readable file", failure)) from failure
    raise IoError(message(function, f"{path}", "a file", "none"))
