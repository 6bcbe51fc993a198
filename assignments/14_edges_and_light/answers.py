"""Right answers to the generated questions, worked out with the solution."""

import numpy as np


def length_in_the_pixel(reference, degrees, offset):
    """By the solution."""
    angle = np.radians([float(degrees)])
    return float(reference.edge_coverage(angle, np.array([float(offset)]))[1][0])


def derivative_of_a_side(reference, side, inside, outside, weight):
    """Both vertices of one side of a square move outward."""
    square = 2 + float(side) * np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    d = reference.edge_sampling_backward(
        square,
        lambda points: np.full((len(points), 1), float(inside)),
        lambda points: np.full((len(points), 1), float(outside)),
        np.full((16, 16, 1), float(weight)),
        (np.arange(4000) + 0.5) / 4000,
    )
    return float(d[1, 0] + d[2, 0])


def derivative_of_a_furnace(reference, albedo, depth):
    """A geometric series, term by term."""
    del reference
    return float(sum(k * albedo ** (k - 1) for k in range(1, int(depth))))
