"""Task 14.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, checks_for

from ..common import EXACT, regular, sampled

check = checks_for(calls=("edge_sampling_backward",), visibility="hidden")


def scene(t, n, count=0):
    """Arguments of the adapter, for n samples; a part of the polygon lies beyond the picture."""
    count = count or int(t.rng.integers(3, 8))
    polygon = regular(t, count, [9, 7], 7.5) + t.rng.uniform(-1, 1, (count, 2))
    colors = t.rng.uniform(-1, 1, (2, 3, 3)) * [1, 0.1, 0.1]
    return polygon, colors, t.rng.uniform(-1, 1, (12, 15, 3)), t.rng.random(n)


def right_of(reference, vertices, colors, d_image, u):
    """What the solution estimates."""
    paints = [lambda points, k=k: colors[k, :, 0] + points @ colors[k, :, 1:].T for k in (0, 1)]
    return reference.edge_sampling_backward(vertices, *paints, d_image, u)


@check(
    "14.2.hidden",
    points=2,
    tolerance=EXACT,
    sole="unseen polygons, partly beyond the picture",
    battery=[
        Subject(
            "adapters.sampled_edges",
            lambda t, n: scene(t, n, 3 + n % 5),  # equal n: equal shapes
            lambda _: Array((None, 2)),
            right=right_of,
        )
    ],
)
def unseen_polygons(t):
    """Random samples of random polygons, compared with the solution, sample by sample."""
    for count, twice in ((0, False), (200, False), (0, True)):
        given = list(scene(t, 300, count))
        if twice:  # a vertex, so that a side has no length
            given[0] = np.repeat(given[0], np.arange(len(given[0])) % 3 // 2 + 1, axis=0)
        t.close("d_vertices", sampled(t, *given), right_of(t.reference, *given))


def vertex_error(found, truth):
    """The largest distance of a vertex, however the vertices are numbered."""
    turns = [np.roll(found, k, axis=0) - truth for k in range(len(truth))]
    return min(float(np.hypot(*turn.T).max()) for turn in turns)


@check("14.2.triangle", points=2, sole="the application: a triangle")
def a_triangle_is_recovered(t):
    """Every vertex within 0.2 pixels, from five starts."""
    truth = regular(t, 3, [8, 8], 6) + t.rng.uniform(-1, 1, (3, 2))
    picture = t.reference.polygon_image(truth, 16, 16)
    for seed in range(5):
        turn, size = t.rng.uniform(-0.5, 0.5), t.rng.uniform(0.6, 0.9)
        c, s = size * np.cos(turn), size * np.sin(turn)
        start = 8 + t.rng.uniform(-1, 1, 2) + (truth - 8) @ np.array([[c, s], [-s, c]])
        got = t.call("adapters.triangle_found", picture, start, 100, seed, returns=Array((3, 2)))
        worst = vertex_error(got, truth)
        t.require(worst < 0.2, f"start {seed}: a vertex is off by {worst:.2f} pixels")


@check("14.2.outline", points=1, sole="the application: a silhouette")
def a_silhouette_is_recovered(t):
    """A blob, from a circle of 24 vertices: intersection over union 0.97 or more."""
    phase = t.rng.uniform(0, 6.28, 2)
    angle = np.arange(60) * 2 * np.pi / 60
    radius = 8 + 1.8 * np.sin(2 * angle + phase[0]) + 0.8 * np.sin(3 * angle + phase[1])
    blob = 14 + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    picture = t.reference.polygon_image(blob, 28, 28)
    start = regular(t, 24, [14, 14], 5)
    got = t.call("adapters.outline_found", picture, start, 90, 3, returns=Array((24, 2)))
    shown = t.reference.polygon_image(got, 28, 28)
    union = float(np.maximum(shown, picture).sum())
    overlap = float(np.minimum(shown, picture).sum()) / max(union, 1.0)
    t.require(overlap >= 0.97, f"intersection over union is {overlap:.3f}, below 0.97")
