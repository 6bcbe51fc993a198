"""The figures of assignment 05, and the facts that their captions claim."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes
from photograd_course.viz.style import RED as CRIMSON

FIGURE_1 = kit_module("05_rays_and_shapes", "figure_1")
_ring_rays = FIGURE_1._ring_rays


def fig1_images(module: ModuleType) -> tuple[Figure, Facts]:
    """A ball of glass over a floor, and a ring of triangles, by your functions."""
    figure, found = FIGURE_1.draw(module)
    facts: Facts = {
        "every ray leaves the ball": Fact(found["every ray leaves the ball"]),
        "in the ball the sky is below": Fact(found["in the ball the sky is below"], 0.2, 1.0),
        "the ring is hit": Fact(found["the ring is hit"], 0.2, 0.8),
    }
    return figure, facts


def fig2_edges(module: ModuleType) -> tuple[Figure, Facts]:
    """Weights of two triangles; rays onto edges that miss all triangles."""
    size = 54
    y, x = (np.mgrid[:size, :size] + 0.5) / size
    square = np.array([[[0, 0, 1], [1, 0, 1], [1, 1, 1]], [[0, 0, 1], [1, 1, 1], [0, 1, 1.0]]])
    picture, sums = np.ones((size, size, 3)), []
    for i in range(size):
        for j in range(size):
            at = np.array([x[i, j], y[i, j], 0.0])
            t, weights = module.hit_triangle(at, np.array([0, 0, 1.0]), square)
            k = int(np.argmin(t))
            if np.isfinite(t[k]):
                picture[i, j] = 1 - weights[k].sum(), *weights[k]
                corner = square[k].T @ picture[i, j]
                sums.append(np.abs(corner[:2] - at[:2]).max())
    rng = np.random.default_rng(2)
    corners, ends = _sheet(rng, 5)
    s = rng.random((2000, 1))
    which = rng.integers(0, len(ends), 2000)
    places = (1 - s) * ends[which, 0] + s * ends[which, 1]
    ways = np.column_stack([rng.uniform(-0.3, 0.3, (2000, 2)), -np.ones(2000)])
    lost = [
        not np.isfinite(module.hit_triangle(place - 4 * way, way, corners)[0]).any()
        for place, way in zip(places, ways, strict=True)
    ]
    lost_by_corner = ~_from_a_corner(places - 4 * ways, ways, corners).any(axis=1)
    facts: Facts = {
        "none misses": Fact(not any(lost)),
        "relative to a corner more than one in a hundred": Fact(np.mean(lost_by_corner), 0.01, 1.0),
        "weights reproduce the hit point": Fact(max(sums, default=1.0), 0.0, 1e-12),
    }
    figure, (left, right) = subplots(7.0, 3.3, 1, 2)
    left.imshow(np.clip(picture, 0, 1), origin="lower", extent=(0, 1, 0, 1))
    left.plot([0, 1], [0, 1], color="white", linewidth=0.8)
    for triangle in square[:, :, :2]:
        for letter, corner in zip("abc", triangle, strict=True):
            place = corner + 0.17 * (triangle.mean(axis=0) - corner)
            left.annotate(letter, place, color="white", ha="center", va="center")
    left.set(xticks=[], yticks=[], title="weights of a, b, c")
    for one, two in ends:
        right.plot(*np.array([one, two]).T[:2], color=GRAY, linewidth=0.7)
    right.plot(*places[lost_by_corner].T[:2], "o", color=CRIMSON, markersize=3)
    right.plot(*places[np.array(lost)].T[:2], "x", color=INK)
    title = f"misses relative to a corner: {sum(lost_by_corner)}, with (7): {sum(lost)}"
    right.set(xticks=[], yticks=[], aspect="equal", title=title)
    return figure, facts


def fig3_march(module: ModuleType) -> tuple[Figure, Facts]:
    """Sphere tracing of two rays; the derivative of t with respect to a radius."""
    asked: list[Array] = []

    def scene(places: Array) -> tuple[Array, Array, Array]:
        asked.append(places)
        one, two = _ball(1.0)(places), (3.0 - places[:, 0], places * 0 - [1.0, 0, 0])
        nearer = one[0] < two[0]
        gradient = np.where(nearer[:, None], one[1], two[1])
        return np.where(nearer, one[0], two[0]), gradient, np.where(nearer, -1.0, 0.0)

    walks = []
    for height in (1.05, -2.2):
        asked.clear()
        at = np.array([[-3.0, height, 0]])
        t, _ = module.march_sdf(scene, at, np.array([[1.0, 0, 0]]), 20.0, 200)
        walks.append((np.concatenate(asked), float(t[0])))
    places = walks[0][0]
    room = np.minimum(np.hypot(places[:, 0], places[:, 1]) - 1, 3 - places[:, 0])
    ahead = np.diff(places[:, 0])
    y = np.linspace(-0.96, 0.96, 49)
    origins = np.stack([np.full(49, -3.0), y, np.zeros(49)], axis=1)
    ways = np.tile([1.0, 0, 0], (49, 1))
    slopes = module.march_sdf(_ball(1.0), origins, ways, 20.0, 3000)[1]
    eps = 1e-4
    ends = [module.march_sdf(_ball(1 + e), origins, ways, 20.0, 3000)[0] for e in (-eps, eps)]
    apart = (_finite(ends[1]) - _finite(ends[0])) / (2 * eps)
    facts: Facts = {
        "both hit the wall": Fact(max(abs(each[1] - 6) for each in walks) < 1e-8),
        "the grazing ray takes three times as many evaluations or more": Fact(
            len(walks[0][0]) / len(walks[1][0]), 3.0, 30.0
        ),
        "no step is longer than the distance": Fact(
            len(ahead) > 3 and (ahead <= room[:-1] + 1e-12).all()
        ),
        "finite differences agree": Fact(np.abs(slopes - apart).max(), 0.0, 1e-3),
        "toward the silhouette it grows": Fact(abs(slopes[0]) > 3 * abs(slopes[24]) > 1),
    }
    figure, (left, right) = subplots(7.0, 3.2, 1, 2, width_ratios=(1.4, 1))
    left.add_patch(Circle((0, 0), 1, facecolor="#f6dcc3", edgecolor=INK, linewidth=0.8))
    left.axvline(3, color=INK)
    for (walk, _), color in zip(walks, (BLUE, ORANGE), strict=True):
        left.plot([-3, 3], walk[[0, 0], 1], color=color, linewidth=0.6)
        for place in walk[:60]:
            free = abs(float(scene(place[None])[0][0]))
            left.add_patch(Circle(place[:2], free, fill=False, edgecolor=color, linewidth=0.6))
        left.plot(*walk[:, :2].T, ".", color=color, markersize=3)
    left.set(xlim=(-5.3, 3.4), ylim=(-3.9, 3.2), aspect="equal", xlabel="x  [m]")
    right.plot(y, slopes, color=BLUE)
    right.plot(y[::4], apart[::4], "o", color=INK, markersize=3)
    right.set(xlabel="height  [radii]", ylabel="∂t/∂p")
    plain_axes(right)
    return figure, facts


def fig4_tree(module: ModuleType) -> tuple[Figure, Facts]:
    """Boxes tested for each pixel; boxes by the number of triangles."""
    width, height = 90, 54
    origins, ways = _ring_rays(module, width, height, 52.0)
    counts, depth = _asked(module, module.ring(16, 8), origins, ways)
    every = [
        module.hit_triangle(o, d, module.ring(16, 8))[0].min(initial=np.inf)
        for o, d in zip(origins[::23], ways[::23], strict=True)
    ]
    hits = np.isfinite(depth)
    sizes, means = [], []
    chosen = np.flatnonzero(hits)[::32]
    for turns in (8, 16, 32, 64):
        sizes.append(turns * turns)
        found, _ = _asked(module, module.ring(turns, turns // 2), origins[chosen], ways[chosen])
        means.append(float(np.mean(found)))
    facts: Facts = {
        "the hits are those of testing every triangle": Fact(
            np.allclose(_finite(depth[::23]), _finite(np.array(every)), atol=1e-9)
        ),
        "a miss of the root tests one box": Fact(counts.min() == 1),
        "the most expensive pixel tests some 60": Fact(int(counts.max()), 45, 75),
        "from 256 to 4096 less than twice as many": Fact(means[3] / means[1], 1.0, 2.0),
        "with 256 triangles about 25": Fact(means[1], 22.0, 28.0),
    }
    figure, (left, right) = subplots(7.0, 2.9, 1, 2, width_ratios=(1.5, 1))
    drawn = left.imshow(counts.reshape(height, width), cmap="viridis", vmin=0)
    figure.colorbar(drawn, ax=left, label="tested boxes", shrink=0.8)
    left.set(xticks=[], yticks=[])
    right.loglog(sizes, sizes, color=GRAY, linewidth=1)
    right.loglog(sizes, means, color=BLUE, marker="o", markersize=4)
    note(right, "every triangle", (sizes[1], sizes[1]), (-30, 22), color=INK)
    note(right, "boxes of the tree", (sizes[1], means[1]), (-20, -16), color=BLUE)
    right.set(xlabel="triangles", ylabel="tests per ray", ylim=(5, 8000))
    right.set_xticks(sizes, [str(k) for k in sizes])
    right.minorticks_off()
    plain_axes(right)
    return figure, facts


def _finite(t: Array) -> Array:
    return np.where(np.isfinite(t), t, 0.0)


def _angle(ways: Array) -> Array:
    """Angle with the z axis, in degrees."""
    return np.degrees(np.arctan2(np.abs(ways[:, 0]), np.abs(ways[:, 2])))


def _ball(radius: float) -> Callable[[Array], tuple[Array, Array, Array]]:
    def shape(places: Array) -> tuple[Array, Array, Array]:
        away = np.linalg.norm(places, axis=1)
        return away - radius, places / away[:, None], -np.ones(len(places))

    return shape


def _sheet(rng: np.random.Generator, n: int) -> tuple[Array, Array]:
    """(corners (M, 3, 3), inner edges (E, 2, 3)) of a bumpy sheet."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    v = np.stack([x, y, np.zeros(x.shape)], axis=2) + rng.uniform(-0.3, 0.3, (n + 1, n + 1, 3))
    a, b, c, d = v[:-1, :-1], v[1:, :-1], v[1:, 1:], v[:-1, 1:]
    both = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    edges = [
        np.stack([a, c], axis=2),
        np.stack([b, c], axis=2)[:-1],
        np.stack([d, c], axis=2)[:, :-1],
    ]
    return both.reshape(-1, 3, 3), np.concatenate([e.reshape(-1, 2, 3) for e in edges])


