"""Task 01.6, hidden checks."""

import math

import numpy as np
from photograd_course.grading import Number, Subject, checks_for

from ..common import EXACT, on_points
from ..task_6 import Patient

check = checks_for(calls=("backtracking",), visibility="hidden")


def refused(t, n):
    """Arguments of `backtracking`: n step sizes are rejected."""
    x, reach = t.rng.uniform(1.0, 2.0, 3), float(t.rng.uniform(1.2, 1.8))
    return Patient(lambda y: float(0.5 * y @ y)), lambda y: y, x, -(2.0**n) * reach * x


@check(
    "01.6.undefined", points=2, hint="Write the loop so that NaN is rejected: `not value <= bound`."
)
def a_step_out_of_the_domain_is_refused(t):
    """Where the function is NaN the step is too long."""

    def f(x):
        return float(x[0] - math.log(x[0])) if x[0] > 0.0 else math.nan

    x = np.array([float(t.rng.uniform(2.0, 3.0))])
    d = np.array([-4.0])
    tau = float(t.call("backtracking", Patient(f), lambda y: 1.0 - 1.0 / y, x, d, returns=Number()))
    t.require(tau > 0.0 and float(x[0] + tau * d[0]) > 0.0, "this step leaves the domain of f")
    t.require(f(x + tau * d) < f(x), "this step does not lead downhill")


# Iterations of the best of 120 fixed step sizes from 1e-3 to 30, until a millionth of the excess
# is left; tests/course/assignments/test_01.py counts them again.
FIXED_STEPS = {"bowl": 98, "valley": 244, "quartic": 23, "logistic": 6, "two walls": 30}


def five_functions():
    """Name to (f, gradient, start, minimum)."""
    hessian = np.array([[0.2, 0.0, 0.0], [0.0, 3.25, 2.75], [0.0, 2.75, 3.25]])  # 0.2, 0.5, 6
    data = np.random.default_rng(0).normal(size=(30, 3))
    data *= np.sign(data @ np.array([1.0, -2.0, 0.5]) + 0.5 * data[::-1, 0])[:, None]
    weights, walls = np.array([1.0, 2.0, 4.0]), np.array([1.0, 3.0])
    return {
        "bowl": (
            lambda x: float(0.5 * x @ hessian @ x),
            lambda x: hessian @ x,
            np.array([6.0, 2.0, 1.0]),
        ),
        "valley": (
            lambda x: float((1 - x[0]) ** 2 + 4 * (x[1] - x[0] ** 2) ** 2),
            lambda x: np.array(
                [-2 * (1 - x[0]) - 16 * x[0] * (x[1] - x[0] ** 2), 8 * (x[1] - x[0] ** 2)]
            ),
            np.array([-1.2, 1.0]),
        ),
        "quartic": (
            lambda x: float(np.sum(weights * x**2 / 2 + x**4 / 4)),
            lambda x: weights * x + x**3,
            np.array([3.0, -2.0, 1.0]),
        ),
        "logistic": (
            lambda x: float(np.mean(np.logaddexp(0, -data @ x)) + 0.05 * x @ x),
            lambda x: 0.1 * x - data.T @ np.exp(-np.logaddexp(0, data @ x)) / 30,
            np.array([-3.0, 3.0, -3.0]),
        ),
        "two walls": (
            lambda x: float(np.sum(np.logaddexp(walls * x, -walls * x)) + 0.05 * x @ x),
            lambda x: walls * np.tanh(walls * x) + 0.1 * x,
            np.array([2.0, -1.5]),
        ),
    }


def goal_of(name, f, x0):
    """The value at which a millionth of the excess over the minimum is left."""
    least = {
        "bowl": 0.0,
        "valley": 0.0,
        "quartic": 0.0,
        "logistic": LOGISTIC_MINIMUM,
        "two walls": 2.0 * math.log(2.0),
    }[name]
    return least + 1e-6 * (f(x0) - least)


LOGISTIC_MINIMUM = 0.5052239008227084  # where the gradient is 1e-15


@check(
    "01.6.descends",
    points=4,
    seconds=15.0,
    hint="Begin with the given step size tau0, also above 1.",
    battery=[
        Subject(
            "backtracking",
            refused,
            lambda _: Number(),
            sizes=(1, 2, 40),
            large=400,
            tolerance=EXACT,
        )
    ],
)
def it_needs_no_tuning(t):
    """On five functions the loss never rises, in at most twice the steps of the best fixed tau."""
    for name, (*functions, x0) in five_functions().items():
        f, grad = on_points(len(x0), *functions)
        x, tau, goal, most = x0, 1.0, goal_of(name, f, x0), 2 * FIXED_STEPS[name]
        for _ in range(most):
            d = -grad(x)
            tau = float(t.call("backtracking", Patient(f), grad, x, d, 2.0 * tau, returns=Number()))
            t.require(f(x + tau * d) <= f(x), f"{name}: a step has raised the loss")
            x = x + tau * d
            if f(x) <= goal:
                break
        t.require(f(x) <= goal, f"{name}: not there after {most} steps")
