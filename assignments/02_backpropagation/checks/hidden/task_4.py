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
    """A chain of n nodes, each of which uses an earlier one too, among others; and its end."""
    between = np.sort(t.rng.permutation(2 * n - 2)[: max(n - 2, 0)] + 1)
    chain = [0, *map(int, between), *([2 * n - 1] if n > 1 else [])]
    edges = [[], *(uses_of(t, range(k), k - 1) for k in range(1, 2 * n))]
    for k in range(1, n):
        edges[chain[k]] = uses_of(t, chain, k - 1)
    return edges, chain[-1]


def uses_of(t, earlier, k):
    """The k-th of these and one up to it, each with a slope."""
    return [[earlier[k], 1.0], [earlier[int(t.rng.integers(k + 1))], 0.5]]


def only_order(_, edges, root):
    """The one order of a winding chain, as the adapter has it."""
    chain = [root]
    while edges[chain[-1]]:
        chain.append(edges[chain[-1]][0][0])
    return np.append(chain[::-1], [END] * (2 * len(edges) + 1 - len(chain)))


@hidden_check(
    "02.4.work",
    points=4,
    calls=("topo_order",),
    tolerance=EXACT,
    battery=[
        Subject(
            "adapters.order_again",
            winding,
            lambda n: Array((4 * n + 1,), "i8"),
            right=only_order,
            large=300,  # deep, and not too deep for recursion, which 02.4.chain is about
        )
    ],
)
def each_value_is_visited_once(t):
    """A ladder of diamonds, with 4096 paths through 37 values, costs what 37 values cost."""
    require_order(t, ladder(4), 12)
    require_work(t, ladder(12), "a ladder")
