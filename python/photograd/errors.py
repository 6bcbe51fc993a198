"""The typed errors, as `photograd` users import them.

They are defined in `photograd_course.errors`.
"""

from __future__ import annotations

from photograd_course.errors import (
    DtypeError,
    Error,
    IoError,
    RangeError,
    SceneError,
    ShapeError,
    message,
)

__all__ = ["DtypeError", "Error", "IoError", "RangeError", "SceneError", "ShapeError", "message"]
