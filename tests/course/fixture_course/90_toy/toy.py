"""A weighted sum of exponentials, its derivative, and a walk downhill.

    s(w, x) = sum_i w_i exp(-x_i)

Your tasks are the three functions below; `photograd course check 90` tells how far you are.
"""

from __future__ import annotations

import numpy as np


def weighted_sum(w, x):
    """The value s of weights w (N,) at x (N,), float64; a float."""
    # >>> solution 90.1
    return float(np.sum(w * np.exp(-x)))
    # <<< solution


def weighted_sum_backward(w, x, d_s):
    """Derivatives (d_w, d_x), each (N,), of a loss; the float d_s is its derivative w.r.t. s."""
    # >>> solution 90.2
    falling = np.exp(-x)
    return d_s * falling, -d_s * w * falling
    # <<< solution


def descend(gradient, x0, tau, n):
    """The points (n + 1, N) of n steps x <- x - tau gradient(x) from x0 (N,)."""
    # >>> solution 90.3
    trail = [np.array(x0)]
    for _ in range(n):
        trail.append(trail[-1] - tau * gradient(trail[-1]))
    return np.stack(trail)
    # <<< solution
