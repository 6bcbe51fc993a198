"""Right answers to the generated questions, computed with the solution."""

import numpy as np


def derivative_of_max_product(reference, a, x, y):
    """d/dx of max(a x, y) x + log y."""

    def f(leaves):
        first, second = leaves
        return (first * a).maximum(second) * first + second.log()

    return float(reference.value_and_gradient(f, [x, y])[1][0])


def contributions(reference, k):
    """Uses recorded by k rounds of y = y * x + y."""
    y, x = reference.Value(1.0), reference.Value(2.0)
    for _ in range(int(k)):
        y = y * x + y
    return float(sum(len(node.inputs) for node in reference.topo_order(y)))


def error_of_a_factor(reference, c):
    """What grad_check says of a gradient c times too long."""

    def f(x):
        return float(x @ x), c * 2.0 * np.asarray(x)

    return round(reference.grad_check(f, np.array([1.0, -2.0, 0.5])), 8)
