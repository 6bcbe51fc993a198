"""Task 05.6, public checks."""

import numpy as np
from photograd_course.grading import Integer, Items, Number, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import EXACT, WHOLE, Scene, built, distances, lengths

check = checks_for(calls=("traverse",), needs=("build_bvh",))


def rectangles(t, count, size=1.0, stretch=(1.0, 1.0, 1.0)):
    """A scene of random rectangles."""
    low = t.rng.uniform(-5, 5, (count, 3)) * stretch
    high = low + size * t.rng.uniform(0.3, 1.5, (count, 3))
    axis = t.rng.integers(0, 3, count)
    high[np.arange(count), axis] = low[np.arange(count), axis]
    return Scene(low, high)


def grow(t, scene):
    """The submission's tree for a scene, and its boxes for the scene's service."""
    tree = built(t, scene.low, scene.high)
    scene.boxes = tree[0]
    return tree


def first_met(t, scene, tree, origin, direction):
    """(t, number) of the submission."""
    scene.ray(origin, direction)
    parts = Items(Number(finite=False, above=0.0), Integer(), names=("t", "number"))
    _, first, count, order = tree
    return t.call(
        "traverse",
        first,
        count,
        order,
        scene.box,
        scene.intersect,
        origin,
        direction,
        returns=parts,
    )


def right_answer(t, scene, got, hint=""):
    """The nearest of all, asked one by one."""
    every = scene.times(np.arange(len(scene.low)))
    nearest = float(every.min())
    said = "nothing" if np.isinf(got[0]) else f"t = {got[0]:.6g}"
    asked = "nothing" if np.isinf(nearest) else "something"
    same = np.isinf(got[0]) == np.isinf(nearest)
    t.require(same, f"a ray hits {asked}, yours hits {said}", hint=hint)
    if np.isinf(nearest):
        t.require(got[1] == -1, "a ray that hits nothing has the number -1")
        return
    t.close("t", got[0], nearest, EXACT, hint=hint)
    t.require(0 <= got[1] < len(every) and every[got[1]] == nearest, "t is right, number is not")


@check(
    "05.6.nearest",
    points=4,
    hint="handout, equation (19): a box may be skipped only if it is missed or begins behind "
    "the best so far",
    sole="the same answer as from asking everything",
)
def the_nearest_of_all(t):
    """The first primitive that rays hit is the one found by asking all."""
    for count, size in ((1, 1.0), (3, 1.0), (60, 1.0), (30, 6.0)):  # the last ones overlap a lot
        scene = rectangles(t, count, size)
        tree = grow(t, scene)
        for k in range(10):
            origin, direction = (
                t.rng.uniform(-6, 6, 3),
                unit_vectors(t.rng, 1)[0] * lengths(t, 1)[0, 0],
            )
            if k % 2:  # aimed at one
                which = t.rng.integers(count)
                target = t.rng.uniform(scene.low[which], scene.high[which])
                direction = (target - origin) * t.rng.uniform(0.2, 1.4)
            right_answer(t, scene, first_met(t, scene, tree, origin, direction))


@check(
    "05.6.axes",
    points=3,
    hint="where a component of the direction is 0, the origin is between both faces or not",
    sole="what random rays never do, and those of a camera always",
)
def rays_along_axes(t):
    """Rays along axes and in planes, from points on faces too, hit what they should."""
    scene = rectangles(t, 40, 2.0)
    tree = grow(t, scene)
    for k in range(18):
        origin, direction = t.rng.uniform(-5, 5, 3), unit_vectors(t.rng, 1)[0]
        direction[k % 3] = 0.0
        if k % 2:
            direction[(k + 1) % 3] = 0.0
        which = t.rng.integers(40)
        target = t.rng.uniform(scene.low[which], scene.high[which])
        origin = np.where(direction == 0, target, origin)
        right_answer(t, scene, first_met(t, scene, tree, origin, direction))
    # One rectangle, and rays through its edges and corners: they run along faces of its box.
    scene = Scene(np.array([[2.0, -1, 0.5]]), np.array([[2.0, 1, 3]]))
    tree = grow(t, scene)
    for y, z in ((-1, 2), (1, 2), (0, 0.5), (0, 3), (1, 3), (-1, 0.5), (1.5, 2)):
        for x, ahead in ((0.0, 0.5), (5.0, -1.0)):
            answer = first_met(t, scene, tree, np.array([x, y, z]), np.array([ahead, 0, 0]))
            right_answer(t, scene, answer, "0/0 is no number: deal with such axes by themselves")


def lanes(t, rows, deep):
    """A scene of rectangles across x, `deep` of them one behind the other in rows x rows lanes."""
    x, y, z = np.meshgrid(np.arange(deep), np.arange(rows), np.arange(rows), indexing="ij")
    low = np.stack([x, y, z], axis=3).reshape(-1, 3).astype(float)
    low += t.rng.uniform(0.05, 0.15, low.shape)
    high = low + np.array([0.0, 0.7, 0.7])
    return Scene(low, high)


