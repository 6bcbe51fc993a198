"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def weight_of_the_third(reference, a, b, c):
    """The pixel of three steps of which the third alone is white."""
    color = np.array([0.0, 0.0, 1.0])[None, :, None]
    steps = np.full((1, 3), 0.5)
    return float(reference.composite(np.array([[a, b, c]]), color, steps, np.zeros(1))[0][0, 0])


def slope_of_one_step(reference, s, dt, c, b):
    """The derivative of one step's pixel with respect to its extinction."""
    given = (np.array([[s]]), np.array([[[c]]]), np.array([[dt]]), np.array([b]))
    return float(reference.composite_adjoint(*given, np.ones((1, 1)), np.zeros(1))[0][0, 0])


def meters_in_the_box(reference, y, dx, dy):
    """The length of a ray's stretch within a box."""
    box = np.zeros(3), np.array([4.0, 2.0, 3.0])
    near, far = reference.ray_box(*box, np.array([[-1.0, y, 1.0]]), np.array([[dx, dy, 0.0]]))
    return float((far - near)[0] * np.hypot(dx, dy))
