"""Gaussians on a canvas: closed forms, order, slabs, and the step from 2D to 3D."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.errors import DtypeError, ShapeError
from photograd.fields import Gaussians2D
from photograd.fields import gaussians_2d as module
from photograd.representation import CanvasBatch, Outputs, RenderOptions
from photograd.sh import Y_0
from photograd.splats.splatting import Gaussians, SplatOptions
from photograd.splats.splatting import render as splat


def drawn(field: Gaussians2D, points: Any) -> Any:
    return field.render(CanvasBatch(np.asarray(points)), seed=0, step=0, options=RenderOptions())


def test_one_gaussian_by_hand() -> None:
    # Long along (cos 30, sin 30), right and down.
    half = np.sqrt(0.75)
    field = Gaussians2D(
        np.array([[0.5, 0.5]]),
        np.log([[0.2, 0.1]]),
        np.array([np.pi / 6]),
        np.array([np.log(3)]),
        np.array([[1.0, 0.5, 0.25]]),
    )
    along, across = [0.5 + 0.2 * half, 0.6], [0.5 - 0.1 * 0.5, 0.5 + 0.1 * half]
    outputs, context = drawn(field, [[0.5, 0.5], along, across])
    alpha = 0.75 * np.exp([0, -0.5, -0.5])
    np.testing.assert_allclose(outputs.opacity, alpha, rtol=1e-14)
    np.testing.assert_allclose(outputs.color, alpha[:, None] * [1, 0.5, 0.25], rtol=1e-13)
    d = field.render_backward(context, Outputs(np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 0]])))
    np.testing.assert_allclose(d["mean"], [[alpha[1] / 0.2 * half, alpha[1] / 0.4]], rtol=1e-13)
    np.testing.assert_allclose(d["log_scale"], [[alpha[1], 0]], atol=1e-14)
    np.testing.assert_allclose(d["opacity_logit"], [alpha[1] / 4], rtol=1e-13)


def test_the_first_row_lies_on_top() -> None:
    field = Gaussians2D.example(seed=1)
    field.params["opacity_logit"][:] = 40.0  # opaque in the middle
    middle = field.params["mean"][:1]
    np.testing.assert_allclose(drawn(field, middle)[0].color, field.params["color"][:1])
    backwards = Gaussians2D(*(array[::-1].copy() for array in field.params.values()))
    difference = drawn(backwards, middle)[0].color - field.params["color"][:1]
    assert np.abs(difference).max() > 0.01
    _, context = drawn(field, middle)
    d = field.render_backward(context, Outputs(np.ones((1, 3))))
    assert all(np.isfinite(array).all() for array in d.values())


def test_slabs_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    field, outcome = Gaussians2D.example(seed=2), []
    batch = field.example_batch(seed=2)
    cotangents = np.random.default_rng(1).standard_normal((60, 3))
    for slab in (1 << 17, 9 * 7):  # all at once; seven points at a time
        monkeypatch.setattr(module, "SLAB", slab)
        outputs, context = drawn(field, batch.points)
        outcome.append({"color": outputs.color, "opacity": outputs.opacity})
        outcome[-1] |= field.render_backward(context, Outputs(cotangents))
    for name, array in outcome[0].items():
        np.testing.assert_allclose(outcome[1][name], array, rtol=1e-11, atol=1e-14)


def test_a_camera_that_looks_at_flat_gaussians_sees_the_canvas() -> None:
    # Means on the plane z = 0, the first row nearest by a hair; a pixel is 1/32 of the canvas.
    flat = Gaussians2D.example(seed=3)
    n, p = 9, flat.params
    far, size = 1000.0, 32
    solid = Gaussians(
        np.column_stack([p["mean"] - 0.5, 1e-6 * np.arange(n)]),
        np.column_stack([p["log_scale"], np.full(n, -9.0)]),
        np.column_stack([np.cos(p["angle"] / 2), np.zeros((n, 2)), np.sin(p["angle"] / 2)]),
        p["opacity_logit"],
        ((p["color"] - 0.5) / Y_0)[:, None],
    )
    pose = np.eye(4)
    pose[2, 3] = -far
    camera = Camera(size, size, size * far, size * far, size / 2, size / 2, pose)
    sharp = SplatOptions(low_pass=0.0).smooth()
    picture, _ = splat(solid, camera, options=sharp)
    center = (np.arange(size) + 0.5) / size
    points = np.stack(np.meshgrid(center, center), axis=-1).reshape(-1, 2)
    outputs, _ = drawn(flat, points)
    assert outputs.opacity.max() > 0.5
    np.testing.assert_allclose(picture.color.reshape(-1, 3), outputs.color, atol=1e-5)


def test_a_start_covers_the_canvas() -> None:
    field = Gaussians2D.scattered(100, seed=1)
    area = np.pi * np.exp(field.params["log_scale"].astype(np.float64)).prod(axis=1).sum()
    assert area == pytest.approx(1, rel=1e-5)
    assert field.params["mean"].min() >= 0
    assert field.params["mean"].max() < 1


def test_wrong_arrays_are_refused() -> None:
    good = list(Gaussians2D.example(seed=1).params.values())
    with pytest.raises(
        ShapeError, match=r"Gaussians2D: log_scale: expected shape \(N, 2\) with N = 9"
    ):
        Gaussians2D(good[0], good[1][:, :1], *good[2:])
    with pytest.raises(ShapeError, match=r"Gaussians2D: mean: expected shape \(N, 2\) with N >= 1"):
        Gaussians2D(*(array[:0] for array in good))
    with pytest.raises(DtypeError, match=r"Gaussians2D: .*: expected float64 as mean, got float32"):
        Gaussians2D(*good[:4], good[4].astype(np.float32))
