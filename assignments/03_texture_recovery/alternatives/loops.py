"""Scalar loops over samples, texels and channels; indices are clamped, not coordinates."""

import math

import numpy as np
from texture_recovery import CURVATURE_ROUNDS, SAFETY


def _four(shape, place):
    """The four (row, column, weight) of one place."""
    rows, columns = shape
    x, y = float(place[0]) * columns - 0.5, float(place[1]) * rows - 0.5
    column, row = math.floor(x), math.floor(y)
    s, t = x - column, y - row
    near_row, far_row = min(max(row, 0), rows - 1), min(max(row + 1, 0), rows - 1)
    near, far = min(max(column, 0), columns - 1), min(max(column + 1, 0), columns - 1)
    return (
        (near_row, near, (1 - t) * (1 - s)),
        (near_row, far, (1 - t) * s),
        (far_row, near, t * (1 - s)),
        (far_row, far, t * s),
    )


def bilinear_sample(T, uv):
    out = np.zeros((len(uv), T.shape[2]))
    for n in range(len(uv)):
        for row, column, weight in _four(T.shape[:2], uv[n]):
            for c in range(T.shape[2]):
                out[n, c] += weight * T[row, column, c]
    return out


def bilinear_sample_adjoint(shape, uv, g):
    out = np.zeros((shape[0], shape[1], g.shape[1]))
    for n in range(len(uv)):
        for row, column, weight in _four(shape, uv[n]):
            for c in range(g.shape[1]):
                out[row, column, c] += weight * g[n, c]
    return out


def loss_and_grad(T, uv, target):
    got = bilinear_sample(T, uv)
    loss, back = 0.0, np.zeros(got.shape)
    for n in range(got.shape[0]):
        for c in range(got.shape[1]):
            difference = got[n, c] - target[n, c]
            loss += difference * difference / got.shape[0]
            back[n, c] = 2 / got.shape[0] * difference
    return float(loss), bilinear_sample_adjoint(T.shape[:2], uv, back)


def largest_curvature(shape, uv, n):
    x = np.full((shape[0], shape[1], 1), 1 / math.sqrt(shape[0] * shape[1]))
    for _ in range(n + 1):
        unit = x / math.sqrt(float((x * x).sum()))
        x = bilinear_sample_adjoint(shape, uv, bilinear_sample(unit, uv)) * (2 / len(uv))
    return float((unit * x).sum())


def recover_texture(T0, uv, target, n):
    step = SAFETY * 2 / largest_curvature(T0.shape[:2], uv, CURVATURE_ROUNDS)
    T, losses = np.array(T0), []
    for _ in range(n):
        loss, slope = loss_and_grad(T, uv, target)
        losses.append(loss)
        T = T - step * slope
    losses.append(loss_and_grad(T, uv, target)[0])
    unseen = np.ones(T0.shape[:2], dtype=bool)
    for place in uv:
        for row, column, weight in _four(T0.shape[:2], place):
            if weight > 0:
                unseen[row, column] = False
    return T, np.array(losses), unseen


def build_mips(T):
    levels = [np.array(T)]
    while levels[-1].shape[0] * levels[-1].shape[1] > 1:
        above = levels[-1]
        tall, wide = min(2, above.shape[0]), min(2, above.shape[1])
        next_level = np.zeros((above.shape[0] // tall, above.shape[1] // wide, T.shape[2]))
        for row in range(above.shape[0]):
            for column in range(above.shape[1]):
                for c in range(T.shape[2]):
                    share = above[row, column, c] / (tall * wide)
                    next_level[row // tall, column // wide, c] += share
        levels.append(next_level)
    return levels
