"""Assignment 07 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_beside
from photograd_course.build.regions import strip_solution

from course.assignments.support import (
    ASSIGNMENTS,
    SECRET,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    source,
)

FOLDER = ASSIGNMENTS / "07_path_tracing"
PRINTED = 6e-7  # the handout rounds to six decimals


class TestPathTracing(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


@pytest.fixture(scope="module")
def checks():
    return load_checks_of(FOLDER)


def loaded(text: str):
    return load_beside("path_tracing", text, read_folder(FOLDER).brought)


def close(got, expected) -> None:
    np.testing.assert_allclose(np.ravel(got), np.ravel(expected), atol=PRINTED)


def place_of_the_handout():
    """The hit, u_light and the two u_surface of section 3."""
    hit = {
        "points": np.zeros((1, 3)),
        "normals": np.array([[0, 1.0, 0]]),
        "primitive": np.array([0]),
        "wo": np.array([[0, 0.8, 0.6]]),
        "front": np.array([True]),
        "t": np.ones(1),
    }
    found, nothing = np.array([[0.7, 0.25, 0.2]]), np.array([[0.7, 0.3, 0.6]])
    return hit, np.array([[0.5, 0.25, 0.75]]), found, nothing


def test_numbers_of_the_warm_up(solution) -> None:
    f, p, q = np.array([2.0, 1, 6]), np.array([0.2, 0.2, 0.6]), np.array([0.6, 0.2, 0.2])

    def variance(chance, said):
        return chance @ said**2 - (chance @ said) ** 2

    assert f.sum() == pytest.approx(9)
    np.testing.assert_allclose(f / p, [10, 5, 10])
    np.testing.assert_allclose(f / q, [3.33, 5, 30], atol=0.005)
    alone = variance(p, f / p), variance(q, f / q)
    np.testing.assert_allclose(alone, [4, 110.7], atol=0.05)
    assert sum(alone) / 4 == pytest.approx(28.7, abs=0.05)
    w = solution.mis_weight(p, q)
    np.testing.assert_allclose(w, [0.1, 0.5, 0.9])
    np.testing.assert_allclose([w * f / p, (1 - w) * f / q], [[1, 2.5, 9], [3, 2.5, 3]])
    both = variance(p, w * f / p) + variance(q, (1 - w) * f / q)
    assert both == pytest.approx(12.9, abs=0.05)
    slope, drift = np.array([1, 0, 2]), np.array([-0.2, 0.1, 0.1])
    np.testing.assert_allclose(f * drift / p, [-2, 0.5, 1])
    assert slope.sum() - np.sum(f * drift / p) == pytest.approx(3.5)


def test_check_values_of_densities_weights_and_roulette(solution) -> None:
    light = solution.rectangle([-0.5, 2, -0.25], [1, 0, 0], [0, 0, 0.5], emission=1)
    scene = solution.assemble([light])
    for aside, right in ((0.0, 8), (1.5, 15.625)):
        to = np.array([[-aside, 2.0, 0]])
        far = np.linalg.norm(to, axis=1)
        close(solution.light_pdf(scene, np.array([0]), to / far[:, None], far), right)
    weights = solution.mis_weight(np.array([3.0, 1, 2e200]), np.array([1.0, 1, 1e200]))
    close(weights, [0.9, 0.5, 0.8])
    beta, alive = solution.roulette(np.tile([0.2, 0.5, 0.1], (2, 1)), np.array([0.3, 0.6]))
    close(beta, [0.4, 1, 0.2, 0, 0, 0])
    assert alive.tolist() == [True, False]
    close(solution.roulette(np.array([[0.04, 0.1, 0.02]]), np.array([0.03]))[0], [0.4, 1, 0.2])


def test_check_values_of_direct_light_and_its_gradient(solution) -> None:
    scene = solution.demo_table()
    hit, u, found, nothing = place_of_the_handout()
    wi, far, primitive = solution.sample_light(scene, hit["points"], u)
    close(wi, [-0.232810, 0.721711, -0.651868])
    p, q = solution.light_pdf(scene, primitive, wi, far), solution.brdf_pdf(scene, hit, wi)
    close([far, p, q, solution.mis_weight(p, q)], [1.073837, 1.876163, 0.614065, 0.903241])
    close(solution.brdf(scene, hit, wi), [0.701698, 0.449226, 0.196754])
    wi = solution.sample_brdf(scene, hit, found)
    close(wi, [-0.106106, 0.775248, -0.622681])
    there = solution.closest_hit(scene, hit["points"], wi)
    q = solution.brdf_pdf(scene, hit, wi)
    p = solution.light_pdf(scene, there["primitive"], wi, there["t"])
    close([q, p, solution.mis_weight(q, p)], [2.050804, 1.815058, 0.560755])
    for us, light, color, rough in (
        (found, [4.269358, 2.282379, 0.805568], [5.101676, -2.125698, 6.802235], -14.055644),
        (nothing, [1.462845, 0.780426, 0.273452], [1.754445, -0.731019, 2.339259], 3.633138),
    ):
        close(solution.direct_light(scene, hit, u, us), light)
        got = solution.direct_light_backward(scene, hit, u, us, np.array([[1, -0.5, 2]]))
        close(got[0], [*color, 0, 0, 0])
        close(got[1], [rough, 0])


def test_right_draws_are_rejected_as_rarely_as_they_should(solution, checks) -> None:
    """Of 400 judgements p is below 0.05 in 20, give or take; of wrong draws, all, by far."""

    class Draws:
        rng = np.random.default_rng(12)

    scene, hit, right = checks.lit_floor(Draws, 400 * 150)
    u = Draws.rng.random((2, 400 * 150, 3))
    values = solution.direct_light(scene, hit, *u).reshape(400, 150, 3)
    p = np.array([checks.p_value(each, right) for each in values])
    assert 5 <= np.sum(p < 0.05) <= 40
    assert p.min() > checks.LEVEL / 10
    # Eleven judgements, each with a second chance.
    assert 11 * checks.LEVEL**2 < 1e-6
    part = {name: rows[:2000] for name, rows in hit.items()}
    for name in ("direct_no_cosine", "direct_lamps_alone", "direct_wrong_measure"):
        values = loaded(apply_mutant(FOLDER, name)).direct_light(scene, part, *u[:, :2000])
        assert checks.p_value(values, right) < checks.LEVEL / 1000


def test_a_wrong_mean_is_named_by_the_mistake_that_has_it(checks) -> None:
    class Judged:
        def require(self, condition: bool, text: str, hint: str = "") -> None:
            assert condition, f"{text}: {hint}"

    rng, one = np.random.default_rng(14), np.ones(3)
    known = [(2 * one, "twice"), (3 * one, "thrice")]
    for mean, said in ((2.0, "twice"), (3.0, "thrice"), (2.5, "another")):
        with pytest.raises(AssertionError, match=f"is not 1 .*: {said}"):
            checks.require_mean(
                Judged(), "x", lambda m=mean: rng.normal(m, 0.1, (500, 3)), one, known, "another"
            )
    checks.require_mean(Judged(), "x", lambda: rng.normal(1, 0.1, (500, 3)), one, known)
    # The one of those in task 5 that is no named mutant: beta comes before direct light.
    add = "radiance[live] += beta * direct_light(scene, hit, *fresh[:2])"
    times = "beta = beta * brdf(scene, hit, wi) * share[:, None]"
    text = source(FOLDER).replace(add, "light = direct_light(scene, hit, *fresh[:2])")
    text = text.replace(times, f"{times}\n        radiance[live] += beta * light")
    hints = {each.id: each.hint for each in judge(FOLDER, text, tasks=("07.5",))}
    for name in ("integral", "corner", "furnace"):
        assert "beta is updated before direct light" in hints[f"07.5.{name}"]


def test_predictions_and_diagnoses_come_true(checks) -> None:
    # Predictions and d2 are facts of Figures 3, 4 and 5. d1: lights counted twice, by depth.
    twice, rng = loaded(apply_mutant(FOLDER, "trace_double_emission")), np.random.default_rng(13)
    scene = checks.scene_of(checks.cube(emission=1.0, base_color=0.5))
    d = rng.normal(size=(2000, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    for depth, right in ((1, 1.0), (2, 1.5), (3, 2.25), (4, 2.625)):
        seen = twice.trace_paths(scene, np.zeros((2000, 3)), d, depth, rng)
        assert seen.mean() == pytest.approx(right, rel=0.02)


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER, secret=SECRET)
    keys, reference = bundle.keys, bundle.reference
    assert keys is not None
    for height, aside in ((1.5, 0.5), (2.5, 2.0)):
        square = height**2 + aside**2
        got = keys.density_of_the_middle(reference, 0.8, 0.6, height, aside)
        assert got == pytest.approx(square**1.5 / (0.48 * height))
    got = keys.share_of_a_sample(reference, 2.0, 3.0, 1.2)
    assert got == pytest.approx(4 / 13 * 0.6)
    got = keys.radiance_of_the_room(reference, 2.0, 0.6, 4)
    assert got == pytest.approx(2 * (1 - 0.6**4) / 0.4)


def test_the_kit_runs_without_the_solution() -> None:
    """What is given works before anything is written: a student can look at a scene first."""
    module = loaded(strip_solution(source(FOLDER)))
    scene = module.demo_room()
    hit = module.closest_hit(scene, *module.camera_rays(8, 6, [0, 1, 3.4], [0, 1, 0], 38))
    assert {5, 7} <= set(hit["primitive"])
    with pytest.raises(NotImplementedError):
        module.mis_weight(np.ones(1), np.ones(1))


def core_camera(origin, direction):
    camera = pytest.importorskip("photograd.capture.camera").Camera
    pose = pytest.importorskip("photograd.capture.orbit").look_at(origin, origin + direction)
    return camera(1, 1, 1e5, 1e5, 0.5, 0.5, pose)


def test_the_shipped_answers_are_the_core_s(solution) -> None:
    transport = pytest.importorskip("photograd.transport")
    shapes = pytest.importorskip("photograd.transport.shapes")
    table = solution.demo_table()
    parts = [
        shapes.rectangle(
            f"primitive{k}",
            table["corners"][k],
            table["edges_u"][k],
            table["edges_v"][k],
            f"of{k}",
            table["emission"][k],
        )
        for k in range(2)
    ]
    names = ("base_color", "metalness", "roughness")
    materials = {
        f"of{k}": transport.Material("gltf", {n: table[n][k] for n in names}) for k in range(2)
    }
    origins, directions = solution.table_rays()
    light, slope, found = solution.core_answers()
    options = transport.PathOptions(max_depth=2)
    cameras = {k: core_camera(origins[k], directions[k]) for k in (22, 35, 44, 57, 60)}
    scene = transport.Scene("table", tuple(parts), materials, cameras[22])
    tracer = transport.PathTracer(scene, dtype=np.float64)
    for k, camera in cameras.items():
        given = {"spp": 8000, "seed": k, "options": options, "camera": camera}
        seen = tracer.render(**given)
        off = np.abs(seen.mean[0, 0] - light.reshape(70, 3)[k])
        assert (off < 5 * seen.standard_error[0, 0] + 2e-4).all()
        back = tracer.render_backward(np.full((1, 1, 3), 1 / 3), **given)
        right = slope.ravel()[k]
        assert back["materials.of0.roughness"] == pytest.approx(right, rel=0.1, abs=0.02)
    np.testing.assert_allclose(found, [0.8, 0.5, 0.2, 0.35], atol=0.0125)


def test_the_exploration_runs_beside_the_core(tmp_path: Path) -> None:
    for name in ("path_tracing.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    shutil.copy(ASSIGNMENTS / "04_reflectance" / "reflectance.py", tmp_path)
    order = [sys.executable, "explore.py", "--size", "12", "--samples", "2", "--steps", "20"]
    order += ["--figure", "0"]
    done = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout.split("your image is ")[1].split("%")[0]) < 10
    assert float(done.stdout.split("gradient ")[1].split("%")[0]) < 40
    assert "core" in done.stdout
    assert (tmp_path / "traced.png").stat().st_size > 5_000


ALONE = """
import runpy, sys
sys.modules["photograd"] = None
sys.argv[0] = "explore.py"
runpy.run_path("explore.py", run_name="__main__")
"""


def test_the_exploration_without_the_core_fits_the_table_that_is_asked_for(tmp_path: Path) -> None:
    for name in ("path_tracing.py", "explore.py"):
        shutil.copy(FOLDER / name, tmp_path / name)
    shutil.copy(ASSIGNMENTS / "04_reflectance" / "reflectance.py", tmp_path)
    (tmp_path / "alone.py").write_text(ALONE, encoding="utf-8")

    def explore(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "alone.py", "--size", "6", "--figure", "0", *words],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )

    done = explore("--samples", "1", "--roughness", "0.15", "--steps", "25")
    assert done.returncode == 0, done.stderr
    assert "noise unknown" in done.stdout
    assert "not compared" in done.stdout
    assert "from the core's" not in done.stdout
    found = float(done.stdout.split("roughness ")[1].split(" in ")[0])
    assert found == pytest.approx(0.15, abs=0.05)
    none = explore("--steps", "0")
    assert none.returncode == 1
    assert "--steps: expected a whole number of 1 or more, got '0'" in none.stderr
    assert "Traceback" not in none.stderr
