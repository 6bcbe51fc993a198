"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def derivative_of_the_last_sine(reference, bands, x):
    """With respect to x."""
    return float(reference.positional_encoding(np.array([[float(x)]]), int(bands))[1][0, -2])


def numbers_of_an_mlp(reference, n, w, m):
    """Weights and biases."""
    sizes = [int(n), int(w), int(w), int(m)]
    layers = reference.make_layers(sizes, np.random.default_rng(0))
    return float(sum(array.size for array in layers))


def distance_of_a_number(reference, a, b, v):
    """By one sample, whose number is u itself."""
    edges, weights = np.array([[2.0, 3.0, 6.0]]), np.array([[float(a), float(b)]])
    return float(reference.sample_distances(edges, weights, np.array([[float(v)]]))[0, 0])
