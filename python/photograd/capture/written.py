"""Which files in a capture's folder photograd wrote, and may therefore replace.

OUT/capture.json lists them under "files", relative to OUT. Files that are not listed there are not
ours: they stay, whatever is overwritten.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from pathlib import Path

from photograd._inside import leads_outside
from photograd.errors import IoError, message

MANIFEST = "capture.json"
HIDDEN = (".photograd.lock", ".capture.partial", ".capture.replaced")
"""Ours without being listed: the lock of a run, and what a killed one was about to move."""


def written_files(folder: Path) -> set[str]:
    """Names, relative to `folder`, of the files and folders that its manifest lists, and its own.

    Empty without a manifest that can be read. Names that lead out of the folder do not count.
    """
    try:
        listed = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        names = {str(name) for name in listed if name and not leads_outside(str(name))}
        home = folder.resolve()
        within = {
            parent: (folder / parent).resolve().is_relative_to(home)
            for parent in {Path(name).parent for name in names}
        }
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    return {name for name in names if within[Path(name).parent]} | {MANIFEST}


def require_free(
    function: str, argument: str, folder: Path, new: Iterable[str], *, overwrite: bool
) -> None:
    """Refuse a folder that `new` must not be written to; nothing is changed.

    Args:
        function, argument: on whose behalf the error speaks.
        folder: where to write; it need not exist.
        new: names of files and folders to come, relative to `folder`.
        overwrite: what photograd wrote there may be replaced; else the folder has to be empty.

    Raises:
        IoError: it has content; with `overwrite`, a file in the way that is not ours.
    """
    if not overwrite:
        if folder.exists() and (not folder.is_dir() or set(_names(folder)) - set(HIDDEN)):
            remedy = "choose another, or overwrite it"
            raise IoError(message(function, argument, "a new folder", "one with content", remedy))
        return
    ours = written_files(folder)
    for name in new:
        if name not in ours and (folder / name).exists():
            expected = f"no {name} there that photograd did not write"
            remedy = "move it away, or choose another folder"
            raise IoError(message(function, argument, expected, f"{folder / name}", remedy))


def remove_written(folder: Path) -> None:
    """Remove what the manifest of `folder` lists, the manifest last, and folders left empty."""
    names = written_files(folder)
    for name in sorted(names, key=lambda name: name == MANIFEST):
        path = folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    remove_empty_folders(folder, names)


def remove_empty_folders(folder: Path, names: Iterable[str]) -> None:
    """Remove the folders of `names` below `folder` that hold nothing."""
    parents = {parent for name in names for parent in Path(name).parents} - {Path()}
    for parent in sorted(parents, key=lambda parent: -len(parent.parts)):
        path = folder / parent
        if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
            path.rmdir()


def left_alone(folder: Path) -> list[str]:
    """What `folder`, and its folders that we write to, hold besides our files."""
    ours = written_files(folder)
    folders = {parent for name in ours for parent in Path(name).parents}
    known = ours | {str(parent) for parent in folders} | set(HIDDEN)
    held = [str(parent / name) for parent in folders for name in _names(folder / parent)]
    return sorted(name for name in held if name not in known)


def _names(folder: Path) -> list[str]:
    return [entry.name for entry in folder.iterdir()] if folder.is_dir() else []
