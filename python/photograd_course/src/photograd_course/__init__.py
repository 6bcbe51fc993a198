"""photograd_course: gradient checks, optimizers, losses and pictures for the photograd course.

Import the module you need (``from photograd_course import losses``); nothing heavy is imported
here, so that ``photograd --help`` starts quickly.
"""

from __future__ import annotations

from .errors import DtypeError, Error, IoError, RangeError, SceneError, ShapeError

__version__ = "0.2.0"

__all__ = [
    "DtypeError",
    "Error",
    "IoError",
    "RangeError",
    "SceneError",
    "ShapeError",
    "__version__",
]
