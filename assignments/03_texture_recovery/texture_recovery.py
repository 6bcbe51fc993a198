"""Recovering a texture: bilinear interpolation, its adjoint, and gradient descent on the texels.

A texture T has H rows, W columns and C channels, T[row, column, channel], row 0 at the top. A point
on it is (u, v), u to the right, v downward, both from 0 to 1; the center of the texel in column j
is at u = (j + 0.5) / W, of row i at v = (i + 0.5) / H. Beyond the outermost centers the value at
the border is repeated.

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

CURVATURE_ROUNDS = 40  # iterations of the power method, before gradient descent
SAFETY = 0.95  # fraction of the largest stable learning rate


def bilinear_sample(T: Texture, uv: Places) -> Samples:
    """Bilinear interpolation of a texture.

    Args:
        T: (H, W, C), the texels; each 1 or more.
        uv: (N, 2), points, u first.

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
    """The adjoint of `bilinear_sample`: scatters the derivative of each sample to four texels.

    Args:
        shape: (H, W), a tuple or a list: (*shape, 1) works for both.
        uv: (N, 2), points; the same point may occur many times.
        g: (N, C), the derivative of some loss with respect to each sample.

    Returns:
        (H, W, C), the derivative of that loss with respect to each texel; handout equations (7)
        and (8).
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
    """Mean squared error of a texture at the measured points, and its gradient.

    Args:
        T: (H, W, C), the texels.
        uv: (N, 2), the measured points.
        target: (N, C), the measured values.

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
    """The largest eigenvalue of the Hessian of the loss, estimated by power iteration.

    The Hessian is the same for each channel and does not depend on texels or measurements.

    Args:
        shape: (H, W) of the texture, a tuple or a list.
        uv: (N, 2), the measured points.
        n: number of iterations, 0 or more, from a texture of ones.

    Returns:
        the Rayleigh quotient after n iterations, a float; equations (11) to (13).
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
    """Gradient descent with a constant learning rate, SAFETY times the largest stable one.

    Args:
        T0: (H, W, C), the initial texture; this array must not change.
        uv: (N, 2), the measured points.
        target: (N, C), the measured values.
        n: number of steps, 0 or more.

    Returns:
        (T, losses, unseen): T (H, W, C) after n steps; losses (n + 1,), of T0 first and of T last;
        unseen (H, W) bool, True where no sample has a weight for the texel. Equations (14), (15).
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
    """The mipmap of a texture, down to a single texel.

    Args:
        T: (H, W, C); H and W are powers of two, not always the same.

    Returns:
        a list: T itself first; each further level has half the rows and half the columns (a side of
        one texel does not change), each texel is a mean, equation (16); last (1, 1, C).
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
