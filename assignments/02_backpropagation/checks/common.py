"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Integer, Number, Record, Tolerance

EXACT = Tolerance(
    1e-12,
    "three ways to write the gates differ by 2e-16; wrong local derivatives are off by 0.1 or more",
)
DIFFERENCES = Tolerance(
    1e-6,
    "finite differences leave 3e-8 at most, since graphs where they leave more are not asked; "
    "wrong local derivatives and orders are off by 1e-2 and more",
)
STEP = 1e-5
SLOPES = Record({"value": Number(), "slopes": Array((2,)), "strangers": Integer(0)})


def gates_spec(n):
    return Record({"values": Array((n,)), "slopes": Array((n, 2))})


def gate(t, op, a, b=None, same=False):
    """A gate's value and local derivatives (2,), as `adapters.gate` has them."""
    return t.call("adapters.gate", op, a, b, same, returns=SLOPES)


def gates(t, op, a, b=None):
    """Values (N,) of a gate and its local derivatives (N, 2); as `adapters.gates` has them."""
    return t.call("adapters.gates", op, a, b, returns=gates_spec(len(a)))


def differences_of_gate(t, op, a, b):
    """Local derivatives (N, 2) by central differences of values; column 1 is 0 without b."""
    n = len(a)
    slopes = np.zeros((n, 2))
    for column in range(1 if b is None or op == "pow" else 2):
        moved = []
        for sign in (1, -1):
            at = [np.array(a), None if b is None else np.array(b)]
            at[column] = at[column] + sign * STEP
            moved.append(gates(t, op, *at)["values"])
        slopes[:, column] = (moved[0] - moved[1]) / (2 * STEP)
    return slopes


def require_slopes(t, op, a, b=None):
    """A gate's local derivatives against finite differences of its own values."""
    expected = differences_of_gate(t, op, a, b)
    t.close(f"local derivatives of {op}", gates(t, op, a, b)["slopes"], expected, DIFFERENCES)


def away(rng, low, high, n):
    """Numbers of either sign with low <= |x| <= high."""
    return rng.uniform(low, high, n) * rng.choice([-1.0, 1.0], n)


def random_edges(rng, n, uses=3):
    """A graph of n nodes by hand: uses of earlier nodes with local derivatives of either sign."""
    edges = [[]]
    for k in range(1, n):
        count = int(rng.integers(0 if k < n // 3 else 1, uses + 1))
        places = rng.integers(0, k, count)
        slopes = away(rng, 0.4, 1.2, count)
        edges.append([[int(p), float(s)] for p, s in zip(places, slopes, strict=True)])
    return edges


def reachable(edges, root):
    """Places that `root` depends on, itself included, ascending."""
    found = {root}
    for k in range(root, -1, -1):
        if k in found:
            found |= {place for place, _ in edges[k]}
    return sorted(found)


def ordered(n):
    """Result of `adapters.chain`."""
    return Record({"order": Array((2 * n + 1,), "i8"), "gradient": Number()})
