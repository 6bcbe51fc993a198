"""Fitting: from a capture to a model, step by step, and how good and how sure the result is.

model = fit(load_capture("photos"), "dense_grid", folder="model")
job = Fit.start(capture, FitOptions(steps=200))  # the same, a step at a time
print(evaluate(model, capture.test).psnr)  # of photograd.fitting.evaluate

`voxel_gradients`, `sign_claim` and `view_gradients` say what the photographs ask of a scene;
`compare` fits several representations to the same photographs.
"""

from __future__ import annotations

from photograd._fit_options import FitOptions
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import FitResult, Progress, options_for
from photograd.fitting.whole import fit

__all__ = [
    "Fit",
    "FitOptions",
    "FitResult",
    "Model",
    "Progress",
    "fit",
    "load_model",
    "options_for",
]
