"""Task 10.1, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import blocks, equal_cubes, same_counts

check = checks_for(calls=("octree_from_dense",))


def octree(t, full):
    """What the submission makes of it, looked at."""
    return t.call("octree_from_dense", full, returns=Array((None,), "i8"))


def cells_of(t, tree, n):
    """The cube (n, n, n) of bool that a tree says, and how many leaves it has; every rule kept."""
    full, leaves = np.zeros((n, n, n), bool), 0
    used = np.zeros(len(tree), np.int64)
    t.require(len(tree) > 0, "the tree has no node")
    todo = [(0, (0, 0, 0), n)]
    while todo:
        node, low, side = todo.pop()
        used[node] += 1
        value = int(tree[node])
        if value <= 0:
            t.require(value in (0, -1), "a leaf is neither EMPTY nor FULL")
            full[tuple(slice(a, a + side) for a in low)] = value == -1
            leaves += 1
            continue
        t.require(side > 1, "a single cell has children")
        t.require(value + 8 <= len(tree), "children beyond the end of the tree")
        t.require(not used[value : value + 8].any(), "two nodes share a child")
        half = side // 2
        for octant in range(8):
            upper = (octant >> 2, octant >> 1 & 1, octant & 1)
            corner = tuple(a + half * up for a, up in zip(low, upper, strict=True))
            todo.append((value + octant, corner, half))
        t.require(len(todo) <= 8 * len(tree), "the tree has a loop")
    t.require(bool((used == 1).all()), "a node belongs to no parent, or to several")
    return full, leaves


@check(
    "10.1.cells",
    points=5,
    hint="child 4 X + 2 Y + Z lies in the upper half along x where X is 1",
    sole="which cell is full comes before how few nodes say so",
)
def the_tree_says_what_the_cube_says(t):
    """Each cell of the tree is full or empty as it is in the cube."""
    for n in (2, 1, 4, 8):
        for _ in range(3):
            full = blocks(t, n)
            said, _ = cells_of(t, octree(t, full), n)
            same_counts(t, f"full cells of {n}^3", said, full)


@check(
    "10.1.one",
    points=3,
    hint="handout, equation (6): only the node that holds the odd cell is cut",
    sole="the exact formula for the memory",
)
def one_cell_costs_eight_nodes_a_level(t):
    """One full cell among n^3 equal ones: 1 + 8 log2 n nodes, wherever it is."""
    for levels in (0, 1, 2, 3, 4):
        n = 2**levels
        for odd in (True, False):
            full = np.full((n, n, n), not odd)
            full[tuple(t.rng.integers(0, n, 3))] = odd
            nodes, right = len(octree(t, full)), 1 + 8 * levels
            same_counts(t, f"nodes for one odd cell of {n}^3", nodes, right)
    for same in (False, True):
        nodes = len(octree(t, np.full((8, 8, 8), same)))
        same_counts(t, f"nodes where all cells are {same}", nodes, 1)


@check(
    "10.1.fewest",
    points=3,
    hint="handout, equation (4): a cube of equal cells, full or empty, is one leaf",
    sole="what an octree is for: counted, not timed",
)
def leaves_are_as_large_as_can_be(t):
    """As many leaves as there are largest equal cubes; a plane costs at most a few n^2 leaves."""
    for n in (4, 8):
        full = blocks(t, n, 1.0)
        full[:2, :2, :2], full[2:, 2:, 2:] = True, False
        _, leaves = cells_of(t, octree(t, full), n)
        right = round(float((1.0 / equal_cubes(full) ** 3).sum()))
        same_counts(t, f"leaves of {n}^3 cells", leaves, right)
    counts = []
    for n in (8, 16):
        full = np.zeros((n, n, n), bool)
        full[:, :, n // 2] = True
        counts.append(len(octree(t, full)))
    t.require(
        counts[1] < 4.5 * counts[0],
        f"a plane in 8^3 and in 16^3 cells: {counts[0]} and {counts[1]} nodes; "
        "with twice the resolution about 4 times as many are enough",
    )
