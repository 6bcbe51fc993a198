"""Task 14.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    random_cotangent,
    require_cheap,
    require_zero_for_zero,
)
from photograd_course.grading.generators import unit_vectors

from .common import (
    agrees_with_differences,
    corner_scene,
    cube,
    glossy,
    material_spec,
    radiance_of,
    rays_down,
    replayed,
    require_mean,
    scene_of,
)

check = checks_for(calls=("replay_backward",))

PATHS = Tolerance(1e-6, "central differences have an error of 1e-8, wrong ones of 1e-3 or more")
EARLIER = "path_tracing.py, your assignment 07, is wrong; photograd course check 07"


@check(
    "14.4.differences",
    points=5,
    tolerance=PATHS,
    hint="equations (16) to (18): at each vertex first direct light, then the BRDF of the bounce; "
    "what the visible vertex emits lies behind no bounce",
    sole="the definition: the given `path_radiance`, its proposal held fixed",
)
def the_gradient_agrees_with_differences(t):
    """At depth 1 to 4, against finite differences of `path_radiance` at a fixed proposal."""
    scene, rays = corner_scene(t.rng), rays_down(t.rng, 12)
    toward = np.array([0, 1.5, 0]) - rays[0][:2]  # two rays see the light, which reflects as well
    rays[1][:2] = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    for depth in (2, 4):
        seed, d = int(t.rng.integers(10**6)), random_cotangent(t.rng, (12, 3))

        def forward(moved, depth=depth, seed=seed):
            return radiance_of(t, moved, rays, depth, seed, scene)

        agrees_with_differences(t, replayed(t, scene, rays, depth, seed, d), scene, forward, d)
    got = replayed(t, scene, rays, 1, 3, d)
    t.require(
        not (got["base_color"].any() or got["roughness"].any()),
        "at depth 1 only emission is visible, and no material has a derivative",
    )


@check(
    "14.4.zero",
    points=2,
    tolerance=PATHS,
    hint="it is linear in d_radiance; rays that hit nothing contribute nothing",
    sole="what must be zero, what must double, and black surfaces",
)
def zeros_and_doubles(t):
    """Zero for zero, twice for twice; rays that hit nothing; a wall with a black channel."""
    scene, rays = corner_scene(t.rng), rays_down(t.rng, 12)
    rays[1][3] *= -1
    rays[0][3, 1] = 5.0
    scene["base_color"][1, 1] = 0.0
    d = random_cotangent(t.rng, (12, 3))
    require_zero_for_zero(t, replayed(t, scene, rays, 3, 5, 0 * d))
    once, twice = replayed(t, scene, rays, 3, 5, d), replayed(t, scene, rays, 3, 5, 2 * d)
    for name in once:
        t.require(bool(once[name].any()), f"d_{name} is zero everywhere")
        t.close(f"d_{name} for twice the cotangent", twice[name], 2 * once[name])
    beside = d.copy()
    beside[3] += 1.0
    other = replayed(t, scene, rays, 3, 5, beside)
    for name in once:
        t.close(f"d_{name} with another d_radiance of a ray without a hit", other[name], once[name])


@check(
    "14.4.mean",
    points=3,
    hint="a furnace: the derivative of e (1 + a + a^2) with respect to a",
    sole="a closed room, whose radiance and derivative are known",
)
def the_mean_in_a_furnace(t):
    """A room that emits and reflects everywhere alike: the derivative of a geometric series."""
    albedo, depth = float(t.rng.uniform(0.4, 0.7)), 3
    scene = cube(emission=1.0, base_color=albedo)
    n, groups = 40, 14
    rays = np.tile(t.rng.uniform(-0.5, 0.5, 3), (n, 1)), unit_vectors(t.rng, n)
    right = sum(albedo**k for k in range(depth))

    def traced():
        seeds = t.rng.integers(10**6, size=groups)
        got = [
            t.call("adapters.traced", scene, *rays, depth, int(seed), returns=Array((n, 3)))
            for seed in seeds
        ]
        return np.array([each[:, 0].mean() for each in got])

    require_mean(t, "radiance of a furnace by your trace_paths", traced, right, EARLIER)
    slope = sum(k * albedo ** (k - 1) for k in range(1, depth))
    d = np.zeros((n, 3))
    d[:, 0] = 1 / n

    def draw():
        seeds = t.rng.integers(10**6, size=groups)
        got = [replayed(t, scene, rays, depth, int(seed), d) for seed in seeds]
        return np.array([each["base_color"][:, 0].sum() for each in got])

    require_mean(t, "derivative with respect to the albedo", draw, slope)


@check(
    "14.4.cost",
    points=1,
    hint="two passes give all derivatives",
    sole="finite differences would take two renderings per number",
)
def the_gradient_is_cheap(t):
    """A scene of 54 primitives: the gradient costs at most 20 times as much as the radiance."""
    scene, rays = corner_scene(t.rng), rays_down(t.rng, 20)
    small = ((50, 50, 50), (0.1, 0, 0), (0, 0.1, 0))
    more = scene_of([(*small, glossy(t.rng)) for _ in range(50)])
    scene = {name: np.concatenate([scene[name], more[name]]) for name in scene}
    d = random_cotangent(t.rng, (20, 3))
    parts = Items(*material_spec(scene))
    # Where cost is not measured (a student's machine) there must be a gradient at least.
    got = t.call("adapters.both_passes", scene, *rays, 3, 7, d, returns=parts)
    t.require(bool(got[0].any() and got[1].any()), "the gradient is zero everywhere")
    require_cheap(
        t,
        ("path_radiance", (scene, *rays, 3, 7), Array((20, 3))),
        ("adapters.both_passes", (scene, *rays, 3, 7, d), parts),
    )
