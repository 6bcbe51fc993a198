"""An assignment as a folder: its manifest, its checks, its questions, and where to find it."""

from __future__ import annotations

from .checks import load_checks
from .manifest import Limits, Manifest, Task, read_manifest

__all__ = ["Limits", "Manifest", "Task", "load_checks", "read_manifest"]
