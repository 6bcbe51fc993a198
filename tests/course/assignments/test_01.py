"""Assignment 01 owes what every assignment owes; its stated numbers are counted again."""

from __future__ import annotations

import math
from types import ModuleType

import numpy as np
import pytest
from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.load import load_module
from photograd_course.grading import Status

from course.assignments.support import (
    ASSIGNMENTS,
    AssignmentTests,
    apply_mutant,
    judge,
    load_checks_of,
    source,
)

FOLDER = ASSIGNMENTS / "01_gradient_descent"


class TestGradientDescent(AssignmentTests):
    folder = FOLDER


def checks() -> ModuleType:
    return load_checks_of(FOLDER)


def solution() -> ModuleType:
    return load_module("descent", source(FOLDER))


def steps_of(tau: float, f, grad, x0, goal: float, most: int) -> int:
    x = x0
    for count in range(1, most):
        x = x - tau * grad(x)
        value = f(x)
        if not value < 1e12:
            break
        if value <= goal:
            return count
    return most


def test_check_values_of_a_run_that_leaves_the_domain() -> None:
    def f(x: float) -> float:
        return x - math.log(x) if x > 0 else math.nan

    x, values, wrong = solution().gd_1d(f, lambda x: 1 - 1 / x, 1.2, 12.0, 1)
    np.testing.assert_allclose(x, [1.2, -0.8])
    np.testing.assert_allclose(values, [1.017678, math.nan], atol=6e-7)
    assert wrong


@pytest.mark.parametrize("name", ["bowl", "valley", "quartic", "logistic", "two walls"])
def test_the_best_fixed_step_needs_as_many_steps_as_stated(name: str) -> None:
    module = checks()
    f, grad, x0 = module.five_functions()[name]
    goal, best = module.goal_of(name, f, x0), 400
    with np.errstate(all="ignore"):
        for tau in np.geomspace(1e-3, 30.0, 120):
            best = min(best, steps_of(tau, f, grad, x0, goal, best))
    assert best == module.FIXED_STEPS[name]


def test_the_stated_minimum_is_one() -> None:
    module, descent = checks(), solution()
    f, grad, x = module.five_functions()["logistic"]
    for _ in range(40):
        if np.linalg.norm(grad(x)) < 1e-14:
            break
        hessian = np.array([(grad(x + step) - grad(x - step)) / 2e-5 for step in 1e-5 * np.eye(3)])
        d = -np.linalg.solve(hessian, grad(x))
        x = x + descent.backtracking(f, grad, x, d) * d
    assert np.linalg.norm(grad(x)) < 1e-13
    assert math.isclose(f(x), module.LOGISTIC_MINIMUM, rel_tol=1e-14)


def test_the_gradients_of_the_five_functions_are_theirs() -> None:
    descent = solution()
    for f, grad, x0 in checks().five_functions().values():
        difference = descent.numeric_derivative(f, x0, 1e-5)
        np.testing.assert_allclose(difference, grad(x0), rtol=1e-7, atol=1e-8)


def test_the_diagnosis_shows_what_the_broken_program_prints() -> None:
    broken = load_module("descent", apply_mutant(FOLDER, "no_second_correction"))
    x = broken.adam(lambda y: y - 3.0, np.zeros(1), 0.01, 8)[:, 0]
    text = {q.id: q for q in read_folder(FOLDER).questions}
    points = "  ".join(f"{each:.4f}" for each in x)
    losses = "  ".join(f"{0.5 * (each - 3.0) ** 2:.4f}" for each in x)
    assert f"x_k  {points}\n" in text["01.d1"].text
    assert f"f    {losses}\n" in text["01.d1"].text
    bundle = read_folder(FOLDER)
    assert bundle.keys is not None
    for tau, beta2 in ((0.01, 0.999), (0.1, 0.98)):
        step = broken.adam(lambda y: y - 3.0, np.zeros(1), tau, 1, beta2=beta2)[1, 0]
        assert math.isclose(step, bundle.keys.first_broken_step(None, tau, beta2), rel_tol=1e-3)


def test_generated_questions_have_answers_for_all_draws() -> None:
    bundle = read_folder(FOLDER)
    for question in (q for q in bundle.questions if q.kind == "generated"):
        grid = np.meshgrid(*question.draw.values())
        drawn = [dict(zip(question.draw, each, strict=True)) for each in zip(*map(np.ravel, grid))]  # noqa: B905
        answers = [
            getattr(bundle.keys, question.answer)(bundle.reference, **each) for each in drawn
        ]
        assert np.isfinite(answers).all()
        assert np.abs(answers).min() > 1e-3
        # The curvature does not matter in 01.g1, so 36 walks are different there.
        assert len({f"{each:.4g}" for each in answers}) >= 16


def test_answers_in_closed_form() -> None:
    bundle = read_folder(FOLDER)
    keys, reference = bundle.keys, bundle.reference
    got = keys.last_point(reference, 2.0, 1.8, -3.0, 5)
    assert math.isclose(got, 1.0 - 4.0 * (-0.8) ** 5, rel_tol=1e-12)
    assert math.isclose(
        keys.largest_stable_step(reference, 3.0, 2.0, 6.0), 2.0 / 7.0, rel_tol=1e-12
    )
    assert math.isclose(keys.distance_down_the_plane(reference, 0.5, 0.1, 1.0), 3.8, rel_tol=1e-5)


def test_predictions_are_as_the_solution_says() -> None:
    descent = solution()
    x, _, wrong = descent.gd_1d(lambda x: x * x, lambda x: 2.0 * x, 1.0, 0.75, 6)
    assert not wrong
    assert (x[1:] * x[:-1] < 0.0).all()
    # The prediction, and the check that section 3 of the handout offers.
    for kappa, left, steps in ((400.0, 1e-3, 1382), (100.0, 1e-6, 691)):
        h = np.array([1.0, kappa])
        x, _, _ = descent.gd_nd(
            lambda y, h=h: float(y @ (h * y)),
            lambda y, h=h: h * y,
            np.ones(2),
            2.0 / (1.0 + kappa),
            1500,
        )
        distance = np.linalg.norm(x, axis=1)
        assert abs(int(np.argmax(distance < left * distance[0])) - steps) <= 1


@pytest.mark.parametrize(
    ("task", "before", "after"),
    [
        ("01.5", "grad(x[k - 1])", "np.ravel(grad(x[k - 1] if k == 1 else x[k - 1 : k]))"),
        ("01.6", "float(grad(x) @ d)", "float(grad(np.tile(x, (1000, 1)).T)[:, 0] @ d)"),
    ],
    ids=["ragged", "large"],
)
def test_points_of_another_shape_are_a_failed_check(task: str, before: str, after: str) -> None:
    text = source(FOLDER)
    assert text.count(before) == 1
    outcomes = judge(FOLDER, text.replace(before, after), tasks=(task,))
    failed = [each for each in outcomes if "the argument of grad: expected an array" in each.text]
    assert len(failed) >= 2
    assert {each.status for each in failed} == {Status.FAILED}
    assert not any(each.status is Status.ERROR_OURS for each in outcomes)
