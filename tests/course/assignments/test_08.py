"""Assignment 08 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_module
from PIL import Image

from course.assignments.support import ASSIGNMENTS, SECRET, AssignmentTests, apply_mutant, judge

FOLDER = ASSIGNMENTS / "08_volume_rendering"
PRINTED = 6e-7  # the handout rounds to six decimals
SIGMA, DT = np.array([[1.0, 3.0, 0.5]]), np.array([[0.5, 0.25, 0.8]])
COLOR, BEHIND = np.array([0.2, 0.8, 0.4])[None, :, None], np.array([0.6])
LOW, HIGH = np.zeros(3), np.array([2.0, 1.0, 3.0])
# The six wrong adjoints of a ray that look right to the eye, to descent or to a cosine.
SIX = (
    "adjoint_no_occlusion",
    "adjoint_occlusion_added",
    "adjoint_missing_step",
    "adjoint_off_by_one",
    "adjoint_riemann",
    "adjoint_inclusive",
)


class TestVolumeRendering(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), expected, atol=PRINTED)


@pytest.mark.parametrize("mutant", SIX)
def test_the_gate_rejects_subtle_adjoints_by_far(mutant: str) -> None:
    outcomes = {
        each.id: each.details
        for each in judge(FOLDER, apply_mutant(FOLDER, mutant), tasks=("08.2",))
    }
    for gate in ("08.2.differences", "08.2.hidden"):
        assert outcomes[gate]["error"] >= 1000 * outcomes[gate]["tolerance"]


def test_check_values_of_the_warm_up(solution) -> None:
    dark = np.zeros((1, 3, 1))
    pixel, T_end = solution.composite(SIGMA, dark, DT, BEHIND)
    close(pixel, [0.115230])
    close(T_end, [0.192050])
    none = np.zeros(1)
    back = solution.composite_adjoint(SIGMA, dark, DT, BEHIND, np.ones((1, 1)), none)
    close(back[0], [-0.057615, -0.028807, -0.092184])
    close(back[2], [0.192050])
    moved = solution.composite(SIGMA + np.array([0, 0.001, 0]), dark, DT, BEHIND)[0]
    close(moved, [0.115201])
    assert 0.36 < np.exp(-1) < 0.375


def test_check_values_of_a_ray_and_its_adjoint(solution) -> None:
    pixel, T_end = solution.composite(SIGMA, COLOR, DT, BEHIND)
    weights = [0.393469, 0.320026, 0.094455]
    close(pixel, [0.487726])
    one, none = np.ones((1, 1)), np.zeros(1)
    back = solution.composite_adjoint(SIGMA, COLOR, DT, BEHIND, one, none)
    close(back[0], [-0.143863, 0.019048, -0.030728])
    close(back[1], weights)
    close(back[2], T_end)
    hidden = [0.204516, 0.038253, 0.092184]
    own = [0.060653, 0.057301, 0.061456]
    close(back[0], np.array(own) - hidden)
    T = np.exp(-np.cumsum(SIGMA * DT))
    close(DT[0] * T * COLOR[0, :, 0], own)
    back = solution.composite_adjoint(SIGMA, COLOR, DT, BEHIND, one, none - 0.5)
    close(back[0], [-0.095851, 0.043054, 0.046092])
    # The derivatives of weights by the nearest optical depth: each weight has a channel.
    eye, dark = np.eye(3)[None], np.zeros(3)
    slopes = [
        solution.composite_adjoint(SIGMA, eye, DT, dark, np.eye(3)[k : k + 1], none)[0][0, 0]
        for k in range(3)
    ]
    slopes.append(
        solution.composite_adjoint(SIGMA, eye, DT, dark, 0 * eye[:, 0], none + 1)[0][0, 0]
    )
    close(np.array(slopes) / DT[0, 0], [0.606531, -0.320026, -0.094455, -0.192050])


def test_check_values_of_box_and_grid(solution) -> None:
    origins = np.array([[-1, 0.5, 1], [1, 0.5, 1], [-1, 0.5, 1], [3, 0.5, 1], [-1.0, 0, 1]])
    directions = np.array([[2, 0.5, 1], [2, 0.5, 1], [2, 2, 0], [1, 0, 0], [1.0, 0, 0]])
    near, far = solution.ray_box(LOW, HIGH, origins, directions)
    assert near.tolist() == [0.5, 0, 0, 0, 1]
    assert far.tolist() == [1, 0.5, 0, 0, 3]
    grid = np.arange(8.0).reshape(2, 2, 2, 1) ** 2
    u = np.array([[0.4, 0.5, 0.7], [0.1, 0.9, 0.5], [0.5, 0.5, 0.5]])
    close(solution.trilinear(grid, u), [14.06, 6.5, 17.5])
    back = solution.trilinear_adjoint((2, 2, 2), u[:1], np.ones((1, 1)))
    close(back, [0.035, 0.315, 0.035, 0.315, 0.015, 0.135, 0.015, 0.135])
    back = solution.trilinear_adjoint((2, 2, 2), u, np.array([[1.0], [2.0], [-3.0]]))
    close(back, [-0.34, -0.06, 0.66, 0.94, -0.36, -0.24, -0.36, -0.24])


def test_check_values_of_a_picture_and_the_menu(solution) -> None:
    grid = np.zeros((2, 2, 2, 4))
    grid[..., 0], grid[1, :, :, 1], grid[..., 2] = 0.5, 1.0, 0.25
    grid[..., 3] = (np.arange(8).reshape(2, 2, 2) + 1) / 10
    view = (
        LOW,
        HIGH,
        np.array([[-1, 0.2, 1], [3, 0.5, 1]]),
        np.array([[2, 0.5, 1], [1.0, 0, 0]]),
        4,
        np.array([1, 0.5, 0]),
    )
    pixels = solution.render_rays(grid, *view)
    close(pixels, [0.643021, 0.521170, 0.178489, 1, 0.5, 0])
    d_grid, d_background = solution.render_adjoint(grid, *view, 2 * (pixels - 0.5))
    slopes = [-0.014766, -0.024533, -0.022987, -0.055290, -0.000804, -0.002413, -0.005836]
    close(d_grid[..., 3], [*slopes, -0.088338])
    close(d_background, [1.081820, 0.012111, -1.183931])
    middles = (np.cumsum(DT) - DT[0] / 2)[None, :, None]
    close(solution.composite(SIGMA, middles, DT, np.zeros(1))[0], [0.407007])
    fog = [np.full((1, 1), 0.5), np.ones((1, 1, 1)), np.full((1, 1), 2.0), np.zeros(1)]
    close(solution.composite(*fog)[0], [0.632121])


def test_the_classmates_loop_gives_what_the_diagnoses_say(solution) -> None:
    lecture = load_module("volume_rendering", apply_mutant(FOLDER, "lecture"))
    told = {10: (7.81, 0.781), 20: (16.44, 0.822), 40: (33.73, 0.843)}
    for n, (without, mended) in told.items():
        fog = [np.full((1, n), 2.0), np.ones((1, n, 1)), np.full((1, n), 1 / n), np.zeros(1)]
        pixel = lecture.composite(*fog)[0][0, 0]
        assert abs(pixel - without) < 0.005
        assert abs(pixel / n - mended) < 0.0005
        assert abs(solution.composite(*fog)[0][0, 0] - 0.8647) < 5e-5
    fog = [np.full((1, 10), 2.0), np.ones((1, 10, 1)), np.full((1, 10), 0.1), np.zeros(1)]
    for mutant, value in (("riemann", 0.954), ("inclusive", 0.708)):
        module = load_module("volume_rendering", apply_mutant(FOLDER, mutant))
        assert abs(module.composite(*fog)[0][0, 0] - value) < 5e-4


def test_predictions_come_true(solution) -> None:
    rng = np.random.default_rng(3)
    sigma, dt = rng.uniform(0.5, 2, (1, 6)), rng.uniform(0.1, 0.4, (1, 6))
    color = rng.random((1, 6, 1))
    color[:, 3:] = 0.7
    thicker = sigma * [1, 1, 1, 2, 1, 1]
    first, second = (solution.composite(s, color, dt, np.array([0.7]))[0] for s in (sigma, thicker))
    np.testing.assert_allclose(second, first, rtol=1e-14)
    sigma[0, 2] = 1e5
    red_wall = (sigma, color, dt, np.array([0.7]), np.ones((1, 1)), np.zeros(1))
    d_sigma, d_color, _ = solution.composite_adjoint(*red_wall)
    assert not d_color[0, 3:].any()
    assert np.abs(d_sigma[0, 3:]).max() < 1e-15
    assert d_color[0, :3].all()


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER, secret=SECRET)
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for a in drawn["08.g1"]["a"]:
        for b in drawn["08.g1"]["b"]:
            right = np.exp(-(a + b) / 2) * (1 - np.exp(-1.4 / 2))
            assert keys.weight_of_the_third(reference, a, b, 1.4) == pytest.approx(right)
    for s in drawn["08.g2"]["s"]:
        right = 0.4 * np.exp(-0.4 * s) * (0.9 - 0.3)
        assert keys.slope_of_one_step(reference, s, 0.4, 0.9, 0.3) == pytest.approx(right)
        for b in drawn["08.g2"]["b"]:
            for c in drawn["08.g2"]["c"]:
                assert abs(c - b) > 0.1
    for dx in drawn["08.g3"]["dx"]:
        for dy in drawn["08.g3"]["dy"]:
            for y in drawn["08.g3"]["y"]:
                enters, leaves = 1 / dx, min(5 / dx, (2 - y) / dy)
                assert leaves > enters
                right = (leaves - enters) * np.hypot(dx, dy)
                assert keys.meters_in_the_box(reference, y, dx, dy) == pytest.approx(right)


def capture(folder: Path) -> None:
    """Two photographs of a white disc before black, from opposite sides."""
    (folder / "images").mkdir(parents=True)
    v, u = np.mgrid[0:24, 0:32]
    disc = (np.hypot(u - 15.5, v - 11.5) < 6) * np.uint8(255)
    frames = []
    for k, side in enumerate((1.0, -1.0)):
        Image.fromarray(np.repeat(disc[:, :, None], 3, axis=2)).save(folder / f"images/{k}.png")
        pose = np.diag([side, 1.0, side, 1.0])
        pose[2, 3] = 4.0 * side
        frames.append({"file_path": f"images/{k}", "transform_matrix": pose.tolist()})
    told = {"camera_angle_x": 0.7, "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(told), encoding="utf-8")


def test_the_exploration_runs_with_and_without_a_capture(tmp_path: Path) -> None:
    for name in ("volume_rendering.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    capture(tmp_path / "mine")
    done = subprocess.run(
        [
            sys.executable,
            "explore.py",
            "--figure",
            "0",
            "--size",
            "16",
            "--steps",
            "8",
            "--voxels",
            "10",
            "--capture",
            "mine",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for picture in ("ray.png", "volume.png", "capture.png"):
        with Image.open(tmp_path / picture) as image:
            assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    assert "2 photographs" in done.stdout
    off = float(done.stdout.split("your derivative is ")[1].split()[0])
    assert off < 1e-7
    if "core not installed" not in done.stdout:
        assert float(done.stdout.split("its derivative is ")[1].split()[0]) < 1e-9
