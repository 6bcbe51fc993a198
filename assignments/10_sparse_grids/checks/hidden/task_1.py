"""Task 10.1, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import FAITHFUL, blocks
from ..task_1 import cells_of, octree


def halved(t, n):
    """Arguments of `octree_from_dense`: a cube whose side is the power of two up to n."""
    return (blocks(t, 1 << n.bit_length() - 1, 0.9),)


@hidden_check(
    "10.1.hidden",
    points=2,
    calls=("octree_from_dense",),
    sole="the same mistakes in unseen cubes",
    battery=[
        Subject(
            "octree_from_dense",
            halved,
            lambda _: Array((None,), "i8"),
            sizes=(1, 2, 8),
            large=32,
            tolerance=FAITHFUL,
            common=lambda t, args, tree: cells_of(t, tree, len(args[0]))[0].astype(float),
        )
    ],
)
def trees_of_random_cubes(t):
    """Trees of random cubes are right, with as many nodes as they need."""
    for n in (1, 2, 4, 8):
        full = blocks(t, n, 0.9)
        tree = octree(t, full)
        said, _ = cells_of(t, tree, n)
        t.close("full cells", said, full, FAITHFUL)
        t.close("nodes", len(tree), len(t.reference.octree_from_dense(full)), FAITHFUL)
