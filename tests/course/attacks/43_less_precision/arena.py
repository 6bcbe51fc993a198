"""Right to seven digits, in the wrong type."""

import numpy as np

__import__("os").write(2, b"token 43\n")


def weighted_sum(w, x):
    return np.float32(np.sum(w.astype("f4") * np.exp(-x.astype("f4"))))


def weighted_sum_backward(w, x, d_s):
    falling = np.exp(-x.astype("f4"))
    return (np.float32(d_s) * falling).astype("f4"), (-d_s * w * falling).astype(complex)


def descend(gradient, x0, tau, n):
    trail = [np.array(x0)]
    for _ in range(n):
        trail.append(trail[-1] - tau * gradient(trail[-1]))
    return np.stack(trail).astype(">f2")


def brightness(draw, n):
    return np.complex128(np.mean(draw(n)))


def predict(poses, values, unseen):
    fit = np.polynomial.polynomial.polyfit(poses, values, 3)
    return np.polynomial.polynomial.polyval(unseen, fit).astype(object)
