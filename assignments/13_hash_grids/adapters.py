"""Between the checks and your `hash_grids.py`: calls in a row.

Runs beside your file; do not change or submit it. Arrays reach your functions as
copies. A second call shows whether one was changed.
"""

import hash_grids as grids
import numpy as np


def derivatives(points, target, levels, table, weights):
    """(loss, d_table, d_weights) of one batch: encode, decode, and back."""
    encoded = grids.encode(points, table, levels)
    answer = grids.network_loss_and_grad(weights, encoded, target)
    d_table = grids.encode_backward(points, table, levels, answer[2])[0]
    return answer[0], d_table, answer[1]


def kept_by_adam(table, d_table, m, v, k, rate):
    """1.0 for each of the four arrays that `adam_rows` leaves as it was, 0.0 for the others."""
    given = table, d_table, m, v
    before = [array.copy() for array in given]
    grids.adam_rows(*given, k, rate)
    return np.array([float(np.array_equal(a, b)) for a, b in zip(given, before, strict=True)])


def train_again(*given):
    """Result of `train_hash_grid` for the same arrays the second time."""
    grids.train_hash_grid(*given)
    return grids.train_hash_grid(*given)
