"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def slope_by_radius(reference, x, y):
    """The derivative of t with respect to the radius of a sphere-traced ball."""

    def ball(places):
        away = np.linalg.norm(places, axis=1)
        return away - 1.0, places / away[:, None], -np.ones(len(places))

    origin, direction = np.array([[x, y, 0.0]]), np.array([[-1.0, 0.0, 0.0]])
    return float(reference.march_sdf(ball, origin, direction, 10.0, 10_000)[1][0])


def angle_behind(reference, eta, angle):
    """The angle with the normal, in degrees, after light has hit a surface from inside."""
    a = np.radians(angle)
    direction, normal = np.array([[np.sin(a), 0.0, np.cos(a)]]), np.array([[0.0, 0.0, 1.0]])
    out, _ = reference.refract(direction, normal, float(eta))
    return float(np.degrees(np.arctan2(abs(out[0, 0]), abs(out[0, 2]))))


def nodes_of_tree(reference, primitives):
    """How many nodes hold so many primitives."""
    low = np.random.default_rng(5).random((int(primitives), 3))
    return float(len(reference.build_bvh(low, low + 0.1)[0]))
