"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def weight_in_perspective(reference, a, b, s):
    """Of the second corner, by a triangle whose lower edge passes through the pixel."""
    start = 0.5 - 8.0 * s
    flat = [[start, 0.5], [start + 8.0, 0.5], [start, 8.5]]
    corners = np.column_stack([flat, [float(a), float(b), 3.0]])
    return float(reference.rasterize(corners[None], 1, 1)[1][0, 0, 1])


def shown_gray(reference, c, e, w):
    """Of one gray pixel."""
    gray = np.full((1, 1, 3), float(c))
    return float(reference.tone_map(gray, np.array([float(e), float(w)]), 0 * gray)[0][0, 0, 0])


def slope_by_the_radius(reference, d, h):
    """Of one pixel and one sample: the derivative with respect to the first setting."""
    # Two pixels side by side, 1 m away; the normal is turned until the other is h above it.
    depth = np.array([[1.0, 1.0]])
    focal = 1 / d
    normals = np.zeros((1, 2, 3))
    normals[..., 0], normals[..., 2] = h / d, -np.sqrt(1 - (h / d) ** 2)
    offsets = np.zeros((1, 2, 1, 2))
    offsets[0, 0, 0, 0] = 1.0 / (reference.REACH * focal)
    settings, first = np.array([1.0, 2.0, 1.0]), np.array([[1.0, 0.0]])
    return float(reference.ambient_occlusion(depth, normals, focal, offsets, settings, first)[1][0])
