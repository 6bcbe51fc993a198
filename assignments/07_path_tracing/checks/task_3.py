"""Task 07.3, public checks."""

import numpy as np
from photograd_course.grading import checks_for

from .common import (
    TASK_3,
    albedo,
    all_draw,
    corners_of,
    direct,
    flake,
    furnace,
    hit_at,
    irradiance,
    require_mean,
    scene_of,
    ways,
)

check = checks_for(calls=("direct_light",), needs=TASK_3)

TWICE = (
    "twice the right value: both strategies have weight 1; in each direction their "
    "weights must sum to 1"
)


def lit_floor(t, n=2000, size=1.3, height=0.45):
    """(scene, hit, right): a matte point below a light, and its reflected radiance."""
    color, shine = t.rng.uniform(0.2, 0.9, 3), t.rng.uniform(0.5, 4, 3)
    point = t.rng.uniform(-1, 1, 3)
    aside = t.rng.uniform(-0.1, 0.1, 2) * size
    middle = point + np.array([aside[0], height, aside[1]])
    light = (middle - np.array([size / 2, 0, size / 2]), [size, 0, 0], [0, 0, size])
    scene = scene_of([flake(base_color=color), (*light, {"emission": shine})])
    right = color / np.pi * irradiance(corners_of(*light) - point) * shine
    return scene, hit_at(np.tile(point, (n, 1)), ways(t.rng, n), 0), right


@check(
    "07.3.matte",
    points=4,
    hint=(
        "equations (8) to (10): BRDF times cosine times radiance over the density of the "
        "sampling strategy, times its weight; weights sum to 1"
    ),
    sole="the irradiance from a rectangle has a closed form (Lambert)",
)
def light_from_a_rectangle(t):
    """A matte point below a large light: Lambert's formula. Below a small one: low variance."""
    scene, hit, right = lit_floor(t)
    mistakes = [(2 * right, TWICE)]
    require_mean(t, "radiance from a light", lambda: direct(t, scene, hit), right, mistakes)
    # Of 2000 cosine-weighted directions some 40 hit this light: light sampling is far better.
    scene, hit, right = lit_floor(t, 2000, 0.5, 2.0)
    spread = float((direct(t, scene, hit).std(axis=0) / right).max())
    t.require(
        spread < 0.7,
        f"a small light: estimates spread by {spread:.1f} of their mean, 0.2 is "
        "possible: the strategy that fits badly has the weight",
    )


@check(
    "07.3.furnace",
    points=4,
    hint=(
        "in a room of radiance 1 direct light is the albedo: the weights must sum to 1 "
        "in every direction"
    ),
    sole="the integral of assignment 04, with all directions lit",
)
def a_bright_room_shows_the_albedo(t):
    """A glossy point in a room of radiance 1: the mean is the integral of assignment 04."""
    scene, hit = furnace(t)
    right = albedo(t, scene, hit)
    require_mean(t, "albedo", lambda: direct(t, scene, hit), right, [(2 * right, TWICE)])


@check(
    "07.3.proposal",
    points=3,
    hint="directions, densities and weights of `proposal`, the BRDF of `scene`",
    sole="the mean does not depend on the sampling density",
)
def another_proposal_has_the_same_mean(t):
    """Directions sampled from a rougher material: other estimates with the same mean."""
    scene, hit = furnace(t)
    other = {**scene, "roughness": scene["roughness"] + 0.2, "base_color": 1 - scene["base_color"]}
    right = albedo(t, scene, hit)
    require_mean(t, "albedo", lambda: direct(t, scene, hit, proposal=other), right)
    few, u = {name: rows[:50] for name, rows in hit.items()}, t.rng.random((2, 50, 3))
    apart = np.abs(direct(t, scene, few, u, other) - direct(t, scene, few, u)) > 1e-6
    t.require(
        bool(apart.any(axis=1).mean() > 0.5),
        "for the same random numbers a rougher proposal gives the same estimates",
        hint=("directions, densities and weights come from `proposal` if it is given"),
    )


@check(
    "07.3.dark",
    points=2,
    hint="the closest hit along the direction must be the sampled light",
    sole="shadows",
)
def no_light_arrives(t):
    """A light behind a wall, ball or light, below the horizon or seen from behind: exactly 0."""
    n, x = 60, float(t.rng.uniform(0.5, 1.0))
    glossy = flake(base_color=0.8, metalness=0.5, roughness=0.6)
    light = ((-x, 2, -x), (2 * x, 0, 0), (0, 0, 2 * x), {"emission": 3.0})
    hit = hit_at(np.zeros((n, 3)), ways(t.rng, n), 0)
    got = direct(t, scene_of([glossy, light]), hit)
    t.require(bool((got.sum(axis=1) > 0).mean() > 0.5), "below a light there must be light")
    wall = ((-3, 1, -3), (6, 0, 0), (0, 0, 6), {})
    back = (light[0], light[2], light[1], light[3])
    below = ((-x, -2, -x), light[2], light[1], light[3])
    for told, scene in (
        ("a wall in between", scene_of([glossy, light, wall])),
        ("a ball in between", scene_of([glossy, light], [((0, 1.02, 0), 1.0, {})])),
        ("a light seen from behind", scene_of([glossy, back])),
        ("a light below the surface", scene_of([glossy, below])),
    ):
        got = direct(t, scene, hit)
        t.require(not got.any(), f"{told}: no light arrives, but yours is {got.max():.3g}")
    scene = scene_of([glossy, light, (*wall[:3], {"emission": 1.0})])
    got = direct(t, scene, hit, all_draw(t, n, 0.9))
    t.require(bool(got.any(axis=1).all()), "two lights: the nearer one, if sampled, contributes")
    got = direct(t, scene, hit, all_draw(t, n, 0.1))
    t.require(
        not got.any(),
        "two lights, the farther one sampled, the nearer one hit: the sample "
        f"brings nothing, but yours is {got.max():.3g}",
        hint=(
            "the closest hit is a light, but not the sampled one; it has samples of its "
            "own and would count twice"
        ),
    )
