"""Vectorized: whole arrays, the velocity as a difference of points, both moments at once."""

import numpy as np


def numeric_derivative(f, x, eps):
    moves = eps * np.eye(x.size)
    ahead = np.array([f(each) for each in x + moves])
    behind = np.array([f(each) for each in x - moves])
    return (ahead - behind) / eps / 2


def gd_1d(f, df, x0, tau, n):
    points, values, wrong = gd_nd(
        lambda y: f(float(y[0])), lambda y: np.array([df(float(y[0]))]), np.array([x0]), tau, n
    )
    return points[:, 0].copy(), values, wrong


def gd_nd(f, grad, x0, tau, n):
    points = np.zeros((n + 1, x0.size))
    points[0] = here = x0
    for row in points[1:]:
        here = here - tau * grad(here)
        row[:] = here
    values = np.fromiter((f(each) for each in points), dtype=np.float64, count=n + 1)
    return points, values, bool(~(values[-1] <= values[0]))


def momentum(grad, x0, tau, beta, n):
    points = [x0, x0]  # the one before the start is the start: at rest
    for _ in range(n):
        points.append(points[-1] + beta * (points[-1] - points[-2]) - tau * grad(points[-1]))
    return np.stack(points[1:])


def adam(grad, x0, tau, n, beta1=0.9, beta2=0.999, eps=1e-8):
    decay = np.array([[beta1], [beta2]])
    moments = np.zeros((2, x0.size))
    points = [x0.copy()]
    for k in range(1, n + 1):
        g = grad(points[-1])
        moments = decay * moments + (1 - decay) * np.stack([g, g**2])
        mean, square = moments / (1 - decay**k)
        points.append(points[-1] - tau * (mean / (square**0.5 + eps)))
    return np.array(points)


def backtracking(f, grad, x, d, tau0=1.0, c=1e-4, shrink=0.5):
    promise = np.dot(grad(x), d)
    if not promise < 0:
        raise ValueError(promise)
    before, tau = f(x), tau0
    while True:
        if f(x + tau * d) <= before + c * promise * tau:
            return float(tau)
        tau = tau * shrink
