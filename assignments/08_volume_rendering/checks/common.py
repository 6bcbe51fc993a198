"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance

# Evidence: worst of the solution and four alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(
    1e-12, "right ones differ by at most 8e-15, the nearest wrong one (product_of_rests) by 8e-11"
)
GATE = Tolerance(
    1e-6, "finite differences leave 1e-10, the nearest wrong one (adjoint_inclusive) 1.7e-4"
)


def seen(rays, channels):
    """Result of `composite`."""
    return Items(Array((rays, channels)), Array((rays,)), names=("pixel", "T_end"))


def random_rays(t, rays=3, steps=6, channels=3, thick=1.5):
    """Rays whose steps all differ, not one of them opaque: sigma, color, dt, background."""
    sigma = t.rng.uniform(0.1, thick, (rays, steps)) * 4.0
    color = t.rng.uniform(0.0, 1.0, (rays, steps, channels))
    dt = t.rng.uniform(0.1, 0.3, (rays, steps))
    return sigma, color, dt, t.rng.uniform(0.2, 1.0, channels)


def random_box(t):
    """Two opposite corners of a box that is no cube and not at the origin."""
    low = t.rng.uniform(-2.0, -0.5, 3)
    return low, low + t.rng.uniform(0.5, 3.0, 3)


def between_centers(t, shape, n):
    """Random points (n, 3) that no border touches."""
    rim = 0.5 / np.array(shape)
    return t.rng.uniform(rim, 1 - rim, (n, 3))
