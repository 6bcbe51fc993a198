"""The dense grid as Python sees it: linear in its colors, refined without a change of meaning."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.fields import DenseGrid
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import dot_product_error

BOX = np.array([[-1.0, -0.5, 0.0], [1.0, 1.0, 0.8]])
OPTIONS = RenderOptions()


def identity_grid(seed: int) -> DenseGrid:
    """The example with colors that are used as they are."""
    grid = DenseGrid.example(seed=seed)
    return DenseGrid(grid.params["values"], replace(grid.policy, color_activation="identity"))


@pytest.mark.parametrize("fused", [True, False])
def test_the_image_is_linear_in_color_and_its_adjoint_is_the_transpose(fused: bool) -> None:
    grid = identity_grid(1)
    grid.fused = fused
    batch = grid.example_batch(seed=1)
    density = grid.density[..., None].copy()

    def render(color: Any) -> tuple[Any, Any]:
        grid.params = {"values": np.concatenate([color, density], axis=-1)}
        return grid.render(batch, seed=0, step=0, options=OPTIONS)

    def derivative(_: dict[str, Any], v: dict[str, Any]) -> Any:
        return render(v["color"])[0].color  # J v, exactly: the image has no constant part

    def backward(p: dict[str, Any], d_color: Any) -> dict[str, Any]:
        gradients = grid.render_backward(render(p["color"])[1], Outputs(d_color))
        return {"color": np.ascontiguousarray(gradients["values"][..., :3])}

    color = grid.color.copy()
    report = dot_product_error(derivative, backward, {"color": color}, seed=1, tolerance=1e-10)
    assert report, str(report)
    both = render(color)[0].color + render(2 * color)[0].color
    np.testing.assert_allclose(render(3 * color)[0].color, both, rtol=1e-12)


def test_colors_do_not_move_opacity_or_depth() -> None:
    grid = identity_grid(2)
    batch = grid.example_batch(seed=2)
    outputs, context = grid.render(batch, seed=0, step=0, options=OPTIONS)
    assert outputs.opacity is not None
    assert outputs.depth is not None
    d = Outputs(np.zeros_like(outputs.color), np.ones(24), np.ones(24))
    gradient = grid.render_backward(context, d)["values"]
    assert np.abs(gradient[..., 3]).max() > 0
    assert not gradient[..., :3].any()


def test_empty_space_has_the_density_that_was_asked_for() -> None:
    grid = DenseGrid.empty(BOX, 20, finest=80, sigma_t=0.3, dtype=np.float64)
    assert grid.params["values"].shape == (20, 15, 8, 4)
    np.testing.assert_allclose(grid.box, BOX, atol=1e-12)
    # Straight through the box along X: 2 m of 0.3/m, middle gray.
    batch = RayBatch(np.array([[-3.0, 0.2, 0.4]]), np.array([[1.0, 0, 0]]), np.zeros(1, np.uint32))
    outputs, _ = grid.render(batch, seed=0, step=0, options=OPTIONS)
    assert outputs.opacity is not None
    # 40 steps of 0.05 m, none of them cut: the sum is exact up to rounding.
    np.testing.assert_allclose(outputs.opacity, [1 - np.exp(-0.6)], rtol=1e-12)
    np.testing.assert_allclose(outputs.color[0] / outputs.opacity, [0.18] * 3, rtol=1e-12)


def test_voxels_are_cubes_in_a_box_that_may_grow() -> None:
    grid = DenseGrid.empty(np.array([[0, 0, 0], [1.0, 0.33, 0.01]]), 10)
    assert grid.params["values"].shape == (10, 4, 2, 4)
    edge = (grid.box[1] - grid.box[0]) / grid.params["values"].shape[:3]
    np.testing.assert_allclose(edge, 0.1, rtol=1e-12)
    np.testing.assert_allclose(grid.box.mean(axis=0), [0.5, 0.165, 0.005], atol=1e-12)


def test_refining_keeps_box_and_density_scale_and_shortens_the_step() -> None:
    coarse = DenseGrid.empty(BOX, 10, finest=40)
    fine = coarse.refined(20)
    assert fine.params["values"].shape == (20, 16, 8, 4)
    np.testing.assert_array_equal(fine.box, coarse.box)
    assert fine.policy.density_scale == coarse.policy.density_scale == 40 / 2.0
    assert fine.policy.dt == pytest.approx(coarse.policy.dt / 2, rel=1e-12)
    assert np.array_equal(np.unique(fine.density), np.unique(coarse.density))


def test_views_share_their_memory_with_the_parameter() -> None:
    grid = DenseGrid.example(seed=3)
    grid.color[0, 0, 0] = 7
    grid.density[0, 0, 0] = 8
    assert grid.params["values"][0, 0, 0].tolist() == [7, 7, 7, 8]


VALUES = DenseGrid.example(seed=1).params["values"]
POLICY = DenseGrid.example(seed=1).policy


@pytest.mark.parametrize(
    ("values", "error", "words"),
    [
        (VALUES[..., :3], ShapeError, r"values: expected shape \(X, Y, Z, 4\).*got \(5, 4, 6, 3\)"),
        (VALUES[:1], ShapeError, r"got \(1, 4, 6, 4\)"),
        (VALUES.astype(int), DtypeError, "expected float32 or float64, got int64"),
        (np.where(VALUES > 0.9, np.nan, VALUES), Error, "expected finite numbers, got nan"),
    ],
)
def test_bad_values_are_refused(values: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        DenseGrid(values, POLICY)


@pytest.mark.parametrize(
    ("box", "resolution", "words"),
    [
        (BOX, 1, "resolution: expected a whole number of at least 2"),
        (BOX[::-1], 8, "box: expected corners, lower below upper"),
        (np.where(BOX == 1.0, np.nan, BOX), 8, "box: expected finite"),
    ],
)
def test_bad_boxes_are_refused(box: Any, resolution: int, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        DenseGrid.empty(box, resolution)


def test_an_unknown_policy_is_named() -> None:
    unknown: Any = "middle"
    with pytest.raises(RangeError, match=r"MarchPolicy: lattice: expected one of .*'middle'"):
        replace(POLICY, lattice=unknown)


@pytest.mark.parametrize("channel", [0, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_voxel_that_went_bad_is_reported(dtype: Any, channel: int) -> None:
    grid = DenseGrid.example(seed=4, dtype=dtype)
    batch = grid.example_batch(seed=4)
    for bad in (np.nan, np.inf):
        grid.params["values"][2, 2, 2, channel] = bad
        with pytest.raises(Error, match="march: parameters: expected finite values, got 1 that"):
            grid.render(batch, seed=0, step=0, options=OPTIONS)
    # Large values are not confused with infinite ones, although their sum overflows in float32.
    grid.params["values"][..., 3] = 3e36 if dtype is np.float32 else 1e3
    grid.params["values"][2, 2, 2, 0] = 0
    assert np.isfinite(grid.render(batch, seed=0, step=0, options=OPTIONS)[0].color).all()


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("origins", np.nan),
        ("origins", np.inf),
        ("directions", np.nan),
        ("directions", 0.0),
        ("directions", 5.0),
    ],
)
def test_rays_that_are_no_rays_are_named_by_their_pixel(name: str, value: float) -> None:
    grid = DenseGrid.example(seed=4)
    batch = grid.example_batch(seed=4)
    array = getattr(batch, name).copy()
    array[7] = value
    with pytest.raises(RangeError, match=r"unit directions, got 1 others, the first for pixel 7:"):
        grid.render(replace(batch, **{name: array}), seed=0, step=0, options=OPTIONS)
