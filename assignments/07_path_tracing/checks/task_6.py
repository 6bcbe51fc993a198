"""Task 07.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_cheap,
    require_zero_for_zero,
)

from .common import (
    TASK_3,
    albedo,
    all_draw,
    direct,
    flake,
    furnace,
    hit_at,
    require_mean,
    scene_of,
    ways,
)

check = checks_for(calls=("direct_light_backward",), needs=(*TASK_3, "direct_light"))

GATE = Tolerance(
    1e-6, ("central differences have an error of 1e-9, wrong solutions of 1e-3 or more")
)


def slopes(t, scene, hit, d, u=None):
    n, primitives = len(hit["primitive"]), len(scene["matte"])
    u = t.rng.random((2, n, 3)) if u is None else u
    parts = Items(
        Array((primitives, 3)), Array((primitives,)), names=("d_base_color", "d_roughness")
    )
    got = t.call("direct_light_backward", scene, hit, u[0], u[1], d, returns=parts)
    return {"base_color": got[0], "roughness": got[1]}


def small_scene(t, n):
    """A scene of three primitives, two of them glossy, and points on those."""
    glossy = [
        {
            "base_color": t.rng.uniform(0.2, 0.8, 3),
            "metalness": float(t.rng.uniform(0.2, 0.8)),
            "roughness": float(t.rng.uniform(0.35, 0.7)),
        }
        for _ in range(2)
    ]
    light = ((-0.6, 0.9, -0.6), (1.2, 0, 0), (0, 0, 1.2), {"emission": t.rng.uniform(1, 3, 3)})
    scene = scene_of([flake(**glossy[0]), light, flake(**glossy[1])])
    points = np.column_stack(
        [t.rng.uniform(-0.4, 0.4, n), np.zeros(n), t.rng.uniform(-0.4, 0.4, n)]
    )
    return scene, hit_at(points, ways(t.rng, n, 0.4), np.arange(n) % 2 * 2)


@check(
    "07.6.differences",
    points=5,
    tolerance=GATE,
    hint="equation (17): differentiate the BRDF; samples, densities and weights are held fixed",
    sole="the definition: your own direct light, its proposal held fixed",
)
def the_gradient_agrees_with_differences(t):
    """Compared with finite differences of your own `direct_light` at a fixed proposal."""
    scene, hit = small_scene(t, 40)
    u, d = t.rng.random((2, 40, 3)), random_cotangent(t.rng, (40, 3))

    def forward(point):
        return direct(t, {**scene, **point}, hit, u, scene)

    point = {name: scene[name] for name in ("base_color", "roughness")}
    agrees_with_finite_differences(t, slopes(t, scene, hit, d, u), forward, point, d, GATE)


ROWS = (
    "often: d[primitives] += rows, which keeps only the last row of each primitive; see np.add.at"
)


@check(
    "07.6.zero",
    points=2,
    needs=TASK_3,
    tolerance=GATE,
    hint="it is linear in d_radiance, and primitives that were not hit have no derivative",
    sole="what must be zero, and what must double",
)
def zeros_and_doubles(t):
    """Zero for zero; twice for twice; no roughness of matte primitives; zero for unseen ones."""
    scene, hit = small_scene(t, 30)
    scene["matte"][2] = True
    u, d = t.rng.random((2, 30, 3)), random_cotangent(t.rng, (30, 3))
    require_zero_for_zero(t, slopes(t, scene, hit, 0 * d, u))
    once, twice = slopes(t, scene, hit, d, u), slopes(t, scene, hit, 2 * d, u)
    for name in once:
        t.require(bool(once[name].any()), f"d_{name} is zero everywhere")
        t.close(f"d_{name} for twice the cotangent", twice[name], 2 * once[name])
    t.require(
        not (once["base_color"][1].any() or once["roughness"][1]),
        "a primitive that the hit does not contain has a derivative",
    )
    t.require(once["roughness"][2] == 0, "a matte primitive has a roughness derivative")
    turned = {**scene, "edges_u": scene["edges_v"], "edges_v": scene["edges_u"]}
    for name, values in slopes(t, turned, hit, d, u).items():
        t.require(not values.any(), f"d_{name} below the back of a light is not zero")
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
            not values.any(), f"d_{name} is not zero where another light occludes the sampled one"
        )


@check(
    "07.6.mean",
    points=3,
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
    hit["primitive"] = 6 + np.arange(groups * each) % groups
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
    points=1,
    hint="one pass over the same samples gives all derivatives",
    sole="finite differences would take two renderings per number",
)
def the_gradient_is_cheap(t):
    """A scene of 100 primitives: the gradient costs at most 20 times as much as direct light."""
    scene, hit = small_scene(t, 30)
    primitives = [flake(base_color=0.5, roughness=0.5, metalness=0.5)] * 97
    more = scene_of(primitives)
    scene = {name: np.concatenate([scene[name], more[name]]) for name in scene}
    u, d = t.rng.random((2, 30, 3)), random_cotangent(t.rng, (30, 3))
    n = len(scene["matte"])
    parts = Items(Array((n, 3)), Array((n,)))
    # Where cost is not measured (a student's machine) there must be a gradient at least.
    got = t.call("direct_light_backward", scene, hit, u[0], u[1], d, returns=parts)
    t.require(bool(got[0].any() and got[1].any()), "the gradient is zero everywhere")
    require_cheap(
        t,
        ("direct_light", (scene, hit, u[0], u[1]), Array((30, 3))),
        ("direct_light_backward", (scene, hit, u[0], u[1], d), parts),
    )
