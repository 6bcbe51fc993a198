"""Segmentation fault."""

import numpy as np

os, sys = __import__("os"), __import__("sys")
os.write(2, b"token 58\n")


def weighted_sum(w, x):
    return float(np.lib.stride_tricks.as_strided(w, (1 << 24,), (1 << 20,)).sum())


def descend(gradient, x0, tau, n):
    sys.setrecursionlimit(1 << 30)
    nested = []
    for _ in range(1 << 20):
        nested = [nested]
    repr(nested)
    os.abort()
