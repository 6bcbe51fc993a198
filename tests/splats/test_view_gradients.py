"""What is drawn of the gradient of Gaussians is what it says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.fitting.data import TrainingViews
from photograd.fitting.gradient_drawings import draw_gaussian_gradients
from photograd.fitting.loop import Fit
from photograd.fitting.options import options_for
from photograd.fitting.view_gradients import grad2d_picture, screen_covariances, view_gradients
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import Gaussians, SplatOptions, render

from tests.splats.scene import cloud_capture


@pytest.fixture(scope="module")
def scene() -> GaussianScene:
    fit = Fit.start(cloud_capture(), options_for("gaussians", steps=40, gaussians=150, degree=0))
    for _ in range(15):
        fit.step()
    assert isinstance(fit.model, GaussianScene)
    return fit.model


def test_loss_falls_along_what_is_drawn(
    scene: GaussianScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Without cut-offs: what a splat gains at its rim when it becomes more opaque has no gradient,
    # and is 3 % of the whole here.
    monkeypatch.setattr(scene, "policy", scene.policy.smooth())
    views = TrainingViews(cloud_capture().train)
    found = view_gradients(scene, views, 2)
    before = scene.params["opacity_logits"].copy()
    losses = []
    for step in (-20, 20):  # ten views of ten are looked at: the mean loss is that of `found`
        moved = (before + step * found.d_logit).astype(np.float32)
        monkeypatch.setitem(scene.params, "opacity_logits", moved)
        losses.append(view_gradients(scene, views, 2).loss)
    assert losses[0] < found.loss < losses[1]
    # Measured: 4e-6 apart, in float32.
    assert losses[1] - losses[0] == pytest.approx(40 * np.square(found.d_logit).sum(), rel=1e-4)


def test_one_splat_has_the_moments_of_its_ellipse() -> None:
    g: Any = Gaussians(
        means=np.array([[0.1, -0.05, 2.0]]),
        log_scales=np.log([[0.05, 0.12, 0.08]]),
        quats=np.array([[0.9, 0.3, -0.2, 0.4]]),
        opacity_logits=np.array([-5.0]),
        sh=np.ones((1, 1, 3)),
    )
    camera = Camera(96, 96, 120.0, 120.0, 48.0, 48.0, np.eye(4))
    options = SplatOptions(low_pass=0.0).smooth()
    weight = render(g, camera, options=options)[0].opacity
    weight /= weight.sum()
    v, u = np.mgrid[:96, :96] + 0.5
    mean = np.array([(weight * u).sum(), (weight * v).sum()])
    offset = np.stack([u - mean[0], v - mean[1]])
    measured = np.einsum("hw,ahw,bhw->ab", weight, offset, offset)
    np.testing.assert_allclose(screen_covariances(g, camera)[0], measured, rtol=0.01, atol=0.02)


def test_grad2d_is_drawn_where_it_is(scene: GaussianScene) -> None:
    views = TrainingViews(cloud_capture().train)
    camera = views.views[3].camera
    grad2d = np.zeros(scene.resolution)
    pixels, _ = camera.project(scene.params["means"].astype(np.float64))
    middle = int(np.argmin(np.abs(pixels - [20, 20]).sum(axis=1)))
    grad2d[middle] = 0.5
    drawn = grad2d_picture(scene.gaussians, grad2d, camera)
    row, column = np.unravel_index(drawn.argmax(), drawn.shape)
    assert np.hypot(column + 0.5 - pixels[middle, 0], row + 0.5 - pixels[middle, 1]) < 3
    assert 0 < drawn.max() <= 0.5


def test_a_figure_is_drawn_also_of_nothing(scene: GaussianScene) -> None:
    views = TrainingViews(cloud_capture().train)
    found = view_gradients(scene, views, 0)
    grad2d = grad2d_picture(scene.gaussians, found.grad2d, views.views[0].camera)
    figure = draw_gaussian_gradients({0: (found, grad2d), 9: (found, 0 * grad2d)}, threshold=1)
    assert len(figure.axes) == 2 * (3 + 2)
