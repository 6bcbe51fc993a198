"""Volume rendering of a grid of emitting, absorbing voxels, and its adjoint.

A volume is an array (X, Y, Z, 4) between the corners `low` and `high` of a box; channels are r, g,
b and sigma, the extinction in 1/m, never negative. Values belong to voxel centers. A ray is
origin + t * direction, t >= 0; its direction need not have length 1. R rays, S samples each, all
numbers float64.

Your tasks are six functions, one section of the handout each; `photograd course check 08` tells how
far you are. `ray_samples` and `render_rays` are given, and work once yours do.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Steps = Annotated[np.ndarray, "R S"]
StepColors = Annotated[np.ndarray, "R S C"]
PerRay = Annotated[np.ndarray, "R"]
Pixels = Annotated[np.ndarray, "R C"]
Color = Annotated[np.ndarray, "C"]
Vectors = Annotated[np.ndarray, "R 3"]
Corner = Annotated[np.ndarray, "3"]
Grid = Annotated[np.ndarray, "X Y Z C"]
Places = Annotated[np.ndarray, "N 3"]
Samples = Annotated[np.ndarray, "N C"]
Shape = tuple[int, int, int]  # (X, Y, Z)


def composite(
    sigma: Steps, color: StepColors, dt: Steps, background: Color
) -> tuple[Pixels, PerRay]:
    """Emission and absorption along rays, in steps of constant extinction and color.

    Args:
        sigma: (R, S), the extinction in each step, 0 or more, nearest step first; 1/m.
        color: (R, S, C), the color of each step; C is 1 or more.
        dt: (R, S), the length of each step, 0 or more; m. Steps may differ.
        background: (C,), the color behind all steps, the same for all rays.

    Returns:
        (pixel, T_end): (R, C), and (R,) the transmittance of the whole ray; handout equations (4)
        to (8).
    """
    # >>> solution 08.1
    s = sigma * dt
    behind = np.cumsum(s, axis=1)
    front = np.concatenate([np.zeros((len(s), 1)), behind[:, :-1]], axis=1)
    w = np.exp(-front) * -np.expm1(-s)
    T_end = np.exp(-behind[:, -1])
    return np.einsum("rs,rsc->rc", w, color) + T_end[:, None] * background, T_end
    # <<< solution


def composite_adjoint(
    sigma: Steps, color: StepColors, dt: Steps, background: Color, d_pixel: Pixels, d_T_end: PerRay
) -> tuple[Steps, StepColors, Color]:
    """The adjoint (backward pass) of `composite`.

    Args:
        sigma, color, dt, background: as for `composite`.
        d_pixel: (R, C), the derivative of some loss with respect to each pixel.
        d_T_end: (R,), the derivative of that loss with respect to each T_end.

    Returns:
        (d_sigma, d_color, d_background): (R, S), (R, S, C) and (C,), the derivatives of that loss
        with respect to each input; handout section 2.
    """
    # >>> solution 08.2
    pixel, end = composite(sigma, color, dt, background)
    left = np.sum(pixel * d_pixel, axis=1) + end * d_T_end
    T = np.ones(len(sigma))
    d_sigma, d_color = np.zeros(sigma.shape), np.zeros(color.shape)
    for k in range(sigma.shape[1]):
        tau = sigma[:, k] * dt[:, k]
        weight, after = T * -np.expm1(-tau), T * np.exp(-tau)
        v = np.sum(color[:, k] * d_pixel, axis=1)
        left = left - weight * v
        d_sigma[:, k] = dt[:, k] * (after * v - left)
        d_color[:, k] = weight[:, None] * d_pixel
        T = after
    return d_sigma, d_color, T @ d_pixel
    # <<< solution


def ray_box(
    low: Corner, high: Corner, origins: Vectors, directions: Vectors
) -> tuple[PerRay, PerRay]:
    """Entry and exit of rays through an axis-aligned box.

    Args:
        low, high: (3,), two opposite corners, low < high on each axis; faces belong to the box.
        origins: (R, 3).
        directions: (R, 3), of any length above zero; single components may be zero.

    Returns:
        (t_near, t_far): (R,) each, in lengths of the direction. Where a ray hits the box:
        0 <= t_near < t_far; where it misses, both are 0. Handout equations (13) to (15).
    """
    # >>> solution 08.3
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - origins) / directions, (high - origins) / directions
    enter, leave = np.minimum(first, second), np.maximum(first, second)
    parallel = directions == 0
    between = (origins >= low) & (origins <= high)
    enter = np.where(parallel, np.where(between, -np.inf, np.inf), enter)
    leave = np.where(parallel, np.inf, leave)
    t_near = np.maximum(enter.max(axis=1), 0.0)
    t_far = leave.min(axis=1)
    hit = t_near < t_far
    return np.where(hit, t_near, 0.0), np.where(hit, t_far, 0.0)
    # <<< solution


def trilinear(grid: Grid, u: Places) -> Samples:
    """Trilinear interpolation of a grid.

    Args:
        grid: (X, Y, Z, C), each 1 or more.
        u: (N, 3), points, 0 to 1 across the box on each axis; beyond, border values are repeated.

    Returns:
        (N, C); handout equations (16) to (18).
    """
    # >>> solution 08.4
    counts = np.array(grid.shape[:3])
    place = np.clip(u * counts - 0.5, 0, counts - 1)
    near = place.astype(int)
    far = np.minimum(near + 1, counts - 1)
    f = place - near
    values = np.zeros((len(u), grid.shape[3]))
    for corner in np.ndindex(2, 2, 2):
        i, j, k = np.where(corner, far, near).T
        share = np.prod(np.where(corner, f, 1 - f), axis=1)
        values += share[:, None] * grid[i, j, k]
    return values
    # <<< solution


def trilinear_adjoint(shape: Shape, u: Places, g: Samples) -> Grid:
    """The adjoint of `trilinear`: scatters the derivative of each sample to its eight voxels.

    Args:
        shape: (X, Y, Z), a tuple or a list: (*shape, 1) works for both.
        u: (N, 3), points; the same point may occur many times.
        g: (N, C), the derivative of some loss with respect to each sample.

    Returns:
        (X, Y, Z, C), the derivative of that loss with respect to each voxel.
    """
    # >>> solution 08.5
    sizes = np.array(shape)
    where = np.clip(sizes * u - 0.5, 0, sizes - 1)
    floor = where.astype(int)
    ceiling = np.minimum(floor + 1, sizes - 1)
    fraction = where - floor
    d_grid = np.zeros((*shape, g.shape[1]))
    for upper in np.ndindex(2, 2, 2):
        a, b, c = np.where(upper, ceiling, floor).T
        part = np.prod(np.where(upper, fraction, 1 - fraction), axis=1)
        np.add.at(d_grid, (a, b, c), part[:, None] * g)
    return d_grid
    # <<< solution


def ray_samples(low, high, origins, directions, n):
    """Given: midpoints of n equal steps through the box, and the lengths of the steps.

    Returns:
        (u, dt): (R, n, 3), points, 0 to 1 across the box; (R, n), in m for directions of any
        length.
    """
    t_near, t_far = ray_box(low, high, origins, directions)
    step = (t_far - t_near) / n
    t = t_near[:, None] + (np.arange(n) + 0.5) * step[:, None]
    points = origins[:, None, :] + t[:, :, None] * directions[:, None, :]
    meters = step * np.linalg.norm(directions, axis=1)
    return (points - low) / (high - low), np.repeat(meters[:, None], n, axis=1)


def render_rays(grid, low, high, origins, directions, n, background):
    """Given: the pixels (R, 3) of rays through a volume in front of a background (3,)."""
    u, dt = ray_samples(low, high, origins, directions, n)
    samples = trilinear(grid, u.reshape(-1, 3)).reshape(len(origins), n, 4)
    return composite(samples[:, :, 3], samples[:, :, :3], dt, background)[0]


def render_adjoint(
    grid: Grid,
    low: Corner,
    high: Corner,
    origins: Vectors,
    directions: Vectors,
    n: int,
    background: Color,
    d_pixel: Pixels,
) -> tuple[Grid, Color]:
    """The adjoint of `render_rays` with respect to the volume and the background.

    Args:
        grid, low, high, origins, directions, n, background: as for `render_rays`.
        d_pixel: (R, 3), the derivative of some loss with respect to each pixel.

    Returns:
        (d_grid, d_background): (X, Y, Z, 4) and (3,), the derivatives of that loss with respect to
        each; handout section 6.
    """
    # >>> solution 08.6
    points, lengths = ray_samples(low, high, origins, directions, n)
    flat = points.reshape(-1, 3)
    found = trilinear(grid, flat).reshape(*lengths.shape, 4)
    extinction, shade = found[:, :, 3], found[:, :, :3]
    opaque = np.zeros(len(d_pixel))
    back = composite_adjoint(extinction, shade, lengths, background, d_pixel, opaque)
    d_samples = np.concatenate([back[1], back[0][:, :, None]], axis=2)
    return trilinear_adjoint(grid.shape[:3], flat, d_samples.reshape(-1, 4)), back[2]
    # <<< solution
