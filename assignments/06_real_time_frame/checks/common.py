"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Tolerance
from photograd_course.grading.generators import random_rotation, unit_vectors

# Evidence: worst of the solution and the alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(1e-10, "right ones differ by 1e-13, wrong ones by 1e-4 or more")
FAITHFUL = Tolerance(1e-12, "numbers that are handed on unchanged, and sums of a few hundred")
GATE = Tolerance(1e-6, "central differences of smooth functions leave 1e-8, wrong ones 1e-2")


def pose_of(rng):
    """A camera (3, 4) anywhere."""
    return np.concatenate([random_rotation(rng), rng.uniform(-2.0, 2.0, (3, 1))], axis=1)


def rays_of(height, width, focal):
    """Points (H, W, 3) of depth 1 at the centers of pixels, in the camera's frame."""
    y, x = np.meshgrid(np.arange(height) + 0.5, np.arange(width) + 0.5, indexing="ij")
    return np.stack([(x - width / 2) / focal, (y - height / 2) / focal, np.ones_like(x)], axis=2)


def snapped(rng, low, high, size, step=256):
    """Random multiples of 1 / step."""
    return rng.integers(low * step, high * step, size) / step


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def gbuffer_of(rng, height, width, focal):
    """A random G-buffer; normals face the camera, everything is seen."""
    shape = height, width
    toward = -unit(rays_of(height, width, focal))
    return {
        "depth": rng.uniform(2.0, 6.0, shape),
        "normal": unit(toward + 0.7 * unit_vectors(rng, height * width).reshape(*shape, 3)),
        "base_color": rng.uniform(0.05, 0.95, (*shape, 3)),
        "emission": rng.uniform(0.0, 2.0, (*shape, 3)),
        "metalness": rng.uniform(0.0, 1.0, shape),
        "roughness": rng.uniform(0.3, 0.9, shape),
        "alpha": rng.uniform(0.2, 0.9, shape),
    }


def lights_of(rng, pose):
    """Lights whose sun is behind the camera, more or less."""
    behind = -pose[:, 2] + 0.6 * unit_vectors(rng, 1)[0]
    return {
        "to_sun": unit(behind),
        "sun": rng.uniform(1.0, 5.0, 3),
        "sky": rng.uniform(0.2, 1.0, 3),
    }
