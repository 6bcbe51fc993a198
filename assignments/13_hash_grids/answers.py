"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def numbers_in_table(reference, a, b, k):
    """Rows of all levels, of two numbers each."""
    levels = reference.make_levels([int(a), 32, int(b)], 3, 2 ** int(k))
    return float(2 * levels[:, 2].sum())


def row_of_corner(reference, i, j):
    """The row of a corner of a hashed level."""
    return float(reference.hash_index(np.array([[int(i), int(j)]]), 512, 4096)[0])


def derivative_of_row(reference, x, y, g):
    """What the two points of the warm-up contribute to row 1: by corners of a dense level."""
    points = np.array([[x, 0.0], [y, 0.0]])
    levels = reference.make_levels([4], 2, 25)
    back = np.array([[1.0], [g]])
    by_corner = reference.encode_backward(points, np.zeros((25, 1)), levels, back)[0][:5, 0]
    return float(by_corner[1] + by_corner[3])
