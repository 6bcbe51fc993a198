"""Assignment 04 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.drawing import draw as draw_question
from photograd_course.assignment.load import load_module

from course.assignments.support import (
    ASSIGNMENTS,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    source,
)

FOLDER = ASSIGNMENTS / "04_reflectance"
WO, WI = np.array([[0.6, 0.0, 0.8]]), np.array([[-0.48, 0.36, 0.8]])
ROUGH, COLOR = np.array([0.5]), np.array([[0.8, 0.4, 0.1]])
PRINTED = 6e-7  # the handout rounds to six decimals


class TestReflectance(AssignmentTests):
    folder = FOLDER


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def mutant(name: str):
    return load_module("reflectance", apply_mutant(FOLDER, name))


def directions(rng, n: int):
    d = rng.normal(size=(n, 3))
    d[:, 2] = np.abs(d[:, 2])
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def mirrors(module, rough: float):
    return lambda wo, wi: module.ggx_lobe(wo, wi, np.full(len(wo), rough))[:, None]


def white(module, m: float, rough: float):
    def f(wo, wi):
        n = len(wo)
        return module.gltf(wo, wi, np.ones((n, 3)), np.full(n, m), np.full(n, rough))

    return f


def test_check_values_of_the_warm_up(solution) -> None:
    c = WO[0, 2] * WI[0, 2] - WO[0, 0] * WI[0, 0] - WO[0, 1] * WI[0, 1]
    assert c == pytest.approx(0.928)
    assert solution.phong(WO, WI, 1.0, 20)[0, 0] == pytest.approx(0.785602, abs=PRINTED)
    with np.errstate(under="ignore"):
        seen = solution.furnace(
            lambda o, i: solution.phong(o, i, 1.0, 20), np.array([1.0, 0.8, 0.3])
        )
    np.testing.assert_allclose(seen[:, 0], [1, 0.8, 0.308], atol=5e-4)


def test_check_values_of_the_furnace(solution) -> None:
    seen = solution.furnace(lambda o, i: solution.lambert(o, i, COLOR[0]), np.array([0.8]))
    np.testing.assert_allclose(seen, COLOR, atol=1e-12)
    burley = solution.furnace(
        lambda o, i: solution.burley_diffuse(o, i, 1.0, 1.0), np.array([1.0, 0.1])
    )
    np.testing.assert_allclose(burley[:, 0], [1.035714, 1.380126], atol=PRINTED)
    polished = solution.furnace(mirrors(solution, 0.2), np.array([0.1]))[0, 0]
    assert polished == pytest.approx(0.22, abs=0.005)  # what the sum says,
    wi, solid_angles = solution.hemisphere(400, 1024)
    wo = np.tile([np.sqrt(0.99), 0, 0.1], (len(wi), 1))
    right = (solid_angles * wi[:, 2]) @ mirrors(solution, 0.2)(wo, wi)[:, 0]
    assert right == pytest.approx(0.93, abs=0.005)  # and what is


def test_check_values_of_facets_and_samples(solution) -> None:
    h = solution.half_vector(WO, WI)
    np.testing.assert_allclose(h[0], [0.072976, 0.218927, 0.973009], atol=PRINTED)
    alpha = ROUGH**2
    q = (h[:, 0] ** 2 + h[:, 1] ** 2) / alpha**2 + h[:, 2] ** 2
    length = solution.stretched(WO, alpha)
    V = 1 / (2 * (length * 0.8 + solution.stretched(WI, alpha) * 0.8))
    found = [q[0], 1 / (np.pi * alpha[0] ** 2 * q[0] ** 2), length[0], V[0]]
    np.testing.assert_allclose(found, [1.798817, 1.573970, 0.813941, 0.383934], atol=PRINTED)
    assert solution.ggx_lobe(WO, WI, ROUGH)[0] == pytest.approx(0.604301, abs=PRINTED)
    pdf = solution.ggx_pdf(WO, WI, ROUGH)[0]
    assert pdf == pytest.approx(0.487617, abs=PRINTED)
    assert 1.6 / (0.8 + length[0]) == pytest.approx(0.991362, abs=PRINTED)
    assert pdf * 4 * np.sum(WO * h) == pytest.approx(1.603659, abs=PRINTED)
    u2 = np.array([[0.5, 0.25], [0.1, 0.6]])
    drawn = solution.sample_ggx(np.tile(WO, (2, 1)), np.tile(ROUGH, 2), u2)
    expected = [[-0.527803, 0.391748, 0.753630], [-0.664699, -0.075953, 0.743240]]
    np.testing.assert_allclose(drawn, expected, atol=PRINTED)


def test_check_values_of_the_material(solution) -> None:
    for m, expected in (
        (0.0, [0.268694, 0.146484, 0.054827]),
        (0.25, [0.322386, 0.170310, 0.056252]),
        (1.0, [0.483462, 0.241785, 0.060527]),
    ):
        f = solution.gltf(WO, WI, COLOR, np.array([m]), ROUGH)[0]
        np.testing.assert_allclose(f, expected, atol=PRINTED)
    d_f = np.array([[1, -0.5, 2]])
    d_color, d_m, d_r = solution.gltf_backward(WO, WI, COLOR, np.array([0.25]), ROUGH, d_f)
    np.testing.assert_allclose(d_color[0], [0.380191, -0.190095, 0.760382], atol=PRINTED)
    assert d_m[0] == pytest.approx(0.178517, abs=PRINTED)
    assert d_r[0] == pytest.approx(-0.092681, abs=PRINTED)
    one = np.ones(1)
    slope = solution.gltf_backward(WO, WI, np.ones((1, 3)), one, ROUGH, np.full((1, 3), 1 / 3))[2]
    assert slope[0] == pytest.approx(-0.336536, abs=PRINTED)


def test_the_six_functions_are_the_core_s(solution) -> None:
    models = pytest.importorskip("photograd.bsdf").registry()
    rng = np.random.default_rng(3)
    wo, wi, n = directions(rng, 200), directions(rng, 200), 200
    wi[:20, 2] *= -1
    color, m, r = rng.uniform(0, 1, (n, 3)), rng.uniform(0, 1, n), rng.uniform(0.1, 1, n)
    given = {"base_color": color, "metalness": m, "roughness": r}
    # Measured 1e-14, where roughness is 0.1 and f some 200.
    f = models["gltf"].f(given, wo, wi)
    np.testing.assert_allclose(solution.gltf(wo, wi, color, m, r), f, rtol=1e-11, atol=1e-13)
    g = rng.uniform(-1, 1, (n, 3))
    right = models["gltf"].f_backward(given, wo, wi, g)
    found = solution.gltf_backward(wo, wi, color, m, r, g)
    for name, mine in zip(given, found, strict=True):
        np.testing.assert_allclose(mine, right[name], rtol=1e-10, atol=1e-11)
    metal = {"f0": color, "roughness": r}
    pdf = models["ggx_metal"].pdf(metal, wo, wi)
    np.testing.assert_allclose(solution.ggx_pdf(wo, wi, r), pdf, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(
        solution.burley_diffuse(wo, wi, 0.7, 0.4),
        models["burley_diffuse"].f({"albedo": [0.7] * 3, "roughness": 0.4}, wo, wi),
        atol=1e-14,
    )
    with np.errstate(under="ignore"):
        np.testing.assert_allclose(
            solution.cook_torrance(wo, wi, 0.5, 0.3),
            models["cook_torrance"].f({"f0": [0.5] * 3, "slope": 0.3}, wo, wi),
            atol=1e-12,
        )


def test_the_table_of_checks_is_that_of_a_finer_sum(solution) -> None:
    checks = load_checks_of(FOLDER)
    wi, solid_angles = solution.hemisphere(160, 400)
    for rough, z, albedo in checks.MIRRORS:
        wo = np.tile([np.sqrt(1 - z * z), 0, z], (len(wi), 1))
        found = (solid_angles * wi[:, 2]) @ mirrors(solution, rough)(wo, wi)[:, 0]
        assert found == pytest.approx(albedo, abs=PRINTED)
    assert checks.MIRRORS[5][2] == 1 - np.log(2)


def test_right_samples_are_rejected_as_rarely_as_they_should(solution) -> None:
    """Of 400 judgements p is below 0.05 in 20, give or take; wrong samplers are always caught."""
    checks = load_checks_of(FOLDER)
    rng, n = np.random.default_rng(11), 4000
    wo, r = np.tile(WO, (n, 1)), np.full(n, 0.6)

    def pdf(wi):
        return solution.ggx_pdf(np.tile(WO, (len(wi), 1)), wi, np.full(len(wi), 0.6))

    shares = checks.cells(pdf)
    p = [
        checks.chi_square(solution.sample_ggx(wo, r, rng.random((n, 2))), shares)
        for _ in range(400)
    ]
    assert 6 <= sum(value < 0.05 for value in p) <= 40
    assert min(p) > checks.LEVEL / 10
    wrong = mutant("sample_all_facets").sample_ggx(wo, r, rng.random((n, 2)))
    assert checks.chi_square(wrong, shares) < checks.LEVEL / 1000


def test_a_wrong_sampler_is_told_where_its_samples_lie() -> None:
    """About a tenth of the right ones is below the surface (Figure 6), of the bare cap's half."""
    outcomes = judge(FOLDER, apply_mutant(FOLDER, "sample_cap_alone"), tasks=("04.4",))
    told = next(each for each in outcomes if each.id == "04.4.chi")
    mine, right = (
        float(part.partition(" ")[0])
        for part in (told.text.partition("samples: ")[2], told.text.partition("density: ")[2])
    )
    assert mine == pytest.approx(0.48, abs=0.03)
    assert right == pytest.approx(0.1, abs=0.01)
    assert told.arrays is not None
    found, expected = told.arrays
    assert found.shape == expected.shape == (8, 8)
    assert 1 - found.sum() == pytest.approx(mine, abs=6e-4)  # the text rounds to three digits
    assert 1 - expected.sum() == pytest.approx(right, abs=5e-3)  # cells have a rule of their own


