"""From rendering to loss: background, display encoding, error, and the adjoint of all three."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import ShapeError
from photograd.fitting.data import (
    background_kind,
    constant_background,
    first_background,
    learned_background,
    learned_background_backward,
    random_background,
)
from photograd.fitting.loss import image_loss, image_loss_backward
from photograd.representation import Outputs
from photograd_course.color import srgb_decode, srgb_encode
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.gradient_mutants import check_gradient_mutants

RAYS = 40


def place(*, shared: bool) -> dict[str, Any]:
    """Pixels well inside of the curved part of the encoding, whose kink is at 0.0031308."""
    g = np.random.default_rng(1)
    opacity = g.uniform(0.1, 0.9, RAYS)
    return {
        "color": g.uniform(0.1, 0.9, (RAYS, 3)) * opacity[:, None],
        "opacity": opacity,
        "background": g.uniform(0.2, 0.8, 3 if shared else (RAYS, 3)),
    }


def photograph() -> Any:
    g = np.random.default_rng(2)
    alpha = g.uniform(0, 1, RAYS)
    return np.concatenate([g.uniform(0, 1, (RAYS, 3)) * alpha[:, None], alpha[:, None]], axis=-1)


def problem(display: bool) -> tuple[Any, Any]:
    pixels = photograph()

    def loss_of(p: dict[str, Any]) -> Any:
        outputs = Outputs(p["color"], p["opacity"])
        return image_loss(outputs, pixels, p["background"], display=display)

    def backward(p: dict[str, Any], d: float) -> dict[str, Any]:
        d_outputs, d_background = image_loss_backward(loss_of(p))
        gradients = {"color": d_outputs.color, "opacity": d_outputs.opacity}
        return {k: v * d for k, v in {**gradients, "background": d_background}.items()}

    return lambda p: loss_of(p).value, backward


@pytest.mark.parametrize("shared", [True, False], ids=["one background", "a background a ray"])
@pytest.mark.parametrize("display", [True, False], ids=["display", "linear"])
def test_gradient_of_the_loss_with_its_background(display: bool, shared: bool) -> None:
    function, backward = problem(display)
    report = check_gradient(function, backward, place(shared=shared), seed=1)
    assert report, str(report)
    report = taylor_slope(function, backward, place(shared=shared), seed=1)
    assert report, str(report)


def test_automatic_mutants_of_the_loss_die() -> None:
    function, backward = problem(True)
    start = place(shared=True)
    report = check_gradient_mutants(function, backward, start, 1.3, seed=2, coordinates=8)
    assert report, str(report)


def test_the_value_is_what_the_formula_says() -> None:
    p, pixels = place(shared=True), photograph()
    image = p["color"] + (1 - p["opacity"])[:, None] * p["background"]
    truth = pixels[:, :3] + (1 - pixels[:, 3:]) * p["background"]
    expected = np.mean((srgb_encode(image) - srgb_encode(truth)) ** 2)
    assert problem(True)[0](p) == pytest.approx(expected, rel=1e-14)
    assert problem(False)[0](p) == pytest.approx(np.mean((image - truth) ** 2), rel=1e-14)


def test_the_truth_itself_has_no_loss_over_any_background() -> None:
    pixels = photograph()
    outputs = Outputs(np.ascontiguousarray(pixels[:, :3]), pixels[:, 3].copy())
    for behind in (np.ones(3), random_background(RAYS, seed=1, step=2)):
        assert image_loss(outputs, pixels, behind, display=True).value == 0


def test_a_rendering_without_opacity_is_refused() -> None:
    with pytest.raises(ShapeError, match=r"image_loss: outputs.opacity: expected an array \(R,\)"):
        image_loss(Outputs(np.ones((4, 3))), np.ones((4, 4)), np.ones(3), display=True)


def test_gradient_of_a_learned_background() -> None:
    report = check_gradient(
        lambda p: learned_background(p["raw"]),
        lambda p, d: {"raw": learned_background_backward(p["raw"], d)},
        {"raw": np.array([-1.3, 0.2, 2.1])},
        seed=3,
    )
    assert report, str(report)


def test_a_learned_background_starts_at_the_mean_of_the_pixels() -> None:
    color = np.array([0.2, 0.5, 0.9])
    mean = np.append(0.25 * color, 0.25)  # premultiplied, of pixels that cover a quarter
    np.testing.assert_allclose(learned_background(first_background(mean)), color, rtol=1e-5)
    assert np.isfinite(first_background(np.zeros(4))).all()


def test_random_backgrounds_are_uniform_in_display_values_and_addressed_by_ray() -> None:
    whole = random_background(3000, seed=4, step=7)
    assert whole.shape == (3000, 3)
    encoded = np.sort(srgb_encode(whole).ravel())
    # Kolmogorov's distance of 9000 uniform numbers: above 2 / sqrt(9000) once in 1500 trials, and
    # the seed is fixed.
    assert np.abs(encoded - (np.arange(9000) + 0.5) / 9000).max() < 2 / np.sqrt(9000)
    assert np.array_equal(random_background(1000, seed=4, step=7, first=2000), whole[2000:])
    for other in (random_background(3000, seed=5, step=7), random_background(3000, seed=4, step=8)):
        assert not np.array_equal(other, whole)


def test_kinds_of_background() -> None:
    assert background_kind("auto", has_alpha=True) == "random"
    assert background_kind("auto", has_alpha=False) == "learned"
    assert background_kind("white", has_alpha=False) == "white"
    assert constant_background("white").tolist() == [1, 1, 1]
    assert constant_background("black").tolist() == [0, 0, 0]
    assert srgb_decode(np.ones(1))[0] == pytest.approx(1.0)
