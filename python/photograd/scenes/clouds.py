"""Clouds of density in a layer, from noise."""

from __future__ import annotations

import numpy as np

from photograd.scenes.description import Density, Points
from photograd.scenes.noise import fractal_noise
from photograd.types import FloatArray


def cloud_layer(
    box: Points,
    *,
    seed: int,
    sigma_t: float = 60.0,
    feature_size: float = 0.3,
    threshold: float = -0.1,
) -> Density:
    """Clouds that fill a box, flat below and billowing above.

        sigma_t * clip(4 (noise(x / feature_size) - threshold) * profile, 0, 1)

    where the profile rises from 0 to 1 within the lowest fifth of the box and falls to 0 at its
    sides and top, so that no cloud is cut off.

    Args:
        box: (2, 3).
        seed: of the noise.
        sigma_t: the largest value, in 1/m.
        feature_size: metres from cloud to cloud.
        threshold: of the noise; with -0.1 two fifths of the layer are cloud, with 0 one fifth.

    Returns:
        A function from points (N, 3) to sigma_t (N,) in 1/m: continuous, 0 outside the box.
    """
    low, high = np.asarray(box, dtype=np.float64)

    def density(points: Points) -> FloatArray:
        share = (np.asarray(points, dtype=np.float64) - low) / (high - low)
        inside = np.all((share > 0.0) & (share < 1.0), axis=-1)
        values = np.zeros(len(share))
        if not bool(inside.any()):
            return values
        share = share[inside]
        sideways = np.minimum(share, 1.0 - share)[:, [0, 2]].min(axis=1)
        base = np.clip(5.0 * share[:, 1], 0.0, 1.0)
        dome = np.clip(6.0 * sideways, 0.0, 1.0) * np.sqrt(1.0 - share[:, 1])
        noise = fractal_noise(points[inside] / feature_size, seed=seed, octaves=5)
        filled = 4.0 * (noise + 0.35 * (dome - 1.0) - threshold) * base * dome
        values[inside] = sigma_t * np.clip(filled, 0.0, 1.0)
        return values

    return density
