"""What photographs ask of space: matter where the ball is, none where only background shows."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.errors import RangeError
from photograd.fields import DenseGrid
from photograd.fitting.data import TrainingPixels
from photograd.fitting.model import Model
from photograd.fitting.voxel_gradients import density_gradient, voxel_masks
from photograd_course.gradcheck import check_gradient
from photograd_course.viz import sign_report

BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
CENTER, RADIUS = np.array([0.15, -0.1, 0.05]), 0.4


def photograph(camera: Camera) -> Any:
    """(H, W, 4): an opaque ball, exact for each pixel's ray, with stripes of two colors."""
    origins, directions = camera.rays()
    offset = CENTER - origins
    along = np.einsum("rk,rk->r", offset, directions)
    gap = RADIUS**2 - (np.einsum("rk,rk->r", offset, offset) - along**2)
    point = origins + directions * (along - np.sqrt(np.maximum(gap, 0)))[:, None]
    stripe = np.sin(9 * point[:, 1])[:, None] > 0
    color = np.where(stripe, [0.9, 0.5, 0.2], [0.1, 0.3, 0.7])
    rgba = np.concatenate([color, np.ones((len(color), 1))], axis=1) * (gap > 0)[:, None]
    return rgba.reshape(camera.height, camera.width, 4).astype(np.float32)


@cache
def ball(size: int = 64) -> Capture:
    """Six views of `size` x `size` pixels, from above and below.

    Few, so that some voxels have the ball neither before nor behind them in any of the views.
    """
    cameras = [
        camera
        for elevation in (-35.0, 20.0)
        for camera in orbit_cameras(BOX, 3, size=size, elevation=elevation)
    ]
    views = tuple(View(f"view_{k}", c, photograph(c)) for k, c in enumerate(cameras))
    return Capture(views, (), "memory", Path("memory"), "display", True, bounds=BOX)


def start(resolution: int = 16, dtype: Any = np.float32) -> DenseGrid:
    return DenseGrid.empty(BOX, resolution, sigma_t=0.1, dtype=dtype)


def centers(grid: DenseGrid) -> Any:
    """Centers (X, Y, Z, 3) of the voxels."""
    n = grid.params["values"].shape[0]
    axis = -1 + (np.arange(n) + 0.5) * 2 / n
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)


@pytest.mark.parametrize("seed", [0, 1])
def test_signs_of_the_gradient_at_the_start(seed: int) -> None:
    # A19: 95 % by mass in each region. Over ten seeds both shares were 100.0 %.
    field, capture = start(28), ball()
    pixels = TrainingPixels(capture.train, capture.color_space)
    found = density_gradient(field, pixels, seed=seed, rays=1 << 18)
    assert found.loss > 0.004
    masks = voxel_masks(field, capture)
    report = sign_report(
        found.d_sigma_t, occupied=masks.occupied, background_only=masks.background_only
    )
    assert report.occupied_voxels > 50
    assert report.background_voxels > 50
    assert report.holds(0.95), report.caption()
    # Turned around, or with the regions swapped, the claim fails: the report does look at signs.
    swapped = sign_report(
        -found.d_sigma_t, occupied=masks.occupied, background_only=masks.background_only
    )
    assert swapped.occupied_fraction < 0.05
    assert swapped.background_fraction < 0.05


@pytest.mark.parametrize("shade", [0.0, 0.1, 0.5, 1.0])
def test_dark_and_bright_matter_are_wanted_alike(shade: float) -> None:
    field, capture = start(28), ball()
    masks = voxel_masks(field, capture)
    views = [
        replace(v, image=(v.rgba()[..., 3:] * [shade, shade, shade, 1]).astype(np.float32))
        for v in capture.train
    ]
    found = density_gradient(field, TrainingPixels(views, "display"), seed=2, rays=1 << 16)
    report = sign_report(
        found.d_sigma_t, occupied=masks.occupied, background_only=masks.background_only
    )
    assert report.holds(0.95), report.caption()


