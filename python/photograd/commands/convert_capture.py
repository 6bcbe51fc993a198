"""Cameras of a capture as files of other programs, for `photograd convert`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from photograd.capture import load_capture
from photograd.capture.export import Form, write_colmap, write_transforms
from photograd.errors import IoError, message

CAMERAS = ".json"


def convert_capture(source: Path, target: Path, form: Form) -> dict[str, Any]:
    """Write the cameras and points of a capture; returns what the command reports.

    Raises:
        IoError: a name that means nothing, or what `load_capture` raises.
        SceneError: what the format cannot express.
    """
    suffix = target.suffix.lower()
    if suffix not in (CAMERAS, "") or (not suffix and target.exists() and not target.is_dir()):
        expected = "of a capture a name that ends in .json, or a folder for a COLMAP model"
        raise IoError(message("convert", "OUT", expected, target.name))
    capture = load_capture(source)
    if suffix:
        lines, form_written = write_transforms(target, capture), "transforms.json"
    else:
        lines, form_written = write_colmap(target, capture, form=form), f"COLMAP, {form}"
    notes = [{"reading": source.name, "note": line} for line in capture.conversions]
    notes += [{"writing": target.name, "note": line} for line in lines]
    points = 0 if capture.points is None else len(capture.points)
    return {
        "views": len(capture.views),
        "points": points,
        "format": form_written,
        "out": target,
        "notes": notes,
    }
