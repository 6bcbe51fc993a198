"""A tiny network a cell: windows that sum to one, gradients, and what distillation reaches."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.fields import HashGrid, LeafMlps
from photograd.fields.active_voxels import SIDE, ActiveVoxels
from photograd.fields.cell_networks import MARGIN, CellsPolicy, Overlaps
from photograd.representation import Outputs, RenderOptions, check_gradients

BOX = ((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2))


def two_cells() -> ActiveVoxels:
    """Two bricks along x of three, the third without voxels."""
    mask = np.zeros((24, 8, 8), bool)
    mask[:16] = True
    return ActiveVoxels(mask)


def at(x: Any) -> Any:
    """Points in voxels, from positions along x in cells, in the middle of y and z."""
    u = np.stack([x, np.full(len(x), 0.5), np.full(len(x), 0.5)], axis=1)
    return u * SIDE - 0.5


def test_gradients_are_right() -> None:
    report = check_gradients(LeafMlps.example(seed=1), seed=1, camera=True)
    assert report, str(report)


def test_shares_sum_to_one_and_fade_over_the_margin() -> None:
    x = np.linspace(0.0, 2.06, 400)
    found = Overlaps.of_points(at(x), two_cells())
    np.testing.assert_allclose(np.bincount(found.sample, found.share), 1, rtol=1e-12)
    pairs = np.bincount(found.sample)
    near = np.abs(x - 1) < MARGIN
    np.testing.assert_array_equal(pairs, np.where(near, 2, 1))
    first = np.zeros(len(x))
    own = slice(*found.offset[:2])
    first[found.sample[own]] = found.share[own]
    assert abs(np.interp(1.0, x, first) - 0.5) < 1e-2
    assert (np.diff(first[near]) < 0).all()


def test_networks_of_equal_weights_in_neighboring_cells_leave_no_seam() -> None:
    field = LeafMlps.example(seed=2)
    policy = CellsPolicy(field.policy.box, 0.1, octaves=0, width=4, features=2)
    flat = LeafMlps._random(field.active, policy, seed=1, dtype=np.float64)
    for values, networks in zip(flat.params.values(), policy.networks(), strict=True):
        values[:] = values[:1]
        for row in values:  # nothing but biases: equal in all cells
            networks.each.layers(row)[0][0][:] = 0
    grid = flat._grid()
    where = Overlaps.of_points(flat.active.voxels + 0.3, flat.active)
    _, given = grid.densities(where)
    np.testing.assert_allclose(np.ptp(where.blended(given), axis=0), 0, atol=1e-12)


def test_the_windows_derivatives_are_those_of_finite_differences() -> None:
    active = LeafMlps.example(seed=1).active
    random = np.random.default_rng(4)
    points = random.uniform(5.0, 9.0, (60, 3))
    where = Overlaps.of_points(points, active)
    values = random.normal(size=(len(where.sample), 2))
    d = random.normal(size=(60, 2))
    h, along = 1e-6, random.normal(size=(60, 3))

    def blended(sign: int) -> Any:
        moved = Overlaps.of_points(points + sign * h * along, active)
        assert np.array_equal(moved.sample, where.sample)
        return moved.blended(values)

    expected = ((blended(1) - blended(-1)) / (2 * h) * d).sum()
    found = (where.d_local(values, d) * along[where.sample] * 2 / SIDE).sum()
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_the_stop_discards_less_than_it_says() -> None:
    field = LeafMlps.example(seed=3)
    field.policy = CellsPolicy(
        BOX, 0.11, octaves=1, width=6, features=3, hidden="softplus", density_scale=40.0
    )
    look = partial(field.render, field.example_batch(seed=3), seed=0, step=0)
    whole: Outputs = look(options=RenderOptions())[0]
    stopped: Outputs = look(options=RenderOptions(stop=0.05))[0]
    assert 0 < np.abs(whole.color - stopped.color).max() < 0.05


@pytest.fixture(scope="module")
def teacher() -> HashGrid:
    field = HashGrid.example(seed=2, dtype=np.float32)
    field.policy = type(field.policy)(**{**vars(field.policy), "density_scale": 4.0})
    return field


@pytest.fixture(scope="module")
def student(teacher: HashGrid) -> LeafMlps:
    return LeafMlps.from_field(teacher, 16, seed=1)


def colors(field: Any) -> Any:
    batch = LeafMlps.example(seed=1).example_batch(seed=3)
    return field.render(batch, seed=0, step=0, options=RenderOptions())[0].color


def test_distilled_networks_say_what_the_field_says(teacher: HashGrid, student: LeafMlps) -> None:
    assert np.ptp(colors(teacher)) > 0.4
    assert np.sqrt(np.mean((colors(student) - colors(teacher)) ** 2)) < 0.03
    again = LeafMlps.from_field(teacher, 16, seed=1)
    for name, values in student.params.items():
        np.testing.assert_array_equal(values, again.params[name])


def test_baking_comes_closer_with_the_degree(student: LeafMlps, tmp_path: Path) -> None:
    own = colors(student)
    errors = [float(np.mean((colors(student.baked(degree=n)) - own) ** 2)) for n in (0, 1, 2)]
    assert errors == sorted(errors, reverse=True)
    assert errors[2] < 0.5 * errors[0]
    assert errors[2] < 2e-3
    notes = student.export(tmp_path / "baked.npz", None)
    assert "baked to harmonics of degree 2" in notes[-1]


def test_an_empty_field_and_other_voxels_are_refused(teacher: HashGrid, student: LeafMlps) -> None:
    thin = HashGrid.initial(teacher.policy, seed=1, sigma_t=1e-6)
    with pytest.raises(RangeError, match=r"LeafMlps.from_field: field: expected a field with vox"):
        LeafMlps.from_field(thin, 16)
    field = LeafMlps.example(seed=3)
    with pytest.raises(RangeError, match="the voxels of leaf_mlps cannot change"):
        field.load_state(student.state())
