"""Assignment 13 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder

from course.assignments.support import ASSIGNMENTS, AssignmentTests, load_figures, source

FOLDER = ASSIGNMENTS / "13_hash_grids"
EXPLORE = "explore.py --steps 9 --size 32 --log2 8 --finest 32 --cells 16"
PRINTED = 6e-7  # the handout rounds to six decimals


class TestHashGrids(AssignmentTests):
    folder = FOLDER
    long_figures = frozenset({"fig6_size"})


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def small_grid(solution):
    """Table, levels and points of the handout's sections 3, 4 and 6."""
    levels = solution.make_levels([2, 5], 2, 9)
    r = np.arange(18.0)
    table = np.stack([r / 10, r % 4 - 1], axis=1)
    return table, levels, np.array([[0.3, 0.7], [0.9, 0.1]])


def test_numbers_of_the_warm_up() -> None:
    a = np.array([0.2, 0.8])

    def f(x):
        c = int(4 * x)
        return (1 - (4 * x - c)) * a[c % 2] + (4 * x - c) * a[(c + 1) % 2]

    close([f(0.3), f(0.9)], [0.68, 0.44])
    for x, slope in ((0.3, -2.4), (0.9, -2.4), (0.2, 2.4), (0.25, 0.0)):
        assert (f(x + 1e-6) - f(x - 1e-6)) / 2e-6 == pytest.approx(slope, abs=1e-6)
    errors = np.array([f(0.3) - 0.9, f(0.9) - 0.1])
    assert np.sum(errors**2) == pytest.approx(0.164)
    close(np.array([[0.2, 0.6], [0.8, 0.4]]) @ (2 * errors), [0.32, -0.08])
    close([0.8 * 2 * errors[0], 0.4 * 2 * errors[1]], [-0.352, 0.272])


def test_check_values_of_the_leaves(solution) -> None:
    def field(p):
        return p[:, :1] * (1 + 4 * (p[:, 1:] >= 0.5))

    offsets = np.array([[0.25, 0.5], [0.75, 0.5]])
    for tolerance, count in ((0.0, 16), (0.3, 10), (1.3, 4), (5.0, 1)):
        assert len(solution.tabulate(field, 4, offsets, tolerance)[1]) == count
    close(np.sort(solution.tabulate(field, 4, offsets, 1.3)[1][:, 0]), [0.25, 0.75, 1.25, 3.75])
    close(solution.tabulate(field, 4, offsets, 5.0)[1], [1.5])
    leaf, values = solution.tabulate(lambda p: p**2, 2, offsets, 0.0)
    close(values[leaf[1, 0]], [0.578125, 0.0625])


def test_check_values_of_the_rows(solution) -> None:
    for corner, n, rows, right in (
        ((5, 0), 64, 1024, 5),
        ((0, 1), 64, 1024, 433),
        ((3, 7), 64, 1024, 980),
        ((1, 1), 64, 1000, 760),
        ((3, 5), 7, 64, 43),
        ((3, 5), 7, 63, 42),
        ((1, 2, 3), 16, 1024, 476),
    ):
        assert solution.hash_index(np.array([corner]), n, rows).tolist() == [right]


def test_check_values_of_the_encoding(solution) -> None:
    table, levels, points = small_grid(solution)
    assert levels.tolist() == [[2, 0, 9], [5, 9, 9]]
    corners = np.array([[1, 3], [2, 3], [1, 4], [2, 4]])
    assert solution.hash_index(corners, 5, 9).tolist() == [7, 6, 3, 4]
    close(solution.encode(points, table, levels), [[0.48, 0.76, 1.4, 0.0], [0.24, 0.6, 1.2, 1.0]])
    back = np.array([[1.0, 0, 2, 0], [0, 1, -1, 0.5]])
    d_table, d_points = solution.encode_backward(points, table, levels, back)
    close(d_points, [[0.2, -2.4], [2, 2]])
    expected = [[0.36, 0.04], [0.16, 0], [0.5, 0], [0.25, 0.125], [0, 0]]
    close(d_table[[4, 6, 12, 13, 17]], expected)


def test_check_values_of_adam_and_training(solution) -> None:
    table, levels, points = small_grid(solution)
    x, m, v = solution.adam_rows(
        np.array([[1.0, 2], [3, 4]]),
        np.array([[0.5, 0], [0, 0]]),
        np.full((2, 2), 0.1),
        np.full((2, 2), 0.01),
        3,
        0.1,
    )
    close(x, [[0.920047, 1.942477], [3, 4]])
    close(m[0], [0.14, 0.09])
    close(v[0], [0.0124, 0.0099])
    weights = [
        np.array([[1, -0.5], [0.5, 1], [0.2, 0.1], [-0.3, 0.4], [0.1, 0.1]]),
        np.array([[1.0], [0.5], [0]]),
    ]
    target, batches = np.array([[0.5], [0.2]]), np.array([[0, 1], [1, 1], [0, 0]])
    found, _, losses = solution.train_hash_grid(
        points, target, batches, levels, table, weights, 0.02
    )
    close(losses, [1.059650, 0.516214, 0.566761])
    close(found[[0, 7, 13]], [[0, -1], [0.662871, 1.962863], [1.241988, 0.059945]])


