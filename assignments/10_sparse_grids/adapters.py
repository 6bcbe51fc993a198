"""Between the checks and your `sparse_grids.py`: calls in a row.

Runs beside your file; do not change or submit it. Arrays reach your functions as
copies. A second call shows whether one was changed.
"""

import sparse_grids as grids


def picture(n, voxels, values, rays):
    """(colors, wanted, step) of rays through a sparse grid: `march`, then `render`."""
    samples = grids.march(n, voxels, rays)
    return grids.render(values, samples), samples[0], samples[1]


def gradient(n, voxels, values, rays, target):
    """(loss, d_values) of a sparse grid: `march`, then `loss_and_grad`."""
    return grids.loss_and_grad(values, grids.march(n, voxels, rays), target)


def next_start(n, voxels, values, rays, threshold, grow):
    """(voxels, rows) that follow on these: what `prune_and_dilate` makes of their shares.

    rows are the old rows of the new voxels, -1 for new ones; lists, of unknown length.
    """
    row, share = grids.shares(values, grids.march(n, voxels, rays))
    found = grids.prune_and_dilate(n, voxels, row, share, threshold, grow)
    return found, grids.find_rows(grids.row_table(n, voxels), found)


def fit_again(*given):
    """Result of `fit_sparse` for the same arrays the second time."""
    grids.fit_sparse(*given)
    return grids.fit_sparse(*given)
