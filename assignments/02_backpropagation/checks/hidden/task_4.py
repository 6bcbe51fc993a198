"""Task 02.4, hidden checks."""

from photograd_course.grading import hidden_check

from ..task_4 import require_order, require_work


def ladder(rungs):
    """Diamonds in a row: 3 nodes each, and 2 paths through each."""
    edges = [[]]
    for _ in range(rungs):
        top = len(edges) - 1
        edges += [[[top, 0.5]], [[top, 0.7]], [[top + 1, 1.0], [top + 2, 1.0]]]
    return edges


@hidden_check("02.4.work", points=4, calls=("topo_order",))
def each_value_is_visited_once(t):
    """A ladder of diamonds, with 4096 paths through 37 values, costs what 37 values cost."""
    require_order(t, ladder(4), 12)
    require_work(t, ladder(12), "a ladder")
