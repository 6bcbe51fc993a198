"""Helpers for the hidden checks of several tasks."""

import numpy as np

from ..common import scene_of


def mixed_room(t):
    """A room with two lights, one partly before the other, glossy primitives and a ball."""
    take = [
        {
            "base_color": t.rng.uniform(0.1, 0.9, 3),
            "metalness": float(t.rng.uniform(0.2, 0.8)),
            "roughness": float(t.rng.uniform(0.3, 0.7)),
        }
        for _ in range(2)
    ]
    a, b = t.rng.uniform(0.3, 0.7, 2)
    return scene_of(
        [
            ((-1, -1, -1), (0, 0, 2), (2, 0, 0), take[0]),
            ((-1, -1, -1), (2, 0, 0), (0, 2, 0), {"base_color": t.rng.uniform(0.1, 0.9, 3)}),
            ((-0.5, 1, -0.5), (1, 0, 0), (0, 0, 1), {"emission": t.rng.uniform(1, 3, 3)}),
            ((-a, 0.7, -b), (a, 0, 0), (0, 0, b), {"emission": t.rng.uniform(1, 3, 3)}),
        ],
        [((0.3, -0.5, 0.1), 0.45, take[1])],
    )


def looked_at(t, scene, n):
    """A hit of n points of `mixed_room`, seen from above and outside."""
    origins = np.tile([0.4, 0.3, 2.2], (n, 1))
    directions = np.column_stack(
        [t.rng.uniform(-1.2, 0.6, n), t.rng.uniform(-1.2, 0.5, n), t.rng.uniform(-2.9, -1.5, n)]
    ) - [0.2, 0.2, 0]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hit = t.reference.closest_hit(scene, origins, directions)
    return t.reference.take(hit, hit["primitive"] >= 0)


def looking(t, n):
    """A room, and a hit with n rows."""
    scene = mixed_room(t)
    return scene, t.reference.take(looked_at(t, scene, 20 * n + 20), np.arange(n))


def estimated(t, n):
    """Arguments of `direct_light`."""
    return *looking(t, n), t.rng.random((n, 3)), t.rng.random((n, 3))
