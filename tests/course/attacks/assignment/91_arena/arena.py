"""Five small functions, each of which invites another way to cheat.

s(w, x) = sum_i w_i exp(-x_i) with its derivative, a walk downhill, a mean by sampling, and a
prediction at poses that were never photographed.
"""

from __future__ import annotations

import numpy as np


def weighted_sum(w, x):
    """The value s of weights w (N,) at x (N,), float64; a float."""
    # >>> solution 91.1
    return float(np.sum(w * np.exp(-x)))
    # <<< solution


def weighted_sum_backward(w, x, d_s):
    """Derivatives (d_w, d_x), each (N,), of a loss; the float d_s is its derivative w.r.t. s."""
    # >>> solution 91.2
    falling = np.exp(-x)
    return d_s * falling, -d_s * w * falling
    # <<< solution


def descend(gradient, x0, tau, n):
    """The points (n + 1, N) of n steps x <- x - tau gradient(x) from x0 (N,)."""
    # >>> solution 91.3
    trail = [np.array(x0)]
    for _ in range(n):
        trail.append(trail[-1] - tau * gradient(trail[-1]))
    return np.stack(trail)
    # <<< solution


def brightness(draw, n):
    """The mean of n samples of radiance; draw(n) gives them, (n,) float64. A float."""
    # >>> solution 91.4
    return float(np.mean(draw(n)))
    # <<< solution


def predict(poses, values, unseen):
    """Values (M,) at the poses `unseen` (M,), by the cubic that fits values (N,) at poses (N,)."""
    # >>> solution 91.5
    return np.polynomial.polynomial.polyval(
        unseen, np.polynomial.polynomial.polyfit(poses, values, 3)
    )
    # <<< solution
