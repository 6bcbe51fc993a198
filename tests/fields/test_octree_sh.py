"""Octrees of spherical harmonics: closed forms, merged leaves, conversion and fine-tuning."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.fields import DenseGrid, OctreeSh
from photograd.grids.octree import Octree
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import check_gradient
from photograd_course.optim import Adam

OPTIONS = RenderOptions()
BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def rays(origins: Any, directions: Any) -> RayBatch:
    o, d = np.atleast_2d(origins).astype(float), np.atleast_2d(directions).astype(float)
    return RayBatch(o, d / np.linalg.norm(d, axis=1, keepdims=True), np.arange(len(o), dtype="u4"))


def one_leaf(raw: float = 0.4) -> OctreeSh:
    tree = Octree.from_dense(np.ones((1, 1, 1, 1)), BOX)
    coefficients = np.zeros((1, 1, 3))
    coefficients[0, 0] = [1.0, -2.0, 0.5]
    return OctreeSh(tree, np.zeros(1, np.int32), np.array([raw]), coefficients, density_scale=1.5)


def look(field: OctreeSh, batch: RayBatch, options: RenderOptions = OPTIONS) -> Outputs:
    return field.render(batch, seed=0, step=0, options=options)[0]


@pytest.mark.parametrize(
    ("origin", "length"), [([-3.0, 0.1, 0.2], 2.0), ([0.5, 0.0, 0.0], 0.5), ([2.0, 0.0, 0.0], 0.0)]
)
def test_a_constant_medium_has_its_closed_form(origin: list[float], length: float) -> None:
    seen = look(one_leaf(), rays(origin, [1.0, 0.0, 0.0]))
    through = np.exp(-1.5 * np.log1p(np.exp(0.4)) * length)
    rgb = 1 / (1 + np.exp(-0.28209479177387814 * np.array([1.0, -2.0, 0.5])))
    assert seen.opacity is not None
    np.testing.assert_allclose(seen.opacity, [1 - through], rtol=0, atol=1e-14)
    np.testing.assert_allclose(seen.color, [(1 - through) * rgb], rtol=0, atol=1e-14)


def test_cutting_a_leaf_into_equal_ones_changes_nothing() -> None:
    field = OctreeSh.example(seed=3)
    lower, side = field.tree.leaf_boxes()
    labels = np.empty((8, 8, 8))
    for number, (corner, size) in enumerate(zip(lower, side, strict=True)):
        labels[tuple(slice(at, at + size) for at in corner)] = number
    single = Octree.from_function(
        lambda at, size: None if size > 1 else [labels[at]], 3, field.tree.bounds
    )
    source = field.row[single.values[:, 0].astype(int)]
    row = np.where(source >= 0, np.cumsum(source >= 0) - 1, -1).astype(np.int32)
    cut = OctreeSh(
        single,
        row,
        field.params["density"][source[source >= 0]],
        field.params["sh"][source[source >= 0]],
        density_scale=field.density_scale,
    )
    assert len(single.values) == 512 > 2 * len(labels[0])
    assert (side > 1).any()
    batch = field.example_batch(seed=3)
    whole, pieces = look(field, batch), look(cut, batch)
    assert whole.opacity is not None
    assert whole.opacity.max() > 0.5
    np.testing.assert_allclose(pieces.color, whole.color, rtol=0, atol=1e-13)
    np.testing.assert_allclose(pieces.opacity, whole.opacity, rtol=0, atol=1e-13)


def test_the_stop_discards_less_than_it_says() -> None:
    field = OctreeSh.example(seed=4)
    field.density_scale = 40.0
    batch = field.example_batch(seed=4)
    whole, stopped = look(field, batch), look(field, batch, RenderOptions(stop=0.05))
    difference = np.abs(whole.color - stopped.color).max()
    assert 0 < difference < 0.05


def test_the_gradient_holds_under_the_stop() -> None:
    field = OctreeSh.example(seed=4)
    field.density_scale = 40.0
    batch, options = field.example_batch(seed=4), RenderOptions(stop=0.05)

    def forward(params: dict[str, Any]) -> dict[str, Any]:
        field.params = dict(params)
        seen = look(field, batch, options)
        return {"color": seen.color, "opacity": seen.opacity}

    def backward(params: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        field.params = dict(params)
        _, context = field.render(batch, seed=0, step=0, options=options)
        return field.render_backward(context, Outputs(**d))

    # Small steps: a ray may stop a leaf earlier or later.
    report = check_gradient(forward, backward, dict(field.params), seed=4, steps=(1e-5, 1e-6))
    assert report, str(report)


def ball(resolution: int) -> DenseGrid:
    """A fuzzy ball whose color changes from side to side."""
    field = DenseGrid.empty(BOX, resolution, dtype=np.float64)
    at = -1 + (np.arange(resolution) + 0.5) * 2 / resolution
    x, y, z = np.meshgrid(at, at, at, indexing="ij")
    inside = 0.7 - np.sqrt(x**2 + y**2 + z**2)
    field.density[...] = np.where(inside > 0, 5.0, -12.0)
    field.color[...] = np.stack([2 * np.sign(x), 2 * np.sign(y), -x], axis=-1)
    return field


def test_a_grid_becomes_a_tree_that_learns_what_the_conversion_lost() -> None:
    grid = ball(16)
    tree = OctreeSh.from_dense_grid(grid, degree=1, tolerance=0.2)
    # Empty space and the inside are few leaves.
    assert len(tree.params["density"]) < 0.1 * 16**3  # measured: 0.08
    batch = grid.example_batch(seed=5)
    many = [grid.example_batch(seed=s) for s in range(5, 25)]
    batch = RayBatch(
        np.concatenate([b.origins for b in many]),
        np.concatenate([b.directions for b in many]),
        np.arange(24 * 20, dtype=np.uint32),
    )
    truth = grid.render(batch, seed=0, step=0, options=OPTIONS)[0].color
    optimizer = Adam()
    errors = []
    for step in range(41):
        seen, context = tree.render(batch, seed=0, step=step, options=OPTIONS)
        errors.append(float(((seen.color - truth) ** 2).mean()))
        d = Outputs(2 * (seen.color - truth) / truth.size)
        rates = {name: 0.5 * spec.learning_rate for name, spec in tree.param_groups().items()}
        optimizer.step(tree.params, tree.render_backward(context, d), rates)
    assert np.abs(truth).max() > 0.5
    # Measured 0.0149, then 0.0026: a step function stands for a trilinear one.
    assert errors[0] < 0.02
    assert errors[-1] < 0.2 * errors[0]


def test_topology_and_rows_are_checked() -> None:
    field = OctreeSh.example(seed=1)
    other = OctreeSh.example(seed=2)
    with pytest.raises(RangeError, match="the topology of an octree_sh cannot change"):
        field.load_state(other.state())
    density, coefficients = field.params["density"], field.params["sh"]
    with pytest.raises(ShapeError, match="row"):
        OctreeSh(field.tree, field.row[1:], density, coefficients)
    with pytest.raises(RangeError, match="each of 0, 1"):
        OctreeSh(field.tree, np.where(field.row == 1, 0, field.row), density, coefficients)
    with pytest.raises(ShapeError, match="density"):
        OctreeSh(field.tree, field.row, density[1:], coefficients)
    with pytest.raises(RangeError, match="1, 4, 9, 16 or 25"):
        OctreeSh(field.tree, field.row, density, coefficients[:, :5])
