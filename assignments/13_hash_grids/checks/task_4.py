"""Task 13.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    is_the_transpose,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, layout, points_within, table_for
from .task_3 import encoded

EARLIER = ("hash_index", "encode")
GATE = Tolerance(1e-6, "finite differences leave 1e-9, wrong ones are off by 1e-2 or more")

check = checks_for(calls=("encode_backward",), needs=EARLIER, tolerance=EXACT)


def back(t, points, table, levels, g):
    """(d_table, d_points) of the submission."""
    spec = Items(Array(table.shape), Array(points.shape), names=("d_table", "d_points"))
    return t.call("encode_backward", points, table, levels, g, returns=spec)


@check(
    "13.4.table",
    points=3,
    hint="handout, equation (11): the weights of the forward pass, from point to row",
    sole="the definition of an adjoint, for the table",
)
def the_table_by_the_transpose(t):
    """<features of a table, g> = <table, d_table> for any table; each group of features alone."""
    for D, resolutions, features in ((2, [2, 5, 11], 2), (3, [2, 4], 3)):
        levels = layout(resolutions, D, 50)
        table, points = table_for(t, levels, features), t.rng.uniform(0.0, 1.0, (15, D))
        g = random_cotangent(t.rng, (15, len(levels) * features))
        d_table, _ = back(t, points, table, levels, g)
        for _ in range(3):
            x = t.rng.uniform(-1.0, 1.0, table.shape)
            is_the_transpose(t, "<x, d_table>", x, encoded(t, points, x, levels), g, d_table)
        nothing = back(t, points, table, levels, 0 * g)
        require_zero_for_zero(t, {"table": nothing[0], "points": nothing[1]})


@check(
    "13.4.collisions",
    points=3,
    hint="often: `d[row] += ...`, which keeps only the last contribution to a row that occurs "
    "twice; use `np.add.at` or `np.bincount`",
    sole="a thousand points in eight rows",
)
def rows_that_are_shared_sum_up(t):
    """A thousand points share eight rows: nothing is lost, and each point counts."""
    levels = layout([20], 2, 8)
    points, table = t.rng.uniform(0.0, 1.0, (1000, 2)), table_for(t, levels)
    g = t.rng.uniform(0.5, 1.5, (1000, 2))
    d_table, _ = back(t, points, table, levels, g)
    # The weights of a point sum to 1.
    t.close("the sum of d_table over rows", d_table.sum(axis=0), g.sum(axis=0), reveal=True)
    half = back(t, points[:500], table, levels, g[:500])[0]
    other = back(t, points[500:], table, levels, g[500:])[0]
    t.close("d_table, and the sum of two halves", d_table, half + other)


@check(
    "13.4.points",
    points=4,
    tolerance=GATE,
    hint="handout, equation (12): n times the difference across the cell, for each axis",
    sole="the derivative itself, without the reference",
)
def the_points_by_differences(t):
    """Moving a point, away from faces of cells, changes the features as your d_points says."""
    for D, resolutions, features in ((2, [1, 3, 7], 2), (3, [2, 5], 2)):
        levels = layout(resolutions, D, 60)
        table, points = table_for(t, levels, features), points_within(t, 5, D, levels)
        g = random_cotangent(t.rng, (5, len(levels) * features))
        _, d_points = back(t, points, table, levels, g)

        def forward(at, table=table, levels=levels):
            return encoded(t, at["points"], table, levels)

        agrees_with_finite_differences(
            t, {"points": d_points}, forward, {"points": points}, g, GATE
        )


@check(
    "13.4.outside",
    points=1,
    hint="a point outside is clamped: along that axis nothing changes",
    sole="points that no other check has",
)
def outside_nothing_changes(t):
    """Along an axis on which a point lies outside its derivative is 0; the table's is not."""
    levels = layout([3, 6], 2, 30)
    table, inside = table_for(t, levels), points_within(t, 6, 2, levels)
    out = inside.copy()
    out[:3, 0] = [-0.3, 1.4, -2.0]
    out[3:, 1] = [1.2, -0.1, 3.0]
    g = random_cotangent(t.rng, (6, 4))
    d_table, d_points = back(t, out, table, levels, g)
    t.require(
        not d_points[:3, 0].any() and not d_points[3:, 1].any(),
        "d_points is not zero along an axis on which the point lies outside",
    )
    t.require(bool(d_points[:3, 1].all() and d_points[3:, 0].all()), "d_points is zero elsewhere")
    clamped = back(t, np.clip(out, 0.0, 1.0), table, levels, g)
    t.close("d_table", d_table, clamped[0])
