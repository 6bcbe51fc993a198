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
    "twice as bright as it should be: the light is counted in full by both strategies; "
    "in each direction their weights must sum to 1"
)


def lit_floor(t, n=2000, size=1.3, height=0.45):
    """(scene, hit, right): a matte place below a lamp, and the radiance that leaves it."""
    color, shine = t.rng.uniform(0.2, 0.9, 3), t.rng.uniform(0.5, 4, 3)
    point = t.rng.uniform(-1, 1, 3)
    aside = t.rng.uniform(-0.1, 0.1, 2) * size
    middle = point + np.array([aside[0], height, aside[1]])
    lamp = (middle - np.array([size / 2, 0, size / 2]), [size, 0, 0], [0, 0, size])
    scene = scene_of([flake(base_color=color), (*lamp, {"emission": shine})])
    right = color / np.pi * irradiance(corners_of(*lamp) - point) * shine
    return scene, hit_at(np.tile(point, (n, 1)), ways(t.rng, n), 0), right


@check(
    "07.3.matte",
    points=4,
    hint="equations (8) to (10): reflectance times cosine times radiance, over "
    "the density of the strategy that has drawn it, by its weight; weights sum to 1",
    sole="the irradiance from a rectangle has been known since Lambert",
)
def light_from_a_rectangle(t):
    """A matte place below a large lamp: the mean is Lambert's formula. A small lamp: no noise."""
    scene, hit, right = lit_floor(t)
    mistakes = [(2 * right, TWICE)]
    require_mean(t, "light from a lamp", lambda: direct(t, scene, hit), right, mistakes)
    # Of 2000 directions by the cosine some 40 find this lamp: drawing its places is far better.
    scene, hit, right = lit_floor(t, 2000, 0.5, 2.0)
    spread = float((direct(t, scene, hit).std(axis=0) / right).max())
    t.require(
        spread < 0.7,
        f"a small lamp: estimates spread by {spread:.1f} of their mean, 0.2 is "
        "possible: the strategy that fits badly has the weight",
    )


@check(
    "07.3.furnace",
    points=4,
    hint="in a room of radiance 1 direct light is the albedo: both strategies "
    "together must count every direction once",
    sole="the integral of assignment 04, with all directions lit",
)
def a_bright_room_shows_the_albedo(t):
    """A glossy place in a room of radiance 1: the mean is the integral of assignment 04."""
    scene, hit = furnace(t)
    right = albedo(t, scene, hit)
    require_mean(t, "albedo", lambda: direct(t, scene, hit), right, [(2 * right, TWICE)])


@check(
    "07.3.proposal",
    points=3,
    hint="directions, densities and weights by `proposal`, reflectance by `scene`",
    sole="the mean does not depend on how samples are drawn",
)
def another_proposal_has_the_same_mean(t):
    """Directions drawn by a rougher material: other estimates, and the mean of the scene."""
    scene, hit = furnace(t)
    other = {**scene, "roughness": scene["roughness"] + 0.2, "base_color": 1 - scene["base_color"]}
    right = albedo(t, scene, hit)
    require_mean(t, "albedo", lambda: direct(t, scene, hit, proposal=other), right)
    few, u = {name: rows[:50] for name, rows in hit.items()}, t.rng.random((2, 50, 3))
    apart = np.abs(direct(t, scene, few, u, other) - direct(t, scene, few, u)) > 1e-6
    t.require(
        bool(apart.any(axis=1).mean() > 0.5),
        "for the same random numbers a rougher proposal gives the same estimates",
        hint="`proposal` is not looked at: directions, densities and weights come from it "
        "wherever it is given",
    )


@check(
    "07.3.dark",
    points=2,
    hint="what counts is the first thing that is met along the direction, and it must "
    "be the lamp that was drawn",
    sole="shadows",
)
def no_light_arrives(t):
    """A lamp behind a wall, a ball or a lamp, below the horizon or seen from behind: exactly 0."""
    n, x = 60, float(t.rng.uniform(0.5, 1.0))
    glossy = flake(base_color=0.8, metalness=0.5, roughness=0.6)
    lamp = ((-x, 2, -x), (2 * x, 0, 0), (0, 0, 2 * x), {"emission": 3.0})
    hit = hit_at(np.zeros((n, 3)), ways(t.rng, n), 0)
    got = direct(t, scene_of([glossy, lamp]), hit)
    t.require(bool((got.sum(axis=1) > 0).mean() > 0.5), "below a lamp there must be light")
    wall = ((-3, 1, -3), (6, 0, 0), (0, 0, 6), {})
    back = (lamp[0], lamp[2], lamp[1], lamp[3])
    below = ((-x, -2, -x), lamp[2], lamp[1], lamp[3])
    for told, scene in (
        ("a wall in between", scene_of([glossy, lamp, wall])),
        ("a ball in between", scene_of([glossy, lamp], [((0, 1.02, 0), 1.0, {})])),
        ("a lamp seen from behind", scene_of([glossy, back])),
        ("a lamp below the surface", scene_of([glossy, below])),
    ):
        got = direct(t, scene, hit)
        t.require(not got.any(), f"{told}: no light arrives, but yours is {got.max():.3g}")
    scene = scene_of([glossy, lamp, (*wall[:3], {"emission": 1.0})])
    got = direct(t, scene, hit, all_draw(t, n, 0.9))
    t.require(bool(got.any(axis=1).all()), "two lamps: the nearer one, if drawn, brings light")
    got = direct(t, scene, hit, all_draw(t, n, 0.1))
    t.require(
        not got.any(),
        "two lamps, the farther one drawn, the nearer one met: this sample "
        f"brings nothing, but yours is {got.max():.3g}",
        hint="the lamp that is met is not the one that was drawn; it has samples of its "
        "own, and would count twice",
    )
