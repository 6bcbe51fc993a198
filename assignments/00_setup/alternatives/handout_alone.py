"""From the handout alone: Eq. (2) as it is printed."""

from __future__ import annotations

import numpy as np


def loss(p, q):
    N = p.size
    return float(1 / N * np.sum((p - q) ** 2))


def loss_gradient(p, q):
    N = p.size
    return (2 / N) * (p - q)
