"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, Truth, asks

# Right answers: solution and alternatives with six secrets; wrong ones: all mutants with two.
EXACT = Tolerance(1e-12, "right answers differ by at most 3e-15, wrong ones by 4e-9 or more")


def walk(n, *axes):
    """What a run of n steps returns: points, values, flag."""
    names = ("the points", "the values", "the flag")
    return Items(Array((n + 1, *axes)), Array((n + 1,)), Truth(), names=names)


def derivative(t, f, x, eps):
    """`numeric_derivative` of f at x (N,): an array (N,)."""
    return t.call("numeric_derivative", f, x, eps, returns=Array((len(x),)))


def on_points(count, f, grad):
    """f and its gradient, which take nothing but arrays of shape (count,)."""
    spec = Array((count,), finite=False)
    return asks(f, spec, name="f"), asks(grad, spec, name="grad")


def parabola(curvature, center):
    """f and its derivative, of one variable."""
    return lambda x: 0.5 * curvature * (x - center) ** 2, lambda x: curvature * (x - center)


def rotated_bowl(rng, curvatures):
    """f, its gradient and the eigenvectors (columns) for given eigenvalues of the Hessian."""
    vectors, _ = np.linalg.qr(rng.normal(size=(len(curvatures), len(curvatures))))
    hessian = vectors @ np.diag(curvatures) @ vectors.T
    f, grad = lambda x: float(0.5 * x @ hessian @ x), lambda x: hessian @ x
    return *on_points(len(hessian), f, grad), vectors
