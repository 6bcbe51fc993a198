"""Assignment 09 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.load import load_beside
from photograd_course.build.public import kit_files
from photograd_course.captures import two_striped_balls
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Status
from photograd_course.grading.runner import run_checks
from PIL import Image

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    load_figures,
    source,
)

FOLDER, EARLIER = ASSIGNMENTS / "09_recovering_a_volume", ASSIGNMENTS / "08_volume_rendering"
PRINTED = 6e-7  # the handout rounds to six decimals
SLOPES = [-0.223480, 0.003605, -0.035031, 0.001225, -0.153031, 0.001026, -0.085439, -0.001366]
LOSSES, FIRST = [1.155254, 1.016579], [0.598859, 0.598859, 0.598859, 1.014104]
SIGMAS = [1.014104, 0, 1.005960, 0, 1.013409, 0, 1.015557, 0.263635]
POSE = np.array([[0, 0, -1, 3], [0, -1, 0, 0.5], [-1, 0, 0, 0.2], [0, 0, 0, 1.0]])


class TestRecoveringAVolume(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(FOLDER, secret=SECRET)


@pytest.fixture(scope="module")
def solution(bundle: Bundle):
    return bundle.reference


def views(pictures) -> dict:
    """The camera of the handout's check values."""
    return {
        "pictures": pictures,
        "world_from_camera": POSE[None],
        "focal": 2.0,
        "low": np.full(3, -1.0),
        "high": np.full(3, 1.0),
        "background": np.zeros(3),
    }


def half_bright() -> dict:
    pictures = np.zeros((1, 2, 4, 3))
    pictures[:, :, 2:] = 0.9
    return views(pictures)


def test_check_values_of_the_warm_up(solution) -> None:
    sigma, dt, c, b = 0.1, 2.0, 0.5, 0.1
    alpha = 1 - np.exp(-sigma * dt)
    pixel = alpha * c + (1 - alpha) * b
    assert alpha == pytest.approx(0.181269, abs=PRINTED)
    assert pixel == pytest.approx(0.172508, abs=PRINTED)
    slopes = [2 * (pixel - p) * (c - b) * dt * np.exp(-sigma * dt) for p in (0.1, 0.9)]
    np.testing.assert_allclose(slopes, [0.094983, -0.952993], atol=PRINTED)
    # The same by the renderer of 08: one voxel, a ray through 2 m of it.
    ray = (np.full(3, -1.0), np.full(3, 1.0), np.array([[0, 0, 3.0]]), np.array([[0, 0, -1.0]]))
    grid, behind = np.array([c, c, c, sigma])[None, None, None], np.full(3, b)
    seen = solution.render_rays(grid, *ray, 4, behind)
    for p, slope in zip((0.1, 0.9), slopes, strict=True):
        d_pixel = np.array([[1.0, 0, 0]]) * 2 * (seen - p)
        d_grid, _ = solution.render_adjoint(grid, *ray, 4, behind, d_pixel)
        assert d_grid[0, 0, 0, 3] == pytest.approx(slope, rel=1e-12)


def test_check_values_of_the_parts(solution) -> None:
    assert solution.psnr(np.full((2, 2, 3), 0.5), np.full((2, 2, 3), 0.25)) == pytest.approx(
        12.041200, abs=PRINTED
    )
    origins, d, _ = solution.ray_batch(views(np.zeros((1, 2, 4, 3))), np.array([5, 3]))
    np.testing.assert_allclose(origins, [[3, 0.5, 0.2]] * 2)
    np.testing.assert_allclose(d / -d[:, :1], [[-1, -0.25, 0.25], [-1, 0.25, -0.75]])
    pixels, truth = [[0.2, 0.5, 0.1], [0.4] * 3], [[0.1, 0.5, 0.3], [0.4, 0.1, 0.4]]
    loss, d_pixels = solution.mse_and_cotangent(np.array(pixels), np.array(truth))
    assert loss == pytest.approx(0.07)
    np.testing.assert_allclose(d_pixels[0], [0.1, 0, -0.2], atol=1e-15)
    grid = np.arange(8.0).reshape(2, 2, 2, 1) ** 2 / 49
    loss, d_grid = solution.tv_loss_adjoint(grid, 0.1)
    assert loss == pytest.approx(0.363823, abs=PRINTED)
    expected = [-0.152315, -0.147976, -0.112179, -0.066185, -0.045259, 0.044010, 0.116392, 0.363513]
    np.testing.assert_allclose(d_grid.ravel(), expected, atol=PRINTED)


