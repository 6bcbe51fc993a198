"""From the handout alone: hats of equation (1) for both directions, multiplied as matrices."""

import numpy as np
from texture_recovery import CURVATURE_ROUNDS, SAFETY


def _hats(n, place):
    """Weight of each of n texels in a row at each clamped coordinate: (N, n)."""
    clamped = np.clip(n * place - 0.5, 0.0, n - 1.0)
    distance = np.abs(clamped[:, None] - np.arange(n)[None, :])
    return np.maximum(0.0, 1.0 - distance)


def bilinear_sample(T, uv):
    H, W, C = T.shape
    hu, hv = _hats(W, uv[:, 0]), _hats(H, uv[:, 1])
    result = np.zeros((len(uv), C))
    for c in range(C):
        result[:, c] = np.sum((hv @ T[:, :, c]) * hu, axis=1)
    return result


def bilinear_sample_adjoint(shape, uv, g):
    H, W = shape
    hu, hv = _hats(W, uv[:, 0]), _hats(H, uv[:, 1])
    result = np.zeros((H, W, g.shape[1]))
    for c in range(g.shape[1]):
        result[:, :, c] = hv.T @ (hu * g[:, c : c + 1])
    return result


def loss_and_grad(T, uv, target):
    N = target.shape[0]
    r = bilinear_sample(T, uv) - target
    L = 1 / N * np.sum(r * r)
    d_T = 2 / N * bilinear_sample_adjoint(T.shape[:2], uv, r)
    return L, d_T


def largest_curvature(shape, uv, n):
    H, W = shape
    zero = np.zeros((len(uv), 1))

    def hessian(x):
        return loss_and_grad(x, uv, zero)[1]

    x = np.ones((H, W, 1))
    for _ in range(n):
        y = hessian(x)
        x = y / np.sqrt(np.sum(y**2))
    return np.sum(x * hessian(x)) / np.sum(x * x)


def recover_texture(T0, uv, target, n):
    tau = SAFETY * 2 / largest_curvature(T0.shape[:2], uv, CURVATURE_ROUNDS)
    T = T0
    losses = []
    for _ in range(n):
        L, d_T = loss_and_grad(T, uv, target)
        losses.append(L)
        T = T - tau * d_T
    L, d_T = loss_and_grad(T, uv, target)
    losses.append(L)
    hu, hv = _hats(T0.shape[1], uv[:, 0]), _hats(T0.shape[0], uv[:, 1])
    return T, np.array(losses), hv.T @ hu == 0


def build_mips(T):
    levels = [T]
    H, W, _ = T.shape
    while H > 1 or W > 1:
        finer = levels[-1]
        if H > 1:
            H //= 2
            finer = np.array([(finer[2 * i] + finer[2 * i + 1]) / 2 for i in range(H)])
        if W > 1:
            W //= 2
            pairs = [(finer[:, 2 * j] + finer[:, 2 * j + 1]) / 2 for j in range(W)]
            finer = np.stack(pairs, axis=1)
        levels.append(finer)
    return levels
