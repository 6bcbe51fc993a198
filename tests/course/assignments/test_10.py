"""Assignment 10 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_module
from PIL import Image

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    load_figures,
    source,
)

FOLDER = ASSIGNMENTS / "10_sparse_grids"
PRINTED = 6e-7  # the handout rounds to six decimals


class TestSparseGrids(AssignmentTests):
    folder = FOLDER
    long_figures = frozenset({"fig1_result", "fig5_topology"})


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def small_tree(solution):
    """The tree of the handout's sections 1 and 2."""
    full = np.zeros((4, 4, 4), bool)
    full[:2, :2, 2:] = full[3, 3, 0] = True
    return solution.octree_from_dense(full)


def test_numbers_of_the_warm_up(solution) -> None:
    gap = load_figures(FOLDER).parts.gap
    assert np.exp(-0.5) == pytest.approx(0.606531, abs=PRINTED)
    behind = 0.8 * -np.expm1(-1)
    assert behind == pytest.approx(0.505696, abs=PRINTED)
    P = 0.2 * -np.expm1(-0.5) + np.exp(-0.5) * behind
    close([P, 2 * (P - 0.6), (P - 0.6) ** 2], [0.385414, -0.429171, 0.046047])
    loss, slope = gap(solution, 0.0, 0.9)
    close([loss, slope[3]], [0.046047, -0.051320])
    assert not slope[:3].any()
    assert gap(solution, 0.0, 0.3)[1][3] == pytest.approx(0.026772, abs=PRINTED)
    assert loss - gap(solution, 0.001, 0.9)[0] == pytest.approx(0.0000513, abs=6e-8)


def test_check_values_of_octree_and_skipping(solution) -> None:
    tree = small_tree(solution)
    assert len(tree) == 17
    assert (tree == solution.FULL).sum() == 2
    checkers = np.indices((8, 8, 8)).sum(axis=0) % 2 == 0
    assert len(solution.octree_from_dense(checkers)) == 585
    asked: list[np.ndarray] = []

    def leaf(points):
        asked.append(points)
        return solution.octree_leaf(tree, 4, points)

    for start, stride, first, questions in (
        ([0.2, 0.3, 3.5], [0.4, 0.2, 0.0], 5, 2),
        ([3.85, 3.5, 0.5], [-0.3, 0.0, 0.0], 3, 3),
    ):
        asked.clear()
        got = solution.skip_empty(leaf, np.array([start]), np.array([stride]), 8)
        assert got[0].tolist() == [True] * first + [False] * (8 - first)
        assert sum(map(len, asked)) == questions


def test_check_values_of_adjoint_and_pruning(solution) -> None:
    row = np.array([[0, 1, -1, -1, 2, -1, -1, -1], [2, -1, -1, -1, -1, -1, 0, 2]]).T
    weight = [
        [0.1, 0.2, 0.05, 0.15, 0.3, 0.1, 0.05, 0.05],
        [0.3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.05, 0.15],
    ]
    weight = np.array(weight).T
    values = np.array([[1.0, 2], [3, 4], [5, 6], [7, 8]])
    close(solution.sample_sparse(values, row, weight), [[2.2, 2.8], [2.3, 2.8]])
    d_values = solution.sample_sparse_adjoint(4, row, weight, np.array([[1.0, -2], [10, 4]]))
    close(d_values, [[0.6, 0], [0.2, -0.4], [4.8, 1.2], [0, 0]])
    voxels = np.array([[2, 2, 2], [0, 3, 1], [1, 1, 1]])
    read = np.array([0, 1, 2, 0, -1, 1, 2]), np.array([0.1, 0.05, 0.2, 0.02, 0.9, 0.3, 0.01])
    kept = solution.prune_and_dilate(4, voxels, *read, 0.15, 0)
    assert kept.tolist() == [[0, 3, 1], [1, 1, 1]]
    assert len(solution.prune_and_dilate(4, voxels, *read, 0.15, 1)) == 33


