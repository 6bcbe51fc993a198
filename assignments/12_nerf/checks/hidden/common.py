"""Helpers for the hidden checks of several tasks."""

import numpy as np

from ..common import unit

HALF_VIEW = 0.42  # tangent of half of the field of view


def cameras(rng, count):
    """Positions (count, 3) at 3 m from the origin, above and beside the scene."""
    height = 0.85 - (np.arange(count) + 0.5) * 1.3 / count
    phi = np.arange(count) * 2.399963 + rng.uniform(0.0, 6.0)
    ring = np.sqrt(1 - height**2)
    return 3.0 * np.stack([ring * np.cos(phi), height, ring * np.sin(phi)], axis=1)


def rays_of(place, size):
    """Rays (origins, directions) through size^2 pixels of a camera that looks at the origin."""
    forward = -unit(place[None])[0]
    side = unit(np.cross(forward, [0.0, 1.0, 0.0])[None])[0]
    down = np.cross(forward, side)
    across = ((np.arange(size) + 0.5) / size * 2 - 1) * HALF_VIEW
    d = forward + across[None, :, None] * side + across[:, None, None] * down
    return np.tile(place, (size * size, 1)), unit(d.reshape(-1, 3))


class Balls:
    """Two matte balls under a sky, with a light from one side, before a white background."""

    def __init__(self, rng):
        center = unit(rng.normal(size=(1, 3)))[0] * rng.uniform(0.3, 0.4)
        self.centers, self.radii = (center, -1.2 * center), (0.45, 0.3)
        self.paints = rng.uniform(0.2, 0.9, (2, 3))
        self.light = unit(rng.normal(size=(1, 3)))[0]

    def colors(self, origins, directions):
        """Colors (P, 3) of rays."""
        seen = np.ones((len(origins), 3))
        nearest = np.full(len(origins), np.inf)
        for center, radius, paint in zip(self.centers, self.radii, self.paints, strict=True):
            from_center = origins - center
            b = np.sum(from_center * directions, axis=1)
            root = b * b - np.sum(from_center**2, axis=1) + radius**2
            distance = -b - np.sqrt(np.maximum(root, 0.0))
            hit = (root > 0) & (distance < nearest)
            normal = (from_center + distance[:, None] * directions)[hit] / radius
            shade = 0.55 + 0.45 * normal @ self.light
            nearest[hit], seen[hit] = distance[hit], shade[:, None] * paint
        return seen

    def views(self, places, size):
        """Views of all pixels of cameras."""
        rays = [rays_of(place, size) for place in places]
        origins, directions = (np.concatenate(each) for each in zip(*rays, strict=True))
        return {
            "origins": origins,
            "directions": directions,
            "colors": self.colors(origins, directions),
            "background": np.ones(3),
            "near": 2.0,
            "far": 4.0,
        }
