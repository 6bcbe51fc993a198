"""Task 13.2, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import whole

check = checks_for(calls=("hash_index",))

# Resolution, rows of the level, corner, and its row: computed with integers of any length.
GOLDEN = (
    (64, 1024, (5, 0), 5),
    (64, 1024, (0, 1), 433),
    (64, 1024, (3, 7), 980),
    (64, 1000, (1, 1), 760),
    (64, 1000, (17, 40), 353),
    (512, 2**14, (123, 456), 819),
    (512, 2**14, (511, 512), 9215),
    (2**20, 2**19, (1048576, 999999), 365711),
    (2**20, 1000003, (1048575, 1048573), 928385),
    (16, 1024, (0, 0, 1), 917),
    (16, 1024, (1, 2, 3), 476),
    (16, 1024, (16, 16, 16), 592),
    (256, 2**19, (100, 7, 250), 382001),
    (256, 100000, (100, 7, 250), 56433),
    (2**20, 2**24, (1000000, 2000, 300000), 12764656),
)


def indexed(t, corners, resolution, rows):
    """`hash_index` of the submission, whose rows must exist."""
    got = t.call("hash_index", corners, resolution, rows, returns=Array((len(corners),), "i8"))
    t.require(
        len(got) == 0 or bool(got.min() >= 0),
        "a row is negative",
        hint="handout, equation (7): integers that wrap around have a sign",
    )
    t.require(
        len(got) == 0 or bool(got.max() < rows),
        f"a row is {rows} or more, with {rows} rows",
        hint="a level is dense only if all (n + 1)^D corners fit; of the others the modulus T is "
        "taken last",
    )
    return got


def every_corner(resolution, dimensions):
    """All corners (M, D) of a level, x fastest."""
    grid = np.indices(dimensions * (resolution + 1,))
    return np.stack([axis.ravel() for axis in grid[::-1]], axis=1)


@check(
    "13.2.hashed",
    points=3,
    hint="handout, equation (7): the products modulo 2^32, their exclusive or, modulo T",
    sole="golden values of the hash function",
)
def rows_of_hashed_corners(t):
    """Rows of levels whose corners do not fit, for small indices and large ones."""
    for resolution, rows, corner, right in GOLDEN:
        got = indexed(t, np.array([corner]), resolution, rows)
        whole(t, f"row of corner {corner}, resolution {resolution}, T = {rows}", got, [right])


@check(
    "13.2.dense",
    points=3,
    hint="handout, equation (6): where all (n + 1)^D corners fit, each has a row of its own",
    sole="golden order of dense levels, which share no row",
)
def dense_levels_share_nothing(t):
    """Where all corners fit, each has its own row, x fastest; with one row less they are hashed."""
    for resolution, D in ((7, 2), (4, 3), (1, 2), (1, 3)):
        corners, count = every_corner(resolution, D), (resolution + 1) ** D
        for rows in (count, count + 5):
            got = indexed(t, corners, resolution, rows)
            whole(t, f"rows of a dense level, D = {D}, {rows} rows", got, np.arange(count))
        shuffled = t.rng.permutation(count)
        got = indexed(t, corners[shuffled], resolution, count)
        whole(t, "rows of corners in another order", got, shuffled)
    corners = every_corner(15, 2)
    got = indexed(t, corners, 15, 255)
    t.require(
        not np.array_equal(got, np.arange(256) % 255),
        "256 corners do not fit into 255 rows: this level is hashed",
    )


@check("13.2.spread", points=1, sole="what a hash function is for, whatever its constants")
def rows_are_used_evenly(t):
    """A hash spreads the corners of a level over all rows: none has several times its share."""
    for resolution, D, rows in ((127, 2, 512), (31, 3, 1024)):
        often = np.bincount(indexed(t, every_corner(resolution, D), resolution, rows))
        share = (resolution + 1) ** D / rows
        said = f"the fullest row has {often.max()} corners, the mean is {share:.0f}"
        t.require(often.max() < 3 * share, said)
        t.require(len(often) == rows and often.min() > 0, "some rows have no corner at all")
