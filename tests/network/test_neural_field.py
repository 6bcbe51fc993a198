"""Fields of networks as they are fitted: ReLU, linear interpolation, float32, empty cells."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.fields import HashGrid, Nerf
from photograd.fields.hash_grid import HashGridPolicy
from photograd.fields.nerf import NerfPolicy
from photograd.fields.neural_field import CELLS, DECAY, EVERY, PARTS, UNSEEN
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits

pytestmark = pytest.mark.usefixtures("core")

BOX = ((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2))
OPTIONS = RenderOptions(jitter=True)


def hash_grid(dtype: Any) -> HashGrid:
    policy = HashGridPolicy(BOX, 0.05, levels=8, coarsest=4, finest=64, log2_rows=10)
    return started(HashGrid.initial(policy, seed=3, sigma_t=0.5, dtype=dtype))


def nerf(dtype: Any) -> Nerf:
    policy = NerfPolicy(BOX, 0.05, octaves=6)
    return started(Nerf.initial(policy, seed=3, sigma_t=0.5, dtype=dtype))


def started(field: Any) -> Any:
    random = np.random.default_rng(5)
    for name, values in field.params.items():
        noise = random.normal(scale=0.5 if name == "table" else 0.05, size=values.shape)
        values[...] += noise.astype(values.dtype)
    return field


FIELDS = {"hash_grid": hash_grid, "nerf": nerf}
each_field = pytest.mark.parametrize("make", FIELDS.values(), ids=FIELDS)


def rays(count: int, dtype: Any) -> RayBatch:
    random = np.random.default_rng(count)
    origins = random.normal(size=(count, 3))
    origins *= 3 / np.linalg.norm(origins, axis=1, keepdims=True)
    to = random.uniform(-0.6, 0.6, (count, 3)) - origins
    to /= np.linalg.norm(to, axis=1, keepdims=True)
    return RayBatch(origins.astype(dtype), to.astype(dtype), np.arange(count, dtype=np.uint32))


def gradients(field: Any, batch: RayBatch) -> tuple[Outputs, dict[str, Any]]:
    outputs, context = field.render(batch, seed=1, step=2, options=OPTIONS)
    dtype, random = outputs.color.dtype, np.random.default_rng(9)
    d = [random.normal(size=a.shape).astype(dtype) for a in (outputs.color, outputs.opacity)]
    return outputs, field.render_backward(context, Outputs(*d))


@each_field
def test_derivatives_with_relu_and_linear_interpolation(make: Any) -> None:
    # Samples stay where they are while parameters move, and no pre-activation is at its kink.
    field = make(np.float64)
    batch = rays(6, np.float64)

    def function(groups: Any) -> Any:
        field.params = dict(groups)
        outputs, _ = field.render(batch, seed=1, step=2, options=OPTIONS)
        return {"color": outputs.color, "opacity": outputs.opacity, "depth": outputs.depth}

    def backward(groups: Any, cotangent: Any) -> Any:
        field.params = dict(groups)
        _, context = field.render(batch, seed=1, step=2, options=OPTIONS)
        return field.render_backward(context, Outputs(**cotangent))

    report = check_gradient(function, backward, dict(field.params), seed=3)
    assert report, report


@each_field
def test_float32_is_float64_rounded(make: Any) -> None:
    double, single = make(np.float64), make(np.float32)
    for name, values in double.params.items():
        single.params[name] = values.astype(np.float32)
    exact, d_exact = gradients(double, rays(40, np.float64))
    got, d_got = gradients(single, rays(40, np.float32))
    assert exact.opacity is not None
    assert exact.opacity.min() > 0.05  # no ray misses the field
    np.testing.assert_allclose(got.color, exact.color, atol=2e-5)
    for name in d_exact:
        # Where rounding moves a pre-activation across its kink, a sample's derivative differs.
        off = np.linalg.norm(d_got[name] - d_exact[name]) / np.linalg.norm(d_exact[name])
        assert off < 2e-3, (name, off)


@each_field
def test_empty_cells_are_skipped_and_have_no_derivative(make: Any) -> None:
    field = make(np.float32)
    batch = rays(64, np.float32)
    everywhere, d_everywhere = gradients(field, batch)
    field.reached = np.full((CELLS,) * 3, UNSEEN, np.float32)
    same, d_same = gradients(field, batch)
    np.testing.assert_array_equal(same.color, everywhere.color)
    for name in d_same:
        np.testing.assert_array_equal(d_same[name], d_everywhere[name])
    field.reached[:] = 0.0
    field.reached[0, 0, 0] = UNSEEN  # a corner that no ray meets
    nothing, d_nothing = gradients(field, batch)
    assert not nothing.color.any()
    assert not any(d.any() for d in d_nothing.values())
    field.reached[:, :, CELLS // 2 :] = UNSEEN  # x above the middle: [z, y, x]
    half, _ = gradients(field, batch)
    assert nothing.opacity is not None
    assert half.opacity is not None
    assert everywhere.opacity is not None
    along_x = RayBatch(
        np.array([[-3, 0.1, 0.1], [-3, 0.1, 0.1]], np.float32),
        np.array([[1, 0, 0], [1, 0, 0]], np.float32),
        np.arange(2, dtype=np.uint32),
    )
    outputs, _ = field.render(along_x, seed=1, step=2, options=RenderOptions())
    assert outputs.depth is not None
    assert outputs.opacity is not None
    mean_depth = outputs.depth / outputs.opacity
    assert (mean_depth > 3.0).all(), "nothing is seen before the middle"
    assert (half.opacity <= everywhere.opacity + 1e-6).all()
    assert half.opacity.max() > 0.05


@each_field
def test_densities_are_those_that_a_ray_sees(make: Any) -> None:
    field = make(np.float64)
    dt, start = field.policy.dt, np.array([[-0.3, 0.2, 0.1]])
    batch = RayBatch(start, np.array([[1.0, 0, 0]]), np.zeros(1, np.uint32))
    outputs, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
    steps = round((1.0 + 0.3) / dt)
    along = start + (np.arange(steps)[:, None] + 0.5) * [[dt, 0, 0]]
    expected = -np.expm1(-dt * field.densities(along).sum())
    assert outputs.opacity is not None
    assert outputs.opacity[0] == pytest.approx(expected, rel=1e-9)
    with pytest.raises(RangeError, match=r"densities: points"):
        field.densities(np.array([[1.5, 0.0, 0.0]]))
    with pytest.raises(ShapeError, match=r"densities: points"):
        field.densities(np.zeros((3, 2)))


def test_color_depends_on_the_direction_and_density_does_not() -> None:
    field = nerf(np.float64)
    batch = rays(8, np.float64)
    outputs, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
    W, _ = field.color.layers(field.params["color"])[0]
    W[:, field.density.outputs - 1 :] += 0.5  # of the harmonics
    other, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
    np.testing.assert_array_equal(outputs.opacity, other.opacity)
    assert np.abs(outputs.color - other.color).max() > 1e-3


@each_field
def test_cells_are_marked_by_the_densities_in_them(make: Any) -> None:
    field = make(np.float32)
    assert field.occupied() is None
    field.after_step({}, 0)  # a part of the cells: a checkpoint takes finite numbers alone
    assert np.isfinite(field.state()["reached"]).all()
    assert field.reached.max() >= UNSEEN
    for step in range(0, EVERY * PARTS, EVERY):
        field.after_step({}, step)
        field.after_step({}, step + 1)  # nothing in between
    assert field.reached.max() < UNSEEN
    low, high = field.box
    k, j, i = np.meshgrid(*[(np.arange(CELLS) + 0.5) / CELLS] * 3, indexing="ij")
    centers = low + np.stack([i, j, k], -1).reshape(-1, 3) * (high - low)
    there = field.densities(centers.astype(np.float32)).reshape((CELLS,) * 3)
    found = np.log(field.reached)
    # Density varies within a cell, too; along a wrong axis the correlation would vanish.
    assert np.corrcoef(found.ravel(), np.log(there).ravel())[0, 1] > 0.8
    field.params["density"][:] = 0.0
    _, bias = field.density.layers(field.params["density"])[-1]
    bias[0] = -20.0
    before = field.reached.copy()
    for step in range(0, EVERY * PARTS, EVERY):
        field.after_step({}, step)
    np.testing.assert_allclose(field.reached, np.float32(DECAY) * before, rtol=1e-6)


@each_field
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_kept_samples_change_no_bit(make: Any, dtype: Any) -> None:
    field = make(dtype)
    batch, keep = rays(300, dtype), replace(OPTIONS, keep_samples=True, stop=1e-2)
    outputs, context = field.render(batch, seed=1, step=2, options=replace(OPTIONS, stop=1e-2))
    same, kept = field.render(batch, seed=1, step=2, options=keep)
    assert (context.kept is None, kept.kept is None) == (True, False)
    d = Outputs(np.ones_like(outputs.color), np.ones_like(outputs.opacity))
    expected = field.render_backward(context, d)
    for found in (field.render_backward(kept, d), field.render_backward(kept, d)):  # twice
        for name in expected:
            np.testing.assert_array_equal(found[name], expected[name])
    np.testing.assert_array_equal(same.color, outputs.color)
    # What was kept of other rays, or of more than it may keep, is evaluated again.
    fewer = RayBatch(batch.origins[:50], batch.directions[:50], batch.pixel[:50])
    _, other = field.render(fewer, seed=1, step=2, options=OPTIONS)
    d = Outputs(np.ones((50, 3), dtype), np.ones(50, dtype))
    expected = field.render_backward(other, d)
    found = field.render_backward(replace(other, kept=kept.kept), d)
    for name in expected:
        np.testing.assert_array_equal(found[name], expected[name])


def test_sizes_that_no_network_has_are_refused() -> None:
    with pytest.raises(RangeError, match=r"NerfPolicy: width"):
        NerfPolicy(BOX, 0.05, width=0)
    with pytest.raises(RangeError, match=r"HashEncoding: log2_rows"):
        HashGrid(HashGridPolicy(BOX, 0.05, log2_rows=30))
    field = nerf(np.float32)
    with pytest.raises(ShapeError, match=r"Nerf: color"):
        Nerf(field.policy, {**field.params, "color": field.params["color"][1:]})


@same_bits("neural fields", each=FIELDS, kernels=("perceptron_forward", "perceptron_backward"))
def a_batch(name: str) -> list[Any]:
    field = FIELDS[name](np.float32)
    outputs, d = gradients(field, rays(300, np.float32))
    return [outputs.color, *d.values()]
