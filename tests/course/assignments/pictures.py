"""Pictures of handouts, compared with what their scripts draw."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.viz.style import save_figure
from PIL import Image


def difference(stored: Path, figure: Any, dpi: int) -> float:
    """By how much a picture differs from a figure, in gray levels; inf where the sizes differ."""
    with tempfile.TemporaryDirectory() as place:
        drawn = pixels(save_figure(figure, Path(place) / stored.name, dpi))
    known = pixels(stored)
    return float(np.abs(known - drawn).mean()) if known.shape == drawn.shape else np.inf


def pixels(path: Path) -> np.ndarray:
    """(H, W, 3), 0 to 255."""
    with Image.open(path, formats=["PNG"]) as picture:
        return np.asarray(picture.convert("RGB"), dtype=np.float64)
