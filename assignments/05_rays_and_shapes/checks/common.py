"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance
from photograd_course.grading.failures import CheckFailed

# Evidence: worst of the solution and the alternatives over several seeds, against the nearest of
# all named wrong solutions.
EXACT = Tolerance(1e-9, "right ones differ by 1e-12 or less, wrong ones by 1e-3 or more")
T_MIN, CLOSE, LEAF = 1e-9, 1e-9, 2


WHOLE = Array((None,), "i8")


def distances(count):
    """What each of count rays hits: t above 0, infinite where there is nothing."""
    return Array((count,), finite=False, above=0.0)


def same_hits(t, got, right, tolerance=None, hint=""):
    """The same rays hit something, at the same t."""
    wrong = np.isfinite(got) != np.isfinite(right)
    if wrong.any():
        at = int(np.argwhere(wrong)[0, 0])
        told = "hits nothing" if np.isinf(got[at]) else "hits something"
        t.require(
            False,
            f"{int(wrong.sum())} of {len(got)} rays are wrong: number {at} {told}, which is not so",
            hint=hint,
        )
    met = np.isfinite(right)
    if met.any():
        t.close("t", got[met], right[met], tolerance, hint=hint)


def lengths(t, count):
    """Random lengths (count, 1) of directions."""
    return np.exp(t.rng.uniform(-1.5, 1.5, (count, 1)))


def sphere(t):
    return t.rng.uniform(-3, 3, 3), float(t.rng.uniform(0.5, 2.5))


def built(t, low, high):
    """The submission's tree, looked at: (boxes, first, count, order), every rule of form kept."""
    parts = Items(
        Array((None, 2, 3)), WHOLE, WHOLE, WHOLE, names=("boxes", "first", "count", "order")
    )
    tree = t.call("build_bvh", low, high, returns=parts)
    require_tree(t, len(low), tree)
    return tree


def require_tree(t, primitives_in_all, tree):
    """Every rule of the form of a tree over so many primitives."""
    boxes, first, count, order = tree
    nodes = len(boxes)
    t.require(nodes == len(first) == len(count) > 0, "boxes, first and count differ in length")
    t.require(
        np.array_equal(np.sort(order), np.arange(primitives_in_all)),
        "order must hold the number of each primitive once",
    )
    t.require(bool(((count >= 0) & (count <= LEAF)).all()), f"a leaf holds 1 to {LEAF} primitives")
    waiting, used, owned = [0], np.zeros(nodes, np.int64), np.zeros(primitives_in_all, np.int64)
    while waiting:
        node = waiting.pop()
        used[node] += 1
        at, primitives = int(first[node]), int(count[node])
        t.require(
            at >= 0 and at + (primitives or 2) <= (primitives_in_all if primitives else nodes),
            "first points beyond the end",
        )
        owned[at : at + primitives] += 1
        if not primitives:
            t.require(not used[at : at + 2].any(), "two nodes share a child, or one is its own")
            waiting += [at, at + 1]
    t.require(bool((used == 1).all()), "a node belongs to no parent")
    t.require(bool((owned == 1).all()), "a primitive is in no leaf, or in several")


class Scene:
    """Rectangles, each across one axis: what a ray hits, told and counted."""

    def __init__(self, low, high):
        self.low, self.high = low, high
        self.axis = np.argmin(high - low, axis=1)
        self.boxes = None
        self.asked, self.met, self.most = [], [], 5_000

    def ray(self, origin, direction):
        self.origin, self.direction = origin, direction
        self.asked, self.met = [], []

    def times(self, numbers):
        """t (K,) of rectangles."""
        rows = np.arange(len(numbers))
        axis = self.axis[numbers]
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (self.low[numbers, axis] - self.origin[axis]) / self.direction[axis]
            place = self.origin + t[:, None] * self.direction
        place[rows, axis] = self.low[numbers, axis]
        inside = ((place >= self.low[numbers]) & (place <= self.high[numbers])).all(axis=1)
        return np.where(inside & (t > T_MIN), t, np.inf)

    def box(self, node):
        whole = isinstance(node, int) and not isinstance(node, bool)
        if not whole or not 0 <= node < len(self.boxes):
            raise CheckFailed("traverse: box wants the number of a node")
        self.asked.append(node)
        if len(self.asked) > self.most:
            raise CheckFailed("traverse: asks without end")
        return self.boxes[node]

    def intersect(self, numbers):
        numbers = np.asarray(numbers)
        whole = numbers.ndim == 1 and numbers.size and numbers.dtype.kind == "i"
        if not whole or not ((numbers >= 0) & (numbers < len(self.low))).all():
            raise CheckFailed("traverse: intersect wants numbers (K,) of primitives, one or more")
        self.met += numbers.tolist()
        return self.times(numbers)
