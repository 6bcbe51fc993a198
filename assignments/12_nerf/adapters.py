"""Between the checks and your `nerf.py`: calls in a row, and generators of random numbers.

Runs beside your file; do not change or submit it. Your functions are asked through `nerf`, where
the grader may put its own instead of a wrong one.
"""

import engine
import nerf as yours
import numpy as np


def backward_of(layers, x, g):
    """(d_layers, d_x) by `mlp_backward`, for the activations of the given `mlp_forward`."""
    return yours.mlp_backward(layers, yours.mlp_forward(layers, x), g)


def small_graph(a, b):
    """Gradients (2,) of max(a b, 0) + a a by your engine of assignment 02."""
    x, y = engine.Value(a), engine.Value(b)
    engine.backward((x * y).maximum(0.0) + x * x)
    return np.array([x.grad, y.grad])


def fitted_picture(picture, bands, steps, seed):
    """The picture that `fit_picture` reaches with your encoding and your backward pass."""
    return yours.fit_picture(picture, bands, steps, np.random.default_rng(seed))[0]


def drawn(views, seed, times):
    """What `draw` gives in so many steps in a row: a list of (chosen, u, v)."""
    rng = np.random.default_rng(seed)
    return [yours.draw(views, rng) for _ in range(times)]


def train(views, network, steps, seed):
    """`train_nerf` with a generator of this seed."""
    return yours.train_nerf(views, network, steps, np.random.default_rng(seed))


def train_again(views, network, steps, seed):
    """The second of two trainings from the same network; what the first gave is overwritten."""
    for layers in train(views, network, steps, seed)[0].values():
        for array in layers:
            array[...] = 0.0
    return train(views, network, steps, seed)
