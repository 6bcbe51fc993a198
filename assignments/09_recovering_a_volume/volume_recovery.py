"""Recovering a volume from photographs by gradient descent, with the adjoint of assignment 08.

A volume is an array (X, Y, Z, 4), as in assignment 08: r, g, b and sigma, the extinction in 1/m,
which is never negative; colors lie between 0 and 1. *Views* are a dict of photographs and their
cameras, all numbers float64:

    "pictures"            (V, H, W, 3), linear colors, row 0 at the top
    "world_from_camera"   (V, 4, 4), the pose of each camera: x to the right, y down, z forward
    "focal"               the focal length of all cameras, in pixels
    "low", "high"         (3,) each, opposite corners of the box of the volume
    "background"          (3,), the color behind the volume

Your tasks are six functions, one section of the handout each; `photograd course check 09` tells how
far you are. `volume_rendering.py`, beside this file, must be yours of assignment 08.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np
from volume_rendering import render_adjoint, render_rays

# Arrays and their shapes; float64 where nothing else is said.
Grid = Annotated[np.ndarray, "X Y Z 4"]
SignMap = Annotated[np.ndarray, "X Y Z"]
Vectors = Annotated[np.ndarray, "R 3"]
Colors = Annotated[np.ndarray, "R 3"]
Indices = Annotated[np.ndarray, "R"]  # int64
Losses = Annotated[np.ndarray, "steps"]
Picture = Annotated[np.ndarray, "..."]  # colors of any shape
Views = dict[str, np.ndarray]

SAMPLES = 16  # per ray
RAYS = 192  # in the batch of each step of a fit
SMOOTH = 0.1  # eps of the total variation; its weight in a fit is
TV = 1e-2
FLOOR = 1e-6  # fraction of the largest derivative, below which the sign is 0
RATES = np.array([0.05, 0.05, 0.05, 0.5])  # of Adam, for r, g, b and sigma


def psnr(picture: Picture, truth: Picture) -> float:
    """Peak signal-to-noise ratio of two images, in decibels: higher is better.

    Args:
        picture, truth: of the same shape, any; colors with a peak of 1.

    Returns:
        a float, infinite for equal images; handout equation (3).
    """
    # >>> solution 09.1
    return float(-10 * np.log10(np.mean((picture - truth) ** 2)))
    # <<< solution


def ray_batch(views: Views, chosen: Indices) -> tuple[Vectors, Vectors, Colors]:
    """Rays through the centers of some pixels, and the colors of these pixels.

    Args:
        views: V photographs of H x W pixels.
        chosen: (R,), integers: pixels of all photographs, counted from 0 in the order of memory.

    Returns:
        (origins, directions, truth): (R, 3) each, rays in the world and colors; directions may
        have any length above zero. Handout equations (4) to (6).
    """
    # >>> solution 09.2
    pictures = views["pictures"]
    view, row, col = np.unravel_index(chosen, pictures.shape[:3])
    right = (col + 0.5 - pictures.shape[2] / 2) / views["focal"]
    down = (row + 0.5 - pictures.shape[1] / 2) / views["focal"]
    pose = views["world_from_camera"][view]
    aim = np.stack([right, down, np.ones(len(chosen))], axis=1)
    return pose[:, :3, 3], np.einsum("rij,rj->ri", pose[:, :3, :3], aim), pictures[view, row, col]
    # <<< solution


def mse_and_cotangent(pixels: Colors, truth: Colors) -> tuple[float, Colors]:
    """The loss of a batch of rays, and its derivative with respect to each pixel.

    Args:
        pixels: (R, 3), rendered.
        truth: (R, 3), of the photographs.

    Returns:
        (loss, d_pixels): a float, and (R, 3); handout equation (7).
    """
    # >>> solution 09.3
    residual = pixels - truth
    return float(np.sum(residual**2) / len(residual)), 2 / len(residual) * residual
    # <<< solution


# >>> solution 09.4


def _ahead(grid, axis):
    """The next value along an axis minus the current one; zero at the far border."""
    return np.diff(grid, axis=axis, append=grid.take([-1], axis=axis))


# <<< solution


def tv_loss_adjoint(grid: Grid, eps: float) -> tuple[float, Grid]:
    """The total variation of a volume, and its derivative with respect to each number.

    Args:
        grid: (X, Y, Z, C), each 1 or more.
        eps: above zero; differences far below it have almost no effect.

    Returns:
        (loss, d_grid): a float, and (X, Y, Z, C); handout equations (8) to (10).
    """
    # >>> solution 09.4
    ahead = np.stack([_ahead(grid, axis) for axis in range(3)])
    length = np.sqrt(eps**2 + np.sum(ahead**2, axis=0))
    count = grid[..., 0].size
    pull = ahead / length / count
    d_grid = -pull.sum(axis=0)
    for axis in range(3):
        # The difference of voxel i has the value of voxel i + 1, with a plus.
        moved = np.roll(pull[axis], 1, axis=axis)
        d_grid += moved
    return float(np.sum(length - eps) / count), d_grid
    # <<< solution


class Adam:
    """Adam for one volume, as in assignment 01, with beta1 = 0.9 and beta2 = 0.99."""

    def __init__(self):
        self.m = self.v = self.k = 0

    def step(self, grid, d_grid):
        """The volume after one step with learning rates RATES; grid does not change."""
        self.k += 1
        self.m = 0.9 * self.m + 0.1 * d_grid
        self.v = 0.99 * self.v + 0.01 * d_grid**2
        m, v = self.m / (1 - 0.9**self.k), self.v / (1 - 0.99**self.k)
        return grid - RATES * m / (np.sqrt(v) + 1e-8)


def fog(shape):
    """Given: an initial guess, thin gray fog of a shape (X, Y, Z)."""
    grid = np.full((*shape, 4), 0.5)
    grid[..., 3] = 0.1
    return grid


def draw(views, rng):
    """Given: the batch of one step, RAYS different pixels at random; all, if there are fewer."""
    total = views["pictures"][..., 0].size
    return rng.choice(total, min(RAYS, total), replace=False)


def gradient_sign_map(grid: Grid, views: Views) -> SignMap:
    """The sign of the derivative with respect to each extinction, from all photographs.

    Args:
        grid: (X, Y, Z, 4).
        views: as above; all of their pixels count.

    Returns:
        (X, Y, Z), float64: -1 where gradient descent increases sigma, 1 where it decreases it, 0
        where the derivative is below the floor; handout equations (11) and (12).
    """
    # >>> solution 09.5
    slope = np.zeros_like(grid[..., 3])
    each = views["pictures"][0, ..., 0].size
    for view in range(len(views["pictures"])):
        origins, directions, truth = ray_batch(views, np.arange(view * each, (view + 1) * each))
        rays = (views["low"], views["high"], origins, directions, SAMPLES, views["background"])
        _, d_pixels = mse_and_cotangent(render_rays(grid, *rays), truth)
        slope += render_adjoint(grid, *rays, d_pixels)[0][..., 3]
    return np.where(np.abs(slope) > FLOOR * np.abs(slope).max(), np.sign(slope), 0.0)
    # <<< solution


def fit_volume(
    views: Views, grid: Grid, steps: int, rng: np.random.Generator
) -> tuple[Grid, Losses]:
    """Recover a volume from photographs.

    Args:
        views: as above.
        grid: (X, Y, Z, 4), the initial guess; this array must not change.
        steps: the number of steps, 0 or more.
        rng: a numpy.random.Generator, for `draw` alone.

    Returns:
        (grid, losses): (X, Y, Z, 4), and (steps,), the loss before each step; handout equations
        (13) to (16).
    """
    # >>> solution 09.6
    losses = np.zeros(steps)
    adam = Adam()
    for step in range(steps):
        origins, directions, truth = ray_batch(views, draw(views, rng))
        rays = (views["low"], views["high"], origins, directions, SAMPLES, views["background"])
        loss, d_pixels = mse_and_cotangent(render_rays(grid, *rays), truth)
        d_grid, _ = render_adjoint(grid, *rays, d_pixels)
        roughness, d_rough = tv_loss_adjoint(grid, SMOOTH)
        losses[step] = loss + TV * roughness
        grid = adam.step(grid, d_grid + TV * d_rough)
        grid[..., :3] = np.clip(grid[..., :3], 0.0, 1.0)
        grid[..., 3] = np.maximum(grid[..., 3], 0.0)
    return grid.copy(), losses
    # <<< solution
