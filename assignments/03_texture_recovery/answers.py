"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def sample_of_a_plane(reference, a, b, u, v):
    """A sample of a i + b j, 5 rows and 7 columns."""
    i, j = np.mgrid[0:5, 0:7]
    return float(reference.bilinear_sample((a * i + b * j)[:, :, None], np.array([[u, v]]))[0, 0])


def curvature_of_two_spots(reference, m, k):
    """The estimate after two iterations for m samples at one center and k at another."""
    spots = np.array([[0.125, 0.25], [0.625, 0.75]])  # of columns 0 and 2, rows 1 and 4
    return reference.largest_curvature((6, 4), np.repeat(spots, [int(m), int(k)], axis=0), 2)


def texel_after_steps(reference, t, n):
    """A texel measured as 0 at its center, after n steps."""
    texture, place = np.full((1, 1, 1), float(t)), np.array([[0.5, 0.5]])
    return float(reference.recover_texture(texture, place, np.zeros((1, 1)), int(n))[0][0, 0, 0])
