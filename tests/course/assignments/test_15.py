"""Assignment 15 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.build.kits import kit_files
from photograd_course.captures import read_capture
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Status
from photograd_course.grading.runner import run_checks
from PIL import Image

from course.assignments.support import ASSIGNMENTS, SECRET, AssignmentTests, apply_mutant, source

FOLDER, EARLIER = ASSIGNMENTS / "15_gaussian_splatting", ASSIGNMENTS / "08_volume_rendering"
CAPTURE = Path("posed") / "banana" / "undistorted"
EXPLORE = "import runpy; runpy.run_path('explore.py')"
PRINTED = 6e-7  # the handout rounds to six decimals
CAMERA = {
    "camera_from_world": np.eye(4)[:3],
    "focal": np.array([50.0, 40.0]),
    "center": np.array([32.0, 24.0]),
    "width": 64,
    "height": 48,
}


class TestGaussianSplatting(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(FOLDER, secret=SECRET)


@pytest.fixture(scope="module")
def solution(bundle: Bundle) -> ModuleType:
    return bundle.reference


def printed(got: object, expected: object) -> None:
    np.testing.assert_allclose(np.squeeze(got), expected, atol=PRINTED)


def test_the_worked_examples_of_the_handout() -> None:
    x, z, e = 3.0, 2.0, 1e-6
    assert ((x + e) ** 2 * z - (x - e) ** 2 * z) / (2 * e) == pytest.approx(12)
    xx, xy, yy = 2.0, 0.5, 3.0
    ends = [xx * yy - (xy + step) ** 2 for step in (e, -e)]
    assert (ends[0] - ends[1]) / (2 * e) == pytest.approx(-2 * xy)


def test_check_values_of_the_warm_up() -> None:
    x = np.array([0.0, 3.0])
    alpha, v = 0.8 * np.exp(-((1 - x) ** 2) / 8), (1 - x) / 4
    printed(alpha, [0.705998, 0.485225])
    printed(alpha * v, [0.176499, -0.242612])
    assert np.sum(alpha * v) == pytest.approx(-0.066113, abs=PRINTED)
    moved = [0.8 * np.exp(-((1 + e - x) ** 2) / 8).sum() for e in (1e-6, -1e-6)]
    assert (moved[1] - moved[0]) / 2e-6 == pytest.approx(-0.066113, abs=PRINTED)


def test_check_values_of_shape_and_projection(solution: ModuleType) -> None:
    q = np.array([[1, 0.5, -0.25, 0.75]])
    cov, back = solution.covariance(q, np.log([[0.5, 1, 2]]))
    printed(cov, [[0.97, -0.46, 0.1], [-0.46, 2.28, -1.8], [0.1, -1.8, 2]])
    d_q, d_s = back(np.array([[[1.0, 2, 0], [0, 0, 0], [0, 0, -1]]]))
    printed(d_q, [-1.306667, 0.613333, -7.04, -1.013333])
    printed(d_s, [0.055556, 1.022222, -4.977778])
    n = q[0] / np.linalg.norm(q)
    K = solution.CROSS @ n[1:]
    R, s, g = np.eye(3) + 2 * (n[0] * K + K @ K), np.array([0.5, 1, 2]), np.zeros((3, 3))
    g[0], g[2, 2] = (1, 2, 0), -1
    d_M = (g + g.T) @ (R * s)
    printed(d_M, [[1, -1.6, -2.4], [0.333333, -1.866667, 0.533333], [-0.666667] * 2 + [-2.666667]])
    printed((d_M * s)[0], [0.5, -1.6, -4.8])
    d_K = 2 * (n[0] * d_M * s - (d_M * s) @ K - K @ (d_M * s))
    d_a = [np.sum(solution.CROSS[:, :, k] * d_K) for k in range(3)]
    printed([2 * np.sum(d_M * s * K), *d_a], [2.300435, 2.884672, -10.662332, 1.679683])
    cov = np.array([[[0.04, 0.01, 0], [0.01, 0.09, 0.02], [0, 0.02, 0.16]]])
    g = np.array([[1.0, -1]]), np.array([[0.1, 0.2, -0.3]])
    for x, seen, wide, d in (
        (0.5, 44.5, [31.25, 0, 39], [25.5, -13.2, 0.55]),
        (3.0, 107.0, [94.2224, -11.64, 39], [25, -8.544, -33.96224]),
    ):
        mean2d, cov2d, depth, back = solution.project(np.array([[x, -0.25, 2]]), cov, CAMERA)
        printed(mean2d, [seen, 19])
        printed(cov2d, wide)
        assert depth == 2
        printed(back(*g)[0], d)
        if x == 0.5:
            J, d_C = [[25, 0, -6.25], [0, 20, 2.5]], np.array([[0.1, 0.1], [0.1, -0.3]])
            printed(2 * d_C @ J @ cov[0], [[0.24, 0.395, -0.04], [0.08, -1.085, -0.68]])
            printed(back(*g)[1], [[62.5, 50, -9.375], [50, -120, -27.5], [-9.375, -27.5, -1.09375]])
    assert solution.limits(CAMERA)[1][0] == pytest.approx(0.832)


def test_check_values_of_alpha_and_blend(solution: ModuleType) -> None:
    splat = np.array([[3.0, 2]]), np.array([[6, 2.5, 4]]), np.zeros(1)
    alpha, back = solution.screen_alpha(*splat, np.array([[2.5, 2.5], [5.5, 1.5], [1.5, 3.5]]))
    printed(alpha, [0.455337, 0.217473, 0.215396])
    expected = (
        [-0.094088, 0.057798],
        [-0.055793, 0.107574, -0.055181],
        0.011234,
        [0.304936, 0.330660],
    )
    for got, value in zip(back(np.array([[1.0, -1, -1]])), expected, strict=True):
        printed(got, value)
    (dx, dy), d_rho = np.array([[0.5, -2.5, 1.5], [-0.5, 0.5, -1.5]]), -alpha[0] * [1, -1, -1]
    sums = [d_rho @ dx**2 / 2, d_rho @ (dx * dy), d_rho @ dy**2 / 2]
    printed(sums, [0.865006, -0.642648, 0.212587])
    alpha, depth = np.array([[0.5], [0.25], [0.8]]), np.array([2.0, 1, 3])
    printed(-np.log(1 - alpha[:, 0]), [0.693147, 0.287682, 1.609438])
    shown, back = solution.composite_splats(alpha, np.eye(3), depth, np.ones(3))
    printed(shown, [0.45, 0.325, 0.375])
    d_alpha = back(np.array([[1, 0.5, -1]]))[0]
    printed(d_alpha, [1.275, 0.35, -0.5625])
    printed(d_alpha * (1 - alpha), [0.6375, 0.2625, -0.1125])


def test_check_values_of_the_chain_and_of_densify(solution: ModuleType) -> None:
    one = {
        "means": np.array([[0.1, 0, 2]]),
        "log_scales": np.full((1, 3), -1.0),
        "quats": np.eye(4)[:1],
        "opacity_logits": np.zeros(1),
        "colors": np.array([[1, 0.5, 0]]),
    }
    shown, back = solution.render(one, CAMERA, np.array([[32.5, 24.5]]), np.zeros(3))
    printed(shown, [0.487265, 0.243633, 0])
    got = back(np.array([[1.0, 0, 0]]))
    printed(got["means"], [-0.285734, 0.089337, 0.001762])
    printed(got["log_scales"], [0.022767, 0.002226, 0.000057])
    printed(got["absgrad"], [0.011452, 0.004476])
    four = {
        "means": np.zeros((4, 3)),
        "log_scales": np.repeat([[-4.0], [-2], [-2], [-2]], 3, axis=1),
        "quats": np.eye(4)[[0] * 4],
        "opacity_logits": np.array([2.0, 2, -5, 2]),
        "colors": np.arange(4.0)[:, None] * np.ones(3),
    }
    grad2d = np.array([1.0, 2, 3, 4])
    after, source = solution.densify(four, grad2d, np.random.default_rng(0), 10)
    assert after["colors"][:, 0].tolist() == [0, 0, 1, 3, 1, 3]
    assert source.tolist() == [0, -1, -1, -1, -1, -1]
    printed(after["opacity_logits"], [0.639950, 0.639950, 2, 2, 2, 2])


def test_tiles_lose_nothing(solution: ModuleType) -> None:
    rng = np.random.default_rng(3)
    scene = {
        "means": rng.uniform([-1, -1, 2], [1, 1, 4], (40, 3)),
        "quats": rng.normal(size=(40, 4)),
        "log_scales": rng.uniform(-4, -1, (40, 3)),
        "opacity_logits": rng.normal(size=40),
        "colors": rng.random((40, 3)),
    }
    whole, back = solution.picture(scene, CAMERA, np.full(3, 0.2))
    y, x = np.mgrid[0:48, 0:64] + 0.5
    pixels = np.stack([x.ravel(), y.ravel()], axis=1)
    plain, plain_back = solution.render(scene, CAMERA, pixels, np.full(3, 0.2))
    np.testing.assert_allclose(whole.reshape(-1, 3), plain, rtol=1e-12)
    g = rng.normal(size=whole.shape)
    mine, theirs = back(g), plain_back(g.reshape(-1, 3))
    assert set(mine) == set(theirs)
    for name in mine:
        assert np.abs(theirs[name]).max() > 0
        np.testing.assert_allclose(mine[name], theirs[name], rtol=1e-9, atol=1e-12)


def test_the_optimiser_follows_the_rows(solution: ModuleType) -> None:
    scene = {"means": np.arange(6.0).reshape(2, 3), "opacity_logits": np.array([1.0, 2.0])}
    adam = solution.Adam(scene)
    adam.step(scene, {name: array + 1 for name, array in scene.items()})
    adam.follow(np.array([1, -1, -1]))
    np.testing.assert_allclose(adam.m["means"], [[0.4, 0.5, 0.6], [0] * 3, [0] * 3])
    np.testing.assert_allclose(adam.v["opacity_logits"], [0.09, 0, 0])


def test_predictions_come_true(solution: ModuleType) -> None:
    # p1 is a fact of figure 3, p3 of figure 1.
    half, colors, depth = np.full((2, 1), 0.5), np.ones((2, 3)), np.array([1.0, 2.0])
    shown, _ = solution.composite_splats(half, colors, depth, np.zeros(3))
    np.testing.assert_allclose(shown, 0.75)


def test_generated_questions_have_the_answers_that_their_reasons_give(bundle: Bundle) -> None:
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for f in drawn["15.g1"]["f"]:
        for z in drawn["15.g1"]["z"]:
            for s in drawn["15.g1"]["s"]:
                right = (f * s / z) ** 2 + 0.3
                assert keys.variance_of_a_ball(reference, s, z, f) == pytest.approx(right)
            for h in drawn["15.g2"]["h"]:
                right = f * h / z**2
                got = keys.slope_of_the_held_entry(reference, h, f, z)
                assert got == pytest.approx(right, rel=1e-6)
    for a in drawn["15.g3"]["a"]:
        for b in drawn["15.g3"]["b"]:
            right = 1 - (0.5 * b + 0.2 * (1 - b))
            assert keys.slope_of_the_first_alpha(reference, a, b) == pytest.approx(right)
    concept = next(each for each in bundle.questions if each.id == "15.c1")
    assert concept.answer == 3 + 3 + 4 + 1 + 3 * 16


@pytest.mark.parametrize("mutant", ["adjoint_no_occlusion", "background_undimmed"])
def test_a_wrong_08_costs_the_checks_that_call_it(bundle: Bundle, mutant: str) -> None:
    files = bundle.solution_files(source(FOLDER))
    files["volume_rendering.py"] = apply_mutant(EARLIER, mutant).encode()
    sources = bundle.hand(files).sources
    checks = [e for e in bundle.checks if e.id in {"15.3.differences", "15.4.differences"}]
    outcomes = run_checks(checks, bundle.setting, lambda given: LocalStudent(sources, given))
    assert [each.status for each in outcomes] == [Status.PASSED, Status.FAILED]


def test_the_kit_has_the_photographs_with_their_license_and_the_stub_of_08() -> None:
    files = kit_files(FOLDER)
    data = {path: content for path, content in files.items() if path.startswith("data/")}
    assert b"Piero Toffanin" in data["data/LICENSE"]
    named = json.loads(data["data/transforms.json"])["frames"]
    assert {f"data/{frame['file_path']}" for frame in named} < set(data)
    assert (len(named), sum(map(len, data.values())) < 2_000_000) == (14, True)
    assert "08.2 composite_adjoint: see the handout" in files["volume_rendering.py"].decode()
    assert not {"banana.npz", "reduce_capture.py"} & set(files)


def test_the_cameras_of_the_capture_see_its_points() -> None:
    points = np.load(FOLDER / "data" / "points.npy")[:, :3]
    for photo in read_capture(FOLDER / "data", 50, 1000):
        t = (points - photo.world_from_camera[:3, 3]) @ photo.world_from_camera[:3, :3]
        u = photo.focal * t[:, :2] / t[:, 2:]
        assert (t[:, 2] > 1).all()
        assert np.mean((np.abs(u) < [25, 17]).all(axis=1)) > 0.6


def test_the_reduction_gives_the_same_files(tmp_path: Path, shared_data: Path) -> None:
    script = tmp_path / "reduce_capture.py"
    shutil.copy(FOLDER / "reduce_capture.py", script)
    subprocess.run([sys.executable, str(script), str(shared_data / CAPTURE)], check=True)
    for path in (FOLDER / "data").iterdir():
        assert (tmp_path / "data" / path.name).read_bytes() == path.read_bytes(), path.name


@pytest.mark.parametrize("alone", [False, True])
def test_the_exploration_fits_a_capture(tmp_path: Path, alone: bool) -> None:
    """With the core, where it is, and the points; and with neither."""
    for name in ("splatting.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    shutil.copy(EARLIER / "volume_rendering.py", tmp_path / "volume_rendering.py")
    shutil.copytree(FOLDER / "data", tmp_path / "mine")
    if alone:
        (tmp_path / "mine" / "points.npy").unlink()
    options = {"capture": "mine", "pixels": 40, "steps": 40, "start": 80, "every": 10, "frames": 6}
    order = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    hidden = "import sys; sys.modules['photograd'] = None; " if alone else ""
    done = subprocess.run(
        [sys.executable, "-c", f"{hidden}{EXPLORE}", *order],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "fit.gif") as film:
        assert getattr(film, "n_frames", 1) > 10
    assert [*tmp_path.glob("turntable.*")]
    with Image.open(tmp_path / "banana.png") as image:
        assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    said = done.stdout
    new = float(said.split(" dB over all held-out views")[0].rsplit(maxsplit=1)[1])
    nothing = float(said.split("one color has ")[1].split(" dB")[0])
    assert new > nothing + 1
    assert not (alone and "core" in said)
    if "core:" in said:
        pictures, derivatives = said.split("images differ by ")[1].split(", derivatives by ")
        assert float(pictures) < 1e-10
        assert float(derivatives.split()[0]) < 1e-9
