"""Gaussians and rays that nobody should make: never a crash, never a NaN."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.splats.rays import RayOptions, render, render_backward
from photograd.splats.splatting import Gaussians

from tests.splat import oracle, ray_oracle
from tests.splat.test_degenerate import NO_NUMBERS, STRANGE, WEIRD, changed

DEFAULT = RayOptions()
OPTIONS = {"default": DEFAULT, "smooth": DEFAULT.smooth()}
RAYS = ray_oracle.rays(80, 2)
INVISIBLE = {"zero scale", "flat", "wider than numbers", "far away", "absent"}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("policy", OPTIONS)
@pytest.mark.parametrize("name", STRANGE)
def test_strange_gaussians_leave_numbers(name: str, policy: str, dtype: Any) -> None:
    with np.errstate(over="ignore"):
        g = STRANGE[name].astype(dtype)
    picture, context = render(g, *RAYS, options=OPTIONS[policy])
    found = render_backward(context, *[np.ones_like(a) for a in vars(picture).values()], rays=True)
    for array in (*vars(picture).values(), found.background, found.origins, found.directions):
        assert np.isfinite(array).all()
    for group, array in found.gaussians.items():
        assert np.isfinite(array).all(), group
        assert array.any(), group
    assert picture.opacity.max() > 0.3  # the seven others are still there
    if name in INVISIBLE:
        rest = Gaussians(**{key: np.delete(array, 3, 0) for key, array in g.arrays().items()})
        np.testing.assert_array_equal(
            picture.color, render(rest, *RAYS, options=OPTIONS[policy])[0].color
        )


@pytest.mark.parametrize(("name", "bad"), NO_NUMBERS)
def test_what_is_no_number_is_refused_with_its_row(name: str, bad: float) -> None:
    with pytest.raises(RangeError, match=rf"splat_rays: {name}: .* row 3"):
        render(changed(name, bad), *RAYS)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weird_numbers_in_any_combination_leave_numbers(dtype: Any) -> None:
    random = np.random.default_rng(1)
    crossings = 0
    for seed in range(20):
        g = oracle.cloud(200, seed, degree=1)
        for name, array in g.arrays().items():
            if name == "sh":
                continue
            where = random.random(array.shape) < 0.3
            array[where] = random.choice(WEIRD, int(where.sum()))
        with np.errstate(over="ignore"):
            g = g.astype(dtype)
        picture, context = render(g, *RAYS, options=list(OPTIONS.values())[seed % 2])
        found = render_backward(
            context, np.ones_like(picture.color), np.ones_like(picture.opacity), rays=True
        )
        crossings += int(context.crossings.sum())
        rest = {"origins": found.origins, "directions": found.directions}
        for name, array in {**vars(picture), **found.gaussians, **rest}.items():
            assert not np.isnan(array).any(), (seed, name)
            # The derivative with respect to a quaternion of length 1e-30 may overflow.
            assert name == "quats" or np.isfinite(array).all(), (seed, name)
    assert crossings > 1000


@pytest.mark.parametrize("thickness", [1e-3, 1e-6, 1e-9])
def test_paper_of_any_thinness_is_the_same_in_float(thickness: float) -> None:
    # a + t b would lose everything here: the two terms are 1e9 and cancel.
    g = oracle.cloud(1, 5, degree=0)
    g.means[:] = 0.1
    g.log_scales[:] = np.log([0.4, 0.3, thickness])
    g.opacity_logits[:] = 2.0
    origins, directions = ray_oracle.rays(200, 2)
    outcome = []
    for dtype in (np.float32, np.float64):
        picture, context = render(g.astype(dtype), origins, directions)
        found = render_backward(context, np.ones_like(picture.color), rays=True)
        outcome.append([picture.color, picture.depth, found.origins, found.gaussians["means"]])
    for a, b in zip(*outcome, strict=True):
        assert np.abs(b).max() > 0.1
        assert np.linalg.norm(a - b) <= 2e-4 * np.linalg.norm(b)


def test_rays_along_axes_through_means_and_from_within() -> None:
    g = oracle.cloud(20, 4)
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    origins = np.concatenate([np.zeros((6, 3)), -3 * axes, g.means, g.means - axes[:1]])
    directions = np.concatenate([axes, axes, np.ones((20, 3)), np.tile(axes[:1], (20, 1))])
    for options in OPTIONS.values():
        picture, context = render(g, origins, directions, options=options)
        expected = ray_oracle.render(g, origins, directions, np.zeros(3), options)
        np.testing.assert_allclose(picture.color, expected["color"], atol=1e-12)
        found = render_backward(context, np.ones_like(picture.color), rays=True)
        assert all(np.isfinite(array).all() for array in found.gaussians.values())
        assert found.origins is not None
        assert np.isfinite(found.origins).all()


def test_no_gaussians_and_no_rays() -> None:
    none = Gaussians(**{name: array[:0] for name, array in oracle.cloud(1, 1).arrays().items()})
    picture, context = render(none, *RAYS, background=(0.1, 0.2, 0.3))
    assert np.array_equal(picture.color, np.broadcast_to([0.1, 0.2, 0.3], (80, 3)))
    assert not picture.opacity.any()
    found = render_backward(context, np.ones((80, 3)))
    np.testing.assert_allclose(found.background, 80, rtol=1e-12)
    picture, context = render(oracle.cloud(5, 1), np.zeros((0, 3)), np.zeros((0, 3)))
    assert picture.color.shape == (0, 3)
    assert not render_backward(context).gaussians["means"].any()


def test_wrong_arrays_are_refused() -> None:
    g, (origins, directions) = oracle.cloud(4, 1), RAYS
    for name, change in (("origins", np.nan), ("directions", np.inf), ("directions", 0.0)):
        rays = {"origins": origins.copy(), "directions": directions.copy()}
        rays[name][7] = change
        with pytest.raises(RangeError, match=f"splat_rays.render: {name}: .* row 7"):
            render(g, **rays)
    with pytest.raises(ShapeError, match=r"directions: expected shape \(R, 3\) with R = 80"):
        render(g, origins, directions[:5])
    with pytest.raises(ShapeError, match=r"origins: expected shape \(R, 3\)"):
        render(g, origins[:, :2], directions)
    with pytest.raises(ShapeError, match="background"):
        render(g, *RAYS, background=(1.0, 1.0))
    with pytest.raises(RangeError, match="background: expected finite"):
        render(g, *RAYS, background=(np.nan, 1.0, 1.0))
    picture, context = render(g, *RAYS)
    with pytest.raises(ShapeError, match="d_color"):
        render_backward(context, picture.color[1:])
    with pytest.raises(DtypeError, match="d_depth"):
        render_backward(context, None, None, picture.depth.astype(np.float32))


@pytest.mark.parametrize(
    "change", [{"alpha_max": 2.0}, {"alpha_min": np.nan}, {"t_min": -1.0}, {"stop": -1e-3}]
)
def test_options_without_meaning_are_refused(change: dict[str, Any]) -> None:
    (name,) = change
    with pytest.raises(RangeError, match=f"RayOptions: {name}"):
        replace(DEFAULT, **change)
