"""Build-time metadata: where `photograd` finds `photograd-course`, on which it depends.

Inside a source tree the two are installed together, from the tree. For a wheel that is handed on,
set PHOTOGRAD_RELEASE=1: the dependency is then named without a place.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

REQUIREMENTS = [
    "numpy>=1.26", "matplotlib>=3.7", "rich>=13", "typer>=0.12", "pillow>=10", "OpenEXR>=3.3",
    "plyfile>=1.0", "zstandard>=0.22",
]  # fmt: skip


def dynamic_metadata(
    field: str, settings: Mapping[str, Any] | None = None, project: Mapping[str, Any] | None = None
) -> list[str]:
    """The value of `project.dependencies`."""
    if field != "dependencies":
        raise ValueError(f"dynamic_metadata: field: expected 'dependencies', got {field!r}")
    course = Path(__file__).resolve().parent / "photograd_course"
    place = "" if os.environ.get("PHOTOGRAD_RELEASE") else f" @ {course.as_uri()}"
    return [f"photograd-course{place}", *REQUIREMENTS]
