"""The one rule for files that a file names: they lie in its folder.

A file from elsewhere may name any path, for example ../../etc/passwd; what lies outside of its
folder is not its to read. Symbolic links are followed: the text of a file cannot make one.
"""

from __future__ import annotations

from pathlib import Path

from photograd.errors import IoError, message

TRUST = "if you trust the capture: --allow-outside, in Python allow_outside=True"


def leads_outside(name: str) -> bool:
    """Whether a name leads out of the folder that it is relative to: by a root, a drive or ".."."""
    path = Path(name)
    return bool(path.anchor) or ".." in path.parts


def inside(
    function: str,
    place: str,
    folder: Path,
    name: str,
    *,
    allow_outside: bool = False,
    portable: bool = False,
    remedy: str | None = None,
) -> Path:
    """The path of what `name` says, relative to `folder`.

    Args:
        function, place: on whose behalf the error speaks, and where the name stands.
        folder: where the file that says so lies.
        name: as it stands in that file.
        allow_outside: also a name that leads out of the folder.
        portable: refuse a colon, too: in names that are the same on all systems it ends a drive
            or the scheme of a URI.
        remedy: what the error advises.

    Raises:
        IoError: the name leads out of the folder, or is empty.
    """
    refused = not name or leads_outside(name) or (portable and ":" in name)
    if refused and not allow_outside:
        shown = name if len(name) <= 80 else f"{name[:77]}..."
        raise IoError(message(function, place, f"a file in {folder}", repr(shown), remedy))
    return folder / name
