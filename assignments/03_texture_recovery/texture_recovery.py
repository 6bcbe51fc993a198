"""Recovering a texture: bilinear samples, their adjoint, and descent to the texels behind them.

A texture T has H rows, W columns and C channels, T[row, column, channel], row 0 on top. A place on
it is (u, v), u to the right, v downwards, both from 0 to 1; the center of the texel in column j is
at u = (j + 0.5) / W, of row i at v = (i + 0.5) / H. What lies beyond the outermost centers takes
the value at the border.

Your tasks are the six functions below, one section of the handout each;
`photograd course check 03` tells how far you are. All numbers are float64.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Texture = Annotated[np.ndarray, "H W C"]
Places = Annotated[np.ndarray, "N 2"]  # (u, v)
Samples = Annotated[np.ndarray, "N C"]
Losses = Annotated[np.ndarray, "n+1"]
Mask = Annotated[np.ndarray, "H W"]  # bool
Shape = tuple[int, int]  # (H, W)

CURVATURE_ROUNDS = 40  # of power iteration, before a descent
SAFETY = 0.95  # share of the largest stable step that a descent takes


def bilinear_sample(T: Texture, uv: Places) -> Samples:
    """Values of a texture at given places.

    Args:
        T: (H, W, C), the texels; any H, W, C from 1 upwards.
        uv: (N, 2), the places, u first.

    Returns:
        (N, C); handout equations (3) to (6).
    """
    # >>> solution 03.1
    rows, columns, _ = T.shape
    x = np.clip(uv[:, 0] * columns - 0.5, 0, columns - 1)
    y = np.clip(uv[:, 1] * rows - 0.5, 0, rows - 1)
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, bottom = np.minimum(left + 1, columns - 1), np.minimum(top + 1, rows - 1)
    s, t = (x - left)[:, None], (y - top)[:, None]
    above = (1 - s) * T[top, left] + s * T[top, right]
    below = (1 - s) * T[bottom, left] + s * T[bottom, right]
    return (1 - t) * above + t * below
    # <<< solution


def bilinear_sample_adjoint(shape: Shape, uv: Places, g: Samples) -> Texture:
    """The transpose of `bilinear_sample`: each sample's number goes back to its four texels.

    Args:
        shape: (H, W), a tuple or a list: take it apart, (*shape, 1) works for both.
        uv: (N, 2), the places; the same place may occur many times.
        g: (N, C), the derivative of some loss by each sample.

    Returns:
        (H, W, C), the derivative of that loss by each texel; handout equations (7) and (8).
    """
    # >>> solution 03.2
    height, width = shape
    across = np.clip(width * uv[:, 0] - 0.5, 0, width - 1)
    down = np.clip(height * uv[:, 1] - 0.5, 0, height - 1)
    j0, i0 = across.astype(int), down.astype(int)
    j1, i1 = np.minimum(j0 + 1, width - 1), np.minimum(i0 + 1, height - 1)
    fu, fv = (across - j0)[:, None], (down - i0)[:, None]
    d_T = np.zeros((height, width, g.shape[1]))
    np.add.at(d_T, (i0, j0), (1 - fv) * (1 - fu) * g)
    np.add.at(d_T, (i0, j1), (1 - fv) * fu * g)
    np.add.at(d_T, (i1, j0), fv * (1 - fu) * g)
    np.add.at(d_T, (i1, j1), fv * fu * g)
    return d_T
    # <<< solution


def loss_and_grad(T: Texture, uv: Places, target: Samples) -> tuple[float, Texture]:
    """How badly a texture explains the measured samples, and the derivative of that by its texels.

    Args:
        T: (H, W, C), the texels.
        uv: (N, 2), where was measured.
        target: (N, C), what was measured.

    Returns:
        (L, d_T): L a float, the sum of all squared differences divided by N, equation (9); d_T
        (H, W, C), equation (10).
    """
    # >>> solution 03.3
    residual = bilinear_sample(T, uv) - target
    count = len(uv)
    loss = float(np.sum(residual**2)) / count
    return loss, bilinear_sample_adjoint(T.shape[:2], uv, 2 * residual / count)
    # <<< solution


def largest_curvature(shape: Shape, uv: Places, n: int) -> float:
    """The largest eigenvalue of the loss's Hessian, estimated by power iteration.

    The Hessian is the same for each channel and does not depend on texels or measurements.

    Args:
        shape: (H, W) of the texture, a tuple or a list.
        uv: (N, 2), where was measured.
        n: number of rounds, from 0 upwards, that start at a texture of ones.

    Returns:
        the Rayleigh quotient after n rounds, a float; equations (11) to (13).
    """
    # >>> solution 03.4
    x = np.ones((*shape, 1))
    nothing = np.zeros((len(uv), 1))
    for _ in range(n):
        x = loss_and_grad(x, uv, nothing)[1]
        x = x / np.linalg.norm(x)
    return float(np.sum(x * loss_and_grad(x, uv, nothing)[1]) / np.sum(x * x))
    # <<< solution


def recover_texture(
    T0: Texture, uv: Places, target: Samples, n: int
) -> tuple[Texture, Losses, Mask]:
    """Gradient descent with a fixed step, SAFETY times the largest stable one.

    Args:
        T0: (H, W, C), where the descent starts; this array itself must not change.
        uv: (N, 2), where was measured.
        target: (N, C), what was measured.
        n: number of steps, from 0 upwards.

    Returns:
        (T, losses, unseen): T (H, W, C) after n steps; losses (n + 1,), of T0 first and of T last;
        unseen (H, W) bool, True where no sample gives a texel any weight. Equations (14), (15).
    """
    # >>> solution 03.5
    height, width, _ = T0.shape
    step = SAFETY * 2 / largest_curvature((height, width), uv, CURVATURE_ROUNDS)
    T = T0.copy()
    losses = np.zeros(n + 1)
    for k in range(n):
        losses[k], d_T = loss_and_grad(T, uv, target)
        T = T - step * d_T
    losses[n] = loss_and_grad(T, uv, target)[0]
    weight = bilinear_sample_adjoint((height, width), uv, np.ones((len(uv), 1)))
    return T, losses, weight[:, :, 0] == 0
    # <<< solution


def build_mips(T: Texture) -> list[Texture]:
    """The pyramid of ever smaller versions of a texture, down to a single texel.

    Args:
        T: (H, W, C); H and W are powers of two, not always the same.

    Returns:
        a list: T itself first; each further level has half the rows and half the columns (a side of
        one texel stays), each texel the mean of those it replaces, equation (16); last (1, 1, C).
    """
    # >>> solution 03.6
    levels = [T]
    while levels[-1].shape[:2] != (1, 1):
        fine = levels[-1]
        if fine.shape[0] > 1:
            fine = (fine[0::2] + fine[1::2]) / 2
        if fine.shape[1] > 1:
            fine = (fine[:, 0::2] + fine[:, 1::2]) / 2
        levels.append(fine)
    return levels
    # <<< solution
