"""Task 15.5, hidden checks."""

from photograd_course.grading import Array, Record, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent, require_cheap

from ..common import EARLIER, EXACT, ahead, in_world, some_camera, some_scene
from ..task_5 import middle_pixels, shown, shown_back
from .common import values


def pictured(t, n):
    """Arguments of `render`: five Gaussians, n pixels."""
    camera = some_camera(t.rng)
    pixels, background = middle_pixels(t.rng, camera, n), t.rng.uniform(0.0, 1.0, 3)
    return some_scene(t.rng, camera, 5), camera, pixels, background


@hidden_check(
    "15.5.hidden",
    points=2,
    calls=("render",),
    needs=EARLIER,
    tolerance=EXACT,
    sole="the same mistakes at unknown scenes, and the cost of the backward pass",
    battery=[
        Subject(
            "adapters.render", pictured, lambda n: Array((n, 3)), right=values("render"), rows=(2,)
        )
    ],
)
def random_scenes(t):
    """Pixels of 150 Gaussians and their derivatives are right, at the price of a few pictures."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 150, size=0.15)
    t0 = ahead(t.rng, 150) * [2.5, 2.5, 1] - [0, 0, 5.0]
    scene["means"] = in_world(camera, t0)
    scene["opacity_logits"] *= 3
    pixels = t.rng.uniform(0.0, 1.0, (24, 2)) * [20, 14]
    g = random_cotangent(t.rng, (24, 3))
    right, pullback = t.reference.render(scene, camera, pixels, b)
    t.close("shown", shown(t, scene, camera, pixels, b), right)
    got = shown_back(t, scene, camera, pixels, b, g)
    for name, theirs in pullback(g).items():
        t.close(f"d_{name}", got[name], theirs)
    record = Record({name: Array(array.shape) for name, array in got.items()})
    require_cheap(
        t,
        ("adapters.render", (scene, camera, pixels, b), Array(g.shape)),
        ("adapters.render_back", (scene, camera, pixels, b, g), record),
    )