def test_diagnoses_fit_one_answer_alone(solution) -> None:
    view = np.array([0.6])
    seen = {
        name: [mod.furnace(white(mod, m, 0.5), view)[0, 0] for m in (0.0, 0.5, 1.0)]
        for name, mod in ((n, mutant(n)) for n in ("gltf_premixed", "gltf_metal_keeps_ground"))
    }
    np.testing.assert_allclose(seen["gltf_premixed"], [1.002, 0.698, 0.872], atol=5e-4)
    assert seen["gltf_metal_keeps_ground"][2] > 1
    ends = [solution.furnace(white(solution, m, 0.5), view)[0, 0] for m in (0.0, 1.0)]
    assert 0.75 * ends[0] + 0.25 * ends[1] > 0.9  # a squared metalness

    wi, solid_angles = solution.hemisphere()
    up = np.tile([0.0, 0, 1], (len(wi), 1))
    ones = np.ones(len(wi))
    masses = {
        name: solid_angles @ mutant(name).ggx_pdf(up, wi, ones)
        for name in ("pdf_of_facets", "pdf_twice", "pdf_all_facets")
    }
    assert masses["pdf_of_facets"] == pytest.approx(1.72, abs=5e-3)
    assert masses["pdf_twice"] == pytest.approx(1)
    assert masses["pdf_all_facets"] == pytest.approx(0.5)
    right = solution.ggx_pdf(up, wi, ones)
    shares = solid_angles * right  # of samples: weights by the wrong density, on average
    wrong = mutant("pdf_of_facets").ggx_pdf(up, wi, ones)
    lobe = solution.ggx_lobe(up, wi, ones)
    assert shares @ (lobe * wi[:, 2] / wrong) == pytest.approx(0.086, abs=5e-4)


