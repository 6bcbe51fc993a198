"""Reverse-mode differentiation on a graph of scalars.

A `Value` is a number together with the values from which it was computed, and the local derivative
of each use (the derivative of the result with respect to that input, at the current numbers).
`backward` goes from the result to the inputs and applies the chain rule.

Your tasks are the functions that raise NotImplementedError; `photograd course check 02` tells how
far you are. Equations are those of the handout.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Vector = Annotated[np.ndarray, "N"]


class Value:
    """A number in a graph.

    Attributes:
        data: the number, a float.
        grad: derivative of the root with respect to this number; set by `backward`.
        inputs: pairs (value, local derivative), one for each use of an input; () for a leaf.
    """

    def __init__(self, data, inputs=()):
        self.data = float(data)
        self.grad = 0.0
        self.inputs = inputs

    def __add__(self, other: Value | float) -> Value:
        """self + other; `other` may be a plain number. Eq. (5)."""
        other = as_value(other)
        # >>> solution 02.1
        return Value(self.data + other.data, ((self, 1.0), (other, 1.0)))
        # <<< solution

    def __mul__(self, other: Value | float) -> Value:
        """self * other; `other` may be a plain number. Eq. (6)."""
        other = as_value(other)
        # >>> solution 02.1
        return Value(self.data * other.data, ((self, other.data), (other, self.data)))
        # <<< solution

    def maximum(self, other: Value | float) -> Value:
        """The larger of self and other; at a tie `other` gets the derivative. Eq. (7)."""
        other = as_value(other)
        # >>> solution 02.2
        wins = 1.0 if self.data > other.data else 0.0
        larger = self.data if wins else other.data
        return Value(larger, ((self, wins), (other, 1.0 - wins)))
        # <<< solution

    def exp(self) -> Value:
        """The exponential of self. Eq. (8)."""
        # >>> solution 02.3
        grown = math.exp(self.data)
        return Value(grown, ((self, grown),))
        # <<< solution

    def log(self) -> Value:
        """The natural logarithm of self, which must be positive. Eq. (9)."""
        # >>> solution 02.3
        return Value(math.log(self.data), ((self, 1.0 / self.data),))
        # <<< solution

    def __pow__(self, n: float) -> Value:
        """self to the power of a plain number n, which is no input of the graph. Eq. (10)."""
        # >>> solution 02.3
        return Value(self.data**n, ((self, n * self.data ** (n - 1)),))
        # <<< solution

    def __truediv__(self, other):
        """self / other: the worked example of the handout, Eq. (4). Nothing to do here."""
        other = as_value(other)
        quotient = self.data / other.data
        d_self, d_other = 1.0 / other.data, -quotient / other.data
        return Value(quotient, ((self, d_self), (other, d_other)))

    # Composed of the other gates.

    def __radd__(self, other):
        return self + other

    def __rmul__(self, other):
        return self * other

    def __neg__(self):
        return self * -1.0

    def __sub__(self, other):
        return self + as_value(other) * -1.0

    def __rsub__(self, other):
        return as_value(other) - self

    def __rtruediv__(self, other):
        return as_value(other) / self

    def __repr__(self):
        return f"Value({self.data:g}, grad={self.grad:g})"


def as_value(number):
    """A `Value` as it is; a plain number as a new leaf."""
    return number if isinstance(number, Value) else Value(number)


def topo_order(root: Value) -> list[Value]:
    """A topological order of the values that `root` depends on: inputs precede their users.

    Args:
        root: a `Value`.

    Returns:
        A list of each value once, `root` last. The time is proportional to the number of values and
        uses, and the depth of the graph is not limited.
    """
    # >>> solution 02.4
    order, seen = [], set()
    stack = [(root, False)]
    while stack:
        node, inputs_done = stack.pop()
        if inputs_done:
            order.append(node)
        elif node not in seen:
            seen.add(node)
            stack.append((node, True))
            for source, _ in node.inputs:
                stack.append((source, False))
    return order
    # <<< solution


def backward(root: Value, seed: float = 1.0) -> None:
    """Set `grad` of every value that `root` depends on to seed * d root / d value. Eq. (13).

    Each call first sets the gradients of these values to zero. Values that `root` does not depend
    on do not change.

    Args:
        root: a `Value`, the end of the graph.
        seed: the gradient of the root: 1, or that of a larger computation that uses the root.
    """
    # >>> solution 02.5
    order = topo_order(root)
    for node in order:
        node.grad = 0.0
    root.grad = float(seed)
    for node in reversed(order):
        for source, slope in node.inputs:
            source.grad += slope * node.grad
    # <<< solution


def grad_check(f: Callable[[Vector], tuple[float, Vector]], x: Vector, eps: float = 1e-5) -> float:
    """The relative error of a gradient, by central differences, Eqs. (14) to (16).

    Args:
        f: f(x) returns (value, gradient) at x, a float and an array (N,).
        x: float64 array (N,); it is not changed.
        eps: the step for coordinates up to 1; that of coordinate i is eps * max(1, |x_i|).

    Returns:
        ||gradient - differences|| / max(||gradient||, ||differences||), a float: at most 1e-6 for a
        right gradient of a smooth function. 0 if both are zero, infinity if a number is not finite.
        `f` is called 2 N + 1 times.
    """
    # >>> solution 02.6
    gradient = f(x.copy())[1]
    quotients = np.zeros_like(x)
    for i in range(x.size):
        step = eps * max(1.0, abs(x[i]))
        ahead, behind = x.copy(), x.copy()
        ahead[i] += step
        behind[i] -= step
        quotients[i] = (f(ahead)[0] - f(behind)[0]) / (2.0 * step)
    error = float(np.linalg.norm(gradient - quotients))
    scale = max(float(np.linalg.norm(gradient)), float(np.linalg.norm(quotients)))
    if not math.isfinite(error):
        return math.inf
    return error / scale if scale > 0.0 else 0.0
    # <<< solution


def value_and_gradient(f, x):
    """The value of f, and its gradient from `backward`.

    Args:
        f: takes a list of N `Value`s and returns one.
        x: N numbers.

    Returns:
        A float and an array (N,).
    """
    leaves = [Value(number) for number in x]
    root = f(leaves)
    backward(root)
    return root.data, np.array([leaf.grad for leaf in leaves])
