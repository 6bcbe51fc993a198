"""Task 06.3, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.generators import random_rotation

from .common import EXACT, gbuffer_of, lights_of, pose_of, rays_of, unit

check = checks_for(calls=("light_surfaces",), needs=("gltf",), tolerance=EXACT)


def lit_layer(t, gbuffer, *rest):
    """`light_surfaces` of the submission."""
    shape = gbuffer["depth"].shape
    return t.call("light_surfaces", gbuffer, *rest, returns=Array((*shape, 4)))


def case(t, height=5, width=7, focal=8.0):
    """gbuffer, focal, pose, lights, lit, open_sky."""
    pose, shape = pose_of(t.rng), (height, width)
    gbuffer = gbuffer_of(t.rng, height, width, focal)
    parts = t.rng.uniform(0.1, 1.0, (2, *shape))
    return gbuffer, focal, pose, lights_of(t.rng, pose), parts[0], parts[1]


def reflected(t, gbuffer, focal, pose, to_sun):
    """The glTF material (H, W, 3) of assignment 04 toward the camera, times the cosine."""
    height, width = gbuffer["depth"].shape
    n = gbuffer["normal"].reshape(-1, 3) @ pose[:, :3].T
    wo = -unit(rays_of(height, width, focal)).reshape(-1, 3) @ pose[:, :3].T
    x = unit(np.cross(n, t.rng.normal(size=3)))
    frame = np.stack([x, np.cross(n, x), n], axis=1)
    wi = np.tile(to_sun, (len(n), 1))
    inside = [np.sum(frame * w[:, None], axis=2) for w in (wo, wi)]
    material = [gbuffer[name].reshape(-1, *gbuffer[name].shape[2:]) for name in NAMES]
    f = t.call("reflectance.gltf", *inside, *material, returns=Array((len(n), 3)))
    return (f * np.maximum(inside[1][:, 2:], 0.0)).reshape(height, width, 3)


def material_is_there(t):
    """Name `gltf`, not the function that calls it, where only a stub of it is beside."""
    up = np.array([[0.0, 0.0, 1.0]])
    material = np.full((1, 3), 0.5), np.zeros(1), np.full(1, 0.5)
    t.call("reflectance.gltf", up, up, *material, returns=Array((1, 3)))


NAMES = ("base_color", "metalness", "roughness")


@check(
    "06.3.sun",
    points=4,
    hint="handout, equations (12) and (13): take to_sun, which is in the world, into the camera's "
    "frame. If all is 0: does ω_o point from the surface to the viewer?",
    sole="the sun alone, in a closed form",
)
def sunlight_is_reflected_by_the_material(t):
    """The sun alone, opaque: glTF of assignment 04 times cosine, irradiance and what is lit."""
    for size in ((5, 7), (6, 3)):
        gbuffer, focal, pose, lights, lit, open_sky = case(t, *size)
        gbuffer |= {"emission": 0 * gbuffer["emission"], "alpha": np.ones(size)}
        lights["sky"] = np.zeros(3)
        right = reflected(t, gbuffer, focal, pose, lights["to_sun"]) * lights["sun"]
        layer = lit_layer(t, gbuffer, focal, pose, lights, lit, open_sky)
        t.close("radiance", layer[..., :3], right * lit[..., None], reveal=True)


@check(
    "06.3.rest",
    points=3,
    hint="handout, equations (14) and (15): the sky and what is emitted; premultiplied alpha",
    sole="the sky, emission, alpha, and pixels without a surface",
)
def sky_emission_and_alpha(t):
    """Without the sun: emission and sky times base color; all times alpha; 0 where nothing is."""
    material_is_there(t)
    gbuffer, focal, pose, lights, lit, open_sky = case(t)
    lights["sun"] = np.zeros(3)
    gbuffer["depth"][1:3, 2:5] = np.inf
    seen = np.isfinite(gbuffer["depth"])
    sky = gbuffer["base_color"] * lights["sky"] * open_sky[..., None]
    layer = lit_layer(t, gbuffer, focal, pose, lights, lit, open_sky)
    t.require(not layer[~seen].any(), "a layer is 0 where nothing is seen, alpha too")
    alpha = gbuffer["alpha"][seen]
    t.close("alpha", layer[seen][:, 3], alpha, reveal=True)
    right = alpha[:, None] * (gbuffer["emission"] + sky)[seen]
    t.close("radiance times alpha", layer[seen][:, :3], right, reveal=True)


@check(
    "06.3.linear",
    points=3,
    hint="lighting is linear in every light: tone mapping and sRGB come after it",
    sole="the order of passes; and that only directions between vectors count",
)
def light_is_linear(t):
    """Twice the light is twice the radiance; turned together, camera and sun see the same."""
    material_is_there(t)
    gbuffer, focal, pose, lights, lit, open_sky = case(t)
    rest = lit, open_sky
    layer = lit_layer(t, gbuffer, focal, pose, lights, *rest)
    twice = {**lights, "sun": 3 * lights["sun"], "sky": 3 * lights["sky"]}
    brighter = {**gbuffer, "emission": 3 * gbuffer["emission"]}
    got = lit_layer(t, brighter, focal, pose, twice, *rest)
    t.close("radiance of three times the light", got[..., :3], 3 * layer[..., :3])
    turn = random_rotation(t.rng)
    turned = {**lights, "to_sun": turn @ lights["to_sun"]}
    got = lit_layer(t, gbuffer, focal, turn @ pose, turned, *rest)
    t.close("radiance of a scene that is turned", got, layer)


@check(
    "06.3.forward",
    points=2,
    needs=("gltf", "rasterize"),
    hint="the experiment also uses your rasterize, and your gltf of 04",
    sole="forward and deferred: each pixel's light depends on its own surface alone",
)
def forward_is_deferred(t):
    """Each part drawn and lit by itself, the nearest kept, gives the deferred picture."""
    shape = 30, 48
    parts = t.rng.uniform(0.0, 1.0, (2, *shape))
    spec = Items(Array((*shape, 4)), Array((*shape, 4)), names=("deferred", "forward"))
    both = t.call("adapters.deferred_and_forward", *shape, *parts, returns=spec)
    t.require(bool(both[0].any()), "something is seen")
    t.close("the forward picture", both[1], both[0])