def test_check_values_of_the_fit(solution) -> None:
    voxels = np.array([[0, 0, 0], [1, 0, 1], [1, 1, 0]])
    values = np.array([[0.9, 0.2, 0.1, 4], [0.1, 0.8, 0.3, 2], [0.5, 0.5, 0.5, 0.1]])
    rays = np.array([[[0.3, -0.4, 3], [3, 0.2, -0.1]], [[0, 0, -1.0], [-1, 0, 0]]])
    target = np.array([[0.5, 0.5, 0.5], [0.1, 0.2, 0.3]])
    samples = solution.march(2, voxels, rays)
    seen = [[0.077307, 0.328623, 0.128786], [0.099930, 0.084799, 0.065079]]
    close(solution.render(values, samples), seen)
    _, after, losses = solution.fit_sparse(2, voxels, values, rays, target, 1, 2, 0.2, 1)
    close(losses, [0.069050, 0.056167])
    close(after[0], [0.999283, 0.298532, 0.199623, 4.788872])
    row, share = solution.shares(after, samples)
    worth = [share[row == v].max() for v in range(3)]
    close(worth, [0.024058, 0.285689, 0.075238])
    every, after, losses = solution.fit_sparse(2, voxels, values, rays, target, 2, 2, 0.2, 1)
    assert len(every) == 8
    close(losses, [0.069050, 0.056167, 0.030805, 0.018484])
    close(after[4], [0.597616, 0.407020, 0.600051, 0.202126])


def test_memory_is_what_the_formulas_say(solution) -> None:
    """Bytes of dense array, octree, rows and values, from what is really allocated."""
    one = np.zeros((16, 16, 16), bool)
    one[3, 9, 14] = True
    tree = solution.octree_from_dense(one)
    voxels = solution.prune_and_dilate(16, np.argwhere(one), np.zeros(1, int), np.ones(1), 0, 1)
    table, values = solution.row_table(16, voxels), np.zeros((27, 4))
    told = solution.active_stats(16, tree, values)
    assert told == (16**3 * 4 * 8, (1 + 8 * 4) * 8, 18**3 * 8, 27 * 4 * 8)
    assert told == (np.zeros((16, 16, 16, 4)).nbytes, tree.nbytes, table.nbytes, values.nbytes)


def test_the_given_adjoint_agrees_with_differences(solution) -> None:
    """loss_and_grad through march, by every value of a few voxels, missing ones beside them."""
    rng = np.random.default_rng(2)
    voxels = np.argwhere(rng.random((4, 4, 4)) < 0.4)
    values = rng.uniform(0.3, 1.0, (len(voxels), 4)) * [1, 1, 1, 3]
    rays = load_figures(FOLDER).parts.cameras(3, 3)
    target = rng.uniform(0, 1, (27, 3))
    samples = solution.march(4, voxels, rays)
    assert (samples[2] < 0).any()
    _, d_values = solution.loss_and_grad(values, samples, target)
    for index in rng.integers(0, len(voxels), 5):
        for channel in range(4):
            moved = np.zeros(values.shape)
            moved[index, channel] = 1e-5
            up, down = (
                solution.loss_and_grad(values + way * moved, samples, target)[0] for way in (1, -1)
            )
            assert d_values[index, channel] == pytest.approx(
                (up - down) / 2e-5, rel=1e-6, abs=1e-12
            )


def test_pruned_and_grown_by_one_loses_no_voxel_that_a_derivative_asks_for(solution) -> None:
    """What was pruned beside a voxel that stays, and has a derivative worth the name, is back."""
    figures = load_figures(FOLDER).parts
    voxels, values = figures.ball_and_ring(16)
    samples = solution.march(16, voxels, figures.cameras(8, 8))
    target = solution.render(values, samples)
    worn = values * [1, 1, 1, 0.7]
    _, d_values = solution.loss_and_grad(worn, samples, target)
    row, share = solution.shares(worn, samples)
    grown, bare = (
        {tuple(v) for v in solution.prune_and_dilate(16, voxels, row, share, 0.03, steps).tolist()}
        for steps in (1, 0)
    )
    size = np.abs(d_values[:, 3])
    asked = {tuple(v) for v in voxels[size > 0.05 * size.max()].tolist()}
    assert len(asked - bare) > 100  # pruning alone loses these
    assert asked <= grown


