"""Between the checks and your `sparse_grids.py`: calls in a row, and what cannot be seen outside.

Runs beside your file; nothing here is to be changed or handed in. Arrays reach your functions as
copies, so only somebody who stands beside them sees whether they were written to.
"""

from __future__ import annotations

import numpy as np
import sparse_grids as grids


def _table(voxels):
    empty = grids.new_table(len(voxels))
    return grids.voxel_hash_insert(empty, voxels, np.arange(len(voxels)))


def picture(n, voxels, values, rays):
    """(colours, wanted, step) of rays through a sparse grid: `march`, then `render`."""
    samples = grids.march(n, voxels, _table(voxels), rays)
    return grids.render(values, samples), samples[0], samples[1]


def gradient(n, voxels, values, rays, target):
    """(loss, d_values) of a sparse grid: `march`, then `loss_and_grad`."""
    return grids.loss_and_grad(values, grids.march(n, voxels, _table(voxels), rays), target)


def next_start(n, voxels, values, rays, threshold, grow):
    """(voxels, rows) that follow on these: what `prune_and_dilate` makes of their shares.

    rows are those that the new voxels had before, -1 for new ones; as lists, for nobody knows how
    many there are.
    """
    table = _table(voxels)
    row, share = grids.shares(values, grids.march(n, voxels, table, rays))
    found = grids.prune_and_dilate(n, voxels, row, share, threshold, grow)
    return found, grids.voxel_hash_find(table, found)


def fit_leaves_start(n, voxels, values, rays, target):
    """Whether `fit_sparse` leaves the arrays as they were where it starts."""
    before = voxels.copy(), values.copy()
    grids.fit_sparse(n, voxels, values, rays, target, 2, 2, 0.01, 1)
    return bool(np.array_equal(before[0], voxels) and np.array_equal(before[1], values))


def table_left_alone(table, voxels, rows):
    """Whether `voxel_hash_insert` leaves the table that it was given as it was."""
    before = table.copy()
    grids.voxel_hash_insert(table, voxels, rows)
    return bool(np.array_equal(before, table))
