"""Scalar loops and the math module."""

from __future__ import annotations

import math

import numpy as np


def weighted_sum(w, x):
    total = 0.0
    for weight, value in zip(w, x, strict=True):
        total += float(weight) * math.exp(-float(value))
    return total


def weighted_sum_backward(w, x, d_s):
    d_w, d_x = np.zeros(len(w)), np.zeros(len(x))
    for i in range(len(w)):
        d_w[i] += d_s * math.exp(-x[i])
        d_x[i] -= d_s * w[i] * math.exp(-x[i])
    return d_w, d_x


def descend(gradient, x0, tau, n):
    points = np.empty((n + 1, len(x0)))
    points[0] = x0
    for k in range(n):
        slope = gradient(points[k])
        for i in range(len(x0)):
            points[k + 1, i] = points[k, i] - tau * slope[i]
    return points
