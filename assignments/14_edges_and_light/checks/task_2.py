"""Task 14.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Tolerance, checks_for

from .common import EXACT, constant, differences, even, regular, require_mean, sampled, signed_area

check = checks_for(calls=("edge_sampling_backward",))

NODES = Tolerance(2e-3, "200,000 even samples leave 1e-4 at pixel borders, wrong ones 0.02 or more")
LINEAR = Tolerance(5e-4, "100,000 even samples leave 4e-5 at vertices, wrong ones 1e-2 or more")


@check(
    "14.2.point",
    points=1,
    tolerance=EXACT,
    hint=(
        "equations (9) and (10): perimeter over N, times the jump, times the normal, shared "
        "between the two ends of the side"
    ),
    sole="one sample that can be worked out by hand",
)
def one_point(t):
    """One sample on a side of a square, then one beyond the picture."""
    square = np.array([[2.0, 1], [6, 1], [6, 5], [2, 5]]) + t.rng.integers(0, 2, 2)
    d_image = t.rng.uniform(0.2, 1, (8, 9, 2))
    colors = t.rng.uniform(0.2, 1, (2, 2))
    share = float(t.rng.uniform(0.05, 0.2))
    x = square[1] + [0, 4 * share]
    got = sampled(t, square, constant(colors), d_image, np.array([0.25 + share / 4]))
    push = 16 * d_image[int(x[1]), int(x[0])] @ (colors[0] - colors[1])
    right = np.zeros((4, 2))
    right[1, 0], right[2, 0] = (1 - share) * push, share * push
    t.close("d_vertices", got, right, reveal=True)
    for shift in ([20, 0], [-8, 0], [0, 20], [0, -7]):
        got = sampled(t, square + shift, constant(colors), d_image, even(8))
        t.require(not got.any(), f"a square beyond the picture has a derivative, moved by {shift}")


@check(
    "14.2.area",
    points=4,
    tolerance=EXACT,
    hint="the integral over the boundary, with a normal that points out of the polygon",
    sole="the derivative of an area, in closed form",
)
def the_derivative_of_an_area(t):
    """The sum over all pixels is an area times the jump: its derivative is known.

    All sides are equally long and the samples even, so that the estimate is exact. Point samples
    of the pixels do not see the motion: their finite differences are 0.
    """
    for count in (3, 4, 7):
        polygon = regular(t, count, [8, 9], 6.5)
        colors, weights = t.rng.uniform(0, 1, (2, 3)), t.rng.uniform(0.5, 1, 3)
        d_image = np.broadcast_to(weights, (18, 17, 3)).copy()
        got = sampled(t, polygon, constant(colors), d_image, even(40 * count))
        t.require(
            bool(got.any()),
            "the derivative is 0, as that of point samples: the loss changes because edges move",
        )
        jump = weights @ (colors[0] - colors[1])
        x, y = np.roll(polygon, -1, axis=0).T - np.roll(polygon, 1, axis=0).T
        t.close("d_vertices", got, jump / 2 * np.stack([y, -x], axis=1), reveal=True)
        size = float(np.abs(got).sum())
        t.require(
            bool(np.abs(got.sum(axis=0)).max() < 1e-9 * size),
            "moving the polygon does not change its area, but the derivatives do not sum to 0",
        )


@check(
    "14.2.pixels",
    points=3,
    tolerance=NODES,
    hint="each sample multiplies the d_image of its own pixel: row by y, column by x",
    sole="the definition: differences of exact coverage",
)
def each_pixel_counts(t):
    """Against finite differences of the given `polygon_image`, whose areas are exact."""
    for shift in ([0, 0], [7, -5]):
        triangle = regular(t, 3, [7.5, 6.5], 5.5) + t.rng.uniform(-1, 1, (3, 2)) + shift
        d_image = t.rng.uniform(-1, 1, (13, 15, 1))
        got = sampled(t, triangle, constant(np.array([[1.0], [0.0]])), d_image, even(200000))

        def loss(vertices, d_image=d_image):
            shown = t.call("polygon_image", vertices, 13, 15, returns=Array((13, 15)))
            return float(np.sum(shown * d_image[..., 0]))

        t.close("d_vertices", got, differences(loss, triangle))


@check(
    "14.2.colors",
    points=2,
    tolerance=LINEAR,
    hint="both colors are those at the sample, inside minus outside",
    sole="colors that are not the same everywhere",
)
def colors_at_the_edge(t):
    """Colors that are linear in the point: the integral is a polynomial of the vertices."""
    polygon = regular(t, 4, [8, 8], 6) + t.rng.uniform(-1, 1, (4, 2))
    colors = t.rng.uniform(-1, 1, (2, 2, 3)) * [1, 0.1, 0.1]
    weights = t.rng.uniform(0.5, 1, 2)
    d_image = np.broadcast_to(weights, (16, 16, 2)).copy()
    c = weights @ (colors[0] - colors[1])

    def loss(vertices):
        """Integral of c0 + c1 x + c2 y over the polygon, by triangles from the origin."""
        after = np.roll(vertices, -1, axis=0)
        areas = (vertices[:, 0] * after[:, 1] - after[:, 0] * vertices[:, 1]) / 2
        return c[0] * signed_area(vertices) + c[1:] @ (areas @ (vertices + after)) / 3

    got = sampled(t, polygon, colors, d_image, even(100000))
    t.close("d_vertices", got, differences(loss, polygon))


@check(
    "14.2.mean",
    points=2,
    hint="a point on the boundary is chosen with density 1 / perimeter",
    sole="random samples, in sides that are not equally long",
)
def the_estimate_is_unbiased(t):
    """The mean over random samples is the derivative of the area along a random direction."""
    polygon = np.array([[1.0, 2], [14, 3], [13, 6], [4, 15]]) + t.rng.uniform(-0.5, 0.5, (4, 2))
    way = t.rng.uniform(-1, 1, (4, 2))
    x, y = np.roll(polygon, -1, axis=0).T - np.roll(polygon, 1, axis=0).T
    right = float(np.sum(way * np.stack([y, -x], axis=1))) / 2
    colors, ones = constant(np.array([[1.0], [0.0]])), np.ones((17, 17, 1))

    def draw():
        got = [sampled(t, polygon, colors, ones, t.rng.random(50)) for _ in range(60)]
        return np.array([np.sum(way * each) for each in got])

    require_mean(t, "derivative along a direction", draw, right)
