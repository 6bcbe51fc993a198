"""Closures: a gate keeps a function that gives its slopes when they are asked for, not numbers."""

import math

import numpy as np


class Value:
    """A number; `inputs` is worked out from the parents and a closure."""

    def __init__(self, data, inputs=()):
        self.data = float(data)
        self.grad = 0.0
        self._parents, self._slopes = (), None
        self._given = inputs

    @classmethod
    def _made(cls, data, parents, slopes):
        made = cls(data)
        made._parents, made._slopes = parents, slopes
        return made

    @property
    def inputs(self):
        if self._slopes is None:
            return self._given
        return tuple(zip(self._parents, self._slopes(), strict=True))

    def __add__(self, other):
        other = other if isinstance(other, Value) else Value(other)
        return Value._made(other.data + self.data, (other, self), lambda: (1.0, 1.0))

    def __mul__(self, other):
        other = other if isinstance(other, Value) else Value(other)
        x, y = self.data, other.data
        return Value._made(y * x, (self, other), lambda: (y, x))

    def maximum(self, other):
        other = other if isinstance(other, Value) else Value(other)
        if other.data < self.data:
            return Value._made(self.data, (self,), lambda: (1.0,))
        return Value._made(other.data, (other,), lambda: (1.0,))

    def exp(self):
        x = self.data
        return Value._made(math.exp(x), (self,), lambda: (math.exp(x),))

    def log(self):
        x = self.data
        return Value._made(math.log(x), (self,), lambda: (x**-1,))

    def __pow__(self, n):
        x = self.data
        return Value._made(math.pow(x, n), (self,), lambda: (math.pow(x, n - 1) * n,))

    def __truediv__(self, other):
        return self * (other if isinstance(other, Value) else Value(other)) ** -1

    def __radd__(self, other):
        return self.__add__(other)

    def __rmul__(self, other):
        return self.__mul__(other)

    def __sub__(self, other):
        return self + -(other if isinstance(other, Value) else Value(other))

    def __rsub__(self, other):
        return -self + other

    def __rtruediv__(self, other):
        return self**-1 * other


def topo_order(root):
    """Depth first with a stack of iterators."""
    order, seen, stack = [], {id(root)}, [(root, iter(root.inputs))]
    while stack:
        node, rest = stack[-1]
        source = next((each for each, _ in rest if id(each) not in seen), None)
        if source is None:
            order.append(node)
            stack.pop()
        else:
            seen.add(id(source))
            stack.append((source, iter(source.inputs)))
    return order


def backward(root, seed=1.0):
    """Gradients are gathered in a dict and written at the end."""
    order = topo_order(root)
    gathered = {id(node): 0.0 for node in order}
    gathered[id(root)] = seed
    for node in order[::-1]:
        above = gathered[id(node)]
        for source, slope in node.inputs:
            gathered[id(source)] = gathered[id(source)] + above * slope
    for node in order:
        node.grad = float(gathered[id(node)])


def grad_check(f, x, eps=1e-5):
    """All differences in one comprehension, over rows of an identity matrix."""
    x = np.asarray(x, dtype=float)
    g = np.asarray(f(x + 0.0)[1])
    steps = np.diag(eps * np.maximum(1.0, np.abs(x)))
    d = np.array([(f(x + s)[0] - f(x - s)[0]) / (2 * s.sum()) for s in steps])
    if not (np.isfinite(g).all() and np.isfinite(d).all()):
        return math.inf
    scale = max(np.sqrt((g * g).sum()), np.sqrt((d * d).sum()))
    return 0.0 if scale == 0 else float(np.sqrt(((g - d) ** 2).sum()) / scale)
