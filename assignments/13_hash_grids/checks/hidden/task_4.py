"""Task 13.4, hidden checks."""

from photograd_course.grading import Array, Items, Subject, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent, require_cheap

from ..common import EXACT, layout, points_within, table_for
from ..task_4 import EARLIER, back

check = checks_for(calls=("encode_backward",), needs=EARLIER, tolerance=EXACT, visibility="hidden")


def scattered(t, n):
    """Arguments of `encode_backward`, for n points, the first of them outside."""
    levels = layout([2, 4, 9], 3, 64)
    table, points = table_for(t, levels), t.rng.uniform(-0.5, 1.5, (n, 3))
    points[:1, 0] = 1.05
    return points, table, levels, random_cotangent(t.rng, (n, 6))


@check(
    "13.4.hidden",
    points=3,
    sole="the same mistakes at unseen points",
    battery=[
        Subject(
            "encode_backward",
            scattered,
            lambda n: Items(Array((155, 2)), Array((n, 3))),
            sizes=(0, 1, 2, 7),
        )
    ],
)
def the_adjoint_at_random_points(t):
    """Both parts of the adjoint are right at random points, on dense and hashed levels."""
    for D, resolutions, features in (
        (2, [1, 5, 40], 3),
        (3, [4, 30], 2),
        (2, [1000, 7], 1),
        (2, [3] * 20, 9),
    ):
        levels = layout(resolutions, D, 100)
        table, points = table_for(t, levels, features), points_within(t, 20, D, levels)
        g = random_cotangent(t.rng, (20, len(levels) * features))
        d_table, d_points = back(t, points, table, levels, g)
        right = t.reference.encode_backward(points, table, levels, g)
        t.close(f"d_table, D = {D}", d_table, right[0])
        t.close(f"d_points, D = {D}", d_points, right[1])


@check("13.4.cost", points=1)
def the_adjoint_is_cheap(t):
    """For a table of 4,000 numbers the adjoint is right, and costs a few forward calls."""
    levels = layout([8, 16, 32, 64], 2, 900)
    table, points = table_for(t, levels), points_within(t, 60, 2, levels)
    g = random_cotangent(t.rng, (60, 8))
    d_table, d_points = back(t, points, table, levels, g)
    right = t.reference.encode_backward(points, table, levels, g)
    t.close("d_table", d_table, right[0])
    t.close("d_points", d_points, right[1])
    parts = Items(Array(table.shape), Array(points.shape), names=("d_table", "d_points"))
    require_cheap(
        t,
        ("encode", (points, table, levels), Array((60, 8))),
        ("encode_backward", (points, table, levels, g), parts),
    )
