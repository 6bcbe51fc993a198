"""Helpers for the checks of several tasks."""

import math

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance
from photograd_course.grading.generators import upper_directions

# Evidence: worst of the solution and three alternatives, against the nearest named wrong solution.
EXACT = Tolerance(1e-9, "right ones differ by 1e-12, wrong ones by 1e-4 or more")
GATE = Tolerance(1e-5, "central differences have an error of 1e-7, wrong ones are off by 1e-3")
LEVEL = 2e-4  # of one statistical test, which is repeated once; there are four


# Edges and strokes --------------------------------------------------------------------------------
def covered(t, angle, offset):
    """The answers of `edge_coverage`, by name."""
    n = len(angle)
    parts = Items(*[Array((n,))] * 3, names=("area", "d_offset", "d_angle"))
    got = t.call("edge_coverage", angle, offset, returns=parts)
    return dict(zip(("area", "d_offset", "d_angle"), got, strict=True))


def regular(t, vertices, center, radius):
    """A regular polygon, turned at random: all its sides are equally long."""
    angle = t.rng.uniform(0, 6.28) + 2 * np.pi * np.arange(vertices) / vertices
    return np.asarray(center) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def even(n):
    """n numbers, evenly spaced in [0, 1)."""
    return (np.arange(n) + 0.5) / n


def signed_area(vertices):
    x, y = vertices.T
    return np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2


def differences(function, x, step=1e-5):
    """Central differences (shape of x) of a function of one array."""
    found = np.zeros(x.shape)
    for index in np.ndindex(x.shape):
        ends = []
        for sign in (1, -1):
            moved = x.copy()
            moved[index] += sign * step
            ends.append(function(moved))
        found[index] = (ends[0] - ends[1]) / (2 * step)
    return found


def sampled(t, vertices, colors, d_image, u):
    """`edge_sampling_backward` for colors linear in the point; see adapters.py."""
    spec = Array(vertices.shape)
    return t.call("adapters.sampled_edges", vertices, colors, d_image, u, returns=spec)


def constant(colors):
    """Colors (2, C, 3) that are the same everywhere, from those inside and outside (2, C)."""
    return np.stack([colors, 0 * colors, 0 * colors], axis=2)


def stroke_slopes(t, curve, width, d_alpha):
    """(d_curve, d_width) of `stroke_backward`."""
    parts = Items(Array((3, 2)), Number(), names=("d_curve", "d_width"))
    return t.call("stroke_backward", curve, width, d_alpha, returns=parts)


# Light --------------------------------------------------------------------------------------------
def scene_of(flat):
    """A scene of rectangles (corner, edge_u, edge_v, material); the default is gray and matte."""
    materials = [each[3] for each in flat]
    scene = {
        name: np.array([each[k] for each in flat], float)
        for k, name in enumerate(("corners", "edges_u", "edges_v"))
    }
    scene["balls"] = np.zeros((0, 4))
    for name, plain in (("emission", 0.0), ("base_color", 0.5)):
        scene[name] = np.array([np.ones(3) * each.get(name, plain) for each in materials])
    for name, plain in (("metalness", 0.0), ("roughness", 0.5)):
        scene[name] = np.array([float(each.get(name, plain)) for each in materials])
    scene["matte"] = np.array(["roughness" not in each for each in materials])
    return scene


def glossy(rng):
    """A random glossy material."""
    return {
        "base_color": rng.uniform(0.2, 0.8, 3),
        "metalness": float(rng.uniform(0.2, 0.8)),
        "roughness": float(rng.uniform(0.35, 0.7)),
    }


def corner_scene(rng):
    """A glossy floor, primitive 0, two walls, one of them glossy, and a light, primitive 3."""
    wall = {"base_color": rng.uniform(0.3, 0.8, 3)}
    light = {"emission": rng.uniform(2, 5, 3), "base_color": 0.3}
    return scene_of(
        [
            ((-1, 0, -1), (0, 0, 2), (2, 0, 0), glossy(rng)),
            ((-1, 0, -1), (2, 0, 0), (0, 1.5, 0), wall),
            ((-1, 0, -1), (0, 1.5, 0), (0, 0, 2), glossy(rng)),
            ((-0.5, 1.4, -0.5), (1, 0, 0), (0, 0.2, 0.9), light),
        ]
    )