def test_check_values_of_signs_and_fit(solution) -> None:
    fog, seen = solution.fog((2, 2, 2)), half_bright()
    signs = solution.gradient_sign_map(fog, seen)
    assert signs.ravel().tolist() == [-1, 1, -1, 1, -1, 1, -1, -1]
    origins, directions, truth = solution.ray_batch(seen, np.arange(8))
    rays = (seen["low"], seen["high"], origins, directions, 16, np.zeros(3))
    _, d_pixels = solution.mse_and_cotangent(solution.render_rays(fog, *rays), truth)
    d_sigma = solution.render_adjoint(fog, *rays, d_pixels)[0][..., 3].ravel()
    np.testing.assert_allclose(d_sigma, SLOPES, atol=PRINTED)
    grid, losses = solution.fit_volume(seen, fog, 2, np.random.default_rng(0))
    np.testing.assert_allclose(losses, LOSSES, atol=PRINTED)
    np.testing.assert_allclose(grid[0, 0, 0], FIRST, atol=PRINTED)
    np.testing.assert_allclose(grid[..., 3].ravel(), SIGMAS, atol=PRINTED)


def test_predictions_come_true(solution) -> None:
    # p1: an empty voxel between camera and ball. p2 and d1 are facts of figures 6, 4 and 5.
    bright = views(np.full((1, 2, 4, 3), 0.9))
    signs = solution.gradient_sign_map(solution.fog((6, 6, 6)), bright)
    assert set(np.unique(signs)) <= {-1.0, 0.0}
    assert (signs == -1).sum() > 40
    # p3: fewer photographs are matched better, unseen ones worse.
    parts = load_figures(FOLDER).parts
    scene, unseen = two_striped_balls(12), []
    own = []
    for count in (12, 3):
        taken = parts.photographs(solution, scene, count, 10)
        start = solution.fog((12, 12, 12))
        found, _ = solution.fit_volume(taken, start, 40, np.random.default_rng(0))
        own.append(parts.score(solution, found, taken))
        others = parts.photographs(solution, scene, 4, 10, 1.0)
        unseen.append(parts.score(solution, found, others))
    assert own[1] > own[0] + 1
    assert unseen[1] < unseen[0] - 1


def test_the_classmates_loss_is_what_the_diagnosis_says(bundle: Bundle) -> None:
    text = source(FOLDER)
    line = "return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual"
    assert text.count(line) == 1
    told = text.replace(line, line.replace("len(residual)),", "residual.size),"))
    wrong = load_beside(bundle.manifest.module, told, bundle.brought)
    rng = np.random.default_rng(0)
    for n in (10, 1000):
        pixels, truth = rng.random((2, n, 3))
        loss, d = wrong.mse_and_cotangent(pixels, truth)
        moved, _ = wrong.mse_and_cotangent(pixels + 1e-6 * d, truth)
        assert np.vdot(d, d) * 1e-6 / (moved - loss) == pytest.approx(3, rel=1e-4)
    fits = []
    for module in (bundle.reference, wrong):
        assert module is not None
        start = module.fog((3, 3, 3))
        fits.append(module.fit_volume(half_bright(), start, 5, np.random.default_rng(0)))
    np.testing.assert_array_equal(fits[0][0], fits[1][0])
    assert (fits[1][1] < fits[0][1]).all()


def test_generated_questions_have_the_answers_that_their_reasons_give(bundle: Bundle) -> None:
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    drawn = {question.id: question.draw for question in bundle.questions if question.draw}
    for a in drawn["09.g1"]["a"]:
        for b in drawn["09.g1"]["b"]:
            right = -10 * np.log10(0.75 * a**2 + 0.25 * b**2)
            assert keys.decibels_of_two_errors(reference, a, b) == pytest.approx(right)
    for n in drawn["09.g2"]["n"]:
        for b in drawn["09.g2"]["b"]:
            right = n**3 * 4 * 4 * b / 2**20
            assert keys.mebibytes_of_a_fit(reference, n, b) == right
    for w in drawn["09.g3"]["w"]:
        for f in drawn["09.g3"]["f"]:
            right = 10 * (0.5 - w / 2) / f
            assert keys.where_the_corner_ray_lands(reference, 20, w, f) == pytest.approx(right)
    concept = next(each for each in bundle.questions if each.id == "09.c1")
    assert concept.answer == 4096**3 * 4 / 2**30


