"""What the figures of assignment 08 draw: scenes, measurements, pieces of pictures."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Array

FIGURE_1 = kit_module("08_volume_rendering", "figure_1")

STEPS = 48  # along the ray of figures 2 and 4, which is 6 m long
# The mistakes of figure 5, as its caption names them.
LEFT_OUT, ADDED, NO_STEP = "no occlusion term", "occlusion term added", "without dt"
OWN_LIGHT, NO_EXP = "own light in occlusion", "σ dt for opacity"
TAKES_IN = "T includes the step"


def two_clouds() -> tuple[Array, Array, Array]:
    """Midpoints, extinctions, lengths of steps: a thin cloud at 1.5 m, a dense one at 4.5 m."""
    dt = np.full(STEPS, 6.0 / STEPS)
    x = np.cumsum(dt) - dt / 2
    bump = [np.clip(1 - ((x - middle) / 1.0) ** 2, 0, None) for middle in (1.5, 4.5)]
    return x, 0.6 * bump[0] + 2.4 * bump[1], dt


def weights(module: ModuleType, sigma: Array, dt: Array) -> tuple[Array, float]:
    """Weights of the steps of a ray, with one channel per step; T_end."""
    steps = len(sigma)
    pixel, T_end = module.composite(sigma[None], np.eye(steps)[None], dt[None], np.zeros(steps))
    return pixel[0], float(T_end[0])


def end_of(module: ModuleType, sigma: Array, dt: Array) -> float:
    color = np.zeros((1, len(sigma), 1))
    return float(module.composite(sigma[None], color, dt[None], np.zeros(1))[1][0])


def pixel_of(module: ModuleType, sigma: Array, color: Array, dt: float) -> float:
    given = (sigma[None], color[None, :, None], np.full((1, len(sigma)), dt), np.zeros(1))
    return float(module.composite(*given)[0][0, 0])


def transmittance(s: Array) -> Array:
    """Transmittance in front of steps of the given optical depths."""
    return np.exp(-np.concatenate([[0.0], np.cumsum(s)[:-1]]))


def cloud_pixel(way: object, n: int) -> float:
    """The pixel of a smooth cloud of varying color by one way to weight its steps."""
    x = (np.arange(n) + 0.5) / n
    sigma = 3 * np.exp(-(((x - 0.4) / 0.3) ** 2))
    return float(way(sigma, 0.6 + 0.4 * np.sin(4 * x), 1 / n))  # type: ignore[operator]


def differences(
    module: ModuleType,
    sigma: Array,
    color: Array,
    dt: Array,
    background: Array,
    d_pixel: Array | None = None,
) -> Array:
    """Central differences of <pixel, d_pixel> per extinction; of one ray without its axis."""
    d = np.ones((len(sigma), color.shape[2])) if d_pixel is None else d_pixel
    result = np.zeros(sigma.shape)
    for k in range(sigma.shape[1]):
        ends = []
        for sign in (1, -1):
            moved = sigma.copy()
            moved[:, k] += sign * 1e-5
            ends.append(np.sum(module.composite(moved, color, dt, background)[0] * d, axis=1))
        result[:, k] = (ends[0] - ends[1]) / 2e-5
    return result[0] if d_pixel is None else result


def wrong(
    name: str, sigma: Array, color: Array, dt: float, background: Array, d_pixel: Array
) -> Array:
    """d_sigma with one mistake."""
    s = sigma * dt
    T = np.exp(-np.concatenate([np.zeros((len(s), 1)), np.cumsum(s, axis=1)], axis=1))
    front = T[:, 1:] if name == TAKES_IN else T[:, :-1]
    light = front * -np.expm1(-s) * np.einsum("rsc,rc->rs", color, d_pixel)
    end = T[:, -1:] * (d_pixel @ background)[:, None]
    rest = np.concatenate([light, end], axis=1)[:, ::-1].cumsum(axis=1)[:, ::-1]
    hidden = rest[:, :-1] if name == OWN_LIGHT else rest[:, 1:]
    slope = T[:, :-1] if name == NO_EXP else T[:, 1:]
    own = slope * np.einsum("rsc,rc->rs", color, d_pixel)
    if name == LEFT_OUT:
        return dt * own
    if name == ADDED:
        return dt * (own + hidden)
    return (own - hidden) * (1.0 if name == NO_STEP else dt)


def reach(x: Array, mask: Array, dt: Array) -> tuple[float, float]:
    return float(x[mask].min() - dt[0] / 2), float(x[mask].max() + dt[0] / 2)
