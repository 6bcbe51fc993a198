"""Lay out the kit of an assignment in a folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..assignment.manifest import Manifest
from ..atomic_io import atomic_write
from ..errors import IoError, message


def with_own_modules(
    files: Mapping[str, bytes], manifest: Manifest, target: Path
) -> tuple[dict[str, bytes], list[Path]]:
    """A kit with the student's own earlier modules, where they lie in a folder beside the target.

    Args:
        files: of the kit; brought modules are stubs there.
        manifest: of the assignment.
        target: the folder in which the kit will lie.

    Returns:
        The files, and the paths of those taken.
    """
    found, taken = dict(files), []
    for name in manifest.brought:
        for path in sorted(target.resolve().parent.glob(f"[0-9][0-9]_*/{name}.py")):
            if path.parent.name < manifest.folder_name:
                found[path.name] = path.read_bytes()
                taken.append(path)
    return found, taken


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
