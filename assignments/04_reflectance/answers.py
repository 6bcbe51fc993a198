"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def balanced_roughness(reference, c):
    """Where Burley's white returns exactly what came, by halving."""
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2

        def f(wo, wi, r=middle):
            return reference.burley_diffuse(wo, wi, 1.0, r)

        more = reference.furnace(f, np.array([c]))[0, 0] > 1
        low, high = (low, middle) if more else (middle, high)
    return float(low)


def printed_albedo(reference, s, c):
    """The albedo of Cook and Torrance's model with the printed constants."""

    def f(wo, wi):
        return reference.cook_torrance(wo, wi, 1.0, s, printed=True)

    return float(reference.furnace(f, np.array([c]))[0, 0])


def albedo_slope(reference, r, c):
    """Derivative of a white metal's albedo with respect to its roughness."""

    def slope(wo, wi):
        n = len(wo)
        white, ones = np.ones((n, 3)), np.ones(n)
        d_f = np.full((n, 3), 1 / 3)
        return reference.gltf_backward(wo, wi, white, ones, r * ones, d_f)[2][:, None]

    return float(reference.furnace(slope, np.array([c]))[0, 0])
