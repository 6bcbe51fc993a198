"""What each event of density control costs a fit: the photographs before and after it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd._fit_options import DENSITY_CONTROLS
from photograd.fitting import options_for
from photograd.fitting.loop import Fit
from photograd.fitting.loss import picture_loss
from photograd.representation import ImageBatch, RenderOptions
from photograd.splats.model import GaussianScene

from tests.splats.scene import cloud_capture

OPTIONS = options_for("gaussians", steps=200, gaussians=250, degree=1, seed=3, learning_rate=2.0)


def training_psnr(fit: Fit) -> float:
    """Mean over the training views, over white, in dB."""
    found = []
    for view in fit.data.views:
        batch, options = ImageBatch(view.camera), RenderOptions(stop=fit.options.stop)
        outputs, _ = fit.model.render(batch, seed=0, step=0, options=options)
        loss = picture_loss(outputs, view, np.ones(3), ssim_weight=0.0)
        found.append(-10 * np.log10(loss.mean_square))
    return float(np.mean(found))


@pytest.mark.parametrize("control", [name for name in DENSITY_CONTROLS if name != "none"])
def test_no_event_of_a_fit_costs_half_a_decibel(control: str) -> None:
    fit = Fit.start(cloud_capture(), replace(OPTIONS, density_control=control))
    scene = fit.model
    assert isinstance(scene, GaussianScene)
    costs, sizes = [], {scene.resolution}
    while fit.step_number < 150:
        if scene.control.schedule.due(fit.step_number):
            scene.active_degree = fit.options.active_degree(fit.step_number)
            before = training_psnr(fit)
            fit.model.adapted(fit)  # what a step begins with
            costs.append(before - training_psnr(fit))
            sizes.add(scene.resolution)
        fit.step()
    assert len(costs) == 26
    assert sizes == ({83, 166, 250} if control == "clone_split_prune" else {250})
    # Measured: 0.04 and 0.00 dB at most. Parts at random places of the Gaussian, as opaque as the
    # whole, cost 1.5 dB at the first event.
    assert max(costs) < 0.5