def test_parameters_are_what_the_formula_says(solution) -> None:
    """Equation (16), and the numbers of the third prediction, from arrays that are allocated."""
    resolutions, T = (8, 16, 32, 64, 96, 144), 2**14
    levels = solution.make_levels(resolutions, 2, T)
    assert levels[-1, 1] + levels[-1, 2] == sum(min((n + 1) ** 2, T) for n in resolutions)
    rng = np.random.default_rng(0)
    decoder = solution.start_weights((12, 16, 3), rng)
    plain = solution.start_weights((26, 64, 64, 3), rng)
    assert solution.numbers_per_point(decoder) == 259
    assert solution.numbers_per_point(decoder, levels, 2) == 2 * 6 * 4 + 259 == 307
    assert solution.numbers_per_point(plain) == 6083


def test_the_given_network_agrees_with_differences(solution) -> None:
    rng = np.random.default_rng(5)
    weights = [rng.normal(size=(4, 5)), rng.normal(size=(6, 2))]
    x, target = rng.normal(size=(7, 3)), rng.normal(size=(7, 2))
    _, d_weights, d_x = solution.network_loss_and_grad(weights, x, target)

    def loss(first, last, inputs):
        return solution.network_loss_and_grad([first, last], inputs, target)[0]

    at = [*weights, x]
    for k, derivative in enumerate([*d_weights, d_x]):
        way = rng.normal(size=derivative.shape)
        up, down = (
            loss(*(a + sign * 1e-6 * way if i == k else a for i, a in enumerate(at)))
            for sign in (1, -1)
        )
        assert np.vdot(derivative, way) == pytest.approx((up - down) / 2e-6, rel=1e-6)


def test_the_encoding_is_that_of_the_core(solution) -> None:
    """Rows, features and both derivatives, in the plane and in space, dense and hashed."""
    core = pytest.importorskip("photograd.network")
    rng = np.random.default_rng(7)
    for D, resolutions in ((2, [3, 9, 40]), (3, [2, 5, 17])):
        encoding = core.HashEncoding(resolutions, dimensions=D, log2_rows=7, features=2)
        levels = solution.make_levels(resolutions, D, 2**7)
        assert [(each.resolution, each.first, each.rows) for each in encoding.levels] == [
            tuple(level) for level in levels.tolist()
        ]
        table = rng.normal(size=(encoding.rows, 2))
        points, back = rng.uniform(-0.1, 1.1, (200, D)), rng.normal(size=(200, 6))
        mine = solution.encode(points, table, levels)
        np.testing.assert_allclose(mine, encoding.encode(table, points), rtol=0, atol=1e-13)
        theirs = encoding.encode_backward(table, points, back, d_points=True)
        for got, right in zip(
            solution.encode_backward(points, table, levels, back), theirs, strict=True
        ):
            np.testing.assert_allclose(got, right, rtol=0, atol=1e-11)


def test_leaves_bound_the_error(solution) -> None:
    """No cell is farther from its leaf than the tolerance; a finer one costs more leaves."""
    parts = load_figures(FOLDER).parts
    counts = []
    for tolerance in (0.4, 0.2, 0.1):
        leaf, values = solution.tabulate(parts.smooth, 32, np.full((1, 2), 0.5), tolerance)
        cells = parts.smooth(solution.pixels(32)).reshape(32, 32, 3).swapaxes(0, 1)
        assert np.abs(values[leaf] - cells).max() <= tolerance
        counts.append(len(values))
    assert counts == sorted(counts)


def test_the_exploration_runs(tmp_path: Path) -> None:
    (tmp_path / "hash_grids.py").write_text(source(FOLDER), "utf-8")
    shutil.copy(FOLDER / "explore.py", tmp_path)
    shutil.copytree(FOLDER / "data", tmp_path / "data")
    done = subprocess.run(
        [sys.executable, *EXPLORE.split()],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "fine-tuned" in done.stdout
    assert "hash grid: 9 steps in " in done.stdout
    assert "network: 36 steps in " in done.stdout
    assert (tmp_path / "hash_grid.png").stat().st_size > 10_000
