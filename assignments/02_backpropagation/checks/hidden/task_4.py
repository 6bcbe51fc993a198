"""Task 02.4, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT
from ..task_4 import END, require_order, require_work


def ladder(rungs):
    """Diamonds in a row: 3 nodes each, and 2 paths through each."""
    edges = [[]]
    for _ in range(rungs):
        top = len(edges) - 1
        edges += [[[top, 0.5]], [[top, 0.7]], [[top + 1, 1.0], [top + 2, 1.0]]]
    return edges


def winding(t, n):
    """A chain of n nodes, each with one more use of an earlier one, and its end: one order only."""
    uses = [[[k, 1.0], [int(t.rng.integers(k + 1)), 0.5]] for k in range(n - 1)]
    return [[], *uses], n - 1


@hidden_check(
    "02.4.work",
    points=4,
    calls=("topo_order",),
    tolerance=EXACT,
    battery=[
        Subject(
            "adapters.order_again",
            winding,
            lambda n: Array((2 * n + 1,), "i8"),
            right=lambda _ref, _edges, root: np.append(np.arange(root + 1), [END] * (root + 2)),
        )
    ],
)
def each_value_is_visited_once(t):
    """A ladder of diamonds, with 4096 paths through 37 values, costs what 37 values cost."""
    require_order(t, ladder(4), 12)
    require_work(t, ladder(12), "a ladder")