@check(
    "05.6.cost",
    points=3,
    hint="handout, equation (20): the nearer box first, and what begins behind the best, never",
    sole="what a tree is for: evaluations are counted, not seconds",
)
def few_boxes_are_asked_for(t):
    """A ray through many primitives tests the boxes that it enters before its hit, and siblings."""
    scene = lanes(t, 4, 16)
    tree = grow(t, scene)
    boxes, _, count, _ = tree
    for k in range(12):
        ahead = 1.0 if k % 2 else -1.0
        lane = t.rng.integers(0, 4, 2) + 0.4
        origin = np.array([-2.0 if ahead > 0 else 18.0, *lane])
        if k % 3 == 0:
            origin[0] = t.rng.uniform(3, 12)
        got = first_met(t, scene, tree, origin, np.array([ahead, 0.0, 0.0]))
        right_answer(t, scene, got)
        end = origin[0] + ahead * got[0]
        inside = ((boxes[:, 0, 1:] <= lane) & (lane <= boxes[:, 1, 1:])).all(axis=1)
        begins = boxes[:, 0, 0] <= end + 1e-9 if ahead > 0 else boxes[:, 1, 0] >= end - 1e-9
        passed = boxes[:, 1, 0] < origin[0] if ahead > 0 else boxes[:, 0, 0] > origin[0]
        entered = inside & begins & ~passed
        needed = 1 + 2 * int((entered & (count == 0)).sum())
        primitives = int(count[entered].sum())
        t.require(
            len(scene.asked) <= needed, f"{len(scene.asked)} boxes were tested, {needed} are enough"
        )
        t.require(
            len(scene.met) <= primitives,
            f"{len(scene.met)} primitives were tested, {primitives} are enough",
        )


@check(
    "05.6.growth",
    points=2,
    hint="16 times as many primitives are four more levels, not 16 times as many boxes",
    sole="growth, by counts",
)
def questions_grow_like_a_logarithm(t):
    """With 16 times as many primitives of a sheet, fewer than twice as many boxes are tested."""
    means = []
    for rows in (8, 32):
        scene = lanes(t, rows, 1)
        scene.low[:, 1:], scene.high[:, 1:] = scene.low[:, 1:] / rows, scene.high[:, 1:] / rows
        tree = grow(t, scene)
        asked = 0
        for k in range(9):
            which = t.rng.integers(rows * rows)
            target = t.rng.uniform(scene.low[which], scene.high[which])
            origin = target - [2.0, *t.rng.uniform(-0.3, 0.3, 2)] if k % 3 else target - [2.0, 0, 0]
            right_answer(t, scene, first_met(t, scene, tree, origin, target - origin))
            asked += len(scene.asked)
        means.append(asked / 9)
    t.require(
        means[1] < 2 * means[0],
        f"64 primitives: {means[0]:.1f} boxes a ray, 1024 primitives: {means[1]:.1f}",
    )


def ring():
    """Triangles (256, 3, 3) of a ring, with coordinates that float32 has exactly."""
    turn, across = 2 * np.pi * np.arange(16) / 16, 2 * np.pi * np.arange(8) / 8
    far = 2 + 0.75 * np.cos(across)
    height = np.broadcast_to(0.75 * np.sin(across), (16, 8))
    v = np.stack([far * np.cos(turn)[:, None], height, far * np.sin(turn)[:, None]], axis=2)
    v = np.round(v * 64) / 64
    a, b = v, np.roll(v, -1, axis=1)
    d, c = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    both_halves = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return both_halves.reshape(-1, 3, 3)


def ring_rays():
    """(origins, directions) of 24 rays from all around the ring."""
    k = np.arange(24)
    height, phi = 1 - (k + 0.5) / 12, 2.399963 * k
    flat = np.sqrt(1 - height * height)
    origins = np.round(256 * np.stack([flat * np.cos(phi), height, flat * np.sin(phi)], axis=1))
    s, far = 1.7 * phi + 0.3, np.where(k % 4 == 3, 0.5, 2.2)
    to = np.round(64 * np.stack([far * np.cos(s), 0.5 * np.sin(3 * k), far * np.sin(s)], axis=1))
    return origins / 64, (to - origins) / 64


# What Embree [Wald2014] says about them, through the C++ core: triangles, and t where there is one.
EMBREE = (
    2,
    165,
    87,
    -1,
    147,
    68,
    7,
    57,
    17,
    114,
    193,
    48,
    174,
    254,
    76,
    188,
    106,
    40,
    204,
    -1,
    10,
    187,
    93,
    -1,
)
EMBREE_T = (
    0.8074094252247,
    0.8333343913262,
    0.8203379780611,
    0.6868570173722,
    0.8616933137047,
    0.7339925628934,
    1.510409875712,
    0.4864799483926,
    0.3117000289521,
    0.3291869230618,
    0.4012528131706,
    0.3723334201136,
    0.2246670824919,
    0.5828264512131,
    0.3993073220366,
    0.821178456555,
    0.8116245224668,
    0.8129629882266,
    0.8471657567662,
    0.7978106266098,
    0.8077895024417,
)


@check(
    "05.6.embree",
    points=2,
    needs=("build_bvh", "hit_triangle"),
    tolerance=EXACT,
    hint="traverse on triangles: the other checks of this task are simpler",
    sole="the whole, against a library that films are made with",
)
def as_embree_has_it(t):
    """Your tree and triangles find what Embree finds: the triangle, and where."""
    origins, directions = ring_rays()
    parts = Items(distances(24), WHOLE, names=("t", "number"))
    got, numbers = t.call("trace_mesh", ring(), origins, directions, returns=parts)
    right = np.array(EMBREE)
    t.require(len(numbers) == 24, "a number for each ray")
    wrong = int((numbers != right).sum())
    t.require(wrong == 0, f"{wrong} of 24 rays hit another triangle, or none")
    t.close("t", got[right >= 0], np.array(EMBREE_T))