def _from_a_corner(origins: Array, ways: Array, corners: Array) -> Array:
    """Whether rays hit triangles (R, M), relative to the corner a of each [Moller1997]."""
    a, b, c = np.moveaxis(corners, 1, 0)
    origin, way = origins[:, None], ways[:, None]
    p, q = np.cross(way, c - a), np.cross(origin - a, b - a)
    whole = np.sum((b - a) * p, axis=2)
    u, v = np.sum((origin - a) * p, axis=2) / whole, np.sum(way * q, axis=2) / whole
    return (u >= 0) & (v >= 0) & (u + v <= 1)


def _asked(module: ModuleType, corners: Array, origins: Array, ways: Array) -> tuple[Array, Array]:
    """(tested boxes, t), both (R,), of rays through the tree of triangles."""
    boxes, first, count, order = module.build_bvh(corners.min(axis=1), corners.max(axis=1))
    asked, found = np.zeros(len(origins), int), np.zeros(len(origins))
    for r, (o, d) in enumerate(zip(origins, ways, strict=True)):

        def box(node: int, r: int = r) -> Array:
            asked[r] += 1
            return boxes[node]

        def intersect(primitives: Array, o: Array = o, d: Array = d) -> Array:
            return module.hit_triangle(o, d, corners[primitives])[0]

        found[r] = module.traverse(first, count, order, box, intersect, o, d)[0]
    return asked, found


FIGURES = figures_of(fig1_images, fig2_edges, fig3_march, fig4_tree)
RED = {
    "fig1_images": "refract_from_inside_alike",
    "fig2_edges": "triangle_cramer",
    "fig3_march": "march_d_no_cosine",
    "fig4_tree": "traverse_far_child_lost",
}
