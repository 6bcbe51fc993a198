"""Assignment 15 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from PIL import Image

from course.assignments.support import ASSIGNMENTS, SECRET, AssignmentTests

FOLDER = ASSIGNMENTS / "15_gaussian_splatting"
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
    alpha, depth = np.array([[0.5], [0.25], [0.8]]), np.array([2.0, 1, 3])
    shown, back = solution.composite(alpha, np.eye(3), depth, np.ones(3))
    printed(shown, [0.45, 0.325, 0.375])
    printed(back(np.array([[1, 0.5, -1]]))[0], [1.275, 0.35, -0.5625])


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
    shown, _ = solution.composite(half, colors, depth, np.zeros(3))
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


def test_the_exploration_runs_and_tells_the_two_formulas_apart(tmp_path: Path) -> None:
    for name in ("splatting.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    done = subprocess.run(
        [
            sys.executable,
            "explore.py",
            "--steps",
            "30",
            "--pixels",
            "20",
            "--views",
            "5",
            "--every",
            "10",
            "--core-pixels",
            "20",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "fit.gif") as film:
        assert getattr(film, "n_frames", 1) > 10
    with Image.open(tmp_path / "absgrad.png") as image:
        assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    said = done.stdout
    new = float(said.split(" dB on held-out views (an empty scene has ")[0].rsplit(maxsplit=1)[1])
    nothing = float(said.split("an empty scene has ")[1].split(" dB")[0])
    assert new > nothing + 2
    assert float(said.split("doubled later has an error of ")[1].split(";")[0]) < 1e-6
    patched = said.split("the patch (stored whole, still doubled) of ")[1]
    assert float(patched.split("%")[0]) == pytest.approx(208, abs=1)
    differences, public, mended = (
        float(said.split(f"{name} ")[1].split(",")[0].split()[0])
        for name in ("outside: finite differences", "the formula of public code", "clamped branch")
    )
    assert mended == pytest.approx(differences, abs=2e-4)
    assert abs(public - differences) > 0.1 * abs(differences)
    if "core not installed" not in said:
        pictures, derivatives = said.split("images differ by ")[1].split(", derivatives differ by ")
        assert float(pictures) < 1e-10
        assert float(derivatives.split()[0]) < 1e-9
