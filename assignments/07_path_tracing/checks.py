"""Checks of assignment 07.

Most are exact: the numbers that a function would draw are arguments, and where they are nodes of a
quadrature their mean is an integral. Eleven judgements are of random draws. Where one is bad, at
2e-4, new draws get a second one: a right solution fails in less than one of a million hand-ins.
"""

from __future__ import annotations

import math

import numpy as np
from photograd_course.grading import Array, Items, Number, Subject, Tolerance, check
from photograd_course.grading.adjoint_gate import (
    random_cotangent,
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and three alternatives, against the nearest named wrong solution.
EXACT = Tolerance(1e-10, "right ones differ by 1e-15, wrong ones by 1e-3 or more")
NODES = Tolerance(1e-7, "16 nodes an axis leave 1e-9, wrong ones are off by 0.1 or more")
GATE = Tolerance(1e-6, "central differences leave 1e-9, wrong ones are off by 1e-3 or more")
LEVEL = 2e-4  # of one judgement; eleven draws are judged
TASK_3 = ("light_pdf", "mis_weight")
TASK_5 = (*TASK_3, "direct_light", "roulette")
UP = np.array([0.0, 1.0, 0.0])


# Scenes -------------------------------------------------------------------------------------------


def scene_of(flat, balls=()):
    """A scene of rectangles (corner, edge_u, edge_v, material), balls (centre, radius, material).

    Materials are dicts; what they leave out is grey and matte.
    """
    given = [thing[-1] for thing in (*flat, *balls)]
    scene = {
        name: np.array([thing[k] for thing in flat], float).reshape(-1, 3)
        for k, name in enumerate(("corners", "edges_u", "edges_v"))
    }
    scene["balls"] = np.array([[*each[0], each[1]] for each in balls], float).reshape(-1, 4)
    for name, plain in (("emission", 0.0), ("base_color", 0.5)):
        scene[name] = np.array([np.ones(3) * each.get(name, plain) for each in given])
    for name, plain in (("metalness", 0.0), ("roughness", 0.5)):
        scene[name] = np.array([float(each.get(name, plain)) for each in given])
    scene["matte"] = np.array([each.get("matte", "roughness" not in each) for each in given])
    return scene


def cube(**material):
    """Six rectangles around the origin, 2 m wide, fronts inwards."""
    faces = (
        ((-1, -1, -1), (0, 0, 2), (2, 0, 0)),
        ((-1, 1, -1), (2, 0, 0), (0, 0, 2)),
        ((-1, -1, -1), (2, 0, 0), (0, 2, 0)),
        ((-1, -1, 1), (0, 2, 0), (2, 0, 0)),
        ((-1, -1, -1), (0, 2, 0), (0, 0, 2)),
        ((1, -1, -1), (0, 0, 2), (0, 2, 0)),
    )
    return [(*face, material) for face in faces]


def flake(**material):
    """A thing out of everything's way, to lend its material to places of a hit."""
    return ((50, 50, 50), (0.1, 0, 0), (0, 0.1, 0), material)


def hit_at(points, wo, thing):
    """Places on a surface that faces up."""
    n = len(points)
    return {
        "points": np.asarray(points, float),
        "normals": np.tile(UP, (n, 1)),
        "wo": np.asarray(wo, float),
        "front": np.ones(n, bool),
        "t": np.ones(n),
        "thing": np.broadcast_to(np.asarray(thing, np.int64), (n,)).copy(),
    }


def ways(rng, n, low=0.2):
    """Unit vectors (n, 3) around +y, whose y is `low` or more."""
    y, phi = rng.uniform(low, 1, n), rng.uniform(0, 2 * np.pi, n)
    r = np.sqrt(1 - y * y)
    return np.stack([r * np.cos(phi), y, r * np.sin(phi)], axis=1)


def panel(rng, point, low=0.8, high=1.6):
    """(corner, edge_u, edge_v) of a rectangle at random above a point, its front towards it."""
    centre = point + rng.uniform(low, high) * ways(rng, 1, 0.5)[0]
    towards = (point - centre) / np.linalg.norm(point - centre)
    normal = towards + 0.5 * ways(rng, 1, 0.0)[0]
    u = np.cross(normal, rng.normal(size=3))
    v = np.cross(normal, u)
    u, v = (rng.uniform(0.4, 0.8) * e / np.linalg.norm(e) for e in (u, v))
    if np.cross(u, v) @ towards < 0:
        u, v = v, u
    return centre - (u + v) / 2, u, v


def corners_of(corner, u, v):
    """The four corners (4, 3) of a rectangle, around it."""
    corner, u, v = (np.asarray(each, float) for each in (corner, u, v))
    return np.stack([corner, corner + u, corner + u + v, corner + v])


def solid_angle(corners):
    """Of a rectangle seen from the origin: two triangles, by Van Oosterom and Strackee."""
    total = 0.0
    for k in (1, 2):
        a, b, c = corners[0], corners[k], corners[k + 1]
        x, y, z = (np.linalg.norm(each) for each in (a, b, c))
        below = x * y * z + a @ b * z + b @ c * x + c @ a * y
        total += 2 * math.atan2(abs(np.linalg.det(np.stack([a, b, c]))), below)
    return total


def irradiance(corners, normal=UP):
    """Of a surface at the origin, by a rectangle of radiance 1 wholly above it (Lambert)."""
    d = corners / np.linalg.norm(corners, axis=1, keepdims=True)
    total = np.zeros(3)
    for a, b in zip(d, np.roll(d, -1, axis=0), strict=True):
        c = np.cross(a, b)
        total += math.atan2(np.linalg.norm(c), a @ b) * c / np.linalg.norm(c)
    return abs(total @ normal) / 2


def nodes(count):
    """Nodes (count^2, 2) in the unit square and their weights, which sum to 1."""
    x, w = np.polynomial.legendre.leggauss(count)
    x, w = (x + 1) / 2, w / 2
    u, v = np.meshgrid(x, x, indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1), np.outer(w, w).ravel()


def dome(heights=40, turns=64):
    """Directions around +y and what each speaks for of the integral with the cosine."""
    x, w = np.polynomial.legendre.leggauss(heights)
    root = (x + 1) / 2
    y, phi = np.meshgrid(root**2, (np.arange(turns) + 0.5) * (2 * np.pi / turns), indexing="ij")
    r = np.sqrt(1 - y * y)
    wi = np.stack([r * np.cos(phi), y, r * np.sin(phi)], axis=-1).reshape(-1, 3)
    return wi, np.repeat(root * w * root**2 * (2 * np.pi / turns), turns)


# Judgements ---------------------------------------------------------------------------------------


def p_value(values, right):
    """Of draws (n, C) whose means should be `right` (C,): the least by C."""
    n = len(values)
    spread = values.std(axis=0, ddof=1) / math.sqrt(n)
    off = np.abs(values.mean(axis=0) - right)
    off = np.where(
        off < 1e-12 * np.abs(right), 0.0, np.minimum(off / np.maximum(spread, 1e-9), 1e6)
    )
    # Student's t, as a normal variable, by Wallace.
    z = np.sqrt((n - 1) * np.log1p(off**2 / (n - 1))) * (1 - 3 / (4 * n))
    return min(math.erfc(float(z.max()) / math.sqrt(2)) * len(off), 1.0)


def require_mean(t, what, draw, right, mistakes=(), hint=""):
    """Require that draws have the right mean; draws that look bad get a second chance.

    `mistakes` are (mean that it would have, what to say of it); `hint` is for all others.
    """
    values = draw()
    if p_value(values, right) < LEVEL:
        values = draw()
        if p_value(values, right) < LEVEL:
            mean, spread = values.mean(axis=0), values.std(axis=0) / math.sqrt(len(values))
            worst = int(np.argmax(np.abs(mean - right)))
            fits = [(p_value(values, wrong), said) for wrong, said in mistakes]
            fits = [(p, said) for p, said in fits if p > 5 * LEVEL]
            t.require(
                False,
                f"{what}: the mean of {len(values)} samples, {mean[worst]:.4g}, give "
                f"or take {spread[worst]:.1g}, is not {right[worst]:.4g} "
                f"(channel {worst})",
                hint=max(fits)[1] if fits else hint,
            )
    t.require(True, "")


# 07.1 ---------------------------------------------------------------------------------------------


def density(t, scene, thing, wi, distance):
    return t.call("light_pdf", scene, thing, wi, distance, returns=Array((len(thing),)))


def towards(scene, thing, point, uv):
    """(wi, distance) from a point to places (n, 2) of a rectangle."""
    place = (
        scene["corners"][thing]
        + uv[:, :1] * scene["edges_u"][thing]
        + (uv[:, 1:] * scene["edges_v"][thing])
    )
    far = np.linalg.norm(place - point, axis=1)
    return (place - point) / far[:, None], far


@check(
    "07.1.straight",
    task="07.1",
    points=2,
    calls=("light_pdf",),
    tolerance=EXACT,
    hint="equation (6): straight ahead the cosine is 1, and what is left is "
    "distance squared over area, for one of K lamps",
    sole="one number that can be worked out by head",
)
def straight_below(t):
    """Straight below the middle of a lamp: distance squared over its area, a K-th of it for K."""
    for count in (1, 3):
        a, b, h = t.rng.uniform(0.2, 1.0, 3)
        lamp = ((-a, h, -b), (2 * a, 0, 0), (0, 0, 2 * b), {"emission": 2.0})
        others = [((9, k, 0), (0, 1.5, 0), (0, 0, 1), {"emission": 1.0}) for k in range(count - 1)]
        scene = scene_of([*others, lamp, flake()])
        got = density(t, scene, np.array([count - 1]), UP[None], np.array([h]))
        t.close("density", got, [h * h / (4 * a * b * count)], reveal=True)


@check(
    "07.1.solid_angle",
    task="07.1",
    points=4,
    calls=("light_pdf",),
    tolerance=NODES,
    hint="equations (4) to (6): an area turned away looks smaller, one twice as far "
    "away four times smaller",
    sole="a density by solid angle is known by the solid angle",
)
def densities_know_the_solid_angle(t):
    """The mean of 1 / density over the places of a lamp is its solid angle, K times that for K."""
    uv, weights = nodes(16)
    for count in (1, 2, 3):
        point = t.rng.uniform(-1, 1, 3)
        flat = [(*panel(t.rng, point), {"emission": t.rng.uniform(0, 2, 3)}) for _ in range(count)]
        scene = scene_of([flake(), *flat])
        for k in range(count):
            wi, far = towards(scene, k + 1, point, uv)
            pdf = density(t, scene, np.full(len(uv), k + 1), wi, far)
            t.require(bool((pdf > 0).all()), "the front of a lamp is seen, and the density is 0")
            right = solid_angle(corners_of(*flat[k][:3]) - point)
            t.close("mean of 1 / density", weights @ (1 / (count * pdf)), right, reveal=True)


@check(
    "07.1.none",
    task="07.1",
    points=2,
    calls=("light_pdf",),
    hint="only fronts of lamps are drawn: a lamp's front is where its normal points",
    sole="what is never drawn has density 0",
)
def no_density_without_a_lamp(t):
    """Walls, balls, nothing at all, and a lamp from behind or from the edge: exactly 0."""
    turn = t.rng.uniform(0.5, 2.0)
    flat = [flake(), ((0, 1, 0), (1, 0, 0), (0, 0, turn), {"emission": [0, 0, 1]}), flake()]
    scene = scene_of(flat, [((0, 3, 0), 1, {})])
    thing = np.array([1, 0, -1, 3, 1, 1, 2])
    wi = np.array([UP, [0, 0, -1], UP, UP, -UP, [1.0, 0, 0], [0, 0.6, -0.8]])
    far = np.array([1.0, 1, np.inf, 2, 1, 3, 1])
    got = density(t, scene, thing, wi, far)
    t.require(bool(got[0] > 0), "the front of a lamp has a density above 0")
    told = ("", "a wall", "nothing", "a ball", "the back of a lamp", "a lamp's edge", "a wall")
    for k in range(1, len(thing)):
        t.require(bool(got[k] == 0), f"{told[k]} must have density 0, exactly")


# 07.2 ---------------------------------------------------------------------------------------------


def weights_of(t, pdf, other):
    pdf, other = np.asarray(pdf, float), np.asarray(other, float)
    return t.call("mis_weight", pdf, other, returns=Array((len(pdf),)))


@check(
    "07.2.values",
    task="07.2",
    points=3,
    calls=("mis_weight",),
    tolerance=EXACT,
    hint="equation (7): the squares of densities",
    sole="three numbers that can be worked out by head",
)
def known_weights(t):
    """Three times as dense: nine parts of ten. As dense: half."""
    s = float(t.rng.uniform(0.1, 10))
    got = weights_of(t, [3 * s, s, s, 2 * s], [s, 3 * s, s, s])
    t.close("weights of 3:1, 1:3, 1:1, 2:1", got, [0.9, 0.1, 0.5, 0.8], reveal=True)


@check(
    "07.2.sum",
    task="07.2",
    points=2,
    calls=("mis_weight",),
    tolerance=EXACT,
    hint="what one strategy leaves is the other one's",
    sole="no light is counted twice, and none forgotten",
)
def weights_sum_to_one(t):
    """Over both strategies the weights sum to 1."""
    p, q = np.exp(t.rng.uniform(-7, 7, (2, 60)))
    t.close(
        "sum of both weights", weights_of(t, p, q) + weights_of(t, q, p), np.ones(60), reveal=True
    )


@check(
    "07.2.extremes",
    task="07.2",
    points=2,
    calls=("mis_weight",),
    tolerance=EXACT,
    hint="divide by the larger of the two before you square",
    sole="mirrors have densities without bound, and what cannot be drawn has none",
)
def weights_at_the_ends(t):
    """A density of 0, or of 1e200: 0, 1, or by their ratio; never infinite."""
    s = float(t.rng.uniform(0.5, 1.0))
    got = weights_of(t, [0, 0, s, 1e200, 2e200 * s, 3e-200], [0, s, 0, 1, 1e200 * s, 1e-200])
    t.require(bool((got[:2] == 0).all()), "what could not be drawn has weight 0, exactly")
    t.close("weights", got[2:], [1, 1, 0.8, 0.9], reveal=True)


# 07.3 ---------------------------------------------------------------------------------------------


def direct(t, scene, hit, u=None, proposal=None):
    n = len(hit["thing"])
    u = t.rng.random((2, n, 3)) if u is None else u
    more = () if proposal is None else (proposal,)
    return t.call("direct_light", scene, hit, u[0], u[1], *more, returns=Array((n, 3)))


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
    task="07.3",
    points=4,
    calls=("direct_light",),
    needs=TASK_3,
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


def furnace(t, n=2500):
    """(scene, hit, right, error): a glossy place in a room that is equally bright everywhere."""
    given = {
        "base_color": t.rng.uniform(0.2, 0.9, 3),
        "metalness": float(t.rng.uniform(0.2, 0.8)),
        "roughness": float(t.rng.uniform(0.4, 0.8)),
    }
    scene = scene_of([*cube(emission=1.0), flake(**given)])
    wo = ways(t.rng, 1, 0.4)
    hit = hit_at(np.tile(t.rng.uniform(-0.5, 0.5, 3), (n, 1)), np.tile(wo, (n, 1)), 6)
    return scene, hit


def albedo(t, scene, hit):
    """The furnace integral of assignment 04, for the first place of a hit."""
    wi, weights = dome()
    rows = {name: np.repeat(values[:1], len(wi), axis=0) for name, values in hit.items()}
    return weights @ t.call("brdf", scene, rows, wi, returns=Array((len(wi), 3)))


@check(
    "07.3.furnace",
    task="07.3",
    points=4,
    calls=("direct_light",),
    needs=TASK_3,
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
    task="07.3",
    points=3,
    calls=("direct_light",),
    needs=TASK_3,
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
    task="07.3",
    points=2,
    calls=("direct_light",),
    needs=TASK_3,
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


def all_draw(t, n, share):
    """Numbers by which the lamp at this share of all is drawn, and ways that lead past lamps."""
    u = t.rng.random((2, n, 3))
    u[0, :, 0] = share
    u[1, :, 0], u[1, :, 2] = 0.2, 0.9999  # by the cosine, and almost level
    return u


def mixed_room(t):
    """A room with two lamps, one before the other in part, glossy things and a ball."""
    some = [
        {
            "base_color": t.rng.uniform(0.1, 0.9, 3),
            "metalness": float(t.rng.uniform(0.2, 0.8)),
            "roughness": float(t.rng.uniform(0.3, 0.7)),
        }
        for _ in range(2)
    ]
    a, b = t.rng.uniform(0.3, 0.7, 2)
    return scene_of(
        [
            ((-1, -1, -1), (0, 0, 2), (2, 0, 0), some[0]),
            ((-1, -1, -1), (2, 0, 0), (0, 2, 0), {"base_color": t.rng.uniform(0.1, 0.9, 3)}),
            ((-0.5, 1, -0.5), (1, 0, 0), (0, 0, 1), {"emission": t.rng.uniform(1, 3, 3)}),
            ((-a, 0.7, -b), (a, 0, 0), (0, 0, b), {"emission": t.rng.uniform(1, 3, 3)}),
        ],
        [((0.3, -0.5, 0.1), 0.45, some[1])],
    )


def looked_at(t, scene, n):
    """A hit of n places of `mixed_room`, seen from above and outside."""
    origins = np.tile([0.4, 0.3, 2.2], (n, 1))
    directions = np.column_stack(
        [t.rng.uniform(-1.2, 0.6, n), t.rng.uniform(-1.2, 0.5, n), t.rng.uniform(-2.9, -1.5, n)]
    ) - [0.2, 0.2, 0]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hit = t.reference.see(scene, origins, directions)
    return t.reference.some(hit, hit["thing"] >= 0)


# 07.4 ---------------------------------------------------------------------------------------------


def played(t, beta, u):
    beta, u = np.asarray(beta, float), np.asarray(u, float)
    parts = Items(Array(beta.shape), Array(u.shape, "bool"), names=("beta", "alive"))
    return t.call("roulette", beta, u, returns=parts)


@check(
    "07.4.values",
    task="07.4",
    points=2,
    calls=("roulette",),
    tolerance=EXACT,
    hint="equations (11) and (12): the brightest channel decides, u < q goes on",
    sole="one path that goes on and one that ends",
)
def known_ends(t):
    """A path with (0.2, 0.5, 0.1) goes on in half of all cases, as (0.4, 1, 0.2); dark ones too."""
    u = [float(t.rng.uniform(0.3, 0.49)), float(t.rng.uniform(0.51, 0.9)), 0.0, 0.5]
    beta, alive = played(t, [[0.2, 0.5, 0.1]] * 4, u)
    right = [True, False, True, False]
    t.require(alive.tolist() == right, f"alive is {alive.tolist()} for u = {u}, q = 0.5")
    t.close("beta", beta, np.outer(right, [0.4, 1, 0.2]), reveal=True)
    q = np.array([0.1, 0.001])
    beta, alive = played(t, np.outer(q, [0.4, 1, 0.2]), t.rng.uniform(0.1, 0.9) * q)
    t.require(bool(alive.all()), "a path with u < q has ended: q is 0.1 or 0.001")
    t.close(
        "beta of dark paths",
        beta,
        np.tile([0.4, 1, 0.2], (2, 1)),
        reveal=True,
        hint="1 / q is 10 and 1000 here, and nothing may limit it: those who go on speak for "
        "all who have ended",
    )


@check(
    "07.4.mean",
    task="07.4",
    points=3,
    calls=("roulette",),
    tolerance=EXACT,
    hint="who goes on carries 1 / q, for those who do not",
    sole="roulette must not change the mean",
)
def the_mean_is_kept(t):
    """Over 1000 values of u, evenly spread, the mean of beta is what it was."""
    u = (np.arange(1000) + 0.5) / 1000
    for _ in range(4):
        beta = t.rng.integers(1, 999, 3) / 1000
        after, _ = played(t, np.tile(beta, (1000, 1)), t.rng.permutation(u))
        t.close("mean of beta", after.mean(axis=0), beta, reveal=True)


@check(
    "07.4.ends",
    task="07.4",
    points=2,
    calls=("roulette",),
    tolerance=EXACT,
    hint="q is at most 1; and where q is 0 nothing may be divided by it",
    sole="bright paths stay as they are, and dark ones end",
)
def bright_and_dark_paths(t):
    """A channel of 1 or more: goes on unchanged, always. Black: ends, always."""
    bright = t.rng.uniform(0, 3, (20, 3))
    bright[:, 1] = t.rng.uniform(1, 3, 20)
    u = np.append(t.rng.random(18), [0.0, 1 - 2**-53])
    beta, alive = played(t, bright, u)
    t.require(bool(alive.all()), "a path with a channel of 1 or more has ended")
    t.close("beta of bright paths", beta, bright)
    beta, alive = played(t, np.zeros((20, 3)), u)
    t.require(not alive.any() and not beta.any(), "a black path goes on")


# 07.5 ---------------------------------------------------------------------------------------------


def traced(t, scene, origins, directions, depth):
    seed = int(t.rng.integers(2**31))
    n = len(origins)
    return t.call("adapters.traced", scene, origins, directions, depth, seed, returns=Array((n, 3)))


@check(
    "07.5.emitted",
    task="07.5",
    points=2,
    calls=("trace_paths",),
    needs=TASK_5,
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
    task="07.5",
    points=3,
    calls=("trace_paths",),
    needs=TASK_5,
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
    task="07.5",
    points=2,
    calls=("trace_paths",),
    needs=TASK_5,
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
    d = t.rng.normal(size=(n, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return np.tile(t.rng.uniform(-0.5, 0.5, 3), (n, 1)), d


@check(
    "07.5.furnace",
    task="07.5",
    points=4,
    calls=("trace_paths",),
    needs=TASK_5,
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


# 07.6 ---------------------------------------------------------------------------------------------


def slopes(t, scene, hit, d, u=None):
    n, things = len(hit["thing"]), len(scene["matte"])
    u = t.rng.random((2, n, 3)) if u is None else u
    parts = Items(Array((things, 3)), Array((things,)), names=("d_base_color", "d_roughness"))
    got = t.call("direct_light_backward", scene, hit, u[0], u[1], d, returns=parts)
    return {"base_color": got[0], "roughness": got[1]}


def small_scene(t, n):
    """A scene of three things, two of them glossy, and places on those."""
    glossy = [
        {
            "base_color": t.rng.uniform(0.2, 0.8, 3),
            "metalness": float(t.rng.uniform(0.2, 0.8)),
            "roughness": float(t.rng.uniform(0.35, 0.7)),
        }
        for _ in range(2)
    ]
    lamp = ((-0.6, 0.9, -0.6), (1.2, 0, 0), (0, 0, 1.2), {"emission": t.rng.uniform(1, 3, 3)})
    scene = scene_of([flake(**glossy[0]), lamp, flake(**glossy[1])])
    points = np.column_stack(
        [t.rng.uniform(-0.4, 0.4, n), np.zeros(n), t.rng.uniform(-0.4, 0.4, n)]
    )
    return scene, hit_at(points, ways(t.rng, n, 0.4), np.arange(n) % 2 * 2)


@check(
    "07.6.differences",
    task="07.6",
    points=5,
    calls=("direct_light_backward",),
    needs=(*TASK_3, "direct_light"),
    tolerance=GATE,
    hint="equation (17): reflectance is differentiated, all that was drawn stays",
    sole="the definition: your own direct light, its proposal held fixed",
)
def the_gradient_agrees_with_differences(t):
    """Against differences of your own `direct_light` whose proposal stays as it is."""
    scene, hit = small_scene(t, 40)
    u, d = t.rng.random((2, 40, 3)), random_cotangent(t.rng, (40, 3))

    def forward(point):
        return direct(t, {**scene, **point}, hit, u, scene)

    point = {name: scene[name] for name in ("base_color", "roughness")}
    require_gradients(t, slopes(t, scene, hit, d, u), forward, point, d, GATE)


ROWS = (
    "a thing has many rows, and all of them add up; d[things] += rows keeps the last row of "
    "each thing alone: see np.add.at"
)


@check(
    "07.6.zero",
    task="07.6",
    points=2,
    calls=("direct_light_backward",),
    needs=TASK_3,
    tolerance=GATE,
    hint="it is linear in d_radiance, and what was not seen has no derivative",
    sole="what must be zero, and what must double",
)
def zeros_and_doubles(t):
    """Zero for zero; twice for twice; matte things have no roughness; the unseen nothing at all."""
    scene, hit = small_scene(t, 30)
    scene["matte"][2] = True
    u, d = t.rng.random((2, 30, 3)), random_cotangent(t.rng, (30, 3))
    require_zero_for_zero(t, slopes(t, scene, hit, 0 * d, u))
    once, twice = slopes(t, scene, hit, d, u), slopes(t, scene, hit, 2 * d, u)
    for name in once:
        t.require(bool(once[name].any()), f"d_{name} is zero everywhere", hint=ROWS)
        t.close(f"d_{name} for twice the cotangent", twice[name], 2 * once[name])
    t.require(
        not (once["base_color"][1].any() or once["roughness"][1]),
        "a thing that the hit does not contain has a derivative",
    )
    t.require(once["roughness"][2] == 0, "a matte thing has a derivative by roughness")
    turned = {**scene, "edges_u": scene["edges_v"], "edges_v": scene["edges_u"]}
    for name, values in slopes(t, turned, hit, d, u).items():
        t.require(not values.any(), f"d_{name} below a lamp's back is not zero")
    again = {name: np.concatenate([values, values]) for name, values in hit.items()}
    more = slopes(t, scene, again, np.tile(d, (2, 1)), np.tile(u, (1, 2, 1)))
    for name in once:
        t.close(f"d_{name} of the same places twice", more[name], 2 * once[name], hint=ROWS)
    nearer = ((-3, 0.5, -3), (6, 0, 0), (0, 0, 6), {"emission": 1.0})
    hidden = scene_of([flake(), flake(), nearer])
    hidden = {name: np.concatenate([scene[name], rows[2:]]) for name, rows in hidden.items()}
    hidden["balls"] = scene["balls"]
    for name, values in slopes(t, hidden, hit, d, all_draw(t, 30, 0.1)).items():
        t.require(
            not values.any(),
            f"d_{name} is not zero where another lamp hides the one that was drawn",
        )


@check(
    "07.6.mean",
    task="07.6",
    points=3,
    calls=("direct_light_backward",),
    needs=TASK_3,
    hint="equation (18): the mean over samples is the derivative of the integral",
    sole="the mean of the gradient is the gradient of the mean",
)
def the_mean_of_the_gradient(t):
    """In a room of radiance 1 the mean gradient is the derivative of assignment 04's integral."""
    groups, each = 24, 60
    scene, hit = furnace(t, groups * each)
    for name in (
        "corners",
        "edges_u",
        "edges_v",
        "emission",
        "base_color",
        "metalness",
        "roughness",
        "matte",
    ):
        copies = np.repeat(scene[name][6:7], groups - 1, axis=0)
        scene[name] = np.concatenate([scene[name], copies])
    hit["thing"] = 6 + np.arange(groups * each) % groups
    g = t.rng.uniform(0.3, 1.0, 3)
    eps, right = 1e-4, []
    for name, channel in (("base_color", 0), ("base_color", 2), ("roughness", None)):
        ends = []
        for step in (eps, -eps):
            moved = {**scene, name: scene[name].copy()}
            moved[name][(6,) if channel is None else (6, channel)] += step
            ends.append(albedo(t, moved, hit) @ g)
        right.append((ends[0] - ends[1]) / (2 * eps))

    def draw():
        got = slopes(t, scene, hit, np.tile(g / each, (groups * each, 1)))
        return np.column_stack([got["base_color"][6:, [0, 2]], got["roughness"][6:]])

    require_mean(t, "mean gradient", draw, np.array(right))


@check(
    "07.6.cost",
    task="07.6",
    points=1,
    calls=("direct_light_backward",),
    needs=(*TASK_3, "direct_light"),
    hint="one pass over the same samples gives the derivative by everything",
    sole="differences would pay two renderings for each number",
)
def the_gradient_is_cheap(t):
    """A scene of 100 things: the gradient costs at most 20 times what direct light costs."""
    scene, hit = small_scene(t, 30)
    things = [flake(base_color=0.5, roughness=0.5, metalness=0.5)] * 97
    more = scene_of(things)
    scene = {name: np.concatenate([scene[name], more[name]]) for name in scene}
    u, d = t.rng.random((2, 30, 3)), random_cotangent(t.rng, (30, 3))
    n = len(scene["matte"])
    parts = Items(Array((n, 3)), Array((n,)))
    # Where nobody can measure (a student's machine) there must be a gradient at least.
    got = t.call("direct_light_backward", scene, hit, u[0], u[1], d, returns=parts)
    t.require(bool(got[0].any() and got[1].any()), "the gradient is zero everywhere")
    require_cheap(
        t,
        ("direct_light", (scene, hit, u[0], u[1]), Array((30, 3))),
        ("direct_light_backward", (scene, hit, u[0], u[1], d), parts),
    )


# >>> hidden
def looking(t, n):
    """A room, and a hit with n rows."""
    scene = mixed_room(t)
    return scene, t.reference.some(looked_at(t, scene, 20 * n + 20), np.arange(n))


def pointed(t, n):
    """What `light_pdf` takes, for what n rays of a room meet."""
    scene, directions = mixed_room(t), ways(t.rng, n, -1)
    hit = t.reference.see(scene, np.tile([0.1, 0.2, 0.3], (n, 1)), directions)
    return scene, hit["thing"], directions, hit["t"]


def estimated(t, n):
    """What `direct_light` takes."""
    return *looking(t, n), t.rng.random((n, 3)), t.rng.random((n, 3))


@check(
    "07.1.hidden",
    task="07.1",
    points=2,
    calls=("light_pdf",),
    visibility="hidden",
    tolerance=EXACT,
    sole="rooms that are not known beforehand",
    battery=[Subject("light_pdf", pointed, lambda n: Array((n,)), rows=(1, 2, 3))],
)
def densities_in_a_room(t):
    """What random rays of a room meet, against the solution."""
    scene = mixed_room(t)
    directions = ways(t.rng, 200, -1)
    there = t.reference.see(scene, np.tile([0.1, 0.2, 0.3], (200, 1)), directions)
    right = t.reference.light_pdf(scene, there["thing"], directions, there["t"])
    t.close("density", density(t, scene, there["thing"], directions, there["t"]), right)


@check(
    "07.2.hidden",
    task="07.2",
    points=1,
    calls=("mis_weight",),
    visibility="hidden",
    tolerance=EXACT,
    sole="densities that are not known beforehand",
    battery=[
        Subject(
            "mis_weight",
            lambda t, n: np.exp(t.rng.uniform(-3, 3, (2, n))),
            lambda n: Array((n,)),
            rows=(0, 1),
            special={0: (0.0, 1e200), 1: (0.0, 1e200)},
        )
    ],
)
def random_weights(t):
    """Random densities."""
    p, q = np.exp(t.rng.uniform(-3, 3, (2, 40)))
    t.close("weights", weights_of(t, p, q), 1 / (1 + (q / p) ** 2))


@check(
    "07.3.hidden",
    task="07.3",
    points=6,
    calls=("direct_light",),
    needs=TASK_3,
    visibility="hidden",
    tolerance=EXACT,
    sole="the same random numbers, two lamps, shadows, and another proposal",
    battery=[Subject("direct_light", estimated, lambda n: Array((n, 3)), rows=(1, 2, 3))],
)
def direct_light_of_a_room(t):
    """A room with two lamps, a ball and shadows, against the solution, number by number."""
    scene = mixed_room(t)
    other = {
        **scene,
        "roughness": scene["roughness"] + 0.15,
        "matte": ~scene["matte"],
        "base_color": scene["base_color"] / 2,
    }
    hit = looked_at(t, scene, 300)
    u = t.rng.random((2, len(hit["thing"]), 3))
    for proposal in (None, other):
        right = t.reference.direct_light(scene, hit, u[0], u[1], proposal)
        t.close("direct light", direct(t, scene, hit, u, proposal), right)


@check(
    "07.4.hidden",
    task="07.4",
    points=1,
    calls=("roulette",),
    visibility="hidden",
    tolerance=EXACT,
    sole="paths that are not known beforehand",
    battery=[
        Subject(
            "roulette",
            lambda t, n: (t.rng.uniform(0, 1, (n, 3)), t.rng.random(n)),
            lambda n: Items(Array((n, 3)), Array((n,), "bool")),
            rows=(0, 1),
        )
    ],
)
def random_roulette(t):
    """Random paths."""
    beta, u = t.rng.uniform(0, 1.3, (200, 3)) * t.rng.uniform(0, 1, (200, 1)), t.rng.random(200)
    beta[:4], u[:4] = 0.02, [0.01, 0.019, 0.021, 0.03]
    right, goes = t.reference.roulette(beta, u)
    after, alive = played(t, beta, u)
    t.require(bool((alive == goes).all()), "other paths go on than should")
    t.close("beta", after, right)


@check(
    "07.5.hidden",
    task="07.5",
    points=3,
    calls=("trace_paths",),
    needs=TASK_5,
    visibility="hidden",
    sole="glossy things, shadows, and paths that leave the room",
    battery=[
        Subject(
            "adapters.traced",
            lambda t, n: (
                mixed_room(t),
                np.tile([0.1, 0.2, 0.3], (n, 1)),
                ways(t.rng, n, -1),
                3,
                7,
            ),
            lambda n: Array((n, 3)),
            tolerance=EXACT,
            has_right=False,
        )
    ],
)
def paths_of_a_room(t):
    """An open room where walls shine differently, with a glossy ball: the solution's mean."""
    walls = [
        (
            *face[:3],
            {
                "emission": t.rng.uniform(0.3, 2, 3),
                "base_color": t.rng.permutation([0.4, 0.6, 0.9]),
            },
        )
        for face in cube()[:5]
    ]
    glossy = {"base_color": t.rng.uniform(0.5, 0.9, 3), "metalness": 0.7, "roughness": 0.4}
    scene = scene_of(walls, [((0.3, -0.4, 0.1), 0.4, glossy)])
    n, times = 1000, 3
    origins, directions = rays_inside(t, n)
    origins = np.tile([-0.4, -0.2, 0.3], (n, 1))
    theirs = t.reference.trace_paths(
        scene, np.tile(origins, (times, 1)), np.tile(directions, (times, 1)), 4, t.rng
    )
    # Rays differ more than two estimates for one of them do: their differences are judged.
    right = theirs.reshape(times, n, 3).mean(axis=0)
    require_mean(
        t,
        "depth 4, less the solution's, plus 1",
        lambda: 1 + traced(t, scene, origins, directions, 4) - right,
        np.ones(3),
    )


@check(
    "07.6.hidden",
    task="07.6",
    points=2,
    calls=("direct_light_backward",),
    needs=TASK_3,
    visibility="hidden",
    tolerance=GATE,
    sole="two lamps, shadows, a ball and something matte",
    battery=[
        Subject(
            "direct_light_backward",
            lambda t, n: (*estimated(t, n), random_cotangent(t.rng, (n, 3))),
            lambda _: Items(Array((5, 3)), Array((5,))),
        )
    ],
)
def the_gradient_of_a_room(t):
    """A room with two lamps, a ball and shadows, against the solution."""
    scene = mixed_room(t)
    hit = looked_at(t, scene, 1000)  # fewer: too few samples of the material meet a lamp
    n = len(hit["thing"])
    u, d = t.rng.random((2, n, 3)), random_cotangent(t.rng, (n, 3))
    right = t.reference.direct_light_backward(scene, hit, u[0], u[1], d)
    got = slopes(t, scene, hit, d, u)
    t.close("d_base_color", got["base_color"], right[0])
    t.close("d_roughness", got["roughness"], right[1])


def glossy_table(color, metalness, roughness):
    """A table under a lamp, and the rays of a small picture of it."""
    table = ((-1, 0, -1), (0, 0, 2), (2, 0, 0))
    lamp = ((-0.5, 0.4, -1.0), (1.0, 0, 0), (0, 0.5, 0.4), {"emission": [6, 5, 4]})
    given = {"base_color": color, "metalness": metalness, "roughness": roughness}
    return scene_of([(*table, given), lamp])


@check(
    "07.6.recover",
    task="07.6",
    points=3,
    calls=("direct_light_backward",),
    needs=(*TASK_3, "direct_light"),
    visibility="hidden",
    sole="what it is for: a base colour and a roughness, found in a picture",
)
def a_material_is_recovered(t):
    """The base colour within 0.01 and the roughness within 0.02, from an unseen picture."""
    # A polished table, or one channel far from the others, takes more steps than these.
    color, roughness = t.rng.uniform(0.3, 0.8, 3), float(t.rng.uniform(0.35, 0.5))
    truth = glossy_table(color, 0.5, roughness)
    start = glossy_table([0.5, 0.5, 0.5], 0.5, 0.6)
    origins, directions = t.reference.camera_rays(10, 7, [0, 0.9, 1.2], [0, 0, -0.3], 45)
    hit = t.reference.see(truth, origins, directions)
    seen = hit["thing"] == 0
    uv, weights = nodes(12)
    many = t.reference.repeated(t.reference.some(hit, seen), len(uv))
    u3 = np.tile(np.column_stack([0 * uv[:, 0], uv]), (int(seen.sum()), 1))
    wi, far, lamp = t.reference.sample_light(truth, many["points"], u3)
    pdf = t.reference.light_pdf(truth, lamp, wi, far)
    light = np.maximum(np.sum(wi * many["normals"], axis=1), 0) / pdf
    sent = t.reference.brdf(truth, many, wi) * light[:, None] * truth["emission"][1]
    picture = np.zeros((len(seen), 3))
    picture[seen] = np.einsum("nkc,k->nc", sent.reshape(-1, len(uv), 3), weights)
    parts = Items(Array((3,)), Number(), names=("base_color", "roughness"))

    def off():
        seed = int(t.rng.integers(2**31))
        found, rough = t.call(
            "adapters.recovered", start, 0, origins, directions, picture, 60, seed, returns=parts
        )
        return max(float(np.abs(found - color).max()) / 0.01, abs(rough - roughness) / 0.02)

    worst = off()
    worst = off() if worst > 1 else worst
    t.require(worst <= 1, f"what is found is off by {worst:.1f} times what is allowed")


# <<< hidden
