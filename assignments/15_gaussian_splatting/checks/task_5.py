"""Task 15.5, public checks."""

import numpy as np
from photograd_course.grading import Array, Record, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EARLIER, EXACT, GATE, SCENE, in_world, some_camera, some_scene

check = checks_for(calls=("render",), needs=EARLIER, tolerance=EXACT)


def shown(t, scene, camera, pixels, b):
    """The values of `render`."""
    shape = (len(pixels), 3)
    return t.call("adapters.render", scene, camera, pixels, b, returns=Array(shape))


def shown_back(t, scene, camera, pixels, b, g):
    """Result of the `back` of `render`."""
    shapes_of = {name: Array(array.shape) for name, array in scene.items()}
    record = Record(
        {**shapes_of, "background": Array((3,)), "absgrad": Array((len(scene["means"]), 2))}
    )
    return t.call("adapters.render_back", scene, camera, pixels, b, g, returns=record)


def middle_pixels(rng, camera, p):
    """Places near the middle of the picture, (p, 2)."""
    return camera["center"] + rng.uniform(-2.5, 2.5, (p, 2))


@check(
    "15.5.one",
    points=2,
    hint="handout, section 5: the four stages in their order; the camera's depth sorts",
    sole="small enough to work out by hand",
)
def one_splat_straight_ahead(t):
    """A ball straight ahead is a round splat, and a nearer one lies over it, whichever is first."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    z = np.array([3.0, 2.0])
    scene = some_scene(t.rng, camera, 2)
    scene["means"] = in_world(camera, z[:, None] * [0.0, 0.0, 1.0])
    scene["log_scales"] = np.repeat(t.rng.uniform(-1.5, -1.0, (2, 1)), 3, axis=1)
    pixels = middle_pixels(t.rng, camera, 4)
    wide = (camera["focal"] * np.exp(scene["log_scales"][:, :2]) / z[:, None]) ** 2 + 0.3
    r = np.sum((pixels - camera["center"]) ** 2 / wide[:, None], axis=2)
    a = np.exp(-r / 2) / (1 + np.exp(-scene["opacity_logits"][:, None]))
    far, near = a[..., None] * scene["colors"][:, None]
    behind = far + (1 - a[0, :, None]) * b
    t.require(bool((a > 0.01).all()), "the test case is not informative")
    got = shown(t, scene, camera, pixels, b)
    t.close("shown", got, near + (1 - a[1, :, None]) * behind, reveal=True)


@check(
    "15.5.differences",
    points=4,
    tolerance=GATE,
    hint="handout, section 5: the stages backward, each with what the one after it returns",
    sole="the whole chain, group by group, without the reference",
)
def the_chain_agrees_with_differences(t):
    """Moving any number of a scene moves its pixels as your back says; one Gaussian is outside."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 4)
    # Beside the picture and beyond the limits, but large enough to be seen.
    scene["means"][1] = in_world(camera, np.array([[1.1, -0.2, 1.0]]) * 3.05)[0]
    scene["log_scales"][1] += np.log(4)
    pixels = middle_pixels(t.rng, camera, 5)
    g = random_cotangent(t.rng, (5, 3))
    got = shown_back(t, scene, camera, pixels, b, g)

    def forward(point):
        some = {name: point[name] for name in SCENE}
        return shown(t, some, camera, pixels, point["background"])

    found = {name: got[name] for name in (*reversed(SCENE), "background")}
    agrees_with_finite_differences(t, found, forward, {**scene, "background": b}, g, GATE)
    none = shown_back(t, scene, camera, pixels, b, 0 * g)
    require_zero_for_zero(t, none)


@check(
    "15.5.behind",
    points=1,
    hint="leave out each Gaussian whose depth is NEAR or less, and give its rows zeros",
    sole="tests culling only",
)
def what_is_behind_the_camera_has_no_part(t):
    """Gaussians behind the camera or too near change nothing, and their derivatives are 0."""
    camera, b = some_camera(t.rng), t.rng.uniform(0.0, 1.0, 3)
    scene = some_scene(t.rng, camera, 5)
    hidden, kept = [1, 3], [0, 2, 4]
    scene["means"][hidden] = in_world(camera, np.array([[0.1, 0.2, -2.0], [0.001, 0.0, 0.009]]))
    few = {name: array[kept] for name, array in scene.items()}
    pixels, g = middle_pixels(t.rng, camera, 4), random_cotangent(t.rng, (4, 3))
    t.close("shown", shown(t, scene, camera, pixels, b), shown(t, few, camera, pixels, b))
    got = shown_back(t, scene, camera, pixels, b, g)
    right = shown_back(t, few, camera, pixels, b, g)
    for name in (*SCENE, "absgrad"):
        t.require(not got[name][hidden].any(), f"d_{name}: not zero behind the camera")
        t.close(f"d_{name} of the others", got[name][kept], right[name])
    t.close("d_background", got["background"], right["background"])
    none = {name: array[hidden] for name, array in scene.items()}
    t.close("shown, of none", shown(t, none, camera, pixels, b), np.tile(b, (4, 1)), reveal=True)
