"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def _camera(f, center, width):
    return {
        "camera_from_world": np.eye(4)[:3],
        "focal": np.full(2, float(f)),
        "center": np.array([center, 0.5 * width]),
        "width": width,
        "height": width,
    }


def variance_of_a_ball(reference, s, z, f):
    """xx of the splat of a ball straight ahead, low-pass included."""
    camera = _camera(f, 50.0, 100)
    mean, cov = np.array([[0.0, 0.0, float(z)]]), s**2 * np.eye(3)[None]
    return float(reference.project(mean, cov, camera)[1][0, 0]) + reference.LOW_PASS


def slope_of_the_held_entry(reference, h, f, z):
    """d J_xz / d t_z right of the limit, by finite differences of a needle along the axis."""
    width = 100
    camera = _camera(f, (1 + reference.MARGIN) * width - h * f, width)
    needle, entries = np.diag([0.0, 0.0, 1.0])[None], []
    for depth in (z - 1e-4, z + 1e-4):
        mean = np.array([[3 * h * z, 0.0, depth]])
        entries.append(-np.sqrt(reference.project(mean, needle, camera)[1][0, 0]))
    return float((entries[1] - entries[0]) / 2e-4)


def slope_of_the_first_alpha(reference, a, b):
    """The derivative of a pixel with respect to the alpha of the nearer of two splats."""
    colors, depth = np.array([[1.0] * 3, [0.5] * 3]), np.array([1.0, 2.0])
    _, back = reference.composite_splats(np.array([[a], [b]]), colors, depth, np.full(3, 0.2))
    return float(back(np.array([[1.0, 0.0, 0.0]]))[0][0, 0])
