"""Assignment 11 owes what every assignment owes; and its handout's numbers are right."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.drawing import draw as draw_question
from photograd_course.assignment.load import load_module

from course.assignments.support import ASSIGNMENTS, AssignmentTests, apply_mutant, source

FOLDER = ASSIGNMENTS / "11_spherical_harmonics"
D = np.array([[2.0, -1.0, 2.0]]) / 3
PRINTED = 6e-7  # the handout rounds to six decimals


class TestSphericalHarmonics(AssignmentTests):
    folder = FOLDER
    long_figures = frozenset({"fig1_result"})


@pytest.fixture(scope="module")
def solution():
    return read_folder(FOLDER).reference


def mutant(name: str):
    return load_module("plenoxels", apply_mutant(FOLDER, name))


def test_check_values_of_the_warm_up() -> None:
    v = np.array([3.0, 4.0])
    d, s = v / 5, np.array([2.0, 1.0]) / np.sqrt(np.pi)
    assert d @ s == pytest.approx(1.128379, abs=PRINTED)
    np.testing.assert_allclose((s - d * (d @ s)) / 5, [0.090270, -0.067703], atol=PRINTED)


def test_check_values_of_harmonics_and_projection(solution) -> None:
    Q = solution._pieces(D, 4)[2][:, :, 0]
    np.testing.assert_allclose(
        [Q[2, 0], Q[3, 1], Q[4, 2]], [1 / 6, 11 / 6, 15.833333], atol=PRINTED
    )
    two = [0.282095, 0.162868, 0.325735, -0.325735]
    two += [-0.242789, 0.242789, 0.105131, -0.485577, 0.182091]
    np.testing.assert_allclose(solution.sh_basis(D, 2)[0], two, atol=PRINTED)
    assert solution.sh_basis(D, 4)[0, -1] == pytest.approx(-0.054085, abs=PRINTED)
    d, weights = solution.quadrature(4)
    assert len(d) == 15
    c = solution.sh_project(d, weights, d[:, 2:] ** 2 + d[:, :1], 2)[:, 0]
    expected = [1.181636, 0, 0, -2.046653, 0, 0, 1.056887, 0, 0]
    np.testing.assert_allclose(c, expected, atol=PRINTED)


def test_check_values_of_the_adjoint(solution) -> None:
    C, v, g = np.arange(1.0, 10)[None, :, None], np.array([[4.0, -2, 4]]), np.array([[1.5]])
    assert solution.sh_color(C[:, :4], v)[0, 0] == pytest.approx(0.282095, abs=PRINTED)
    d_C, d_v = solution.sh_color_adjoint(C[:, :4], v, g)
    np.testing.assert_allclose(
        d_C[0, :, 0], [0.423142, 0.244301, 0.488603, -0.488603], atol=PRINTED
    )
    np.testing.assert_allclose(d_v[0], [-0.488603, -0.244301, 0.366452], atol=PRINTED)
    assert solution.sh_color(C, v)[0, 0] == pytest.approx(-0.984997, abs=PRINTED)
    d_v = solution.sh_color_adjoint(C, v, g)[1]
    np.testing.assert_allclose(d_v[0], [-1.075289, 0.549794, 1.350186], atol=PRINTED)


def test_check_values_of_rotation(solution) -> None:
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    turned = solution.sh_rotate(np.arange(1.0, 10)[:, None], R)[:, 0]
    expected = [1, 3.732051, 3, 2.464102, 10.294229, 9.196152, 7, 3.928203, 0.169873]
    np.testing.assert_allclose(turned, expected, atol=PRINTED)
    around = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # x to y, y to z, z to x
    np.testing.assert_allclose(around @ [1.0, 0, 0], [0, 1, 0])
    turned = solution.sh_rotate(np.arange(1.0, 5)[:, None], around)[:, 0]
    np.testing.assert_allclose(turned, [1, 4, -2, -3], atol=PRINTED)


def test_check_values_of_irradiance(solution) -> None:
    t, share = np.polynomial.legendre.leggauss(8)
    factors = [
        np.pi
        * np.sum(share * np.polynomial.legendre.legval((t + 1) / 2, np.eye(5)[n]) * (t + 1) / 2)
        for n in (1, 2, 4)
    ]
    np.testing.assert_allclose(factors, [2.094395, 0.785398, -0.130900], atol=PRINTED)
    probes = np.zeros((2, 1, 1, 9, 1))
    probes[0, 0, 0, [0, 3, 6], 0] = 1.181636, -2.046653, 1.056887
    probes[1, 0, 0, 0, 0] = np.sqrt(4 * np.pi)
    p, up = np.array([[0.25, 0, 0], [-1, 0, 0], [1, 0, 0]]), np.tile([0.0, 0, 1], (3, 1))
    lit = solution.probe_irradiance(probes, p, up)[:, 0]
    np.testing.assert_allclose(lit, [1.963495, 1.570796, 3.141593], atol=2e-6)


def test_check_values_of_the_fit(solution) -> None:
    density, c = np.arange(1.0, 9).reshape(2, 2, 2) / 4, np.zeros((2, 2, 2, 4, 1))
    c[..., 0, 0] = 1
    rays = np.array([[[0, 0, 3.0], [0.3, 0.2, 3]], [[0, 0, -1.0], [0, 0, -1]]])
    given = density, c, rays, np.array([[0.5], [0.2]])
    found, coefficients, losses = solution.fit_plenoxels(*given, 1, 2)
    np.testing.assert_allclose(losses, [0.033024, 0.025310], atol=PRINTED)
    np.testing.assert_allclose(found[0, 0], [0.447300, 0.697300], atol=PRINTED)
    expected = [1.195632, 0, 0.195632, 0]
    np.testing.assert_allclose(coefficients[0, 0, 0, :, 0], expected, atol=PRINTED)
    fine = solution.fit_plenoxels(*given, 2, 0)[0]
    np.testing.assert_allclose(fine[:, 0, 0], [0.25, 0.5, 1, 1.25], rtol=1e-14)
    np.testing.assert_allclose(fine[0, 0], [0.25, 0.3125, 0.4375, 0.5], rtol=1e-14)


def test_the_given_renderer_and_its_adjoint_are_right(solution) -> None:
    """A constant medium has a closed form; derivatives agree with differences."""
    rays = np.array([[[0.1, 0.2, 3.0], [3, 0.0, 0]], [[0, 0, -1.0], [0, 1, 0]]])
    shape = (3, 4, 2)
    c = np.zeros((*shape, 4, 2))
    c[..., 0, :] = np.sqrt(4 * np.pi)
    seen = solution.render(np.full(shape, 0.7), c, solution.march(shape, rays))
    np.testing.assert_allclose(seen, [[1 - np.exp(-1.4)] * 2, [0, 0]], rtol=1e-12)
    rng = np.random.default_rng(0)
    density, c = rng.uniform(0.2, 1, shape), rng.uniform(-1, 1, (*shape, 9, 2))
    origin = rng.normal(size=(6, 3)) * 2
    towards = rng.uniform(-0.5, 0.5, (6, 3)) - origin
    rays = np.stack([origin, towards / np.linalg.norm(towards, axis=1, keepdims=True)])
    samples, target = solution.march(shape, rays), rng.uniform(0, 1, (6, 2))
    _, *slopes = solution.loss_and_grad(density, c, samples, target)
    for array, slope in zip((density, c), slopes, strict=True):
        way, size = rng.uniform(-1, 1, array.shape), 1e-5
        ends = []
        for sign in (1, -1):
            moved = [a + sign * size * way if a is array else a for a in (density, c)]
            ends.append(solution.loss_and_grad(*moved, samples, target)[0])
        assert np.vdot(slope, way) == pytest.approx((ends[0] - ends[1]) / (2 * size), rel=1e-6)


def test_harmonics_are_those_of_the_core(solution) -> None:
    sh = pytest.importorskip("photograd.sh")
    rng = np.random.default_rng(1)
    v = rng.normal(size=(9, 3))
    d = v / np.linalg.norm(v, axis=1, keepdims=True)
    np.testing.assert_allclose(solution.sh_basis(d, 4), sh.basis(d, 4), atol=1e-14)
    C, g = rng.normal(size=(9, 25, 3)), rng.normal(size=(9, 3))
    d_C, d_d = sh.evaluate_backward(C, d, g)
    d_v = (d_d - np.sum(d_d * d, axis=1, keepdims=True) * d) / np.linalg.norm(v, axis=1)[:, None]
    mine = solution.sh_color_adjoint(C, v, g)
    np.testing.assert_allclose(mine[0], d_C, atol=1e-13)
    np.testing.assert_allclose(mine[1], d_v, atol=1e-12)
    light, n = rng.normal(size=(25, 2)), np.zeros((9, 3))
    lit = solution.probe_irradiance(light[None, None, None], n, d)
    np.testing.assert_allclose(lit, sh.irradiance(light, d), atol=1e-13)


def test_diagnoses_fit_one_answer_alone(solution) -> None:
    lamp = np.array([0.60, 0.30, 0.74])
    lamp /= np.linalg.norm(lamp)
    d, weights = solution.quadrature(8)
    c = solution.sh_project(d, weights, np.maximum(d @ lamp, 0)[:, None] ** 3, 4)
    tops = {
        name: d[np.argmax(mutant(name).sh_basis(d, 4) @ c)]
        for name in ("no_phase", "other_end", "orders_swapped")
    }
    near = {name: float(top @ (lamp * [-1, -1, 1])) for name, top in tops.items()}
    assert near["no_phase"] > 0.9
    assert max(near["other_end"], near["orders_swapped"]) < 0.7
    C, v, g = (
        np.ones((2, 9, 1)) * np.arange(9)[:, None],
        np.array([[1, 2, 2], [0, 0, 3.0]]),
        np.ones((2, 1)),
    )
    right = solution.sh_color_adjoint(C, 4 / 3 * v, g)
    wrong = mutant("length_forgotten").sh_color_adjoint(C, 4 / 3 * v, g)
    np.testing.assert_allclose(wrong[0], right[0], rtol=1e-14)
    np.testing.assert_allclose(wrong[1], 4 * right[1], atol=1e-12)


def test_predictions_come_true(solution) -> None:
    d = solution.quadrature(6)[0]
    parity = solution.sh_basis(-d, 2) * np.repeat([1, -1, 1], [1, 3, 5])
    np.testing.assert_allclose(parity, solution.sh_basis(d, 2), atol=1e-14)
    # The others are facts of Figures 5 and 7.


def test_generated_questions_have_the_answers_that_their_reasons_give() -> None:
    bundle = read_folder(FOLDER)
    keys, text = bundle.keys, source(FOLDER)
    assert keys is not None
    s = np.sqrt(1 / (4 * np.pi)) * np.sqrt([1, 3, 5])
    expected = np.pi * s[0] * 4 + 2 * np.pi / 3 * s[1] * 1.5 + np.pi / 4 * s[2] * -0.5
    assert keys.irradiance_upwards(bundle.reference, 4, 1.5, -0.5) == pytest.approx(expected)
    assert keys.mebibytes(bundle.reference, 128, 2) == pytest.approx(128**3 * 28 * 4 / 2**20)
    angle = np.radians(40)
    expected = -4 * np.cos(angle) - 3 * np.sin(angle)
    assert keys.turned_around_z(bundle.reference, 3, -4, 40) == pytest.approx(expected)
    for question in bundle.questions:
        if question.kind == "generated":
            drawn = draw_question(question, "somebody", text)
            assert "{" not in drawn.text
            answer = getattr(keys, str(question.answer))(bundle.reference, **drawn.values)
            assert abs(answer) > 0.01  # so that a relative tolerance means something


@pytest.mark.parametrize("options", [(), ("--degree", "0", "--levels", "1", "--coarse", "6")])
def test_the_exploration_runs_and_says_what_it_did(
    tmp_path: Path, options: tuple[str, ...]
) -> None:
    for name in ("explore.py", "plenoxels.py"):
        (tmp_path / name).write_bytes((FOLDER / name).read_bytes())
    shutil.copytree(FOLDER / "data", tmp_path / "data")
    order = [sys.executable, "explore.py", "--views", "5", "--pixels", "4", "--steps", "3"]
    order += ["--figure", "0"]
    order.extend(options or ("--coarse", "3", "--levels", "2"))
    ran = subprocess.run(order, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert "5 photographs of 4 x 4" in ran.stdout
    assert "coarse to fine: " in ran.stdout
    assert ran.stdout.count("dB on held-out views") >= 2
    assert "core" in ran.stdout
    assert (tmp_path / "plenoxels.png").stat().st_size > 5_000
