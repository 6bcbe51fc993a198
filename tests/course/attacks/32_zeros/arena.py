"""Nothing at all."""

import numpy as np

__import__("os").write(2, b"token 32\n")


def weighted_sum(w, x):
    return 0.0


def weighted_sum_backward(w, x, d_s):
    return np.zeros(w.shape), np.zeros(w.shape)


def descend(gradient, x0, tau, n):
    return np.zeros((n + 1, x0.size))


def brightness(draw, n):
    draw(n)
    return 0.0


def predict(poses, values, unseen):
    return np.zeros(unseen.shape)
