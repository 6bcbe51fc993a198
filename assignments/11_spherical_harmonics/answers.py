"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def irradiance_upwards(reference, a, b, c):
    """Irradiance on a surface that faces +z."""
    light = np.zeros((1, 1, 1, 9, 1))
    light[0, 0, 0, [0, 2, 6], 0] = a, b, c
    up = np.array([[0.0, 0.0, 1.0]])
    return float(reference.probe_irradiance(light, np.zeros((1, 3)), up)[0, 0])


def mebibytes(reference, n, d):
    """Size of a grid with a density and three sets of coefficients a cell."""
    coefficients = reference.sh_basis(np.array([[0.0, 0.0, 1.0]]), int(d)).shape[1]
    return n**3 * (1 + 3 * coefficients) * 4 / 2**20


def turned_around_z(reference, a, b, t):
    """Coefficient 3 after a rotation by t degrees around z."""
    angle = np.radians(t)
    R = np.eye(3)
    R[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return float(reference.sh_rotate(np.array([[0.0], [a], [0.0], [b]]), R)[3, 0])
