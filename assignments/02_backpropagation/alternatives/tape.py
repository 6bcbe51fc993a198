"""A tape: gates write an operation code, and the order is the order of writing."""

import heapq
import math

import numpy as np

WRITTEN = [0]


SLOPES = {
    "add": lambda _x, _y, _z: (1.0, 1.0),
    "mul": lambda x, y, _z: (y, x),
    "div": lambda _x, y, z: (1.0 / y, -z / y),
    "max": lambda x, y, _z: (float(x > y), float(x <= y)),
    "exp": lambda _x, _y, z: (z,),
    "log": lambda x, _y, _z: (1.0 / x,),
    "pow": lambda x, y, _z: (y * x ** (y - 1),),
}


class Value:
    """A number, its place on the tape, and a line (code, operands) from which slopes follow."""

    def __init__(self, data, inputs=()):
        self.data, self.grad = float(data), 0.0
        WRITTEN[0] += 1
        self.place = WRITTEN[0]
        self.inputs = inputs

    def __add__(self, other):
        return write("add", lambda x, y: x + y, self, other)

    def __mul__(self, other):
        return write("mul", lambda x, y: x * y, self, other)

    def __truediv__(self, other):
        return write("div", lambda x, y: x / y, self, other)

    def maximum(self, other):
        return write("max", max, self, other)

    def exp(self):
        return write("exp", lambda x, _: math.exp(x), self)

    def log(self):
        return write("log", lambda x, _: math.log(x), self)

    def __pow__(self, n):
        return write("pow", lambda x, y: x**y, self, power=n)

    def __sub__(self, other):
        return self + (-1.0) * (other if isinstance(other, Value) else Value(other))

    def __rsub__(self, other):
        return Value(other) - self

    def __rtruediv__(self, other):
        return Value(other) / self


def write(code, function, first, second=None, power=None):
    """One line of the tape."""
    operands = [first]
    if second is not None:
        operands.append(second if isinstance(second, Value) else Value(second))
    x, y = operands[0].data, power if second is None else operands[1].data
    z = function(x, y)
    return Value(z, tuple(zip(operands, SLOPES[code](x, y, z), strict=True)))


def topo_order(root):
    """What the root needs, latest place first, then turned round."""
    order, waiting, known = [], [(-root.place, root)], {root.place}
    while waiting:
        node = heapq.heappop(waiting)[1]
        order.append(node)
        for source, _ in node.inputs:
            if source.place not in known:
                known.add(source.place)
                heapq.heappush(waiting, (-source.place, source))
    order.reverse()
    return order


def backward(root, seed=1.0):
    """Each value pulls from its users, instead of users pushing."""
    order = topo_order(root)
    users = {node: [] for node in order}
    for node in order:
        for source, slope in node.inputs:
            users[source].append((node, slope))
    for node in reversed(order):
        node.grad = sum(slope * user.grad for user, slope in users[node])
        if node is root:
            node.grad = float(seed)


def grad_check(f, x, eps=1e-5):
    """Scalar loops, lists instead of arrays."""
    place = [float(number) for number in x]
    gradient = [float(number) for number in f(np.array(place))[1]]

    def at(i, number):
        return float(f(np.array([*place[:i], number, *place[i + 1 :]]))[0])

    slopes = []
    for i, number in enumerate(place):
        step = eps * max(1.0, abs(number))
        slopes.append((at(i, number + step) - at(i, number - step)) / (2 * step))
    if not all(math.isfinite(number) for number in [*gradient, *slopes]):
        return math.inf
    off = math.dist(gradient, slopes)
    scale = max(math.hypot(*gradient), math.hypot(*slopes))
    return off / scale if scale else 0.0
