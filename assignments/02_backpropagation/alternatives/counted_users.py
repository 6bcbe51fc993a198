"""Counts of users: a value is done when all its users are (Kahn's algorithm); arrays inside."""

from collections import deque

import numpy as np
from engine import as_value


class Value:
    """A number with its inputs."""

    def _gate(self, other, value, slopes):
        return Value(value, ((self, float(slopes[0])), (other, float(slopes[1]))))

    def __add__(self, other):
        other = as_value(other)
        return self._gate(other, np.add(self.data, other.data), np.ones(2))

    def __mul__(self, other):
        other = as_value(other)
        pair = np.array([self.data, other.data])
        return self._gate(other, pair.prod(), pair[::-1])

    def maximum(self, other):
        other = as_value(other)
        pair = np.array([other.data, self.data])
        return self._gate(other, pair.max(), np.eye(2)[1 - pair.argmax()])

    def exp(self):
        return Value(np.exp(self.data), ((self, float(np.exp(self.data))),))

    def log(self):
        return Value(np.log(self.data), ((self, float(np.reciprocal(self.data))),))

    def __pow__(self, n):
        slope = float(n * np.power(self.data, n - 1.0))
        return Value(np.power(self.data, float(n)), ((self, slope),))

    def __truediv__(self, other):
        return self * as_value(other) ** -1

    def __radd__(self, other):
        return as_value(other) + self

    def __rmul__(self, other):
        return as_value(other) * self

    def __neg__(self):
        return -1.0 * self

    def __sub__(self, other):
        return self + (-as_value(other))


def topo_order(root):
    """First count the uses of each value, then release those whose users have all been met."""
    uses, queue, known = {root: 0}, deque([root]), {root}
    while queue:
        for source, _ in queue.popleft().inputs:
            uses[source] = uses.get(source, 0) + 1
            if source not in known:
                known.add(source)
                queue.append(source)
    order, ready = [], deque([root])
    while ready:
        node = ready.popleft()
        order.append(node)
        for source, _ in node.inputs:
            uses[source] -= 1
            if uses[source] == 0:
                ready.append(source)
    return order[::-1]


def backward(root, seed=1.0):
    """An array of gradients, indexed by position in the order."""
    order = topo_order(root)
    place = {node: k for k, node in enumerate(order)}
    gradients = np.zeros(len(order))
    gradients[place[root]] = seed
    for k in range(len(order) - 1, -1, -1):
        for source, slope in order[k].inputs:
            gradients[place[source]] += gradients[k] * slope
    for node, gradient in zip(order, gradients, strict=True):
        node.grad = float(gradient)


def grad_check(f, x, eps=1e-5):
    """Rows of points, all built before the first call."""
    x = np.array(x)
    h = np.maximum(np.abs(x), 1.0) * eps
    points = x + np.stack([np.diag(h), -np.diag(h)])
    ahead, behind = (np.array([f(point)[0] for point in rows]) for rows in points)
    d = (ahead - behind) / h / 2
    g = np.array(f(x.copy())[1])
    top = np.maximum(np.linalg.norm(g), np.linalg.norm(d))
    if not np.isfinite(top):
        return float("inf")
    return float(np.linalg.norm(d - g) / top) if top else 0.0
