"""PlenOctrees: a field of networks read into leaves, color by color and cell by cell."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd.errors import RangeError
from photograd.fields import HashGrid, Nerf, PlenOctree
from photograd.fields.tabulate import (
    cells_in_reach,
    directions_around,
    radiance_of,
    tabulated,
    visible_cells,
)
from photograd.representation import RayBatch, RenderOptions

OPTIONS = RenderOptions()
BOX = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])


def shining_ball(points: Any, directions: Any) -> tuple[Any, Any]:
    """20/m inside of radius 0.6; raw color is linear in the direction, and in x."""
    inside = (points**2).sum(axis=1) < 0.36
    raw = np.stack([directions[:, 0], 0.5 - directions[:, 2], 2 * points[:, 0]], axis=1)
    return np.where(inside, 20.0, 0.0), 1 / (1 + np.exp(-raw))


def leaves(degree: int, **changes: Any) -> Any:
    given = {"opacity": 0.01, "weights": lambda found: np.ones(len(found.density)), "least": 0.5}
    return tabulated(shining_ball, BOX, (8, 8, 8), degree=degree, **given | changes)


def test_the_quadrature_is_exact_for_products_of_degree_3() -> None:
    directions, weight = directions_around()
    Y = sh.basis(directions, 3)
    np.testing.assert_allclose((Y * weight[:, None]).T @ Y, np.eye(16), rtol=0, atol=1e-12)


@pytest.mark.parametrize("degree", [1, 3])
def test_harmonics_of_a_known_field_come_back(degree: int) -> None:
    found = leaves(degree)
    assert 0.1 * 512 < len(found.density) < 0.5 * 512
    raw = sh.evaluate(found.sh, np.tile([[0.6, 0.0, 0.8]], (len(found.sh), 1)))
    np.testing.assert_allclose(raw[:, 0], 0.6, atol=1e-10)
    np.testing.assert_allclose(raw[:, 1], -0.3, atol=1e-10)
    lower, side = found.tree.leaf_boxes()
    center = (lower + side[:, None] / 2)[found.row >= 0][np.argsort(found.row[found.row >= 0])]
    x = -1 + center[:, 0] / 4
    assert np.abs(raw[:, 2] - 2 * x).max() < 2 * 0.125  # of somewhere in the cell
    depth = np.log1p(np.exp(found.density))
    assert np.isclose(depth, 20 * 0.25, rtol=1e-12).any()  # whole inside: 20/m over the edge
    assert depth.max() < 5.0 + 1e-9


def test_what_no_ray_meets_has_no_leaf() -> None:
    whole = leaves(0)
    half = leaves(0, weights=lambda found: found.tree.leaf_boxes()[0][found.row >= 0][:, 2] < 4)
    assert 0.4 < len(half.density) / len(whole.density) < 0.6
    lower, _ = half.tree.leaf_boxes()
    assert lower[half.row >= 0][:, 2].max() == 3


@pytest.mark.parametrize("kind", [HashGrid, Nerf])
def test_what_is_read_at_points_is_what_the_networks_say(kind: Any) -> None:
    field = kind.example(seed=2)
    points = np.random.default_rng(1).uniform(-0.7, 0.7, (20, 3))
    directions = field.example_batch(seed=1).directions[:20]
    sigma_t, rgb = radiance_of(field, 0.05)(points, directions)
    np.testing.assert_allclose(sigma_t, field.densities(points), rtol=1e-8)
    lower, upper = field.box
    unit = (points - lower) / (upper - lower)
    encoded = (
        field.encoding.encode(field.params["table"], unit)
        if kind is HashGrid
        else field.encoding.encode(2 * unit - 1)
    )
    features = field.density.forward(field.params["density"], encoded)[:, 1:]
    given = np.concatenate([features, sh.basis(-directions, 3)], axis=1)
    raw = field.color.forward(field.params["color"], given)
    np.testing.assert_allclose(rgb, 1 / (1 + np.exp(-raw)), rtol=1e-7)


def test_a_smooth_field_and_its_leaves_look_alike() -> None:
    field = HashGrid.example(seed=3)
    batch = field.example_batch(seed=3)
    truth, _ = field.render(batch, seed=0, step=0, options=OPTIONS)
    errors = []
    for resolution in (5, 14):
        tree = PlenOctree.from_field(field, resolution, degree=2, opacity=0.0)
        looks, _ = tree.render(batch, seed=0, step=0, options=OPTIONS)
        errors.append(float(np.abs(looks.color - truth.color).max()))
    assert truth.color.max() > 0.1
    assert errors[1] < 0.08
    assert errors[1] < 0.8 * errors[0]


def test_the_greatest_weight_of_a_leaf_is_that_of_the_pixel_that_needs_it_most() -> None:
    tree = PlenOctree.example(seed=4)
    batch = tree.example_batch(seed=4)
    weight = tree.greatest_weights([batch])
    one = [
        tree.greatest_weights([RayBatch(batch.origins[r : r + 1], batch.directions[r : r + 1], p)])
        for r, p in enumerate(batch.pixel[:, None])
    ]
    np.testing.assert_array_equal(weight, np.max(one, axis=0))
    opacity = tree.render(batch, seed=0, step=0, options=OPTIONS)[0].opacity
    np.testing.assert_allclose(np.sum(one, axis=1), opacity, rtol=1e-12)
    assert 0 < weight.max() < 1


@pytest.mark.parametrize("shape", [(5, 4, 6), (20, 16, 24), (70, 33, 12)])
def test_cells_that_the_occupancy_marks_nowhere_are_not_read(shape: Any) -> None:
    field = HashGrid.example(seed=3)
    field.reached = np.zeros((64, 64, 64), np.float32)
    field.reached[40:60, 3:30, 20:34] = 1e3  # [z, y, x]: neither centered nor symmetric
    reach = cells_in_reach(field, field.box, shape)
    assert reach is not None
    assert reach.shape == shape
    assert 0 < reach.mean() < 0.15
    read = [
        visible_cells(radiance_of(field, 0.05), field.box, shape, opacity=0.0, reach=cells)
        for cells in (None, reach)
    ]
    assert len(read[0].index) > 0
    np.testing.assert_array_equal(read[1].index, read[0].index)
    np.testing.assert_array_equal(read[1].sigma_t, read[0].sigma_t)
    field.reached[:] = 0.0
    field.reached[0, 0, 0] = 1e3
    corner = cells_in_reach(field, field.box, shape)
    assert corner is not None
    assert corner[0, 0, 0]
    assert corner.sum() <= np.prod([-(-n // 64) + 1 for n in shape])


def test_an_empty_field_is_refused() -> None:
    field = HashGrid.initial(HashGrid.example(seed=1).policy, seed=1, sigma_t=1e-6)
    with pytest.raises(RangeError, match=r"cells more opaque than 0.01 .*got none"):
        PlenOctree.from_field(field, 16)
    with pytest.raises(RangeError, match="degree"):
        PlenOctree.from_field(field, 16, degree=4)
