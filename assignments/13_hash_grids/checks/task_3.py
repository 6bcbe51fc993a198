"""Task 13.3, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import EXACT, layout, points_within, table_for
from .task_2 import every_corner

EARLIER = ("hash_index",)

check = checks_for(calls=("encode",), needs=EARLIER, tolerance=EXACT)


def encoded(t, points, table, levels):
    """`encode` of the submission."""
    shape = (len(points), len(levels) * table.shape[1])
    return t.call("encode", points, table, levels, returns=Array(shape))


def affine_table(mix, resolution, D):
    """A dense level's table that holds x -> 1 + mix x at the corners."""
    return 1 + every_corner(resolution, D) / resolution @ mix


@check(
    "13.3.dense",
    points=3,
    hint="handout, equations (8) and (9): n cells and n + 1 corners along an axis; interpolate",
    sole="the trilinear grid: a closed form",
)
def a_dense_level_is_a_grid(t):
    """A dense level that holds a linear function gives that function, at corners as well."""
    for D, n in ((2, 5), (3, 4), (2, 1)):
        levels = layout([n], D, 10**6)
        mix = t.rng.uniform(0.5, 1.5, (D, 2)) * np.array([1.0, -3.0])
        points = t.rng.uniform(0.0, 1.0, (9, D))
        got = encoded(t, points, affine_table(mix, n, D), levels)
        t.close(f"features, D = {D}, within cells", got, 1 + points @ mix, reveal=True)
        table = table_for(t, levels)
        got = encoded(t, every_corner(n, D) / n, table, levels)
        t.close(f"features, D = {D}, at corners, are the rows of the table", got, table)


@check(
    "13.3.blend",
    points=2,
    hint="handout, equation (9): a weight is the product of w or 1 - w of all axes",
    sole="tests the weights inside of one cell",
)
def weights_are_products(t):
    """Within one cell a corner that holds 1 among zeros gives its weight, a product of all axes."""
    for D in (2, 3):
        levels, points = layout([1], D, 10**6), t.rng.uniform(0.05, 0.95, (6, D))
        weight = np.ones((6, 2**D))
        for k, corner in enumerate(every_corner(1, D)):
            for axis, side in enumerate(corner):
                weight[:, k] *= points[:, axis] if side else 1 - points[:, axis]
        got = encoded(t, points, np.eye(2**D), levels)
        t.close(f"weights, D = {D}", got, weight)


@check(
    "13.3.hashed",
    points=3,
    hint="the corners of a cell are those of equation (9), their rows those of your hash_index, "
    "counted from the level's first row",
    sole="hashed levels, by dense ones",
)
def a_hashed_level_reads_the_rows_of_its_corners(t):
    """A hashed level is a dense one whose corners hold the rows that your hash_index names."""
    for D, n, rows in ((2, 9, 16), (3, 5, 32)):
        coarse = layout([n - 2, n], D, rows)
        table, points = table_for(t, coarse), points_within(t, 12, D, coarse)
        corners = every_corner(n, D)
        spec = Array((len(corners),), "i8")
        row = coarse[1, 1] + t.call("hash_index", corners, n, rows, returns=spec)
        dense = encoded(t, points, table[row], layout([n], D, 10**6))
        t.close(f"features of level 1, D = {D}", encoded(t, points, table, coarse)[:, 2:], dense)


@check(
    "13.3.levels",
    points=2,
    hint="handout, equation (10): each level reads its own rows, and has its own columns",
    sole="the order of levels, and their rows",
)
def levels_stand_side_by_side(t):
    """The features of several levels are those of each level alone, side by side."""
    for D, resolutions, features in ((2, [3, 6, 12], 2), (3, [2, 3, 5], 1)):
        levels = layout(resolutions, D, 40)
        table, points = table_for(t, levels, features), t.rng.uniform(0.0, 1.0, (7, D))
        got = encoded(t, points, table, levels)
        for k, (n, begin, count) in enumerate(levels):
            alone = np.array([[n, 0, count]])
            right = encoded(t, points, table[begin : begin + count], alone)
            t.close(f"level {k}, D = {D}", got[:, k * features : (k + 1) * features], right)


@check(
    "13.3.outside",
    points=1,
    hint="clamp the points to 0 to 1 first; a point at 1 belongs to the last cell",
    sole="points that no other check has",
)
def outside_is_the_border(t):
    """A point outside has the features of the nearest point inside."""
    levels = layout([3, 7], 2, 30)
    table, points = table_for(t, levels), t.rng.uniform(-0.6, 1.6, (20, 2))
    within = np.clip(points, 0.0, 1.0)
    t.close("features", encoded(t, points, table, levels), encoded(t, within, table, levels))
