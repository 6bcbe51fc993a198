"""Task 05.5, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import EXACT, LEAF, built

check = checks_for(calls=("build_bvh",))


def some_boxes(t, count, stretch=(1.0, 1.0, 1.0)):
    """(low, high), both (count, 3), of primitives of many sizes, in a region that is stretched."""
    middle = t.rng.uniform(-5, 5, (count, 3)) * stretch
    half = np.exp(t.rng.uniform(-4, 0, (count, 3)))
    return middle - half, middle + half


def held(tree):
    """For each node the numbers of the primitives below it."""
    _, first, count, order = tree
    found, way = [None] * len(first), [0]
    for node in way:  # which grows meanwhile
        if not count[node]:
            way += [first[node], first[node] + 1]
    for node in reversed(way):
        at = first[node]
        below = order[at : at + count[node]] if count[node] else np.concatenate(found[at : at + 2])
        found[node] = below
    return found


SIZES = (1, 2, 3, 7, 40)


@check(
    "05.5.boxes",
    points=4,
    tolerance=EXACT,
    hint="handout, equation (16): the smallest corner of all, and the largest",
    sole="a box that is too small loses primitives, one too large costs",
)
def boxes_fit(t):
    """Every primitive is in one leaf, and every box is the smallest that holds what is below it."""
    for count in SIZES:
        low, high = some_boxes(t, count)
        tree = built(t, low, high)
        primitives = held(tree)
        right = np.array([[low[mine].min(axis=0), high[mine].max(axis=0)] for mine in primitives])
        t.close(f"boxes of {count} primitives", tree[0], right)


@check(
    "05.5.halves",
    points=2,
    hint="handout, equation (17): half of the primitives to each side, down to LEAF",
    sole="no path is longer than the logarithm",
)
def halves_are_equal(t):
    """Siblings hold equally many primitives, up to one; nothing is split that fits into a leaf."""
    for count in SIZES:
        tree = built(t, *some_boxes(t, count))
        _, first, many, _ = tree
        sizes = np.array([len(mine) for mine in held(tree)])
        inner = many == 0
        t.require(bool((sizes[inner] > LEAF).all()), "a node is cut that would fit into a leaf")
        apart = np.abs(sizes[first[inner]] - sizes[first[inner] + 1])
        t.require(bool((apart <= 1).all()), "siblings differ by more than one primitive")


@check(
    "05.5.axis",
    points=3,
    hint="cut across the axis on which the middles of the boxes are spread most",
    sole="halves that lie apart are what lets a ray skip one",
)
def halves_lie_apart(t):
    """The middles of siblings are apart along the axis on which they are spread most."""
    for stretch in ((1, 1, 1), (1, 9, 1), (1, 1, 9), (9, 1, 1)):
        low, high = some_boxes(t, 24, stretch)
        # A long primitive across: its box is large, its middle is not far out.
        low[0], high[0] = -30 * np.roll([1, 0, 0], t.rng.integers(3)), np.array([1.0, 1, 1])
        tree = built(t, low, high)
        _, first, many, _ = tree
        primitives, middle = held(tree), (low + high) / 2
        for node in np.flatnonzero(many == 0):
            axis = int(np.argmax(np.ptp(middle[primitives[node]], axis=0)))
            one, two = (middle[primitives[first[node] + k], axis] for k in (0, 1))
            split = one.max() <= two.min() or two.max() <= one.min()
            t.require(bool(split), "the halves of a node mix along the axis of largest spread")
