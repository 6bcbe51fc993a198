"""Assignment 01: gradient descent.

Six functions that take other functions as arguments. Everything is float64. A point in N
dimensions is an array of shape (N,); the iterates are the rows of an array (n + 1, N), the initial
point included. Never change a given array: make a new one.

`photograd course check 01` tells how far you are.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Point = Annotated[np.ndarray, "N"]
Points = Annotated[np.ndarray, "steps N"]  # of a walk, the start first
Values = Annotated[np.ndarray, "steps"]
Loss = Callable[[Point], float]
Gradient = Callable[[Point], Point]


def numeric_derivative(f: Loss, x: Point, eps: float) -> Point:
    """The gradient of f at x by central finite differences, Eq. (3).

    Args:
        f: the function; takes an array (N,), returns a float.
        x: the point, (N,) float64. It must not change.
        eps: the step in each coordinate, in the unit of x, > 0.

    Returns:
        The gradient, (N,) float64. f is called 2 N times.
    """
    # >>> solution 01.1
    slope = np.zeros(len(x))
    for i in range(len(x)):
        step = np.zeros(len(x))
        step[i] = eps
        slope[i] = (f(x + step) - f(x - step)) / (2.0 * eps)
    return slope
    # <<< solution


def gd_1d(
    f: Callable[[float], float], df: Callable[[float], float], x0: float, tau: float, n: int
) -> tuple[Values, Values, bool]:
    """n steps of gradient descent on a function of one variable, Eq. (5), and a flag, Eq. (8).

    Args:
        f: the function, float -> float; may return NaN where it is not defined.
        df: its derivative, float -> float; call it once per step.
        x0: the initial point.
        tau: learning rate, > 0.
        n: number of steps, >= 0.

    Returns:
        The points x_0 ... x_n, (n + 1,) float64; the values f(x_0) ... f(x_n), (n + 1,) float64;
        and True if it went wrong: the last value is not at most the first.
    """
    # >>> solution 01.2
    x = np.full(n + 1, x0)
    for k in range(n):
        x[k + 1] = x[k] - tau * df(float(x[k]))
    loss = np.array([f(float(each)) for each in x])
    return x, loss, not loss[-1] <= loss[0]
    # <<< solution


def gd_nd(f: Loss, grad: Gradient, x0: Point, tau: float, n: int) -> tuple[Points, Values, bool]:
    """n steps of gradient descent on a function of N variables, Eq. (9).

    Args:
        f: the function, (N,) -> float; may return NaN where it is not defined.
        grad: its gradient, (N,) -> (N,); call it once per step.
        x0: the initial point, (N,) float64. It must not change.
        tau: learning rate, > 0.
        n: number of steps, >= 0.

    Returns:
        The points x_0 ... x_n, (n + 1, N) float64; the values f(x_0) ... f(x_n), (n + 1,) float64;
        and True if it went wrong, as in `gd_1d`.
    """
    # >>> solution 01.3
    x = np.tile(x0, (n + 1, 1))
    for k in range(n):
        x[k + 1] = x[k] - tau * grad(x[k])
    loss = np.array([f(each) for each in x])
    return x, loss, not loss[n] <= loss[0]
    # <<< solution


def momentum(grad: Gradient, x0: Point, tau: float, beta: float, n: int) -> Points:
    """n steps of gradient descent with momentum, Eqs. (12) and (13), from rest.

    Args:
        grad: the gradient, (N,) -> (N,); call it once per step.
        x0: the initial point, (N,) float64. It must not change.
        tau: learning rate, > 0.
        beta: the decay of the velocity, 0 <= beta < 1.
        n: number of steps, >= 0.

    Returns:
        The points x_0 ... x_n, (n + 1, N) float64.
    """
    # >>> solution 01.4
    x, v = np.tile(x0, (n + 1, 1)), np.zeros(len(x0))
    for k in range(n):
        v = beta * v + grad(x[k])
        x[k + 1] = x[k] - tau * v
    return x
    # <<< solution


def adam(
    grad: Gradient,
    x0: Point,
    tau: float,
    n: int,
    beta1: float = 0.9,
    beta2: float = 0.999,
    eps: float = 1e-8,
) -> Points:
    """n steps of Adam, Eqs. (16) to (20), both moments starting at zero.

    Args:
        grad: the gradient, (N,) -> (N,); call it once per step.
        x0: the initial point, (N,) float64. It must not change.
        tau: learning rate, > 0.
        n: number of steps, >= 0.
        beta1, beta2: decay of the first and of the second moment, 0 <= beta < 1.
        eps: keeps the quotient finite; it is outside the square root.

    Returns:
        The points x_0 ... x_n, (n + 1, N) float64.
    """
    # >>> solution 01.5
    x = np.tile(x0, (n + 1, 1))
    m, v = np.zeros(len(x0)), np.zeros(len(x0))
    for k in range(1, n + 1):
        g = grad(x[k - 1])
        m = beta1 * m + (1.0 - beta1) * g
        v = beta2 * v + (1.0 - beta2) * g * g
        m_hat = m / (1.0 - beta1**k)
        v_hat = v / (1.0 - beta2**k)
        x[k] = x[k - 1] - tau * m_hat / (np.sqrt(v_hat) + eps)
    return x
    # <<< solution


def backtracking(
    f: Loss,
    grad: Gradient,
    x: Point,
    d: Point,
    tau0: float = 1.0,
    c: float = 1e-4,
    shrink: float = 0.5,
) -> float:
    """Backtracking: the first of tau0, tau0 shrink, ... that satisfies Armijo's rule, Eq. (22).

    Args:
        f: the function, (N,) -> float; where it returns NaN, a step is not acceptable.
        grad: its gradient, (N,) -> (N,).
        x: the current point, (N,) float64. It must not change.
        d: the search direction, (N,); need not be minus the gradient.
        tau0: the first step size to try, > 0.
        c: the required fraction of the predicted decrease, 0 < c < 1.
        shrink: the factor for a rejected step size, 0 < shrink < 1.

    Returns:
        The step size, a float.

    Raises:
        ValueError: d is not downhill: its scalar product with the gradient is not < 0.
    """
    # >>> solution 01.6
    slope = float(grad(x) @ d)
    if not slope < 0.0:
        raise ValueError(f"d is not downhill: directional derivative {slope}")
    tau, start = tau0, f(x)
    while not f(x + tau * d) <= start + c * tau * slope:
        tau *= shrink
    return tau
    # <<< solution
