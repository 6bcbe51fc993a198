"""Helpers for the checks of several tasks."""

import math

import numpy as np
from photograd_course.grading import Array, Tolerance
from photograd_course.grading.generators import hemisphere_quadrature, upper_directions

# Evidence: worst of the solution and three alternatives, against the nearest named wrong solution.
EXACT = Tolerance(1e-10, "right ones differ by 1e-15, wrong ones by 1e-3 or more")
LEVEL = 2e-4  # of one test; there are eleven
TASK_3 = ("light_pdf", "mis_weight")
UP = np.array([0.0, 1.0, 0.0])


# Scenes -------------------------------------------------------------------------------------------
def scene_of(flat, balls=()):
    """A scene of rectangles (corner, edge_u, edge_v, material), balls (center, radius, material).

    Materials are dicts; the default is gray and matte.
    """
    given = [primitive[-1] for primitive in (*flat, *balls)]
    scene = {
        name: np.array([primitive[k] for primitive in flat], float).reshape(-1, 3)
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
    """Six rectangles around the origin, 2 m wide, fronts inward."""
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
    """A distant primitive whose material is used by points of a hit."""
    return ((50, 50, 50), (0.1, 0, 0), (0, 0.1, 0), material)


def hit_at(points, wo, primitive):
    """Points on a surface that faces up."""
    n = len(points)
    return {
        "points": np.asarray(points, float),
        "normals": np.tile(UP, (n, 1)),
        "wo": np.asarray(wo, float),
        "front": np.ones(n, bool),
        "t": np.ones(n),
        "primitive": np.broadcast_to(np.asarray(primitive, np.int64), (n,)).copy(),
    }


def ways(rng, n, low=0.2):
    """Unit vectors (n, 3) around +y, whose y is `low` or more."""
    return upper_directions(rng, n, low, up=1)


def corners_of(corner, u, v):
    """The four corners (4, 3) of a rectangle, around it."""
    corner, u, v = (np.asarray(each, float) for each in (corner, u, v))
    return np.stack([corner, corner + u, corner + u + v, corner + v])


def irradiance(corners, normal=UP):
    """Irradiance of a surface at the origin from a rectangle of radiance 1 above it (Lambert)."""
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


# Statistical tests --------------------------------------------------------------------------------
def p_value(values, right):
    """p-value of samples (n, C) with the expected means `right` (C,): the smallest times C."""
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
    """Require that samples have the right mean; a failed test is repeated once.

    `mistakes` are (mean of a known mistake, its message); `hint` is for all others.
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


def direct(t, scene, hit, u=None, proposal=None):
    n = len(hit["primitive"])
    u = t.rng.random((2, n, 3)) if u is None else u
    more = () if proposal is None else (proposal,)
    return t.call("direct_light", scene, hit, u[0], u[1], *more, returns=Array((n, 3)))


def furnace(t, n=2500):
    """(scene, hit, right, error): a glossy point in a room that is equally bright everywhere."""
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
    """The furnace integral of assignment 04, for the first point of a hit."""
    wi, solid_angles = hemisphere_quadrature(40, 64, up=1)
    rows = {name: np.repeat(values[:1], len(wi), axis=0) for name, values in hit.items()}
    return (solid_angles * wi[:, 1]) @ t.call("brdf", scene, rows, wi, returns=Array((len(wi), 3)))


def all_draw(t, n, share):
    """Random numbers that sample the light at this fraction of all, and directions past lights."""
    u = t.rng.random((2, n, 3))
    u[0, :, 0] = share
    u[1, :, 0], u[1, :, 2] = 0.2, 0.9999  # cosine-weighted, and nearly horizontal
    return u
