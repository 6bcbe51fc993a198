"""Task 07.1, public checks."""

import math

import numpy as np
from photograd_course.grading import Array, Tolerance, checks_for

from .common import EXACT, UP, corners_of, flake, nodes, scene_of, ways

check = checks_for(calls=("light_pdf",))

NODES = Tolerance(1e-7, "16 nodes per axis have an error of 1e-9, wrong solutions of 0.1 or more")


def panel(rng, point, low=0.8, high=1.6):
    """(corner, edge_u, edge_v) of a random rectangle above a point that faces its front."""
    center = point + rng.uniform(low, high) * ways(rng, 1, 0.5)[0]
    towards = (point - center) / np.linalg.norm(point - center)
    normal = towards + 0.5 * ways(rng, 1, 0.0)[0]
    u = np.cross(normal, rng.normal(size=3))
    v = np.cross(normal, u)
    u, v = (rng.uniform(0.4, 0.8) * e / np.linalg.norm(e) for e in (u, v))
    if np.cross(u, v) @ towards < 0:
        u, v = v, u
    return center - (u + v) / 2, u, v


def solid_angle(corners):
    """Solid angle of a rectangle from the origin: two triangles, by Van Oosterom and Strackee."""
    total = 0.0
    for k in (1, 2):
        a, b, c = corners[0], corners[k], corners[k + 1]
        x, y, z = (np.linalg.norm(each) for each in (a, b, c))
        below = x * y * z + a @ b * z + b @ c * x + c @ a * y
        total += 2 * math.atan2(abs(np.linalg.det(np.stack([a, b, c]))), below)
    return total


def density(t, scene, primitive, wi, distance):
    return t.call("light_pdf", scene, primitive, wi, distance, returns=Array((len(primitive),)))


def towards(scene, primitive, point, uv):
    """(wi, distance) from a point to points (n, 2) of a rectangle."""
    place = (
        scene["corners"][primitive]
        + uv[:, :1] * scene["edges_u"][primitive]
        + (uv[:, 1:] * scene["edges_v"][primitive])
    )
    far = np.linalg.norm(place - point, axis=1)
    return (place - point) / far[:, None], far


@check(
    "07.1.straight",
    points=2,
    tolerance=EXACT,
    hint=(
        "equation (6): straight below the cosine is 1, so it is distance squared over "
        "area, times 1 / K"
    ),
    sole="one number that can be worked out by hand",
)
def straight_below(t):
    """Straight below the center of one of K lights: distance squared over K times its area."""
    for count in (1, 3):
        a, b, h = t.rng.uniform(0.2, 1.0, 3)
        light = ((-a, h, -b), (2 * a, 0, 0), (0, 0, 2 * b), {"emission": 2.0})
        others = [((9, k, 0), (0, 1.5, 0), (0, 0, 1), {"emission": 1.0}) for k in range(count - 1)]
        scene = scene_of([*others, light, flake()])
        got = density(t, scene, np.array([count - 1]), UP[None], np.array([h]))
        t.close("density", got, [h * h / (4 * a * b * count)], reveal=True)


@check(
    "07.1.solid_angle",
    points=4,
    tolerance=NODES,
    hint=(
        "equations (4) to (6): a tilted area covers a smaller solid angle, at twice the "
        "distance a quarter"
    ),
    sole="a density per solid angle integrates to the solid angle",
)
def densities_know_the_solid_angle(t):
    """The mean of 1 / density over the area of a light is its solid angle, times K for K lights."""
    uv, weights = nodes(16)
    for count in (1, 2, 3):
        point = t.rng.uniform(-1, 1, 3)
        flat = [(*panel(t.rng, point), {"emission": t.rng.uniform(0, 2, 3)}) for _ in range(count)]
        scene = scene_of([flake(), *flat])
        for k in range(count):
            wi, far = towards(scene, k + 1, point, uv)
            pdf = density(t, scene, np.full(len(uv), k + 1), wi, far)
            t.require(
                bool((pdf > 0).all()), ("the front of a light is visible, and the density is 0")
            )
            right = solid_angle(corners_of(*flat[k][:3]) - point)
            t.close("mean of 1 / density", weights @ (1 / (count * pdf)), right, reveal=True)


@check(
    "07.1.none",
    points=2,
    hint="only the fronts of lights are sampled: the front is on the side of the normal",
    sole="directions that are never sampled have density 0",
)
def no_density_without_a_lamp(t):
    """Walls, balls, no hit, and a light from behind or from the edge: exactly 0."""
    turn = t.rng.uniform(0.5, 2.0)
    flat = [flake(), ((0, 1, 0), (1, 0, 0), (0, 0, turn), {"emission": [0, 0, 1]}), flake()]
    scene = scene_of(flat, [((0, 3, 0), 1, {})])
    primitive = np.array([1, 0, -1, 3, 1, 1, 2])
    wi = np.array([UP, [0, 0, -1], UP, UP, -UP, [1.0, 0, 0], [0, 0.6, -0.8]])
    far = np.array([1.0, 1, np.inf, 2, 1, 3, 1])
    got = density(t, scene, primitive, wi, far)
    t.require(bool(got[0] > 0), "the front of a light has a density above 0")
    told = (
        "",
        "a wall",
        "nothing",
        "a ball",
        "the back of a light",
        "the edge of a light",
        "a wall",
    )
    for k in range(1, len(primitive)):
        t.require(bool(got[k] == 0), f"{told[k]} must have density 0, exactly")
