"""Build-time metadata: where `photograd` finds `photograd-course`, on which it depends.

Inside a source tree the two are installed together, from the tree. In an sdist, and in what is
built from one, the dependency is named without a place (pyproject.toml sets `place = false`); for
a wheel that is handed on, set PHOTOGRAD_RELEASE=1.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

REQUIREMENTS = [
    "numpy>=1.26",
    "matplotlib>=3.7",
    "rich>=13",
    "typer>=0.12",
    "pillow>=10",
    "OpenEXR>=3.3",
    "zstandard>=0.22",
]


def dynamic_metadata(
    field: str, settings: Mapping[str, Any] | None = None, project: Mapping[str, Any] | None = None
) -> list[str]:
    """The value of `project.dependencies`."""
    if field != "dependencies":
        raise ValueError(f"dynamic_metadata: field: expected 'dependencies', got {field!r}")
    elsewhere = os.environ.get("PHOTOGRAD_RELEASE") or not (settings or {}).get("place", True)
    course = Path(__file__).resolve().parent / "photograd_course"
    place = "" if elsewhere else f" @ {course.as_uri()}"
    return [f"photograd-course{place}", *REQUIREMENTS]
