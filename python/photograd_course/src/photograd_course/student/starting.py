"""Lay out the kit of an assignment in a folder."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from ..assignment.manifest import Manifest
from ..atomic_io import atomic_write
from ..errors import IoError, message

# What a stub raises; see `build.regions`.
STUB = re.compile(
    r"^ *raise NotImplementedError\(\"\d\d\.\d+ ([\w.]+): see the handout, section \d+\"\)",
    re.MULTILINE,
)


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


def unwritten(source: str) -> list[str]:
    """The functions of a student's module that are still stubs, in their order.

    Args:
        source: of the module.
    """
    return STUB.findall(source)


def taken_along(path: Path) -> str:
    """What `course start` says of a module that it has copied; it names what is not written yet."""
    said = f"Taken along: your {path}"
    if names := unwritten(path.read_text("utf-8", errors="replace")):
        what = f"{', '.join(names)} {'is' if len(names) == 1 else 'are'} not written there yet"
        said += f"; {what}: copy it again when you have finished it"
    return said


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
