"""Fitting: from a capture to a model, step by step, and how good and how sure the result is.

::

    model = fit(load_capture("photos"), "dense_grid", folder="model")
    job = Fit.start(capture, FitOptions(steps=200))  # the same, a step at a time
    print(photograd.evaluate(model, capture.test).psnr)

`density_gradient(model, capture, seed=0)` is the gradient of the loss with respect to the
extinction of each voxel; `photograd_course.viz.signed_projections` draws it. The modules
`group_gradients`, `view_gradients` and `sign_claim` have other gradients; `compare` fits several
representations to the same photographs. `fit_image` fits a network to one picture.
"""

from __future__ import annotations

from photograd._fit_options import FitOptions
from photograd.fitting.image_fit import FittedImage, ImageFitOptions, fit_image, load_neural_image
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import FitResult, Progress, options_for
from photograd.fitting.steps import training_data
from photograd.fitting.voxel_gradients import density_gradient
from photograd.fitting.whole import fit

__all__ = [
    "Fit",
    "FitOptions",
    "FitResult",
    "FittedImage",
    "ImageFitOptions",
    "Model",
    "Progress",
    "density_gradient",
    "fit",
    "fit_image",
    "load_model",
    "load_neural_image",
    "options_for",
    "training_data",
]
