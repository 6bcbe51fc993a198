"""Between the checks and your `plenoxels.py`: calls in a row, and what cannot be seen from outside.

Runs beside your file; nothing here is to be changed or handed in. Arrays reach your functions as
copies, so only somebody who stands beside them sees whether they were written to.
"""

from __future__ import annotations

import numpy as np
import plenoxels


def gradient(density, coefficients, rays, target):
    """(loss, d_density, d_coefficients) for a grid: `march`, then `loss_and_grad`."""
    samples = plenoxels.march(density.shape, rays)
    return plenoxels.loss_and_grad(density, coefficients, samples, target)


def fit_leaves_start(density, coefficients, rays, target):
    """Whether `fit_plenoxels` leaves the arrays as they were where it starts."""
    before = density.copy(), coefficients.copy()
    plenoxels.fit_plenoxels(density, coefficients, rays, target, 2, 2)
    same = np.array_equal(before[0], density) and np.array_equal(before[1], coefficients)
    return bool(same)
