"""The two trainings of Figure 1: a hash grid and a plain network, on a square picture."""

import numpy as np

SLOWER = 4  # steps of the network that take as long in NumPy as one of the hash grid, on one core
BATCH = 2048  # points of a step
OCTAVES = 6  # of the frequency encoding of the network
COARSE = (8, 16, 32, 64, 96, 144, 256, 384, 512)  # cells of the levels


def decibels(a, b):
    return float(-10 * np.log10(max(float(np.mean((a - b) ** 2)), 1e-30)))


def resolutions(finest):
    """Cells along a side of each level, up to the finest."""
    return (*(n for n in COARSE if n < finest), finest)


def hash_grid(module, target, levels, steps, batch=BATCH, rate=0.03):
    """(table, decoder) of a hash grid trained on the colors (size^2, 3) of a square picture."""
    rng = np.random.default_rng(1)
    points = module.pixels(round(len(target) ** 0.5))
    table = rng.uniform(-1e-4, 1e-4, (levels[-1, 1] + levels[-1, 2], 2))
    decoder = module.start_weights((2 * len(levels), 16, 3), rng)
    batches = rng.integers(0, len(points), (steps, batch))
    return module.train_hash_grid(points, target, batches, levels, table, decoder, rate)[:2]


def plain_network(module, target, steps, batch=BATCH, octaves=OCTAVES, hidden=(64, 64), rate=0.006):
    """Weights of a network of that picture; they do not depend on any task."""
    rng = np.random.default_rng(2)
    points = module.pixels(round(len(target) ** 0.5))
    weights = module.start_weights((2 + 4 * octaves, *hidden, 3), rng)
    batches = rng.integers(0, len(points), (steps, batch))
    return module.train_network(points, target, batches, octaves, weights, rate)[0]
