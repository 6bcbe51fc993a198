"""Scalar loops: every coordinate on its own, Python floats, lists until the end."""

import math

import numpy as np


def numeric_derivative(f, x, eps):
    result = []
    for i in range(len(x)):
        values = []
        for sign in (1.0, -1.0):
            moved = [float(each) for each in x]
            moved[i] = moved[i] + sign * eps
            values.append(f(np.array(moved)))
        result.append(0.5 * (values[0] - values[1]) / eps)
    return np.array(result)


def gd_1d(f, df, x0, tau, n):
    points = [float(x0)]
    values = [float(f(float(x0)))]
    while len(points) <= n:
        here = points[-1]
        there = here - df(here) * tau
        points.append(there)
        values.append(float(f(there)))
    improved = values[-1] < values[0] or values[-1] == values[0]
    return np.array(points), np.array(values), not improved


def gd_nd(f, grad, x0, tau, n):
    points = [[float(each) for each in x0]]
    while len(points) <= n:
        here = points[-1]
        down = grad(np.array(here))
        points.append([here[i] - tau * float(down[i]) for i in range(len(here))])
    values = [float(f(np.array(each))) for each in points]
    gone = math.isnan(values[-1]) or math.isnan(values[0]) or values[-1] > values[0]
    return np.array(points), np.array(values), gone


def momentum(grad, x0, tau, beta, n):
    velocity = [0.0 for _ in x0]
    points = [[float(each) for each in x0]]
    while len(points) <= n:
        down = grad(np.array(points[-1]))
        velocity = [beta * velocity[i] + float(down[i]) for i in range(len(velocity))]
        points.append([points[-1][i] - tau * velocity[i] for i in range(len(velocity))])
    return np.array(points)


def adam(grad, x0, tau, n, beta1=0.9, beta2=0.999, eps=1e-8):
    size = len(x0)
    first, second = [0.0] * size, [0.0] * size
    power1, power2 = 1.0, 1.0
    points = [[float(each) for each in x0]]
    while len(points) <= n:
        power1, power2 = power1 * beta1, power2 * beta2
        down = grad(np.array(points[-1]))
        there = []
        for i in range(size):
            slope = float(down[i])
            first[i] += (1 - beta1) * (slope - first[i])
            second[i] += (1 - beta2) * (slope**2 - second[i])
            scale = math.sqrt(second[i] / (1 - power2)) + eps
            there.append(points[-1][i] - tau * first[i] / (1 - power1) / scale)
        points.append(there)
    return np.array(points)


def backtracking(f, grad, x, d, tau0=1.0, c=1e-4, shrink=0.5):
    down = grad(x)
    slope = 0.0
    for i in range(len(d)):
        slope += float(down[i]) * float(d[i])
    if slope >= 0.0 or math.isnan(slope):
        raise ValueError("this direction does not lead downhill")
    start = f(x)
    for count in range(10_000):
        tau = tau0 * shrink**count
        value = f(np.array([float(x[i]) + tau * float(d[i]) for i in range(len(d))]))
        if value - start <= c * tau * slope:
            break
    return tau