def test_the_storage_table_is_right() -> None:
    text = (FOLDER / "handout.md").read_text("utf-8")
    for n, said in ((20, f"{20**3 * 4 / 2**10:.0f} KiB"), (256, "64 MiB"), (1024, "4 GiB")):
        assert f"| {n}³ | {said} |" in text
    assert 256**3 * 4 == 64 << 20
    assert 1024**3 * 4 == 4 << 30
    assert "256 GiB" not in text


@pytest.mark.parametrize("mutant", ["adjoint_no_occlusion", "adjoint_missing_step", "view_units"])
def test_a_wrong_adjoint_of_08_costs_the_check_of_the_chain_alone(
    bundle: Bundle, mutant: str
) -> None:
    files = bundle.solution_files(source(FOLDER))
    files["volume_rendering.py"] = apply_mutant(EARLIER, mutant).encode()
    sources = bundle.hand(files).sources
    wanted = {"09.3.chain", "09.5.differences", "09.6.first"}
    checks = [each for each in bundle.checks if each.id in wanted]
    outcomes = run_checks(checks, bundle.setting, lambda given: LocalStudent(sources, given))
    assert [each.status for each in outcomes] == [Status.FAILED, Status.PASSED, Status.PASSED]
    assert outcomes[0].details["error"] > 1000 * outcomes[0].details["tolerance"]


def test_the_kit_has_the_stub_of_08_and_none_of_its_solution() -> None:
    files = kit_files(FOLDER)
    stub = files["volume_rendering.py"].decode()
    assert "08.2 composite_adjoint: see the handout" in stub
    assert "np.expm1(-tau)" not in stub
    assert b"np.add.at" not in b"".join(d for p, d in files.items() if not p.endswith(".png"))


def capture(folder: Path) -> None:
    """Photographs of a white ball before black from six sides, cameras as NeRF tools write them."""
    (folder / "images").mkdir(parents=True)
    v, u = np.mgrid[0:24, 0:32]
    disc = (np.hypot(u - 15.5, v - 11.5) < 6) * np.uint8(255)
    frames = []
    for k in range(6):
        Image.fromarray(np.repeat(disc[:, :, None], 3, axis=2)).save(folder / f"images/{k}.png")
        c, s = np.cos(k * np.pi / 3), np.sin(k * np.pi / 3)
        pose = np.array([[c, 0, s, 4 * s], [0, 1, 0, 0], [-s, 0, c, 4 * c], [0, 0, 0, 1]])
        frames.append({"file_path": f"images/{k}", "transform_matrix": pose.tolist()})
    told = {"camera_angle_x": 0.7, "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(told), encoding="utf-8")


def test_the_exploration_runs_with_and_without_a_capture(tmp_path: Path) -> None:
    for name in ("volume_recovery.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    shutil.copy(EARLIER / "volume_rendering.py", tmp_path / "volume_rendering.py")
    capture(tmp_path / "mine")
    done = subprocess.run(
        [
            sys.executable,
            "explore.py",
            "--figure",
            "0",
            "--views",
            "6",
            "--pixels",
            "10",
            "--voxels",
            "10",
            "--steps",
            "25",
            "--capture",
            "mine",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for picture in ("recovery.png", "capture.png"):
        with Image.open(tmp_path / picture) as image:
            assert np.asarray(image.convert("L"), dtype=float).std() > 5.0
    new = float(done.stdout.split("photographs, ")[1].split(" dB on held-out views")[0])
    fog = float(done.stdout.split("fog has ")[1].split(" dB")[0])
    assert new > fog + 3
    kept_back = float(done.stdout.split(" dB on the held-out one")[0].rsplit(maxsplit=1)[1])
    assert kept_back > 15  # black has 10
    if "core not installed" not in done.stdout:
        assert float(done.stdout.split("its derivative is ")[1].split("%")[0]) < 5