def test_masks_hold_for_every_ray() -> None:
    # Which voxels does any ray of an opaque, of an empty pixel touch? Asked of each ray and each
    # voxel's cube (its basis function reaches one voxel to either side), by the slab test.
    grid, capture = start(16), ball(32)
    position = centers(grid).reshape(-1, 3)
    touched = {"opaque": np.zeros(len(position), bool), "empty": np.zeros(len(position), bool)}
    for view in capture.train:
        origins, directions = view.camera.rays()
        opaque = view.rgba()[..., 3].ravel() > 0.5
        for number in range(0, len(directions), 16):
            rays = slice(number, number + 16)
            ends = [
                (position + side * 2 / 16 - origins[0])[:, None] / directions[rays]
                for side in (-1, 1)
            ]
            enter = np.minimum(*ends).max(axis=2)
            hit = enter <= np.maximum(*ends).min(axis=2)
            touched["opaque"] |= hit[:, opaque[rays]].any(axis=1)
            touched["empty"] |= hit[:, ~opaque[rays]].any(axis=1)
    masks = voxel_masks(grid, capture)
    occupied, background = masks.occupied.ravel(), masks.background_only.ravel()
    assert not (occupied & touched["empty"]).any()
    assert not (background & touched["opaque"]).any()
    # The footprint is a rectangle around the cube's image, so that some voxels are missed.
    right = {"occupied": ~touched["empty"], "background": ~touched["opaque"]}
    assert occupied.sum() >= right["occupied"].sum() / 8
    assert background.sum() >= right["background"].sum() / 4
    assert np.linalg.norm(position[occupied] - CENTER, axis=1).max() < RADIUS


def test_masks_need_alpha() -> None:
    capture = ball()
    opaque = Capture(capture.train, (), "memory", Path("memory"), "display", False, bounds=BOX)
    with pytest.raises(RangeError, match="voxel_masks: capture: expected images with alpha"):
        voxel_masks(start(), opaque)


def test_the_gradient_is_that_of_sigma_t() -> None:
    # Differences in sigma_t itself, through the inverse of sigma_t = scale softplus(raw).
    capture = ball()
    pixels = TrainingPixels(capture.train, capture.color_space)
    field = start(6, np.float64)
    scale = field.policy.density_scale
    sigma_t = np.random.default_rng(1).uniform(0.1, 2.0, (6, 6, 6))
    field.color[...] = np.random.default_rng(2).uniform(-1, 1, (6, 6, 6, 3))

    def evaluate(p: dict[str, Any]) -> Any:
        field.density[...] = np.log(np.expm1(p["sigma_t"] / scale))
        return density_gradient(field, pixels, seed=3, rays=300)

    report = check_gradient(
        lambda p: evaluate(p).loss,
        lambda p, d: {"sigma_t": d * evaluate(p).d_sigma_t.astype(np.float64)},
        {"sigma_t": sigma_t},
        seed=1,
        directions=4,
        coordinates=12,
    )
    assert report, str(report)


def test_many_rays_are_the_mean_of_their_parts() -> None:
    # More rays than are rendered at once: the parts are weighed by their numbers.
    capture = ball()
    pixels = TrainingPixels(capture.train, capture.color_space)
    field = start(6)
    whole = density_gradient(field, pixels, seed=4, rays=(1 << 16) + 5000, background=np.ones(3))
    part = density_gradient(field, pixels, seed=4, rays=1 << 16, background=np.ones(3))
    # Measured: 0.4 and 0.3 %.
    assert whole.loss == pytest.approx(part.loss, rel=0.01)
    assert whole.loss != part.loss
    np.testing.assert_allclose(
        np.abs(whole.d_sigma_t).sum(), np.abs(part.d_sigma_t).sum(), rtol=0.01
    )


def test_a_model_brings_its_background_and_without_alpha_there_must_be_one() -> None:
    field, capture = start(16), ball()
    opaque = [replace(v, image=np.maximum(v.rgba(), [0, 0, 0, 1])) for v in capture.train]
    photographs = replace(capture, train=tuple(opaque), has_alpha=False)
    learned = replace(Model.of(field), background=np.array([0.2, 0.5, 0.7]))
    found = density_gradient(learned, photographs, seed=5, rays=3000)
    same = density_gradient(
        field, photographs, seed=5, rays=3000, background=np.array([0.2, 0.5, 0.7])
    )
    np.testing.assert_array_equal(found.d_sigma_t, same.d_sigma_t)
    assert found.d_sigma_t.any()
    with pytest.raises(RangeError, match=r"density_gradient: background: .*no alpha.*Model"):
        density_gradient(field, photographs, seed=5)
    assert density_gradient(Model.of(field), capture, seed=5, rays=3000).loss > 0
