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
    hint="a path of one piece ends at a lamp, or brings nothing",
    sole="what is seen by itself, exactly",
)
def depth_one(t):
    """One straight piece: what lamps emit from their fronts. A black lamp shows no more, ever."""
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
        t.close(f"a black lamp and nothing, at depth {depth}", got[[0, 1, 3]], right[[0, 1, 3]])


# What the best known mistakes say of themselves by the mean that they have.
AGAIN = (
    "what a path meets after a bounce adds its emission: direct light at the place before has "
    "counted it already"
)
ANEW = (
    "beta is started anew, or left out: it is the product of all surfaces since the viewer, "
    "equation (14)"
)
LAST = "beta is that of the last surface alone; equation (14) multiplies it by the one before"
EARLY = "beta is multiplied before direct light is added: at each place direct light comes first"
DARK = "what the first place emits towards the viewer is missing"
FEWER = "a piece too few: direct light is asked for depth - 1 times"
MORE = "a piece too many: direct light is asked for depth - 1 times"


@check(
    "07.5.integral",
    points=3,
    hint="two straight pieces are direct light and what is emitted, nothing else",
    sole="depth two is the integral of assignment 04",
)
def depth_two(t):
    """Emission plus the integral over all directions; more pieces change nothing where none lead.

    First two pieces in a closed room. Then a floor that sees a black lamp and nothing besides.
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
    lamp = (point + np.array([0.5, 0.05, -1]), [0, 0, 2], [0, size, 0])
    scene = scene_of(
        [
            (point - np.array([0.2, 0, 0.2]), [0, 0, 0.4], [0.4, 0, 0], {"base_color": color}),
            (*lamp, {"emission": shine, "base_color": 0.0}),
            flake(base_color=0.9),
        ]
    )
    right = color / np.pi * irradiance(corners_of(*lamp) - point) * shine
    wo = ways(t.rng, 1000, 0.4)
    for depth in (2, 4):
        require_mean(
            t,
            f"a floor beside a lamp, depth {depth}",
            lambda d=depth: traced(t, scene, point + 0.05 * wo, -wo, d),
            right,
            [(2 * right, AGAIN), (right * color, EARLY)],
            hint="the floor sees a black lamp and nothing else: direct light at its one "
            "place is all there is, at any depth",
        )


@check(
    "07.5.corner",
    points=2,
    hint="three pieces: the direction of the material leads to the wall, and there "
    "direct light is asked for again, times what the floor reflects of it",
    sole="light from where the path went, and from nowhere else",
)
def around_a_corner(t):
    """A floor that sees a lamp's back, and a wall on which it shines: three straight pieces."""
    floor, wall, shine = t.rng.uniform(0.3, 0.6, 3), t.rng.uniform(0.4, 0.9, 3), 5.0
    lamp = ((0.4, 1.3, -0.4), (0, 0.6, 0), (0, 0, 0.8))
    scene = scene_of(
        [
            ((-0.1, 0, -0.1), (0, 0, 0.2), (0.2, 0, 0), {"base_color": floor}),
            ((1, 0, -1), (0, 0, 2), (0, 1, 0), {"base_color": wall}),
            (*lamp, {"emission": shine, "base_color": 0.0}),
        ]
    )
    uv, weights = nodes(10)
    places = np.column_stack([np.ones(100), uv[:, 0], 2 * uv[:, 1] - 1])
    lit = [irradiance(corners_of(*lamp) - place, np.array([-1.0, 0, 0])) for place in places]
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
                "the wall's light counts as if the floor reflected all of it: is "
                "beta multiplied by reflectance times cosine over density, (14)?",
            ),
            (right * wall, EARLY),
            (0 * right, FEWER),
        ],
    )
    t.require(not traced(t, scene, 0.05 * wo, -wo, 2).any(), "at depth 2 the floor is black")


def rays_inside(t, n):
    """Rays from a place in the cube into all directions."""
    d = unit_vectors(t.rng, n)
    return np.tile(t.rng.uniform(-0.5, 0.5, 3), (n, 1)), d


@check(
    "07.5.furnace",
    points=4,
    hint="equation (15): e (1 + a + a^2 + ...), as many terms as pieces; each surface "
    "multiplies once, and lamps that a path finds by chance are counted already",
    sole="a room whose light is a geometric series",
)
def a_room_that_shines(t):
    """A closed room that shines and reflects everywhere: a geometric series, by depth."""
    # Roulette has no say before depth 5, so that at 4 mistakes have means in closed form.
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
        hint="depth 4 is right, and roulette begins after it: what it returns is the new "
        "beta, (12), of the paths that go on",
    )
