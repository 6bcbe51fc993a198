"""Written from the handout alone: one line of code for one equation, helpers for what repeats."""

import numpy as np


def numeric_derivative(f, x, eps):
    result = np.zeros_like(x)
    for i in range(x.size):
        right = x.copy()
        left = x.copy()
        right[i] += eps
        left[i] -= eps
        result[i] = (f(right) - f(left)) / (2 * eps)  # Eq. (3)
    return result


def _went_wrong(values):
    return not (values[-1] <= values[0])  # Eq. (8)


def gd_1d(f, df, x0, tau, n):
    xs = [x0]
    for _ in range(n):
        x = xs[-1]
        xs.append(x - tau * df(x))  # Eq. (5)
    values = [f(x) for x in xs]
    return np.array(xs, dtype=float), np.array(values, dtype=float), _went_wrong(values)


def gd_nd(f, grad, x0, tau, n):
    xs = [np.array(x0)]
    for _ in range(n):
        x = xs[-1]
        xs.append(x - tau * grad(x))  # Eq. (9)
    values = [f(x) for x in xs]
    return np.array(xs), np.array(values, dtype=float), _went_wrong(values)


def momentum(grad, x0, tau, beta, n):
    xs = [np.array(x0)]
    v = np.zeros(x0.shape)
    for _ in range(n):
        v = beta * v + grad(xs[-1])  # Eq. (12)
        xs.append(xs[-1] - tau * v)  # Eq. (13)
    return np.array(xs)


def adam(grad, x0, tau, n, beta1=0.9, beta2=0.999, eps=1e-8):
    xs = [np.array(x0)]
    m = np.zeros(x0.shape)
    v = np.zeros(x0.shape)
    for k in range(1, n + 1):
        g = grad(xs[-1])
        m = beta1 * m + (1 - beta1) * g  # Eq. (16)
        v = beta2 * v + (1 - beta2) * g**2  # Eq. (17)
        m_hat = m / (1 - beta1**k)  # Eq. (18)
        v_hat = v / (1 - beta2**k)  # Eq. (19)
        xs.append(xs[-1] - tau * m_hat / (np.sqrt(v_hat) + eps))  # Eq. (20)
    return np.array(xs)


def backtracking(f, grad, x, d, tau0=1.0, c=1e-4, shrink=0.5):
    slope = np.sum(grad(x) * d)
    if not slope < 0:
        raise ValueError("d must lead downhill")
    here = f(x)
    tau = tau0
    while not (f(x + tau * d) <= here + c * tau * slope):  # Eq. (22)
        tau = tau * shrink
    return tau
