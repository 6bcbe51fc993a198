"""A sky shortly before sunset, as an environment map that a formula paints."""

from __future__ import annotations

from typing import Any

import numpy as np

from photograd.types import Array

ZENITH, HORIZON, GROUND = [0.2, 0.36, 0.75], [1.5, 0.9, 0.52], [0.15, 0.12, 0.10]
SUN = np.array([0.62, 0.26, 0.44])  # towards it, of any length
SUN_RADIANCE, SUN_SHARPNESS = [700.0, 460.0, 240.0], 900.0  # a lobe of about 2.7 degrees
GLOW_RADIANCE, GLOW_SHARPNESS = [2.0, 1.1, 0.5], 8.0


def map_directions(height: int) -> Array:
    """Directions (H, 2 H, 3) of the texels' centres, as `EnvironmentMap` has them."""
    theta = (np.arange(height) + 0.5) / height * np.pi
    phi = ((np.arange(2 * height) + 0.5) / (2 * height) - 0.5) * 2 * np.pi
    side = np.sin(theta)[:, None]
    up = np.broadcast_to(np.cos(theta)[:, None], (height, 2 * height))
    return np.stack([-side * np.sin(phi), up, side * np.cos(phi)], axis=-1)


def evening_map(height: int = 64, sun: Any = SUN) -> Array:
    """Radiance (H, 2 H, 3) float32: blue above, orange at the horizon, a low sun, its glow.

    `sun` (3,) points towards it, of any length.
    """
    w = map_directions(height)
    up = w[..., 1:2]
    sky = np.array(HORIZON) + (np.array(ZENITH) - HORIZON) * np.sqrt(np.clip(up, 0.0, 1.0))
    above = 1.0 / (1.0 + np.exp(-60.0 * up))  # the horizon is soft over a few texels
    radiance = np.array(GROUND) * (1.0 - above) + sky * above
    toward = (w @ (np.asarray(sun) / np.linalg.norm(sun)))[..., None] - 1.0
    for color, sharpness in ((SUN_RADIANCE, SUN_SHARPNESS), (GLOW_RADIANCE, GLOW_SHARPNESS)):
        radiance = radiance + above * np.array(color) * np.exp(sharpness * toward)
    return np.asarray(radiance, np.float32)
