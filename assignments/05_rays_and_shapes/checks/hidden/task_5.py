"""Task 05.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.generators import unit_vectors

from ..common import EXACT, WHOLE, Scene, built, require_tree
from ..task_5 import held


def stacked(t, n):
    """Arguments of `build_bvh`."""
    low = t.rng.uniform(-5, 5, (n, 3))
    return low, low + t.rng.uniform(0.2, 1.0, (n, 3))


def tight(low, high, primitives):
    """The smallest box of each list of primitives."""
    return np.array([[low[mine].min(axis=0), high[mine].max(axis=0)] for mine in primitives])


def misfit(t, args, tree):
    """By how much boxes of a tree are off: 0 for all right ones."""
    require_tree(t, len(args[0]), tree)
    return float(np.abs(tree[0] - tight(*args, held(tree))).max())


@hidden_check(
    "05.5.hidden",
    points=2,
    calls=("build_bvh",),
    tolerance=EXACT,
    sole="the same mistakes at unseen primitives; growth",
    battery=[
        Subject(
            "build_bvh",
            stacked,
            lambda _: Items(Array((None, 2, 3)), WHOLE, WHOLE, WHOLE),
            common=misfit,
        )
    ],
)
def trees_at_random(t):
    """Random primitives: the boxes fit, and many more of them cost a ray few more boxes."""
    means = []
    for count in (64, 1024):
        middle = t.rng.uniform(-5, 5, (count, 3)) * [1.0, 2.0, 1.0]
        half = 2.0 * count ** (-1 / 2) * t.rng.uniform(0.2, 1, (count, 3))
        low, high = middle - half, middle + half
        tree = built(t, low, high)
        primitives = held(tree)
        t.close(f"boxes of {count} primitives", tree[0], tight(low, high, primitives))
        asked = 0
        for _ in range(24):
            scene = Scene(low, high)
            scene.boxes = tree[0]
            scene.ray(t.rng.uniform(-8, 8, 3), unit_vectors(t.rng, 1)[0])
            t.reference.traverse(
                tree[1],
                tree[2],
                tree[3],
                lambda k, s=scene: s.box(int(k)),
                scene.intersect,
                scene.origin,
                scene.direction,
            )
            asked += len(scene.asked)
        means.append(asked / 24)
    t.require(
        means[1] < 4 * means[0],
        f"64 primitives: {means[0]:.1f} boxes for a ray, 1024 primitives: {means[1]:.1f}; "
        "fewer than four times as many are enough",
    )