def test_the_diagnoses_are_what_the_mistakes_give(solution) -> None:
    last = load_module("sparse_grids", apply_mutant(FOLDER, "back_to_the_last"))
    figures = load_figures(FOLDER).parts
    voxels, values = figures.ball_and_ring(8)
    order = np.random.default_rng(0).permutation(len(voxels))
    for some in (np.arange(len(voxels)), order):
        samples = last.march(8, voxels[some], figures.cameras(6, 6))
        target = np.full((216, 3), 0.5)
        wrong = last.loss_and_grad(values[some], samples, target)[1]
        right = solution.loss_and_grad(values[some], samples, target)[1]
        np.testing.assert_allclose(wrong[:-1], right[:-1], atol=1e-15)
        assert np.abs(wrong[-1]).max() > 3 * np.abs(right).max()


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER, secret=SECRET)
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for n in drawn["10.g1"]["n"]:
        for k in drawn["10.g1"]["k"]:
            assert keys.nodes_of_cells(reference, n, k) == 9 + 8 * k * (np.log2(n) - 1)
    for a in drawn["10.g2"]["a"]:
        for c in drawn["10.g2"]["c"]:
            T, C = np.exp(-a / 2), 0.8 * -np.expm1(-1)
            right = T * (c - C) / 2 * 2 * (0.2 * (1 - T) + T * C - 0.6)
            assert keys.slope_of_the_gap(reference, a, c) == pytest.approx(right)
    for i in drawn["10.g3"]["i"]:
        for j in drawn["10.g3"]["j"]:
            for s in drawn["10.g3"]["s"]:
                right = (min(i, s) + s + 1) * (min(15 - j, s) + s + 1) * (2 * s + 1)
                assert keys.voxels_after_growth(reference, i, j, s) == right


ADD = "np.add.at(d_values, row[known], parts[known])"
OLD = "old = find_rows(row_table(n, voxels), chosen)"
# Mistakes that no mutant's fingerprint meets, as everybody makes them a little differently.
LIKELY = {
    "np.add.at": (
        "10.3.transpose",
        ADD,
        "for c in range(8):\n        d_values[row[c]] += parts[c]",
    ),
    "table of the old ones": (
        "10.5.chain",
        OLD,
        "old = np.arange(len(chosen)); old[len(voxels):] = -1",
    ),
    "stands still": ("10.2.faces", "np.maximum(jump, 1)", "jump"),
}


@pytest.mark.parametrize("said", LIKELY)
def test_likely_mistakes_are_recognized(said: str) -> None:
    check, right, wrong = LIKELY[said]
    text = source(FOLDER).replace("for _ in range(count):  #", "while len(live):  #")
    assert text.count(right) == 1
    outcomes = {
        each.id: each for each in judge(FOLDER, text.replace(right, wrong), tasks=[check[:4]])
    }
    assert said in outcomes[check].hint


def capture(folder: Path) -> None:
    """Two photographs of a white disc, transparent around it, from opposite sides."""
    (folder / "images").mkdir(parents=True)
    v, u = np.mgrid[0:24, 0:32]
    disc = (np.hypot(u - 15.5, v - 11.5) < 6) * np.uint8(255)
    frames = []
    for k, side in enumerate((1.0, -1.0)):
        Image.fromarray(np.repeat(disc[:, :, None], 4, axis=2)).save(folder / f"images/{k}.png")
        pose = np.diag([side, 1.0, side, 1.0])
        pose[2, 3] = 4.0 * side
        frames.append({"file_path": f"images/{k}", "transform_matrix": pose.tolist()})
    told = {"camera_angle_x": 0.7, "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(told), encoding="utf-8")


EXPLORE = "explore.py --voxels 8 --rounds 3 --steps 4 --views 8 --size 8 --capture mine --figure 0"


def test_the_exploration_runs_with_a_capture_and_beside_the_core(tmp_path: Path) -> None:
    for name in ("sparse_grids.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    shutil.copytree(FOLDER / "data", tmp_path / "data")
    capture(tmp_path / "mine")
    command = [sys.executable, *EXPLORE.split()]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for picture in ("sparse.png", "capture.png"):
        with Image.open(tmp_path / picture) as image:
            assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    black, recovered = (
        float(done.stdout.split(f" dB {word}")[0].split()[-1])
        for word in ("for black", "recovered")
    )
    assert recovered > black + 3
    if find_spec("photograd") is not None:
        assert float(done.stdout.split("derivative is ")[1].split()[0]) < 1e-9
        assert float(done.stdout.split("largest shares ")[1].split()[0]) < 1e-5
        its, yours = done.stdout.split("its octree has ")[1].split(" leaves, yours ")
        assert int(its) == int(yours.split()[0])
        assert "all voxels active; values are the same" in done.stdout


def test_the_photographs_are_those_that_their_script_renders() -> None:
    pytest.importorskip("photograd.scenes")
    photographs = load_figures(FOLDER).parts.PHOTOGRAPHS
    _, count, size, turn = photographs.HELD_OUT
    for kept, made in zip(
        photographs.read(photographs.HELD_OUT), photographs.render(count, size, turn), strict=True
    ):
        assert np.abs(kept.colors ** (1 / 2.2) - made.colors ** (1 / 2.2)).max() < 0.6 / 255
    assert sum(path.stat().st_size for path in (FOLDER / "data").glob("*.png")) < 2_000_000
