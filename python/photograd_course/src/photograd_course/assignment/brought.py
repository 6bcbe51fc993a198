"""Modules of earlier assignments that a submission carries along, to build upon.

A manifest names them by listing their files in `submission` beside the graded module. Students
bring their own; the solution of the earlier assignment stands in where trusted code runs.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import SceneError, message
from .manifest import Manifest


def brought_sources(folder: Path, manifest: Manifest) -> dict[str, str]:
    """Module name to the text of the earlier assignment's instructor source.

    Args:
        folder: an assignment's source folder, or that of an unpacked sealed bundle.
        manifest: of the assignment.

    Raises:
        SceneError: no assignment beside this one has such a module.
    """
    return {name: _find(folder, name).read_text(encoding="utf-8") for name in manifest.brought}


def _find(folder: Path, name: str) -> Path:
    beside = folder / f"{name}.py"  # in a sealed bundle
    if beside.exists():
        return beside
    for path in sorted(folder.resolve().parent.glob(f"[0-9][0-9]_*/{name}.py")):
        return path
    expected = "the module of an assignment beside this one"
    raise SceneError(message("assignment.toml", f"submission: {name}.py", expected, "none"))
