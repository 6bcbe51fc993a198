"""Task 06.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT, FAITHFUL, rays_of, snapped

check = checks_for(calls=("rasterize",), tolerance=EXACT)


def drawn(t, corners, height, width):
    """(face, weights, depth) of the submission."""
    shape = height, width
    return t.call(
        "rasterize",
        corners,
        height,
        width,
        returns=Items(
            Array(shape, "i8"),
            Array((*shape, 3)),
            Array(shape, finite=False, above=0.0),
            names=("face", "weights", "depth"),
        ),
    )


def facing(x, y, z):
    """Triangles (F, 3, 3) of x, y (F, 3), and one depth."""
    return np.stack([x, y, np.full_like(x, z)], axis=2)


def mesh_of(t, cells, step):
    """Triangles that cover a square of cells x cells, `step` pixels each, once, any winding."""
    x, y = np.meshgrid(np.arange(cells + 1.0), np.arange(cells + 1.0), indexing="xy")
    points = step * np.stack([x, y], axis=2)
    # Corners inside of the square lie on centers of pixels.
    points[1:-1, 1:-1] += t.rng.integers(-1, 2, (cells - 1, cells - 1, 2)) + 0.5
    found = []
    for v, u in np.ndindex(cells, cells):
        a, b, c, d = points[v, u], points[v, u + 1], points[v + 1, u + 1], points[v + 1, u]
        halves = ((a, b, c), (a, c, d)) if t.rng.random() < 0.5 else ((a, b, d), (b, c, d))
        found += [half[:: t.rng.choice([1, -1])] for half in halves]
    flat = np.array(found)
    return np.concatenate([flat, np.full((len(flat), 3, 1), 2.0)], axis=2)


@check(
    "06.1.once",
    points=4,
    hint="handout, equation (5): a center on an edge belongs to the triangle whose top or left "
    "edge it is; if left and right or top and bottom are swapped, remember that y is down. "
    "Indices are (row, column)",
    sole="which pixels belong to a triangle",
)
def each_pixel_belongs_to_one_triangle(t):
    """Triangles that share edges cover each pixel exactly once, also where edges meet centers."""
    half = np.array([[0.5, 0.5, 2], [4.5, 0.5, 2], [0.5, 4.5, 2]])
    other = np.array([[4.5, 0.5, 2], [4.5, 4.5, 2], [0.5, 4.5, 2]])
    v, u = np.mgrid[:6, :6]
    square = (u < 4) & (v < 4)
    for winding in (1, -1):
        for corners, mask in ((half, u + v < 4), (other, u + v >= 4)):
            face, *_ = drawn(t, corners[None, ::winding], 6, 6)
            t.close("pixels of a triangle", face == 0, square & mask, FAITHFUL, reveal=True)
    narrow = np.array([[0.25, 0.5, 2], [0.75, 0.5, 2], [0.5, 3.25, 2]])
    face, *_ = drawn(t, narrow[None], 4, 1)
    t.close("pixels of a narrow triangle", face[:, 0], [0, 0, 0, -1], FAITHFUL, reveal=True)
    corners = mesh_of(t, 4, 6)
    count = sum((drawn(t, each[None], 24, 24)[0] >= 0).astype(float) for each in corners)
    t.close("triangles that cover a pixel", count, np.ones((24, 24)), FAITHFUL, reveal=True)


@check(
    "06.1.perspective",
    points=5,
    hint="handout, equations (6) and (7): 1 / depth is linear in the picture, depth is not. The "
    "weights mix anything that is linear on the triangle, such as positions, as (2) does",
    sole="a closed form for weights and depths",
)
def a_slanted_triangle_in_perspective(t):
    """Depths are those of the triangle's plane; weights give the point that the pixel sees."""
    height, width, focal = 20, 26, 24.0
    rays = rays_of(height, width, focal)
    for _ in range(3):
        corners = np.array([[[-9.0, -7, 0], [41, -4, 0], [5, 33, 0]]])
        corners[..., :2] += snapped(t.rng, -2, 2, (1, 3, 2))
        corners[..., 2] = t.rng.permutation([1.5, 4.0, 9.0]) * t.rng.uniform(0.9, 1.1, 3)
        x, y, z = np.moveaxis(corners[0], 1, 0)
        points = np.stack([(x - width / 2) / focal * z, (y - height / 2) / focal * z, z], axis=1)
        across = np.cross(points[1] - points[0], points[2] - points[0])
        right = points[0] @ across / (rays @ across)
        face, weights, depth = drawn(t, corners, height, width)
        seen = face == 0
        t.require(int(seen.sum()) > 200, "the triangle covers more than 200 pixels")
        t.require(bool(np.isinf(depth[~seen]).all()), "depth is infinite where nothing is seen")
        near = np.where(seen, depth, 0.0), np.where(seen, right, 0.0)
        t.close("depth, 0 where nothing is seen", *near, reveal=True)
        t.close("sum of the weights", weights[seen].sum(axis=1), np.ones(seen.sum()))
        t.close(
            "positions of the corners, mixed with your weights",
            np.where(seen[..., None], weights @ points, 0.0),
            np.where(seen, right, 0.0)[..., None] * rays,
            reveal=True,
        )


@check(
    "06.1.nearest",
    points=3,
    hint="handout, equation (8): a pixel keeps the nearest triangle, whatever the order; "
    "buffers start as -1, 0 and infinity in each call",
    sole="the depth test and the buffers",
)
def the_nearest_triangle_wins(t):
    """In any order the nearest triangle is seen, the first of equals; nothing where none is."""
    x, y = np.array([[-1.0, 30, -1]]), np.array([[-1.0, -1, 30]])
    z = t.rng.permutation(np.array([2.0, 3.0, 3.5, 5.0, 8.0]))
    corners = np.concatenate([facing(x, y, each) for each in z])
    face, weights, depth = drawn(t, corners, 8, 9)
    t.close("face", face, np.full((8, 9), z.argmin()), FAITHFUL, reveal=True)
    t.close("depth", depth, np.full((8, 9), 2.0), reveal=True)
    face, *_ = drawn(t, np.concatenate([corners[:1]] * 3), 8, 9)
    t.require(not face.any(), "of equally near triangles the first counts")
    small = facing(np.array([[1.0, 5, 1]]), np.array([[1.0, 1, 5]]), 9.0)
    face, weights, depth = drawn(t, small, 8, 9)
    seen = face == 0
    t.require(
        1 < int(seen.sum()) < 20, "a small triangle covers some pixels, after larger ones too"
    )
    t.require(bool((face[~seen] == -1).all()), "face is -1 where nothing is seen")
    t.require(bool(np.isinf(depth[~seen]).all()), "depth is infinite where nothing is seen")
    t.require(not weights[~seen].any(), "weights are 0 where nothing is seen")
    crossing = np.array(
        [[[-1.0, -1, 2], [30, -1, 9], [-1, 30, 2]], [[-1, -1, 9], [30, -1, 2], [-1, 30, 9]]]
    )
    one, two = (drawn(t, each[None], 8, 28)[2] for each in crossing)
    both, shown = (drawn(t, crossing[order], 8, 28)[2] for order in ([0, 1], [1, 0]))
    seen = np.isfinite(np.minimum(one, two))
    t.close("depth of triangles that cross", both[seen], np.minimum(one, two)[seen])
    t.close("depth in the other order", shown[seen], both[seen])
