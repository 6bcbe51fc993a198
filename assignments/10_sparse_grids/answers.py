"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def nodes_of_cells(reference, n, k):
    """Nodes of the octree of k cells in as many octants."""
    full = np.zeros((int(n), int(n), int(n)), bool)
    for octant in list(np.ndindex(2, 2, 2))[: int(k)]:
        full[tuple(n // 2 * upper for upper in octant)] = True
    return float(len(reference.octree_from_dense(full)))


def slope_of_the_gap(reference, a, c):
    """Derivative of the loss of the warm-up with respect to the extinction of the absent step."""
    values = np.array([[0.2] * 3 + [a], [c] * 3 + [0.0], [0.8] * 3 + [2.0]])
    row = np.array([[0, 1, 2]])
    samples = np.ones((1, 3), bool), np.array([0.5]), row, np.ones((1, 3))
    # Three equal channels, whose mean the loss is.
    return float(reference.loss_and_grad(values, samples, np.full((1, 3), 0.6))[1][1, 3])


def voxels_after_growth(reference, i, j, s):
    """How many voxels one brings along."""
    one, alone = np.array([[int(i), int(j), 7]]), np.zeros((1, 1), np.int64)
    return float(len(reference.prune_and_dilate(16, one, alone, np.ones((1, 1)), 0.0, int(s))))
