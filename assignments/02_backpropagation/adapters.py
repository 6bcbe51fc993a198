"""Between the checks and your engine: graphs come as lists of numbers, and numbers go back.

Runs beside your `engine.py`; nothing here is to be changed or handed in. A node is known by its
place in a list; inputs stand first, and every node after those that it uses.
"""

from __future__ import annotations

import math

import engine
import numpy as np

READS_ALLOWED = 500_000  # a walk that has gone so far need not be waited for


class TooManyReads(Exception):
    """`inputs` was read far more often than there are nodes."""


def apply(op, a, b):
    """One gate of the engine: `a` a Value, `b` a Value or a plain number (None where not used)."""
    if op == "exp":
        return a.exp()
    if op == "log":
        return a.log()
    if op == "pow":
        return a**b
    if op == "max":
        return a.maximum(b)
    if op == "radd":
        return b + a
    if op == "rmul":
        return b * a
    return {"add": a.__add__, "mul": a.__mul__, "sub": a.__sub__, "div": a.__truediv__}[op](b)


def gate(op, a, b=None, same=False):
    """One gate alone: its value, and the slope that it noted for each of its inputs.

    Args:
        op: name of the gate.
        a: a float, the first input.
        b: a float, the second input; a plain number for "pow"; None where there is none.
        same: a is both inputs, as in x * x.

    Returns:
        {"value", "slopes": (2,), "strangers"}: slopes towards a and b, summed over uses, and how
        many of the recorded inputs are neither of the two.
    """
    first = engine.Value(a)
    plain = b is None or op in {"pow", "radd", "rmul"}
    second = first if same else b if plain else engine.Value(b)
    result = apply(op, first, second)
    slopes, strangers = np.zeros(2), 0
    for node, slope in result.inputs:
        if node is first:
            slopes[0] += slope
        elif node is second:
            slopes[1] += slope
        else:
            strangers += 1
    return {"value": result.data, "slopes": slopes, "strangers": strangers}


def gates(op, a, b, same=False):
    """`gate` for arrays a (N,) and b (N,) or None: values (N,), slopes (N, 2)."""
    second = [None] * len(a) if b is None else [float(number) for number in b]
    done = [gate(op, float(x), y, same) for x, y in zip(a, second, strict=True)]
    values = np.array([each["value"] for each in done])
    return {"values": values, "slopes": np.array([each["slopes"] for each in done])}


def build(program, inputs):
    """The nodes of a program: Values of the inputs, then one for each instruction [op, a, b].

    `a` is the place of a node; `b` too, or a number for "pow", "radd" and "rmul", or None.
    """
    nodes = [engine.Value(number) for number in inputs]
    for op, a, b in program:
        plain = b is None or op in {"pow", "radd", "rmul"}
        nodes.append(apply(op, nodes[a], b if plain else nodes[b]))
    return nodes


def run_graph(program, inputs, seed=1.0):
    """Values (M,) of all nodes of a program, and gradients (M,) of the last by each of them."""
    nodes = build(program, inputs)
    engine.backward(nodes[-1], seed)
    values = np.array([node.data for node in nodes])
    return {"values": values, "gradients": np.array([node.grad for node in nodes])}


def run_graphs(programs, inputs):
    """`run_graph` of each program: last values (P,), gradients by the inputs as a list."""
    last, gradients = [], []
    for program, given in zip(programs, inputs, strict=True):
        nodes = build(program, given)
        engine.backward(nodes[-1])
        last.append(nodes[-1].data)
        gradients.append(np.array([node.grad for node in nodes[: len(given)]]))
    return {"values": np.array(last), "gradients": gradients}


def forward_values(program, points):
    """Last values (P,) of a program at points (P, N)."""
    return np.array([build(program, point)[-1].data for point in points])


