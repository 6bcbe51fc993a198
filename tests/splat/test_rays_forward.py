"""What rays see of Gaussians: against the oracle, splatting, closed forms, order, symmetries."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.splats.rays import RayOptions, render
from photograd.splats.splatting import Gaussians, SplatOptions
from photograd.splats.splatting import render as splat

from tests.splat import oracle, ray_oracle

DEFAULT = RayOptions()
POLICIES = {
    "default": DEFAULT,
    "smooth": DEFAULT.smooth(),
    "dropped only": replace(DEFAULT.smooth(), alpha_min=1e-3),
    "stops early": replace(DEFAULT, stop=0.1),
    "held": replace(DEFAULT, alpha_max=0.5),
}
BACKGROUND = np.array([0.2, 0.5, 0.9])


def psnr(a: Any, b: Any) -> float:
    return float(-10 * np.log10(((a - b) ** 2).mean()))


@pytest.mark.parametrize("name", POLICIES)
def test_rays_agree_with_the_oracle(name: str) -> None:
    # 120 Gaussians: without alpha_min, four rounds of the list of 32.
    for degree in range(4):
        g = oracle.cloud(120, degree, degree=degree)
        origins, directions = ray_oracle.rays(150, degree)
        picture, context = render(
            g, origins, directions, background=BACKGROUND, options=POLICIES[name]
        )
        expected = ray_oracle.render(g, origins, directions, BACKGROUND, POLICIES[name])
        assert np.array_equal(context.crossings, expected.pop("crossings"))
        assert picture.opacity.max() > 0.85
        for output, value in expected.items():
            np.testing.assert_allclose(getattr(picture, output), value, atol=1e-12)


def test_the_tree_loses_nothing() -> None:
    # The smallest alpha_min that is not zero drops next to nothing, and searches the tree.
    g = oracle.cloud(2000, 3, degree=0, size=-3.5)
    origins, directions = ray_oracle.rays(200, 3)
    all_of_them = replace(DEFAULT.smooth(), alpha_min=1e-13)
    found = render(g, origins, directions, options=all_of_them)
    expected = render(g, origins, directions, options=DEFAULT.smooth())
    assert found[1].crossings.max() > 100
    assert found[1].crossings.max() < 1500
    np.testing.assert_allclose(found[0].color, expected[0].color, atol=1e-10)
    np.testing.assert_allclose(found[0].depth, expected[0].depth, atol=1e-10)


def narrow(size: int = 64, back: float = 20.0) -> Camera:
    """3.7 degrees across, 20 m away."""
    pose = np.eye(4)
    pose[2, 3] = -back
    focal = size * back / 1.3
    return Camera(size, size, focal, focal, size / 2, size / 2, pose)


def small_gaussians(count: int = 400) -> Gaussians:
    """Two to five pixels of `narrow` wide, in all directions, half a meter around the origin."""
    g = np.random.default_rng(5)
    return replace(
        oracle.cloud(count, 5, spread=0.5), log_scales=np.log(g.uniform(0.04, 0.1, (count, 3)))
    )


def both(g: Gaussians, camera: Camera, options: SplatOptions) -> tuple[Any, Any]:
    shape = (camera.height, camera.width, 3)
    rays = render(g, *camera.rays(), background=BACKGROUND)[0].color.reshape(shape)
    return rays, splat(g, camera, background=BACKGROUND, options=options)[0].color


def test_rays_agree_with_splatting_for_small_gaussians_in_a_narrow_view() -> None:
    g, camera = small_gaussians(), narrow()
    rays, splats = both(g, camera, SplatOptions(low_pass=0.0))
    assert rays.std() > 0.1
    assert (
        psnr(rays, splats) > 35
    )  # the aim; measured 39.1, most of it the order of overlapping ones


def test_the_difference_to_splatting_is_order_low_pass_and_perspective() -> None:
    g, camera = small_gaussians(40), narrow()
    # Far apart in depth, so that no two peaks change places; then only perspective is left.
    g.means[:, 2] = np.linspace(-3, 3, 40)
    sharp = psnr(*both(g, camera, SplatOptions(low_pass=0.0)))
    blurred = psnr(*both(g, camera, SplatOptions()))
    wide = replace(camera, fx=camera.fx / 10, fy=camera.fy / 10)
    pose = camera.world_from_camera.copy()
    pose[2, 3] = -5.0
    near = psnr(*both(g, replace(wide, world_from_camera=pose), SplatOptions(low_pass=0.0)))
    assert sharp > 50  # measured 70.7
    assert blurred < sharp - 10  # 51.8
    assert near < sharp - 5  # 58.4


def one(mean: Any = (0, 0, 0), scales: Any = (0.2, 0.2, 0.2), logit: float = 0.0) -> Gaussians:
    return Gaussians(
        np.array([mean], float),
        np.log([scales]),
        np.array([[1.0, 0, 0, 0]]),
        np.array([logit]),
        np.full((1, 1, 3), 0.5),
    )


def test_one_gaussian_in_closed_form() -> None:
    # Rays along z at the offset (x, y): the depth and the scale along z do not matter for alpha.
    offset = np.stack(np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9)), -1).reshape(-1, 2)
    origins = np.column_stack([offset, np.full(81, -3.0)])
    directions = np.tile([0, 0, 2.0], (81, 1))
    picture, _ = render(
        one((0, 0, 1.5), (0.5, 0.2, 7.0), 1.2), origins, directions, options=DEFAULT.smooth()
    )
    q = (offset**2 / [0.25, 0.04]).sum(1)
    alpha = np.exp(-q / 2) / (1 + np.exp(-1.2))
    np.testing.assert_allclose(picture.opacity, alpha, atol=1e-15)
    np.testing.assert_allclose(picture.depth, 4.5 * alpha, rtol=1e-12)


def test_a_tilted_needle_peaks_off_its_mean() -> None:
    # A needle along (1, 0, 1): a ray at x = 0.3 is nearest to it, in its own measure, near z = 0.3.
    half = np.sqrt(0.5)
    turned = replace(
        one((0, 0, 0), (1.0, 0.01, 0.01)),
        quats=np.array([[np.cos(np.pi / 8), 0, -np.sin(np.pi / 8), 0]]),
    )
    axis = oracle.rotation(turned.quats[0])[:, 0]
    np.testing.assert_allclose(axis, [half, 0, half], atol=1e-12)
    picture, _ = render(turned, [[0.3, 0, -2.0]], [[0, 0, 1.0]])
    assert picture.depth[0] / picture.opacity[0] == pytest.approx(2.3, abs=1e-4)


def test_the_order_of_rows_changes_nothing() -> None:
    g, rays = oracle.cloud(300, 9), ray_oracle.rays(100, 9)
    order = np.random.default_rng(1).permutation(300)
    shuffled = Gaussians(**{name: array[order] for name, array in g.arrays().items()})
    a, b = render(g, *rays)[0], render(shuffled, *rays)[0]
    assert np.array_equal(a.color, b.color)
    assert np.array_equal(a.depth, b.depth)


def test_of_equal_peaks_the_first_row_is_in_front() -> None:
    # More of them than the list holds, all at the same place.
    many = Gaussians(**{name: np.repeat(a, 100, 0) for name, a in one().arrays().items()})
    many.opacity_logits[:] = -4.0
    many.sh[:, 0, 0] = np.linspace(-1, 1, 100)
    picture, context = render(many, [[0.1, 0, -2.0]], [[0, 0, 1.0]], options=DEFAULT.smooth())
    expected = ray_oracle.render(
        many, np.array([[0.1, 0, -2.0]]), np.array([[0, 0, 1.0]]), np.zeros(3), DEFAULT.smooth()
    )
    assert context.crossings[0] == 100
    np.testing.assert_allclose(picture.color, expected["color"], rtol=1e-12)
    assert picture.color[0, 0] < picture.color[0, 1]  # the dark red ones stand in front


def test_a_rays_length_and_batch_change_nothing() -> None:
    g, (origins, directions) = oracle.cloud(50, 2), ray_oracle.rays(60, 2)
    picture, _ = render(g, origins, directions)
    longer, _ = render(g, origins, 4.0 * directions)
    np.testing.assert_array_equal(longer.depth, picture.depth)
    alone, _ = render(g, origins[17:18], directions[17:18])
    assert np.array_equal(alone.color[0], picture.color[17])
