"""Pictures of Gaussians: against the oracle, closed forms, order, symmetries."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.splats.splatting import Gaussians, SplatOptions, render

from tests.splat import oracle

BACKGROUND = (0.2, 0.5, 0.9)
DEFAULT = SplatOptions()
POLICIES = {
    "default": DEFAULT,
    "smooth": DEFAULT.smooth(),
    "antialiased": replace(DEFAULT, antialiased=True),
    "no box": replace(DEFAULT, extent_sigmas=0.0),
    "sharp": replace(DEFAULT.smooth(), low_pass=0.0),
}


def one(mean: Any = (0, 0, 0), scale: float = 0.2, logit: float = 0.0, sh: Any = None) -> Gaussians:
    colors = np.full((1, 1, 3), 0.5) if sh is None else sh
    return Gaussians(
        np.array([mean], float),
        np.full((1, 3), np.log(scale)),
        np.array([[1.0, 0, 0, 0]]),
        np.array([logit]),
        colors,
    )


def straight(width: int = 33, height: int = 33, focal: float = 40.0, back: float = 2.0) -> Camera:
    pose = np.eye(4)
    pose[2, 3] = -back
    return Camera(width, height, focal, focal, width / 2, height / 2, pose)


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
@pytest.mark.parametrize("name", POLICIES)
def test_pictures_agree_with_the_oracle(name: str, degree: int) -> None:
    g, camera = oracle.cloud(40, degree, degree=degree), oracle.camera()
    picture, context = render(g, camera, background=BACKGROUND, options=POLICIES[name])
    expected = oracle.render(g, camera, np.array(BACKGROUND), POLICIES[name])
    assert context.visible.sum() > 25
    assert picture.opacity.max() > 0.5
    for output, value in expected.items():
        np.testing.assert_allclose(getattr(picture, output), value, atol=1e-12)  # measured 3e-15


def test_an_early_stop_ends_at_the_same_splat_as_the_oracle() -> None:
    g, camera = oracle.cloud(150, 5, size=-1.2), oracle.camera()
    g = replace(g, opacity_logits=g.opacity_logits + 3)
    stop = replace(DEFAULT, stop=0.05)
    picture, _ = render(g, camera, options=stop)
    expected = oracle.render(g, camera, np.zeros(3), stop)
    whole = oracle.render(g, camera, np.zeros(3), DEFAULT)
    assert np.abs(whole["color"] - expected["color"]).max() > 1e-3  # the stop matters here
    np.testing.assert_allclose(picture.color, expected["color"], atol=1e-12)
    np.testing.assert_allclose(picture.depth, expected["depth"], atol=1e-12)


def test_cutoffs_change_a_picture_by_less_than_they_promise() -> None:
    g, camera = oracle.cloud(40, 7), oracle.camera()
    smooth = render(g, camera, options=DEFAULT.smooth())[0].color
    dropped = replace(DEFAULT, extent_sigmas=0.0)
    error = np.abs(render(g, camera, options=dropped)[0].color - smooth).max()
    assert 0 < error < 40 / 255  # each of 40 splats drops less than 1/255; measured 0.02
    boxed = render(g, camera, options=DEFAULT)[0].color
    assert np.abs(boxed - smooth).max() < 40 * np.exp(-4.5)


def test_one_splat_in_closed_form() -> None:
    camera, scale = straight(), 0.2
    picture, _ = render(one(scale=scale, logit=1.2), camera, options=DEFAULT.smooth())
    x, y = oracle.pixel_centers(camera)
    variance = (40.0 * scale / 2.0) ** 2 + 0.3
    alpha = np.exp(-((x - 16.5) ** 2 + (y - 16.5) ** 2) / (2 * variance)) / (1 + np.exp(-1.2))
    # 1 - (1 - alpha) loses what is smaller than 1e-16; measured 5e-17.
    np.testing.assert_allclose(picture.opacity, alpha, atol=1e-15)
    color = 0.5 + 0.28209479177387814 * 0.5
    np.testing.assert_allclose(picture.color, color * np.repeat(alpha[..., None], 3, 2), rtol=1e-12)
    np.testing.assert_allclose(picture.depth, 2.0 * alpha, rtol=1e-12)


@pytest.mark.parametrize("mean", [(0.0, 0.0, 0.0), (0.11, -0.07, 0.3), (-0.2, 0.15, -0.4)])
def test_the_centroid_is_the_projected_mean(mean: tuple[float, float, float]) -> None:
    camera = straight(65, 65)
    opacity = render(one(mean, 0.06), camera, options=DEFAULT.smooth())[0].opacity
    x, y = oracle.pixel_centers(camera)
    at, _ = camera.project(np.array([mean]))
    got = [(opacity * x).sum() / opacity.sum(), (opacity * y).sum() / opacity.sum()]
    np.testing.assert_allclose(got, at[0], atol=1e-3)  # measured 1e-8


def test_the_order_of_rows_changes_nothing() -> None:
    g, camera = oracle.cloud(60, 9), oracle.camera()
    order = np.random.default_rng(1).permutation(60)
    shuffled = Gaussians(**{name: array[order] for name, array in g.arrays().items()})
    a, b = render(g, camera)[0], render(shuffled, camera)[0]
    assert np.array_equal(a.color, b.color)
    assert np.array_equal(a.depth, b.depth)


def test_of_equal_depths_the_first_row_is_in_front() -> None:
    g = one()
    both = Gaussians(**{name: np.repeat(array, 2, 0) for name, array in g.arrays().items()})
    both.opacity_logits[:] = 3.0
    both.sh[0], both.sh[1] = 1.0, -1.0
    camera = straight()
    bright = render(both, camera)[0].color[16, 16, 0]
    both.sh[[0, 1]] = both.sh[[1, 0]]
    dark = render(both, camera)[0].color[16, 16, 0]
    front, behind = 0.5 + 0.28209479177387814, 0.5 - 0.28209479177387814
    alpha = 1 / (1 + np.exp(-3.0))
    assert bright == pytest.approx(alpha * (front + (1 - alpha) * behind), abs=1e-12)
    assert dark == pytest.approx(alpha * (behind + (1 - alpha) * front), abs=1e-12)


def test_a_quaternion_and_its_negative_and_multiples_are_one_gaussian() -> None:
    g, camera = oracle.cloud(20, 2), oracle.camera()
    color = render(g, camera)[0].color
    assert np.array_equal(render(replace(g, quats=-g.quats), camera)[0].color, color)
    scaled = render(replace(g, quats=1e-30 * g.quats), camera)[0].color
    np.testing.assert_allclose(scaled, color, atol=1e-12)


def test_antialiased_splats_keep_their_total_when_the_camera_moves_back() -> None:
    # Screen area falls by 1/z^2, so opacity summed over pixels times z^2 stays; two thin splats.
    def totals(options: SplatOptions) -> list[float]:
        found = []
        for back in (2.0, 8.0, 16.0):
            picture, _ = render(one(scale=0.04), straight(back=back), options=options)
            found.append(float(picture.opacity.sum()) * back**2)
        return found

    smooth = DEFAULT.smooth()
    steady = totals(replace(smooth, antialiased=True))
    np.testing.assert_allclose(steady, steady[0], rtol=0.02)  # measured: 0.9 %
    grown = totals(smooth)
    assert grown[2] > 5 * grown[0]  # without: 31 times brighter for its size at 0.01 pixel^2
