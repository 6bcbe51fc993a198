"""Task 07.5, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.generators import unit_vectors

from .common import (
    EXACT,
    TASK_3,
    UP,
    corners_of,
    cube,
    flake,
    irradiance,
    nodes,
    require_mean,
    scene_of,
    ways,
)

TASK_5 = (*TASK_3, "direct_light", "roulette")

check = checks_for(calls=("trace_paths",), needs=TASK_5)


def traced(t, scene, origins, directions, depth):
    seed = int(t.rng.integers(2**31))
    n = len(origins)
    return t.call("adapters.traced", scene, origins, directions, depth, seed, returns=Array((n, 3)))


@check(
    "07.5.emitted",
    points=2,
    tolerance=EXACT,
    hint="a path of one segment ends at a light, or contributes 0",
    sole="emission toward the camera, exactly",
)
def depth_one(t):
    """One segment: emission of the fronts of lights. A black light does not depend on the depth."""
    shine = t.rng.uniform(0.5, 3, 3)
    scene = scene_of(
        [
            ((-1, 2, -1), (2, 0, 0), (0, 0, 2), {"emission": shine, "base_color": 0.0}),
            ((-1, -1, 3), (2, 0, 0), (0, 2, 0), {}),
        ]
    )
    origins = np.array([[0, 0, 0], [0, 3, 0], [0, 0, 0], [0, 0, 0.0]])
    directions = np.array([UP, -UP, [0, 0, 1], [0, 0, -1.0]])
    right = np.array([shine, 0 * shine, 0 * shine, 0 * shine])
    t.close("depth 1", traced(t, scene, origins, directions, 1), right, reveal=True)
    for depth in (2, 4):
        got = traced(t, scene, origins, directions, depth)
        t.close(f"a black light and nothing, at depth {depth}", got[[0, 1, 3]], right[[0, 1, 3]])


# Messages for the most common mistakes, recognized by their means.
AGAIN = (
    "emission is added at a hit after a bounce: direct light at the vertex before "
    "has counted it already"
)
ANEW = "beta is reset, or missing: it is the product over all vertices of the path, equation (14)"
LAST = (
    "beta is the factor of the last vertex only; equation (14) multiplies it by the previous beta"
)
EARLY = "beta is updated before direct light is added: at each vertex direct light comes first"
DARK = "the emission at the first hit is missing"
FEWER = "one segment too few: direct_light is called depth - 1 times"
MORE = "one segment too many: direct_light is called depth - 1 times"


@check(
    "07.5.integral",
    points=3,
    hint="two segments are direct light and emission, nothing else",
    sole="depth two is the integral of assignment 04",
)
def depth_two(t):
    """Emission plus direct light; more segments change nothing where there is no further light.

    First two segments in a closed room. Then a floor that sees a black light and nothing else.
    """
    shine, color = t.rng.uniform(0.5, 2, 3), t.rng.uniform(0.2, 0.8, 3)
    scene = scene_of(cube(emission=shine, base_color=color))
    origins, directions = rays_inside(t, 1000)
    right = shine * (1 + color)
    mistakes = [
        (shine, FEWER),
        (right + shine * color**2, MORE),
        (shine * color, DARK),
        (right + shine * color, AGAIN),
        (shine * (1 + color**2), EARLY),
    ]
    require_mean(
        t,
        "a closed room, depth 2",
        lambda: traced(t, scene, origins, directions, 2),
        right,
        mistakes,
    )
    point, size = t.rng.uniform(-0.1, 0.1, 3), t.rng.uniform(0.8, 1.2)
    light = (point + np.array([0.5, 0.05, -1]), [0, 0, 2], [0, size, 0])
    scene = scene_of(
        [
            (point - np.array([0.2, 0, 0.2]), [0, 0, 0.4], [0.4, 0, 0], {"base_color": color}),
            (*light, {"emission": shine, "base_color": 0.0}),
            flake(base_color=0.9),
        ]
    )
    right = color / np.pi * irradiance(corners_of(*light) - point) * shine
    wo = ways(t.rng, 1000, 0.4)
    for depth in (2, 4):
        require_mean(
            t,
            f"a floor beside a light, depth {depth}",
            lambda d=depth: traced(t, scene, point + 0.05 * wo, -wo, d),
            right,
            [(2 * right, AGAIN), (right * color, EARLY)],
            hint=(
                "the floor sees a black light and nothing else: direct light at its "
                "point is the result, at any depth"
            ),
        )


@check(
    "07.5.corner",
    points=2,
    hint="three segments: the BSDF sample hits the wall; add direct light there times beta",
    sole="light from the vertices of the path, and from nowhere else",
)
def around_a_corner(t):
    """A floor that sees the back of a light, and a wall that the light lights: three segments."""
    floor, wall, shine = t.rng.uniform(0.3, 0.6, 3), t.rng.uniform(0.4, 0.9, 3), 5.0
    light = ((0.4, 1.3, -0.4), (0, 0.6, 0), (0, 0, 0.8))
    scene = scene_of(
        [
            ((-0.1, 0, -0.1), (0, 0, 0.2), (0.2, 0, 0), {"base_color": floor}),
            ((1, 0, -1), (0, 0, 2), (0, 1, 0), {"base_color": wall}),
            (*light, {"emission": shine, "base_color": 0.0}),
        ]
    )
    uv, weights = nodes(10)
    places = np.column_stack([np.ones(100), uv[:, 0], 2 * uv[:, 1] - 1])
    lit = [irradiance(corners_of(*light) - place, np.array([-1.0, 0, 0])) for place in places]
    share = 2 * places[:, 1] / np.sum(places**2, axis=1) ** 2  # cosines, area, distance squared
    right = floor * wall / np.pi**2 * shine * (weights * share @ np.array(lit))
    wo = ways(t.rng, 3000, 0.4)
    require_mean(
        t,
        "a floor in the shadow",
        lambda: traced(t, scene, 0.05 * wo, -wo, 3),
        right,
        [
            (
                right / floor,
                (
                    "the light of the wall counts as if the floor reflected all of it: "
                    "is beta multiplied by f cos / q, equation (14)?"
                ),
            ),
            (right * wall, EARLY),
            (0 * right, FEWER),
        ],
    )
    t.require(not traced(t, scene, 0.05 * wo, -wo, 2).any(), "at depth 2 the floor is black")


def rays_inside(t, n):
    """Rays from a point in the cube in all directions."""
    d = unit_vectors(t.rng, n)
    return np.tile(t.rng.uniform(-0.5, 0.5, 3), (n, 1)), d


@check(
    "07.5.furnace",
    points=4,
    hint=(
        "equation (15): e (1 + a + a^2 + ...), as many terms as segments; each vertex "
        "multiplies once, and lights that a path hits after a bounce are counted already"
    ),
    sole="a room whose radiance is a geometric series",
)
def a_room_that_shines(t):
    """A closed room that emits and reflects everywhere: a geometric series in the depth."""
    # Roulette begins at depth 5, so that at 4 mistakes have means in closed form.
    shine, color = t.rng.uniform(0.5, 2, 3), t.rng.permutation([0.3, 0.5, 0.8])
    scene = scene_of(cube(emission=shine, base_color=color))
    origins, directions = rays_inside(t, 1000)
    first = shine * (1 + color + color**2)
    right = first + shine * color**3
    mistakes = [
        (right + shine * (color + color**2), AGAIN),
        (shine * (1 + 3 * color), ANEW),
        (shine * (1 + color + 2 * color**2), LAST),
        (right - shine, DARK),
        (first, FEWER),
        (shine + color * (right - shine), EARLY),
        (right + shine * color**4, MORE),
    ]
    require_mean(t, "depth 4", lambda: traced(t, scene, origins, directions, 4), right, mistakes)
    require_mean(
        t,
        "depth 9",
        lambda: traced(t, scene, origins, directions, 9),
        shine * (1 - color**9) / (1 - color),
        hint=(
            "depth 4 is right, and roulette begins after it: its result is the new beta "
            "(12) of the surviving paths"
        ),
    )
