"""Wrong on purpose."""

import numpy as np

__import__("os").write(2, b"token 11\n")


def weighted_sum(w, x):
    return 0.5


def weighted_sum_backward(w, x, d_s):
    return np.full(w.shape, 0.5), np.full(w.shape, 0.5)


def brightness(draw, n):
    draw(n)
    return 0.5


def predict(poses, values, unseen):
    return np.full(unseen.shape, 0.5)
