"""Tables over directions: what they cost, what they look up, and harmonics of equal error."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd.errors import RangeError, ShapeError
from photograd.fields.dense_grid import DenseGrid
from photograd.lights.probes import (
    best_harmonics,
    best_table,
    blend,
    evaluate,
    evaluate_backward,
    grid_bytes,
    rows_for,
    sphere_quadrature,
    table_numbers,
)
from photograd_course.gradcheck import check_gradient

pytestmark = pytest.mark.usefixtures("core")


def unit(n: int, seed: int) -> Any:
    d = np.random.default_rng(seed).normal(size=(n, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def glow(directions: Any) -> Any:
    """A soft highlight about six axes: 0.2 + exp(4 (cos - 1))."""
    return 0.2 + np.exp(4 * (directions @ unit(6, 1).T - 1))


def test_bytes_are_those_of_the_arrays() -> None:
    shape = (7, 5, 3)
    for numbers in (1, 9, table_numbers(4)):
        arrays = np.zeros(shape, np.float32), np.zeros((*shape, numbers, 3), np.float32)
        assert grid_bytes(shape, numbers) == sum(a.nbytes for a in arrays)
    assert grid_bytes(shape, 4, channels=1, bytes_per_number=2) == 7 * 5 * 3 * 5 * 2
    field = DenseGrid.empty([[0, 0, 0], [7, 5, 3]], 7)
    values = field.params["values"]
    assert grid_bytes(values.shape[:3], 1) == values.nbytes


def test_bytes_of_known_grids() -> None:
    assert grid_bytes((128,) * 3, sh.count(2)) == 112 * 2**21  # 28 floats a voxel: 224 MiB
    assert grid_bytes((128,) * 3, table_numbers(8)) == 1540 * 2**21  # 8 x 16 directions: 3 GiB
    assert grid_bytes((2000,) * 3, 128) == 8 * 10**9 * 385 * 4  # more than 32 bits count


def test_sizes_that_make_no_sense_are_refused() -> None:
    with pytest.raises(RangeError, match="rows"):
        table_numbers(0)
    with pytest.raises(RangeError, match="at least 1"):
        grid_bytes((4, 0, 4), 9)
    with pytest.raises(ShapeError, match="grid_bytes: shape"):
        grid_bytes((4, 4), 9)
    with pytest.raises(ShapeError, match="2 T"):
        evaluate(np.zeros((4, 4, 3)), unit(2, 1))


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_a_cell_center_returns_its_entry_and_weights_add_up(rows: int) -> None:
    theta = (np.arange(rows) + 0.5) * np.pi / rows
    phi = (np.arange(2 * rows) + 0.5) * np.pi / rows
    t, p = (a.ravel() for a in np.meshgrid(theta, phi, indexing="ij"))
    centers = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=1)
    table = np.random.default_rng(2).normal(size=(rows, 2 * rows, 3))
    np.testing.assert_allclose(evaluate(table, centers), table.reshape(-1, 3), atol=1e-12)
    entries, weights = blend(unit(500, 3), rows)
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert weights.min() >= 0
    assert set(np.unique(entries)) <= set(range(table_numbers(rows)))


def on_sphere(theta: Any, phi: Any) -> Any:
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


def test_lookups_are_continuous_across_the_seam_and_the_poles() -> None:
    table = np.random.default_rng(4).normal(size=(4, 8, 1))
    theta, phi = np.linspace(0.1, 3, 50), np.linspace(0, 6, 50)
    tiny = 1e-9
    pairs = [
        (on_sphere(theta, -tiny), on_sphere(theta, tiny)),
        (on_sphere(tiny, phi), on_sphere(-tiny, phi)),  # the latter is half a turn on
        (on_sphere(np.pi - tiny, phi), on_sphere(np.pi + tiny, phi)),
    ]
    for here, there in pairs:
        values = evaluate(table, here)
        assert np.ptp(values) > 0.1
        # arccos knows an angle near a pole to 1e-8; slopes are some units a radian.
        np.testing.assert_allclose(evaluate(table, there), values, atol=1e-6)


def test_derivative_by_the_table() -> None:
    directions = unit(60, 6)
    place = {"table": np.random.default_rng(7).normal(size=(3, 6, 3))}
    report = check_gradient(
        lambda p: evaluate(p["table"], directions),
        lambda p, d: {"table": evaluate_backward(p["table"], directions, d)},
        place,
        seed=1,
    )
    assert report, str(report)


def test_errors_are_those_of_the_representation() -> None:
    # What a representation holds exactly costs no error.
    # Sums over 4608 directions round by about sqrt(4608) 2.2e-16 = 1.5e-14.
    assert best_harmonics(lambda d: 1 + d, 1) < 1e-13
    exact = np.random.default_rng(8).normal(size=(3, 6, 2))
    assert best_table(lambda d: evaluate(exact, d), 3) < 1e-13
    # Parseval: what degree 1 leaves of Y_00 + Y_20 / 2 is the latter, of norms 1 and 1/2.
    only = best_harmonics(lambda d: sh.basis(d, 2)[:, [0]] + 0.5 * sh.basis(d, 2)[:, [6]], 1)
    assert only == pytest.approx(0.5 / np.sqrt(1.25), rel=1e-12)
    # The fit is no worse than sampling the cell centers.
    directions, weights = sphere_quadrature(48)
    theta, phi = np.meshgrid((np.arange(4) + 0.5) / 4, (np.arange(8) + 0.5) / 8, indexing="ij")
    theta, phi = np.pi * theta, 2 * np.pi * phi
    r = np.sin(theta)
    centers = np.stack([r * np.cos(phi), r * np.sin(phi), np.cos(theta)], axis=-1)
    values = glow(directions)
    found = evaluate(glow(centers.reshape(-1, 3)).reshape(4, 8, 6), directions)
    sampled = np.sqrt((weights @ (found - values) ** 2).sum() / (weights @ values**2).sum())
    assert 0.55 * sampled < best_table(glow, 4) < 0.7 * sampled  # measured: 0.62


def test_harmonics_need_fewer_numbers_for_soft_light() -> None:
    tables = {rows: best_table(glow, rows) for rows in range(1, 8)}
    needed = {}
    for degree in (2, 3, 4):
        error = best_harmonics(glow, degree)
        needed[degree] = table_numbers(min(rows for rows in tables if tables[rows] <= error))
    assert needed == {2: 18, 3: 32, 4: 98}  # against 9, 16, 25
    assert rows_for(glow, best_harmonics(glow, 2)) == 3
    assert rows_for(glow, 1e-9, most=3) is None
