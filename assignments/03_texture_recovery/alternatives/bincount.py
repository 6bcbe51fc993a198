"""Vectorized with flat texel numbers: one gather forwards, one np.bincount a channel backwards."""

import numpy as np
from texture_recovery import CURVATURE_ROUNDS, SAFETY


def _numbers_and_weights(shape, uv):
    """Flat texel numbers (4, N) and their weights (4, N)."""
    size = np.array([shape[1], shape[0]])
    place = uv * size - 0.5
    corner = np.floor(place)
    weight_far = place - corner
    number, weight = [], []
    for down in (0, 1):
        for right in (0, 1):
            index = np.clip(corner + np.array([right, down]), 0, size - 1).astype(np.int64)
            number.append(index[:, 1] * shape[1] + index[:, 0])
            w = np.where((right, down), weight_far, 1 - weight_far)
            weight.append(w[:, 0] * w[:, 1])
    return np.stack(number), np.stack(weight)


def bilinear_sample(T, uv):
    number, weight = _numbers_and_weights(T.shape[:2], uv)
    flat = T.reshape(-1, T.shape[2])
    return np.einsum("kn,knc->nc", weight, flat[number])


def bilinear_sample_adjoint(shape, uv, g):
    number, weight = _numbers_and_weights(shape, uv)
    texels = shape[0] * shape[1]
    channels = [
        np.bincount(number.ravel(), (weight * g[:, c]).ravel(), minlength=texels)
        for c in range(g.shape[1])
    ]
    return np.stack(channels, axis=-1).reshape(*shape, g.shape[1])


def loss_and_grad(T, uv, target):
    error = target - bilinear_sample(T, uv)
    gradient = bilinear_sample_adjoint(T.shape[:2], uv, error)
    return float(np.vdot(error, error) / len(target)), -2.0 / len(target) * gradient


def largest_curvature(shape, uv, n):
    x = np.ones((*shape, 1))
    y = bilinear_sample_adjoint(shape, uv, bilinear_sample(x, uv))
    for _ in range(n):
        x = y / np.abs(y).max()
        y = bilinear_sample_adjoint(shape, uv, bilinear_sample(x, uv))
    return float(2 / len(uv) * np.vdot(x, y) / np.vdot(x, x))


def recover_texture(T0, uv, target, n):
    bound = 2 / largest_curvature(T0.shape[:2], uv, CURVATURE_ROUNDS)
    T, losses = T0, []
    for k in range(n + 1):
        loss, gradient = loss_and_grad(T, uv, target)
        losses.append(loss)
        if k < n:
            T = T - SAFETY * bound * gradient
    number, weight = _numbers_and_weights(T0.shape[:2], uv)
    seen = np.zeros(T0.shape[0] * T0.shape[1], dtype=bool)
    seen[number[weight > 0]] = True
    return T, np.array(losses), ~seen.reshape(T0.shape[:2])


def build_mips(T):
    levels = [T]
    while levels[-1].size > T.shape[2]:
        rows, columns, channels = levels[-1].shape
        tall, wide = (2 if rows > 1 else 1), (2 if columns > 1 else 1)
        blocks = levels[-1].reshape(rows // tall, tall, columns // wide, wide, channels)
        levels.append(blocks.mean(axis=(1, 3)))
    return levels
