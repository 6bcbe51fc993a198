"""Lay out the kit of an assignment in a folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..atomic_io import atomic_write
from ..errors import IoError, message


def lay_out(files: Mapping[str, bytes], target: Path) -> list[Path]:
    """Write the files of a kit; none is ever replaced.

    Args:
        files: relative path to content.
        target: the folder, made if need be.

    Raises:
        IoError: one of the files is already there, or cannot be written.
    """
    there = sorted(name for name in files if (target / name).exists())
    if there:
        remedy = "nothing was written; give another folder, or go on with the work that is there"
        found = f"{there[0]} and {len(there) - 1} more" if len(there) > 1 else there[0]
        raise IoError(message("start", str(target), "a folder without the kit", found, remedy))
    paths = []
    for name, content in sorted(files.items()):
        path = target / name
        path.parent.mkdir(parents=True, exist_ok=True)
        paths.append(atomic_write(path, content))
    return paths
