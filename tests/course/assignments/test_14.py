"""Assignment 14 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.drawing import draw as draw_question
from photograd_course.assignment.load import load_beside

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    lost,
    source,
)

FOLDER = ASSIGNMENTS / "14_edges_and_light"
EARLIER = {
    "path_tracing.py": ASSIGNMENTS / "07_path_tracing",
    "reflectance.py": ASSIGNMENTS / "04_reflectance",
}
PRINTED = 6e-7  # the handout rounds to six decimals


class TestEdgesAndLight(AssignmentTests):
    folder = FOLDER
    long_figures = frozenset({"fig5_replay"})


@pytest.fixture(scope="module")
def bundle() -> Bundle:
    return read_folder(FOLDER, secret=SECRET)


@pytest.fixture(scope="module")
def solution(bundle: Bundle):
    return bundle.reference


def mutant(bundle: Bundle, name: str):
    return load_beside("edges_and_light", apply_mutant(FOLDER, name), bundle.brought)


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def one_color(value: float):
    return lambda points: np.full((len(points), 1), value)


SQUARE = np.array([[2.0, 1], [6, 1], [6, 5], [2, 5]])


def test_numbers_of_the_warm_up() -> None:
    def pixel(p):
        return 0.9 * p + 0.2 * (1 - p)

    def four_samples(p):
        x = np.array([1, 3, 5, 7]) / 8
        return np.where(x < p, 0.9, 0.2).mean()

    assert pixel(0.35) == pytest.approx(0.445)
    assert (pixel(0.36) - pixel(0.34)) / 0.02 == pytest.approx(0.7)
    assert four_samples(0.35) == pytest.approx(0.375)
    assert four_samples(0.36) == four_samples(0.34)
    assert 2 * (pixel(0.35) - 0.62) * 0.7 == pytest.approx(-0.245)
    assert pixel(0.6) == pytest.approx(0.62)


def test_check_values_of_edges(solution) -> None:
    angle, offset = np.array([0, np.pi / 4, 0.4, 0.4]), np.array([0.2, 0.3, 0.1, 0.5])
    area, d_offset, d_angle = solution.edge_coverage(angle, offset)
    close(area, [0.7, 0.834264, 0.608570, 0.966405])
    close(d_offset, [1, 0.814214, 1.085704, 0.432811])
    close(d_angle, [0, 0, 0.045903, -0.049795])
    colors = one_color(0.9), one_color(0.2)
    got = solution.edge_sampling_backward(SQUARE, *colors, np.full((8, 8, 1), 2.0), np.array([0.3]))
    close(got, [0, 0, 17.92, 0, 4.48, 0, 0, 0])
    twice = np.repeat(SQUARE, [1, 2, 1, 1], axis=0)
    got = solution.edge_sampling_backward(twice, *colors, np.full((8, 8, 1), 2.0), np.array([0.3]))
    close(got, [0, 0, 0, 0, 17.92, 0, 4.48, 0, 0, 0])
    even = (np.arange(4000) + 0.5) / 4000
    colors = one_color(1.0), one_color(0.0)
    got = solution.edge_sampling_backward(SQUARE, *colors, np.ones((8, 8, 1)), even)
    close(got, [[-2, -2], [2, -2], [2, 2], [-2, 2]])


def test_check_values_of_the_stroke(solution) -> None:
    curve, d_alpha = np.array([[1.0, 4], [4, 4], [7, 4]]), np.zeros((8, 8))
    d_alpha[4, 3] = 1.0
    close(solution.nearest_on_curve(curve, np.array([[3.5, 4.5]])), [0.416667, 0.5])
    d_curve, d_width = solution.stroke_backward(curve, 1.0, d_alpha)
    close(d_width, 0.564190)
    close(d_curve, [0, 0.383962, 0, 0.548518, 0, 0.195899])
    curve, d_alpha = np.array([[1.5, 4.5], [4, 4.5], [7, 4.5]]), np.zeros((8, 8))
    d_alpha[4, 1] = 1.0
    d_curve, d_width = solution.stroke_backward(curve, 0.5, d_alpha)
    close([d_width, *d_curve.ravel()], [1.011553, 0, 0, 0, 0, 0, 0])


def test_check_values_of_replay_and_loss(solution) -> None:
    scene = solution.demo_niche()
    ray = np.array([[0, 1.1, 2.6]]), np.array([[0, -0.4, -1]]) / np.sqrt(1.16)
    radiance = solution.path_radiance(scene, *ray, 3, 7)
    close(radiance, [0.374245, 0.250799, 0.120863])
    got = solution.replay_backward(scene, *ray, 3, 7, radiance, np.ones((1, 3)))
    close(got[0][[0, 3]], [0.466041, 0.498566, 0.595216, 0.316228, 0.183952, 0.068551])
    close(got[1], [0.296469, 0, 0, 0, 0])
    twice = [np.tile(each, (2, 1)) for each in ray]
    picture = np.full((2, 3), 0.2)
    loss, _, d_roughness = solution.noisy_loss_and_grad(scene, *twice, picture, 3, 2, (1, 2))
    close([loss, d_roughness[0]], [1.181121, 2.490488])


def test_check_values_of_the_lens(solution) -> None:
    heights = np.array([[0, 0.02], [0.03, 0.06]])
    got = solution.landing_backward(heights, np.array([[1.0, -2]]))
    close(got, [0.249416, 0.735593, -0.724335, -0.238159])

    def bending(q):
        k = (np.sqrt(1 + (1 - 1.5**2) * q) - 1.5) / (1 + q)
        return -k / (1.5 + k)

    q = 0.025**2 + 0.035**2
    assert q == pytest.approx(0.00185)
    close(bending(q), 0.500347)
    close((bending(q + 1e-6) - bending(q - 1e-6)) / 2e-6, 0.187978)


def test_the_paths_are_those_of_the_path_tracer(solution) -> None:
    """Equal means: `path_radiance` with its own numbers, `trace_paths` of assignment 07."""
    scene, rays = solution.demo_niche(), solution.niche_rays(4, 3)
    many = [np.repeat(each, 300, axis=0) for each in rays]
    mine = np.array([solution.path_radiance(scene, *many, 3, seed).mean() for seed in range(12)])
    tracer = solution.direct_light.__globals__["trace_paths"]
    theirs = np.array(
        [tracer(scene, *many, 3, np.random.default_rng(seed)).mean() for seed in range(12)]
    )
    spread = np.sqrt(mine.var(ddof=1) / 12 + theirs.var(ddof=1) / 12)
    assert abs(mine.mean() - theirs.mean()) < 4.5 * spread
    assert spread < 0.02 * mine.mean()


def test_right_estimates_are_rejected_as_rarely_as_they_should() -> None:
    checks = load_checks_of(FOLDER)
    rng = np.random.default_rng(3)
    p = np.array([checks.p_value(rng.exponential(size=60), 1.0) for _ in range(400)])
    assert 8 <= np.sum(p < 0.05) <= 45
    assert 3 * checks.LEVEL**2 < 1e-6
    assert checks.p_value(rng.exponential(size=60), 2.0) < checks.LEVEL


def test_diagnoses_fit_one_answer_alone(bundle: Bundle, solution) -> None:
    thin = np.array([[2.0, 2], [14, 2], [14, 3], [2, 3]])
    colors, ones = (one_color(1.0), one_color(0.0)), np.ones((16, 16, 1))
    even = (np.arange(52000) + 0.5) / 52000
    wrong = mutant(bundle, "edges_uniform_sides")
    one, other = (m.edge_sampling_backward(thin, *colors, ones, even) for m in (solution, wrong))
    np.testing.assert_allclose(other[:, 0] / one[:, 0], 26 / 4 / 1, rtol=1e-3)
    np.testing.assert_allclose(other[:, 1] / one[:, 1], 26 / 4 / 12, rtol=1e-3)
    # Without the last bounce, the late subtraction adds 1 at depth 3 in a furnace of albedo 0.5.
    checks = load_checks_of(FOLDER)
    scene, rng = checks.cube(emission=1.0, base_color=0.5), np.random.default_rng(2)
    rays = np.zeros((20000, 3)), rng.normal(size=(20000, 3))
    rays[1][:] /= np.linalg.norm(rays[1], axis=1, keepdims=True)
    radiance, d = solution.path_radiance(scene, *rays, 3, 1), np.full((20000, 3), 1 / 60000)
    late = mutant(bundle, "replay_subtract_late")
    totals = [m.replay_backward(scene, *rays, 3, 1, radiance, d)[0].sum() for m in (solution, late)]
    assert totals[0] == pytest.approx(2.0, abs=0.05)
    assert totals[1] - 0.5 == pytest.approx(3.0, abs=0.05)  # 0.5 by the last bounce


def test_answers_of_the_generated_questions(bundle: Bundle) -> None:
    keys, text = bundle.keys, source(FOLDER)
    assert keys is not None
    got = keys.length_in_the_pixel(bundle.reference, 30, 0.05)
    assert got == pytest.approx(1 / np.cos(np.pi / 6))
    assert keys.derivative_of_a_side(bundle.reference, 5, 0.9, 0.3, 2.0) == pytest.approx(6.0)
    assert keys.derivative_of_a_furnace(bundle.reference, 0.5, 4) == pytest.approx(2.75)
    for question in bundle.questions:
        if question.kind == "generated":
            drawn = draw_question(question, "somebody", text)
            assert "{" not in drawn.text
            answer = getattr(keys, str(question.answer))(bundle.reference, **drawn.values)
            assert abs(answer) > 0.01  # so that a relative tolerance means something


def test_a_wrong_path_tracer_costs_the_check_of_the_furnace_alone(
    bundle: Bundle, monkeypatch
) -> None:
    text = bundle.brought["path_tracing"]
    right = "    radiance = emitted(scene, hit)\n"
    wrong = text.replace(right, "    radiance = np.zeros((len(origins), 3))\n")
    assert wrong != text
    monkeypatch.setitem(bundle.brought, "path_tracing", wrong)
    monkeypatch.setattr("course.assignments.support.bundle_of", lambda *_: bundle)
    outcomes = judge(FOLDER, tasks=["14.4"])
    assert lost(outcomes) == {"14.4.mean"}
    assert any("path_tracing.py" in str(each.hint) for each in outcomes)


def test_coverage_and_edge_sampling_are_those_of_the_core(solution) -> None:
    core = pytest.importorskip("photograd.raster.coverage")
    rng = np.random.default_rng(7)
    polygon = np.array([[2.1, 3.2], [11.7, 1.4], [14.2, 9.9], [5.5, 12.8]])
    exact = core.polygon_coverage(polygon, (12, 16))
    np.testing.assert_allclose(solution.polygon_image(polygon, 12, 16), exact, atol=1e-12)
    d_image, u = rng.uniform(-1, 1, (12, 16)), (np.arange(400_000) + 0.5) / 400_000
    colors = one_color(1.0), one_color(0.0)
    got = solution.edge_sampling_backward(polygon, *colors, d_image[..., None], u)
    right = core.polygon_coverage_backward(polygon, d_image)
    assert np.linalg.norm(got - right) < 1e-3 * np.linalg.norm(right)


ALONE = """
import runpy, sys
sys.modules["photograd"] = None
sys.argv[0] = "explore.py"
runpy.run_path("explore.py", run_name="__main__")
"""


def test_the_exploration_runs_and_says_what_it_did(tmp_path: Path) -> None:
    for name in ("edges_and_light.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    for name, folder in EARLIER.items():
        shutil.copy(folder / name, tmp_path / name)
    (tmp_path / "alone.py").write_text(ALONE, encoding="utf-8")

    def explore(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *words], cwd=tmp_path, capture_output=True, text=True, check=False
        )

    few = ("--figure", "0", "--cells", "24", "--steps", "12", "--fit", "3")
    done = explore("alone.py", *few, "--letters", "hq")
    assert done.returncode == 0, done.stderr
    assert "core not installed" in done.stdout
    assert "HQ, correlation 0." in done.stdout
    assert (tmp_path / "edges_and_light.png").stat().st_size > 10_000
    none = explore("explore.py", "--letters", "A1")
    assert none.returncode == 1
    assert "two of A to Z" in none.stderr
    assert "Traceback" not in none.stderr


def test_initials_are_drawn_from_the_text_of_the_module(solution) -> None:
    pairs = {solution.initials_of(f"submission {k}") for k in range(200)}
    assert len(pairs) > 100
    assert all(len(each) == 2 and each.isalpha() and each.isupper() for each in pairs)
    assert solution.initials_of("a") == solution.initials_of("a")
    glyphs = [solution.letters_image(2 * chr(65 + k), 14) for k in range(26)]
    assert len({each.tobytes() for each in glyphs}) == 26
    np.testing.assert_allclose([each.mean() for each in glyphs], 1)
