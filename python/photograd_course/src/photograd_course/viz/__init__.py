"""Gradient pictures: where a scene is about to change, how a fit went, and how well it ended.

All functions return a Matplotlib ``Figure`` that :func:`save_figure` writes with the same bytes
every time; none opens a window or touches pyplot.
"""

from __future__ import annotations

from .curves import FitCurves, fit_curves
from .projections import signed_projection, signed_projections
from .sign_report import SignReport, sign_report
from .signed_slices import signed_slices
from .steps import projection_steps
from .strips import comparison_strips
from .style import save_figure
from .turntable import write_frames, write_gif

__all__ = [
    "FitCurves",
    "SignReport",
    "comparison_strips",
    "fit_curves",
    "projection_steps",
    "save_figure",
    "sign_report",
    "signed_projection",
    "signed_projections",
    "signed_slices",
    "write_frames",
    "write_gif",
]
