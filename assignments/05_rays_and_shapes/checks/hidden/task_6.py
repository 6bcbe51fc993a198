"""Task 05.6, hidden checks."""

from photograd_course.grading import Integer, Items, Number, Subject, hidden_check

from ..common import EXACT
from ..task_6 import first_met, rectangles, right_answer


def searched(t, n):
    """Arguments of `traverse`: n primitives, and a ray toward one of them."""
    scene = rectangles(t, n, 3.0)
    scene.boxes, *tree = t.reference.build_bvh(scene.low, scene.high)
    origin = t.rng.uniform(-4, 4, 3)
    scene.ray(origin, (scene.low[0] + scene.high[0]) / 2 - origin)
    return *tree, lambda k: scene.box(int(k)), scene.intersect, origin, scene.direction


@hidden_check(
    "05.6.hidden",
    points=2,
    calls=("traverse",),
    needs=("build_bvh",),
    tolerance=EXACT,
    sole="the same mistakes in unseen scenes",
    battery=[
        Subject(
            "traverse",
            searched,
            lambda _: Items(Number(finite=False, above=0.0), Integer()),
            sizes=(1, 2, 64),
        )
    ],
)
def scenes_at_random(t):
    """Random rays in random scenes: the answer, and how many boxes and primitives it takes."""
    # Of 3, 6, 12 ... primitives a third are alone in their leaves, and those boxes are flat.
    for count, size in ((3, 1.5), (24, 6.0), (96, 1.5)):
        scene = rectangles(t, count, size)
        low, high = scene.low, scene.high
        tree = t.reference.build_bvh(low, high)
        scene.boxes = tree[0]
        mine, enough = [0, 0], [0, 0]
        for _ in range(8):
            which = t.rng.integers(count)
            target = t.rng.uniform(low[which], high[which])
            origin = t.rng.uniform(-4, 4, 3)
            direction = (target - origin) * t.rng.uniform(0.2, 1.4)
            right_answer(t, scene, first_met(t, scene, tree, origin, direction))
            mine = [mine[0] + len(scene.asked), mine[1] + len(scene.met)]
            scene.ray(origin, direction)
            t.reference.traverse(
                tree[1],
                tree[2],
                tree[3],
                lambda k, s=scene: s.box(int(k)),
                scene.intersect,
                origin,
                direction,
            )
            enough = [enough[0] + len(scene.asked), enough[1] + len(scene.met)]
        for what, got, right in zip(("boxes", "primitives"), mine, enough, strict=True):
            t.require(got <= 1.05 * right, f"{got} {what} were tested, {right} are enough")