def by_hand(edges):
    """Nodes made without gates; edges[k] lists [place of the input, slope] for each use."""
    nodes = []
    for uses in edges:
        nodes.append(engine.Value(1.0, tuple((nodes[k], slope) for k, slope in uses)))
    return nodes


def order_of(edges, root):
    """`topo_order` of node `root` of a graph made by hand, as places."""
    nodes = by_hand(edges)
    place = {id(node): k for k, node in enumerate(nodes)}
    return [place.get(id(node), -1) for node in engine.topo_order(nodes[root])]


def run_by_hand(edges, orders, seeds, default_seed=False):
    """`backward` on a graph made by hand, once for each order, one after another.

    Args:
        edges: see `by_hand`.
        orders: places in the order that `topo_order` is to give, so that a mistake there does not
            count here; the last is the root.
        seeds: one for each.
        default_seed: leave the seed out.

    Returns:
        Gradients (calls, M) after each call.
    """
    nodes = by_hand(edges)
    own_order, after = engine.topo_order, []
    try:
        for order, seed in zip(orders, seeds, strict=True):
            given = [nodes[k] for k in order]
            engine.topo_order = lambda _, given=given: list(given)
            if default_seed:
                engine.backward(given[-1])
            else:
                engine.backward(given[-1], seed)
            after.append([node.grad for node in nodes])
    finally:
        engine.topo_order = own_order
    return np.array(after)


def chain(n, slope=1.0, with_backward=False):
    """A chain of n nodes, each with one input.

    Returns:
        {"length": of the order, "in_order": whether each node follows its input, "gradient": of the
        first node, 0 without `with_backward`}.
    """
    nodes = [engine.Value(1.0)]
    for _ in range(n - 1):
        nodes.append(engine.Value(1.0, ((nodes[-1], slope),)))
    if with_backward:
        original, engine.topo_order = engine.topo_order, lambda _: list(nodes)
        try:
            engine.backward(nodes[-1])
        finally:
            engine.topo_order = original
        return {"length": n, "in_order": True, "gradient": nodes[0].grad}
    order = engine.topo_order(nodes[-1])
    in_order = len(order) == n and all(a is b for a, b in zip(order, nodes, strict=True))
    return {"length": len(order), "in_order": in_order, "gradient": 0.0}


class Counter:
    """Counts how often inputs are read and how often nodes are compared with one another."""

    def __init__(self):
        self.count = 0

    def add(self):
        """One more."""
        self.count += 1
        if self.count > READS_ALLOWED:
            raise TooManyReads(f"{READS_ALLOWED} reads")


class Counted(tuple):
    """Inputs of a node; reading them is counted."""

    counter = None

    def __iter__(self):
        self.counter.add()
        return super().__iter__()

    def __getitem__(self, place):
        self.counter.add()
        return super().__getitem__(place)


def work(edges, root):
    """How often `topo_order` reads inputs or compares nodes; at most READS_ALLOWED and one more."""
    counter = Counter()

    class Watched(engine.Value):
        def __eq__(self, other):
            counter.add()
            return self is other

        __hash__ = object.__hash__

    class Reads(Counted):
        pass

    Reads.counter = counter
    nodes = []
    for uses in edges:
        nodes.append(Watched(1.0, Reads((nodes[k], slope) for k, slope in uses)))
    counter.count = 0
    try:
        engine.topo_order(nodes[root])
    except TooManyReads:
        return counter.count
    return counter.count


def checked(f, x):
    """`grad_check` of a function of the grader's.

    Returns:
        {"accepted": whether the error is at most 1e-6, "error": -1 where it is infinite and -2
        where it is no number, "unchanged": whether x is still what it was}.
    """
    kept = x.copy()
    error = engine.grad_check(f, x)
    if not math.isfinite(error):
        error = -1.0 if error == math.inf else -2.0
    return {
        "accepted": bool(0.0 <= error <= 1e-6),
        "error": float(error),
        "unchanged": bool(np.array_equal(kept, x)),
    }
