"""Task 02.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Integer, Record, Truth, checks_for

from .common import ordered, random_edges, reachable

check = checks_for(calls=("topo_order",))

END = -2  # see adapters.order_of
LETTERS = "abcdefghijklmnopqrstuvwxyz"
EARLY = (
    "append a value after all its inputs; a value that is marked as visited when it is pushed onto "
    "the stack counts as done too early: mark it when it is popped"
)


def named(place):
    """Node `place` as a letter."""
    return LETTERS[place] if 0 <= place < len(LETTERS) else "?"


def in_words(edges, root):
    """A graph as text: each node that `root` needs, with its inputs in brackets."""
    parts = []
    for k in reachable(edges, root):
        inputs = ", ".join(named(place) for place, _ in edges[k])
        parts.append(f"{named(k)}({inputs})" if inputs else named(k))
    return ", ".join(parts)


def require_order(t, edges, root):
    """`topo_order` of one graph: everything needed, once, inputs first."""
    needed = reachable(edges, root)
    places = t.call("adapters.order_of", edges, root, returns=Array((2 * len(edges) + 1,), "i8"))
    order = [int(place) for place in places if place != END]
    yours = " ".join(map(named, order)) or "empty"
    graph = f"in the graph {in_words(edges, root)} with the root {named(root)} (inputs in brackets)"
    where = f"{graph} your order is {yours}" if t.check.visibility == "public" else "your order"
    twice = [named(k) for k in needed if order.count(k) > 1]
    t.require(
        not twice,
        f"{where}: {', '.join(twice)} more than once",
        hint="mark each value that you have expanded, and pass over marked ones",
    )
    missing = [named(k) for k in needed if k not in order]
    t.require(
        not missing,
        f"{where}: without {', '.join(missing)}",
        hint="everything that the root depends on, and the root itself",
    )
    t.require(len(order) == len(needed), f"{where}: the root does not depend on all of these")
    place = {node: at for at, node in enumerate(order)}
    early = [(k, j) for k in needed for j, _ in edges[k] if place[k] < place[j]]
    said = f"{where}: {named(early[0][0])} before its input {named(early[0][1])}" if early else ""
    t.require(not early, said, hint=EARLY)


@check(
    "02.4.order",
    points=5,
    sole="`backward` gets its order given, so this alone looks at it in detail",
)
def inputs_stand_before_their_users(t):
    """Every value that the root needs stands in the order once, after its own inputs."""
    # From small to large, so that the graph of a message is a small one.
    require_order(t, [[]], 0)
    require_order(t, [[], [[0, 1.0]], [[0, 1.0], [1, 1.0]]], 2)
    require_order(t, [[], [[0, 1.0]], [[1, 1.0], [0, 1.0]]], 2)
    skip = [[[0, 1.0]], [[1, 1.0]], [[2, 1.0]]]
    require_order(t, [[], *skip, [[3, 1.0], [0, 1.0]], [[4, 1.0], [1, 1.0]]], 5)
    for n in (4, 4, 5, 5, 6, 6, 7, 8):
        require_order(t, random_edges(t.rng, n), n - 1)
    for _ in range(20):
        edges = random_edges(t.rng, 12)
        require_order(t, edges, 11)
        require_order(t, edges, 8)


def chain(n):
    return [[]] + [[[k, 1.0]] for k in range(n - 1)]


WORK_PER_NODE = 20  # right walks need 1 or 2; all paths through a ladder of 12 need over 300
WORK = Record({"reads": Integer(0), "comparisons": Integer(0), "too_deep": Truth()})
TOO_DEEP = "an explicit stack has no limit; Python limits the depth of recursion"
LISTED = "marks in a list are searched from the front; use a set"
UNMARKED = "read the inputs of each value once: mark what you have seen"


def require_work(t, edges, what):
    found = t.call("adapters.work", edges, len(edges) - 1, returns=WORK)
    t.require(
        not found["too_deep"],
        f"{what} of {len(edges)} nodes: topo_order: RecursionError",
        hint=TOO_DEEP,
    )
    each = (found["reads"] + found["comparisons"]) / len(edges)
    t.require(
        each <= WORK_PER_NODE,
        f"{what} of {len(edges)} nodes: {each:.0f} reads and comparisons a node, allowed "
        f"{WORK_PER_NODE}",
        hint=LISTED if found["comparisons"] > found["reads"] else UNMARKED,
    )


@check("02.4.chain", points=4, seconds=20.0)
def a_chain_of_a_hundred_thousand(t):
    """A chain of 100,000 values is put in order, without a recursion error."""
    require_work(t, chain(1500), "a chain")
    n = 100_000
    order = t.call("adapters.chain", n, returns=ordered(n))["order"]
    t.require(order[0] != -3, "a chain of 100,000 nodes: topo_order: RecursionError", hint=TOO_DEEP)
    length = int((order != -2).sum())
    t.require(length == n, f"the order holds {length} values, not 100,000")
    in_order = np.array_equal(order[:n], np.arange(n))
    t.require(in_order, "the values of a chain are not in the order of the chain")