def cube(**material):
    """A closed cube, 2 m wide, of one material: six rectangles whose fronts look inward."""
    faces = (
        ((-1, -1, -1), (0, 0, 2), (2, 0, 0)),
        ((-1, 1, -1), (2, 0, 0), (0, 0, 2)),
        ((-1, -1, -1), (2, 0, 0), (0, 2, 0)),
        ((-1, -1, 1), (0, 2, 0), (2, 0, 0)),
        ((-1, -1, -1), (0, 2, 0), (0, 0, 2)),
        ((1, -1, -1), (0, 0, 2), (0, 2, 0)),
    )
    return scene_of([(*face, material) for face in faces])


def rays_down(rng, n):
    """Rays (origins, directions) from around (0.2, 0.9, 0.6), downward."""
    origins = np.array([0.2, 0.9, 0.6]) + rng.uniform(-0.2, 0.2, (n, 3))
    return origins, -upper_directions(rng, n, 0.5, up=1)


def radiance_of(t, scene, rays, depth, seed, proposal=None):
    """`path_radiance`, which is given."""
    more = () if proposal is None else (proposal,)
    spec = Array((len(rays[0]), 3))
    return t.call("path_radiance", scene, *rays, depth, seed, *more, returns=spec)


def material_spec(scene):
    n = len(scene["matte"])
    return Array((n, 3)), Array((n,))


def replayed(t, scene, rays, depth, seed, d_radiance):
    """The derivatives of `replay_backward`, by name, for the radiance of `path_radiance`."""
    radiance = radiance_of(t, scene, rays, depth, seed)
    parts = Items(*material_spec(scene), names=("d_base_color", "d_roughness"))
    got = t.call("replay_backward", scene, *rays, depth, seed, radiance, d_radiance, returns=parts)
    return {"base_color": got[0], "roughness": got[1]}


def agrees_with_differences(t, got, scene, forward, d):
    """Require that d_base_color and d_roughness are finite differences of <forward(scene), d>.

    The values of `forward`, an array (..., 3), are channel by channel functions of base_color, so
    one difference moves all three channels of a primitive.
    """
    for name in ("base_color", "roughness"):
        expected = np.zeros(scene[name].shape)
        for k in range(len(expected)):
            ends = []
            for sign in (1, -1):
                moved = {**scene, name: scene[name].copy()}
                moved[name][k] += 1e-5 * sign
                ends.append(np.sum((forward(moved) * d).reshape(-1, 3), axis=0))
            change = (ends[0] - ends[1]) / 2e-5
            expected[k] = change if name == "base_color" else change.sum()
        t.require(bool(expected.any()), f"d_{name}: the differences are all zero")
        t.close(f"d_{name}", got[name], expected)


def p_value(values, right):
    """p-value of independent numbers (n,) with the expected mean `right`, by Student's t."""
    n = len(values)
    spread = max(float(values.std(ddof=1)) / math.sqrt(n), 1e-12)
    off = min(abs(float(values.mean()) - right) / spread, 1e6)
    z = math.sqrt((n - 1) * math.log1p(off**2 / (n - 1))) * (1 - 3 / (4 * n))
    return math.erfc(z / math.sqrt(2))


def require_mean(t, what, draw, right, hint=""):
    """Require that the numbers of `draw` have the right mean; a failed test is repeated once."""
    values = draw()
    if p_value(values, right) < LEVEL:
        values = draw()
        spread = float(values.std()) / math.sqrt(len(values))
        t.require(
            p_value(values, right) >= LEVEL,
            f"{what}: the mean of {len(values)} estimates, {values.mean():.4g}, give or take "
            f"{spread:.1g}, is not {right:.4g}",
            hint=hint,
        )
    t.require(True, "")