def test_rough_lobes_are_largest_beyond_the_mirror_direction(solution) -> None:
    angle = np.radians(np.linspace(0.0, 89.9, 900))
    wo = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
    wi = np.tile([-np.sqrt(0.5), 0.0, np.sqrt(0.5)], (900, 1))
    largest = [
        np.degrees(angle[solution.ggx_lobe(wo, wi, np.full(900, rough)).argmax()])
        for rough in (0.35, 0.5, 0.7)
    ]
    np.testing.assert_allclose(largest, [46, 49, 90], atol=0.5)


def test_predictions_come_true(solution) -> None:
    seen = solution.furnace(mirrors(solution, 1.0), np.array([1.0]))[0, 0]
    assert seen == pytest.approx(1 - np.log(2))
    # The others are facts of Figures 3 and 7.


def test_generated_questions_have_the_answers_that_their_reasons_give(solution) -> None:
    bundle = read_folder(FOLDER)
    keys, text = bundle.keys, source(FOLDER)
    assert keys is not None
    rough = keys.balanced_roughness(solution, 0.2)
    seen = solution.furnace(
        lambda wo, wi: solution.burley_diffuse(wo, wi, 1.0, rough), np.array([0.2])
    )
    assert seen[0, 0] == pytest.approx(1, abs=1e-12)
    assert 3.2 < keys.printed_albedo(solution, 0.6, 0.9) < 4
    ends = [
        solution.furnace(mirrors(solution, 0.7 + e), np.array([0.7]))[0, 0] for e in (1e-4, -1e-4)
    ]
    assert keys.albedo_slope(solution, 0.7, 0.7) == pytest.approx(
        (ends[0] - ends[1]) / 2e-4, rel=1e-6
    )
    for question in bundle.questions:
        if question.kind == "generated":
            drawn = draw_question(question, "somebody", text)
            assert "{" not in drawn.text
            answer = getattr(keys, str(question.answer))(bundle.reference, **drawn.values)
            assert abs(answer) > 0.01  # so that a relative tolerance means something


@pytest.mark.parametrize(
    "options",
    [
        (),
        ("--roughness", "0.6", "--metalness", "0.5"),
        ("--roughness", "0.4", "--metalness", "0.5", "--start-metalness", "0"),
    ],
)
def test_the_exploration_runs_and_says_what_it_did(
    tmp_path: Path, options: tuple[str, ...]
) -> None:
    for name in ("explore.py", "reflectance.py"):
        (tmp_path / name).write_bytes((FOLDER / name).read_bytes())
    order = [sys.executable, "explore.py", "--pixels", "16", "--steps", "60", "--figure", "0"]
    order += options
    ran = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    rough = float(options[1]) if options else 0.35
    found = float(ran.stdout.partition("fit: roughness ")[2].partition(",")[0])
    assert found == pytest.approx(rough, abs=0.05)
    assert "ball: 1" in ran.stdout
    metal = ran.stdout.partition("fit: ")[2].partition("metalness ")[2].split()[0]
    assert float(metal) == pytest.approx(0.5 if options else 0.0, abs=0.05)
    assert "core" in ran.stdout
    assert (tmp_path / "reflectance.png").stat().st_size > 5_000
