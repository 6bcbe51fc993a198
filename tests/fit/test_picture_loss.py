"""The loss of whole pictures, and what a fit of Gaussians draws from its photographs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.view import View
from photograd.errors import RangeError
from photograd.fitting.data import TrainingView, TrainingViews
from photograd.fitting.loss import picture_loss, picture_loss_backward
from photograd.representation import Outputs
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants

CAMERA = Camera(13, 12, 20.0, 20.0, 6.5, 6.0, np.eye(4))


def view(seed: int, alpha: float = 1.0) -> TrainingView:
    pixels = np.random.default_rng(seed).uniform(0.2, 0.8, (12, 13, 4)).astype(np.float32)
    pixels[..., 3] = alpha
    pixels[..., :3] *= alpha
    return TrainingView(CAMERA, pixels, None)


class Proof:
    """Color, opacity and background as parameters; the photograph is opaque."""

    def __init__(self, seed: int, ssim_weight: float, seen: TrainingView) -> None:
        g = np.random.default_rng(seed)
        self.view, self.weight = seen, ssim_weight
        self.place = {
            "color": g.uniform(0.1, 0.5, (12 * 13, 3)),
            "opacity": g.uniform(0.2, 0.9, 12 * 13),
            "background": np.array([0.3, 0.6, 0.9]),
        }

    def loss(self, p: dict[str, Any]) -> Any:
        return picture_loss(
            Outputs(p["color"], p["opacity"]), self.view, p["background"], ssim_weight=self.weight
        )

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        return {"value": np.array(self.loss(p).value)}

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        outputs, behind = picture_loss_backward(self.loss(p))
        found = {"color": outputs.color, "opacity": outputs.opacity, "background": behind}
        return {name: float(d["value"]) * value for name, value in found.items()}


@pytest.mark.parametrize("weight", [0.0, 0.2, 1.0])
def test_gradient_agrees_with_central_differences(weight: float) -> None:
    proof = Proof(1, weight, view(2))
    report = check_gradient(
        proof.forward, proof.backward, proof.place, seed=1, steps=(1e-5, 1e-6, 1e-7)
    )
    assert report, str(report)


def test_pixels_that_are_not_valid_have_no_gradient() -> None:
    valid = np.ones((12, 13), np.bool_)
    valid[3:6, 4:9] = False
    proof = Proof(3, 0.0, replace(view(4), valid=valid))
    gradient = proof.backward(proof.place, {"value": np.array(1.0)})
    assert not gradient["color"].reshape(12, 13, 3)[~valid].any()
    assert np.abs(gradient["color"].reshape(12, 13, 3)[valid]).min() > 0


def test_the_mean_square_is_that_of_valid_pixels() -> None:
    valid = np.ones((12, 13), np.bool_)
    valid[:4] = False
    seen = view(4)
    proof = Proof(3, 0.2, replace(seen, valid=valid))
    loss = proof.loss(proof.place)
    truth = seen.premultiplied[..., :3].astype(np.float64)  # opaque
    expected = np.square(loss.image - truth)[valid].mean()
    assert expected > 0.01
    assert loss.mean_square == pytest.approx(expected, rel=1e-12)


def test_wrong_gradients_die() -> None:
    proof = Proof(5, 0.2, view(6))
    report = check_gradient_mutants(
        proof.forward,
        proof.backward,
        proof.place,
        {"value": np.array(1.0)},
        seed=5,
        directions=4,
        steps=(1e-5, 1e-6),
    )
    assert report, str(report)


def test_a_perfect_rendering_has_no_loss() -> None:
    seen = view(7, alpha=0.4)
    outputs = Outputs(
        seen.premultiplied[..., :3].reshape(-1, 3).astype(np.float64),
        seen.premultiplied[..., 3].ravel().astype(np.float64),
    )
    loss = picture_loss(outputs, seen, np.array([0.1, 0.5, 0.7]), ssim_weight=0.2)
    assert abs(loss.value) < 1e-7
    assert loss.mean_square < 1e-14


def test_every_view_comes_once_before_any_comes_again() -> None:
    pixels = np.random.default_rng(8).uniform(0, 1, (12, 13, 4)).astype(np.float32)
    views = TrainingViews([View(f"v{k}", CAMERA, pixels) for k in range(7)])
    drawn = [views.draw(seed=3, step=k) for k in range(21)]
    for turn in range(3):
        assert sorted(drawn[7 * turn : 7 * turn + 7]) == list(range(7))
    assert drawn[:7] != drawn[7:14]
    assert drawn == [views.draw(seed=3, step=k) for k in range(21)]
    assert drawn != [views.draw(seed=4, step=k) for k in range(21)]


def test_linear_photographs_become_display_values() -> None:
    pixels = np.full((12, 13, 4), 0.5, np.float32)
    pixels[..., :3] = 0.2140411
    linear = TrainingViews([View("a", CAMERA, pixels, "linear")])
    np.testing.assert_allclose(linear.views[0].premultiplied[..., :3], 0.25, atol=1e-5)
    np.testing.assert_allclose(linear.mean_color(), [0.10702] * 3 + [0.5], atol=1e-4)
    with pytest.raises(RangeError, match="at least one view"):
        TrainingViews([])
