"""Direct light by multiple importance sampling, path tracing, and the gradient of direct light.

A *scene* is a dict of arrays. It has Q rectangles and B balls, T = Q + B primitives, rectangles
first. `corners`, `edges_u`, `edges_v` (Q, 3): a corner of each rectangle and the two edges that
start there, at right angles; its front faces the direction edge_u x edge_v. `balls` (B, 4): center
and radius. `emission` (T, 3): the radiance of the front, 0 for primitives that are no light, and
for every ball. `base_color` (T, 3), `metalness` (T,), `roughness` (T,), 0.045 to 1: the glTF
material of assignment 04; `matte` (T,) of bool: no specular coating, only base_color / pi.

The closest hits of N rays are a *hit*, a dict of arrays with N rows: `points` (N, 3), `normals`
(N, 3), unit, on the side of the viewer, `wo` (N, 3), unit, to the viewer, `front` (N,) of bool,
`t` (N,) the distance from the ray origin, in meters, and `primitive` (N,), the index of the
primitive, or -1 where nothing is hit.

Directions are unit vectors that leave the surface; wi leads to the light. Radiance is linear, in
three channels. Random numbers come as arguments: `u` uniform in [0, 1), or a generator `rng`.

Your tasks are six functions, one section of the handout each; `photograd course check 07` tells how
far you are. The other functions are given and stay as they are. All numbers are float64.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np
from reflectance import ggx_pdf, gltf, gltf_backward, sample_ggx

# Arrays and their shapes; float64 where nothing else is said.
PerRow = Annotated[np.ndarray, "N"]
Vectors = Annotated[np.ndarray, "N 3"]
Colors = Annotated[np.ndarray, "N 3"]
PrimitiveColors = Annotated[np.ndarray, "T 3"]
PerPrimitive = Annotated[np.ndarray, "T"]
Indices = Annotated[np.ndarray, "N"]  # int64
Scene = dict[str, np.ndarray]
Hit = dict[str, np.ndarray]

T_MIN = 1e-6  # meters; nearer intersections do not count
ALWAYS = 2  # no roulette at the first vertices of a path, counted from the visible one
SIDE = 4  # SIDE x SIDE samples of each pixel, in a step of `recover`

# Geometry ----------------------------------------------------------------------------------------


def front_normals(scene):
    """Unit normals (Q, 3) of the rectangles' fronts."""
    normals = np.cross(scene["edges_u"], scene["edges_v"])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def intersect(scene, origins, directions):
    """Closest hit of each ray: (t (N,), primitive (N,)), infinite and -1 where there is none."""
    u, v, normals = scene["edges_u"], scene["edges_v"], front_normals(scene)
    slope = directions @ normals.T
    height = origins @ normals.T - np.sum(scene["corners"] * normals, axis=1)
    t = -height / np.where(slope == 0, np.nan, slope)
    inside = t > T_MIN
    for edge in (u, v):
        along = (
            origins @ edge.T + t * (directions @ edge.T) - np.sum(scene["corners"] * edge, axis=1)
        )
        inside &= np.abs(along / np.sum(edge**2, axis=1) - 0.5) <= 0.5 + 1e-9
    t = np.where(inside, t, np.inf)
    offset = origins[:, None] - scene["balls"][:, :3]
    half_b = np.sum(offset * directions[:, None], axis=2)
    rest = half_b**2 - np.sum(offset**2, axis=2) + scene["balls"][:, 3] ** 2
    root = np.sqrt(np.maximum(rest, 0))
    t_ball = np.where(-half_b - root > T_MIN, -half_b - root, root - half_b)
    t_ball = np.where((rest > 0) & (t_ball > T_MIN), t_ball, np.inf)
    t = np.concatenate([t, t_ball], axis=1)
    primitive = t.argmin(axis=1)
    t = t[np.arange(len(t)), primitive]
    return t, np.where(np.isinf(t), -1, primitive)


def closest_hit(scene, origins, directions):
    """The closest hits of N rays: a hit with N rows. Directions (N, 3) are unit vectors."""
    t, primitive = intersect(scene, origins, directions)
    far = np.where(np.isinf(t), 0.0, t)
    points = origins + far[:, None] * directions
    quads, balls = len(scene["corners"]), scene["balls"]
    outward = -directions.copy()  # where nothing is hit
    flat, round_ = (primitive >= 0) & (primitive < quads), primitive >= quads
    outward[flat] = front_normals(scene)[primitive[flat]]
    which = balls[primitive[round_] - quads]
    outward[round_] = (points[round_] - which[:, :3]) / which[:, 3:]
    front = np.sum(outward * directions, axis=1) < 0
    normals = np.where(front[:, None], outward, -outward)
    return {
        "points": points,
        "normals": normals,
        "wo": -directions,
        "front": front,
        "t": t,
        "primitive": primitive,
    }


def take(hit, rows):
    """Rows of a hit: by indices, or by a mask (N,) of bool."""
    return {name: values[rows] for name, values in hit.items()}


def dot(a, b):
    """Scalar products (N,) of rows."""
    return np.sum(a * b, axis=1)


def camera_rays(width, height, place, target, degrees):
    """Rays (origins, directions), (height width, 3) each, row by row; y is up, `degrees` high."""
    z = np.asarray(target, float) - place
    z /= np.linalg.norm(z)
    x = np.cross(z, [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    v, u = np.mgrid[:height, :width].reshape(2, -1) + 0.5
    scale = 2 * np.tan(np.radians(degrees) / 2) / height
    flat = [scale * (u - width / 2), scale * (v - height / 2), np.ones(len(u))]
    directions = np.stack(flat, axis=1) @ np.stack([x, np.cross(z, x), z])
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return np.tile(np.asarray(place, float), (len(u), 1)), directions


# Materials and lights ----------------------------------------------------------------------------


def emitted(scene, hit):
    """The radiance (N, 3) that a hit emits toward the viewer; 0 but on the fronts of lights."""
    shines = hit["front"] & (hit["primitive"] >= 0)
    return np.where(shines[:, None], scene["emission"][hit["primitive"]], 0.0)


def emitters(scene):
    """The indices (K,) of the primitives that emit."""
    return np.flatnonzero(scene["emission"].any(axis=1))


def sample_light(scene, points, u3):
    """Sample a point on a light for each point: one of K lights and its area uniformly.

    Args:
        scene: with at least one light.
        points: (N, 3).
        u3: (N, 3), uniform in [0, 1).

    Returns:
        (wi (N, 3), distance (N,), primitive (N,)): the direction and the distance to the sampled
        point, and the index of the light. Neither visibility nor the side of the light is tested.
    """
    numbers = emitters(scene)
    primitive = numbers[(u3[:, 0] * len(numbers)).astype(int)]
    along = u3[:, 1:2] * scene["edges_u"][primitive] + u3[:, 2:] * scene["edges_v"][primitive]
    wi = scene["corners"][primitive] + along - points
    distance = np.linalg.norm(wi, axis=1)
    return wi / distance[:, None], distance, primitive


def _frames(normals):
    """An orthonormal frame around each normal, its last row: (N, 3, 3), a vector a row."""
    low = np.abs(normals).argmin(axis=1)
    x = np.cross(normals, np.eye(3)[low])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(normals, x), normals], axis=1)


def _local(hit, wi):
    """wo, wi (N, 3) each, in the frame of the surface, where the normal is +z."""
    frames = _frames(hit["normals"])
    return tuple(np.einsum("nij,nj->ni", frames, w) for w in (hit["wo"], wi))


def _material(scene, hit):
    return tuple(scene[name][hit["primitive"]] for name in ("base_color", "metalness", "roughness"))


def brdf(scene, hit, wi):
    """The BRDF for light from wi to the viewer, (N, 3) in 1/sr, without the cosine."""
    wo, wi = _local(hit, wi)
    base_color, metalness, roughness = _material(scene, hit)
    matte = np.where(((wo[:, 2] > 0) & (wi[:, 2] > 0))[:, None], base_color / np.pi, 0.0)
    glossy = gltf(wo, wi, base_color, metalness, roughness)
    return np.where(scene["matte"][hit["primitive"]][:, None], matte, glossy)


def brdf_backward(scene, hit, wi, d_f):
    """The adjoint of `brdf`, row by row: (d_base_color (N, 3), d_roughness (N,)).

    d_f (N, 3) is the derivative of some loss with respect to the result of `brdf`; directions are
    held fixed.
    """
    wo, wi = _local(hit, wi)
    matte = scene["matte"][hit["primitive"]]
    d_base_color, _, d_roughness = gltf_backward(wo, wi, *_material(scene, hit), d_f)
    above = ((wo[:, 2] > 0) & (wi[:, 2] > 0))[:, None]
    d_matte = np.where(above, d_f / np.pi, 0.0)
    return np.where(matte[:, None], d_matte, d_base_color), np.where(matte, 0.0, d_roughness)


def sample_brdf(scene, hit, u3):
    """Sample directions wi (N, 3): one half by the cosine, one half with `sample_ggx`.

    Matte primitives have the first kind only. Some directions are below the surface. u3 (N, 3),
    uniform in [0, 1).
    """
    wo = _local(hit, hit["normals"])[0]
    phi, r = 2 * np.pi * u3[:, 1], np.sqrt(u3[:, 2])
    even = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u3[:, 2])], axis=1)
    mirrored = sample_ggx(wo, scene["roughness"][hit["primitive"]], u3[:, 1:])
    by_cosine = scene["matte"][hit["primitive"]] | (u3[:, 0] < 0.5)
    wi = np.where(by_cosine[:, None], even, mirrored)
    return np.einsum("nij,ni->nj", _frames(hit["normals"]), wi)


def brdf_pdf(scene, hit, wi):
    """The density of `sample_brdf` per solid angle, (N,) in 1/sr; 0 below the surface."""
    wo, wi = _local(hit, wi)
    even = np.maximum(wi[:, 2], 0) / np.pi
    mirrored = ggx_pdf(wo, wi, scene["roughness"][hit["primitive"]])
    return np.where(scene["matte"][hit["primitive"]], even, 0.5 * even + 0.5 * mirrored)


# Your tasks ---------------------------------------------------------------------------------------


def light_pdf(scene: Scene, primitive: Indices, wi: Vectors, distance: PerRow) -> PerRow:
    """The density of `sample_light` per solid angle.

    Args:
        scene: with K lights.
        primitive: (N,), the primitive in the direction wi; -1 for none.
        wi: (N, 3), from the point toward it.
        distance: (N,), its distance, in meters.

    Returns:
        (N,), in 1/sr; exactly 0 where the primitive is no light, or its back is seen. Handout
        equations (5) and (6).
    """
    # >>> solution 07.1
    numbers = emitters(scene)
    rows = np.flatnonzero(np.isin(primitive, numbers))
    light = primitive[rows]
    width, height = (np.linalg.norm(scene[edge][light], axis=1) for edge in ("edges_u", "edges_v"))
    facing = -np.sum(wi[rows] * front_normals(scene)[light], axis=1)
    seen = facing > 0
    small = len(numbers) * width[seen] * height[seen] * facing[seen]
    pdf = np.zeros(len(primitive))
    pdf[rows[seen]] = distance[rows[seen]] ** 2 / small
    return pdf
    # <<< solution


def mis_weight(pdf: PerRow, other: PerRow) -> PerRow:
    """The weight of a sample in multiple importance sampling of two strategies.

    Args:
        pdf: (N,), the density of the strategy that took the sample, 0 to 1e200, in 1/sr.
        other: (N,), that of the other one, likewise.

    Returns:
        (N,), 0 to 1, by the power heuristic: handout equation (7). 0 where `pdf` is 0.
    """
    # >>> solution 07.2
    weight, drawn = np.zeros(len(pdf)), pdf > 0
    weight[drawn] = (pdf[drawn] / np.hypot(pdf[drawn], other[drawn])) ** 2
    return weight
    # <<< solution


def direct_light(
    scene: Scene, hit: Hit, u_light: Vectors, u_surface: Vectors, proposal: Scene | None = None
) -> Colors:
    """Direct light: radiance from lights that the surface reflects to the viewer.

    Args:
        scene: with at least one light.
        hit: N surface points; every row has a primitive.
        u_light: (N, 3), for `sample_light`: one direction for each row.
        u_surface: (N, 3), for `sample_brdf`: another one.
        proposal: the scene that determines directions, densities and weights; None for `scene`
            itself. Both scenes have the same shapes and lights, materials may differ. Closest hits
            and the BRDF are always those of `scene`.

    Returns:
        (N, 3), an estimate of the radiance without the emission of the point itself. Handout
        equations (8) to (10).
    """
    # >>> solution 07.3
    sampled_from = scene if proposal is None else proposal
    total = np.zeros((len(hit["primitive"]), 3))
    wi, _, chosen = sample_light(sampled_from, hit["points"], u_light)
    for way, wanted in ((wi, chosen), (sample_brdf(sampled_from, hit, u_surface), None)):
        there = closest_hit(scene, hit["points"], way)
        by_light = light_pdf(sampled_from, there["primitive"], way, there["t"])
        by_surface = brdf_pdf(sampled_from, hit, way)
        if wanted is not None:
            mine, theirs = by_light, by_surface
            lit = (mine > 0) & (there["primitive"] == wanted)
        else:
            mine, theirs = by_surface, by_light
            lit = mine > 0
        scale = mis_weight(mine, theirs) * np.sum(way * hit["normals"], axis=1)
        scale = np.divide(scale, mine, out=np.zeros(len(mine)), where=lit)
        total += scale[:, None] * brdf(scene, hit, way) * emitted(scene, there)
    return total
    # <<< solution


def roulette(beta: Colors, u: PerRow) -> tuple[Colors, PerRow]:
    """Russian roulette: end paths of small throughput at random, and compensate the others.

    Args:
        beta: (N, 3), the throughput of each path, 0 or more.
        u: (N,), uniform in [0, 1).

    Returns:
        (beta (N, 3), alive (N,) of bool): the new throughput, zeros where the path has ended, and
        which paths continue. Handout equations (11) and (12).
    """
    # >>> solution 07.4
    q = beta.max(axis=1).clip(max=1.0)
    alive = u < q
    after = np.zeros(beta.shape)
    after[alive] = beta[alive] / q[alive, None]
    return after, alive
    # <<< solution


def trace_paths(
    scene: Scene, origins: Vectors, directions: Vectors, depth: int, rng: np.random.Generator
) -> Colors:
    """The radiance along rays, with direct and indirect light.

    Args:
        scene: with at least one light.
        origins, directions: (N, 3), of the camera rays; unit directions.
        depth: 1 or more: the largest number of segments of a path, from the light to the camera.
            1 is emission toward the camera, 2 has direct light as well, and so on.
        rng: a generator; each ray gets independent random numbers.

    Returns:
        (N, 3), one estimate for each ray; 0 where a ray hits nothing. Handout equations (13) to
        (15).
    """
    # >>> solution 07.5
    hit = closest_hit(scene, origins, directions)
    radiance = emitted(scene, hit)
    live = np.flatnonzero(hit["primitive"] >= 0)
    hit, beta = take(hit, live), np.ones((len(live), 3))
    for bounce in range(depth - 1):
        fresh = rng.random((3, len(live), 3))
        radiance[live] += beta * direct_light(scene, hit, *fresh[:2])
        wi = sample_brdf(scene, hit, fresh[2])
        pdf, cos = brdf_pdf(scene, hit, wi), np.sum(wi * hit["normals"], axis=1)
        share = np.divide(cos, pdf, out=np.zeros(len(pdf)), where=pdf > 0)
        beta = beta * brdf(scene, hit, wi) * share[:, None]
        if bounce >= ALWAYS:
            beta, _ = roulette(beta, rng.random(len(live)))
        there = closest_hit(scene, hit["points"], wi)
        goes_on = (there["primitive"] >= 0) & beta.any(axis=1)
        hit, beta, live = take(there, goes_on), beta[goes_on], live[goes_on]
    return radiance
    # <<< solution


def direct_light_backward(
    scene: Scene, hit: Hit, u_light: Vectors, u_surface: Vectors, d_radiance: Colors
) -> tuple[PrimitiveColors, PerPrimitive]:
    """The adjoint of `direct_light` with respect to the materials (detached sampling).

    Directions, densities and weights are held fixed: it is the derivative of
    `direct_light(scene, hit, u_light, u_surface, proposal)` with respect to `scene` alone, where
    `proposal` is a copy of `scene` that is held fixed.

    Args:
        scene, hit, u_light, u_surface: as for `direct_light`.
        d_radiance: (N, 3), the derivative of some loss with respect to the result of
            `direct_light`.

    Returns:
        (d_base_color (T, 3), d_roughness (T,)), one row for each primitive of the scene, zero for
        primitives that the hit does not contain. Handout equations (16) to (18).
    """
    # >>> solution 07.6
    n, primitives = len(hit["primitive"]), len(scene["matte"])
    towards, _, light = sample_light(scene, hit["points"], u_light)
    ways = np.concatenate([towards, sample_brdf(scene, hit, u_surface)])
    both = take(hit, np.tile(np.arange(n), 2))
    found = closest_hit(scene, both["points"], ways)
    of_light = light_pdf(scene, found["primitive"], ways, found["t"])
    of_brdf = brdf_pdf(scene, both, ways)
    by_light_sampling = np.arange(2 * n) < n
    own, other = (
        np.where(by_light_sampling, of_light, of_brdf),
        np.where(by_light_sampling, of_brdf, of_light),
    )
    counts = own > 0
    counts[:n] &= found["primitive"][:n] == light
    factor = mis_weight(own, other) * np.sum(ways * both["normals"], axis=1)
    factor = np.divide(factor, own, out=np.zeros(2 * n), where=counts)
    d_f = np.tile(d_radiance, (2, 1)) * factor[:, None] * emitted(scene, found)
    by_color, by_rough = brdf_backward(scene, both, ways, d_f)
    d_base_color, d_roughness = np.zeros((primitives, 3)), np.zeros(primitives)
    np.add.at(d_base_color, both["primitive"], by_color)
    np.add.at(d_roughness, both["primitive"], by_rough)
    return d_base_color, d_roughness
    # <<< solution


# Scenes and a fit --------------------------------------------------------------------------------


def rectangle(corner, edge_u, edge_v, **material):
    """One rectangle for `assemble`; `material`: see there."""
    return {"corner": corner, "edge_u": edge_u, "edge_v": edge_v, **material}


def ball(center, radius, **material):
    """One ball for `assemble`."""
    return {"ball": [*center, radius], **material}


def assemble(primitives):
    """A scene of rectangles and balls; balls come last.

    Each primitive may have base_color, a number or three, emission likewise, metalness, roughness,
    and matte. Defaults are 0.5, 0, 0, 0.5, and true if neither metalness nor roughness is given.
    """
    primitives = sorted(primitives, key=lambda primitive: "ball" in primitive)
    flat = [primitive for primitive in primitives if "ball" not in primitive]
    scene = {
        name: np.array([primitive[key] for primitive in flat], float).reshape(-1, 3)
        for name, key in (("corners", "corner"), ("edges_u", "edge_u"), ("edges_v", "edge_v"))
    }
    balls = [primitive["ball"] for primitive in primitives if "ball" in primitive]
    scene["balls"] = np.array(balls, float).reshape(-1, 4)
    for name, default in (("base_color", 0.5), ("emission", 0.0)):
        scene[name] = np.array(
            [np.ones(3) * primitive.get(name, default) for primitive in primitives]
        )
    for name, default in (("metalness", 0.0), ("roughness", 0.5)):
        scene[name] = np.array([float(primitive.get(name, default)) for primitive in primitives])
    glossy = [
        primitive.get("matte", not {"metalness", "roughness"} & set(primitive))
        for primitive in primitives
    ]
    scene["matte"] = np.array(glossy, bool)
    return scene


def demo_room():
    """A room with a light in the ceiling, a glossy floor and a metal ball: primitive 7."""
    light, white = {"emission": [9.0, 8.0, 6.5], "base_color": 0.0}, {"base_color": 0.7}
    return assemble(
        [
            rectangle(
                [-1, 0, -1], [0, 0, 2], [2, 0, 0], base_color=[0.4, 0.35, 0.3], roughness=0.35
            ),
            rectangle([-1, 2, -1], [2, 0, 0], [0, 0, 2], **white),
            rectangle([-1, 0, -1], [2, 0, 0], [0, 2, 0], **white),
            rectangle([-1, 0, -1], [0, 2, 0], [0, 0, 2], base_color=[0.65, 0.1, 0.1]),
            rectangle([1, 0, -1], [0, 0, 2], [0, 2, 0], base_color=[0.15, 0.45, 0.15]),
            rectangle([-0.35, 1.98, -0.35], [0.7, 0, 0], [0, 0, 0.7], **light),
            rectangle(
                [-0.95, 0.15, -0.95], [0.5, 0, -0.02], [0, 0.5, 0], base_color=[0.1, 0.2, 0.6]
            ),
            ball([0.25, 0.5, 0], 0.5, base_color=[0.9, 0.6, 0.3], metalness=1, roughness=0.4),
        ]
    )


def demo_table(base_color=(0.8, 0.5, 0.2), roughness=0.35):
    """A table, primitive 0, under a tilted light. Its image has 10 x 7 pixels."""
    return assemble(
        [
            rectangle(
                [-1, 0, -1],
                [0, 0, 2],
                [2, 0, 0],
                base_color=base_color,
                roughness=roughness,
                metalness=0.5,
            ),
            rectangle([-0.5, 0.4, -1], [1, 0, 0], [0, 0.5, 0.4], emission=[6, 5, 4], base_color=0),
        ]
    )


def table_rays():
    """The rays (origins, directions) of the image of `demo_table`, (70, 3) each."""
    return camera_rays(10, 7, [0, 0.9, 1.2], [0, 0, -0.3], 45)


def repeated(hit, times):
    """A hit with each row repeated `times` times."""
    return take(hit, np.repeat(np.arange(len(hit["primitive"])), times))


def strata(rng, pixels, side=SIDE):
    """Stratified random numbers (pixels side^2, 3): lower variance, same mean.

    Within a pixel the last two numbers are jittered in a grid of cells, the first one in a shuffled
    sequence of intervals.
    """
    cells = np.stack(np.mgrid[:side, :side], axis=-1).reshape(-1, 2)
    dealt = rng.permuted(np.tile(np.arange(side**2), (pixels, 1)), axis=1)
    first = (dealt + rng.random(dealt.shape)) / side**2
    last = (cells + rng.random((pixels, side**2, 2))) / side
    return np.concatenate([first[..., None], last], axis=2).reshape(-1, 3)


def recover(scene, primitive, origins, directions, picture, steps, rng):
    """Recover the base color and the roughness of one primitive from an image, by your gradient.

    Adam on the mean squared error relative to the image (plus 0.1), so that the highlight does not
    dominate. The residual and the derivative that it multiplies have independent random numbers
    (a dual-buffer loss): section 6 of the handout says why.

    Args:
        scene: known but for base_color and roughness of `primitive`, which are an initial guess.
        primitive: the index of the primitive.
        origins, directions: (N, 3), the rays of the image.
        picture: (N, 3), direct light only.
        steps: of gradient descent, 1 or more.
        rng: a generator.

    Returns:
        (base_color (3,), roughness, track (steps, 4)): the mean of the last third of the steps,
        and base color and roughness after each.
    """
    own = {
        **scene,
        "base_color": scene["base_color"].copy(),
        "roughness": scene["roughness"].copy(),
    }
    hit = closest_hit(own, origins, directions)
    mine = hit["primitive"] == primitive
    pixels, samples = int(mine.sum()), SIDE**2
    hit = repeated(take(hit, mine), samples)
    x = np.append(own["base_color"][primitive], own["roughness"][primitive])
    mean, square, track = np.zeros(4), np.zeros(4), []
    for step in range(1, steps + 1):
        u = [strata(rng, pixels) for _ in range(4)]
        shown = direct_light(own, hit, u[0], u[1]).reshape(pixels, samples, 3).mean(axis=1)
        d_shown = 2 * (shown - picture[mine]) / (picture[mine] + 0.1) ** 2
        d_shown /= shown.size * samples
        d_hit = np.repeat(d_shown, samples, axis=0)
        d_base_color, d_roughness = direct_light_backward(own, hit, u[2], u[3], d_hit)
        d_x = np.append(d_base_color[primitive], d_roughness[primitive])
        mean, square = 0.8 * mean + 0.2 * d_x, 0.95 * square + 0.05 * d_x**2
        pull = mean / (1 - 0.8**step) / np.sqrt(square / (1 - 0.95**step) + 1e-30)
        x = np.clip(x - 0.06 * (1 - step / (steps + 1)) ** 2 * pull, 0.0, 1.0)
        x[3] = max(x[3], 0.1)
        own["base_color"][primitive], own["roughness"][primitive] = x[:3], x[3]
        track.append(x.copy())
    track = np.array(track)
    found = track[-max(1, steps // 3) :].mean(axis=0)
    return found[:3], float(found[3]), track


def by_roughness(scene, primitive, origins, directions, rng, side=12):
    """Derivative of each pixel (N,), mean of RGB, with respect to a primitive's roughness."""
    hit, slope = closest_hit(scene, origins, directions), np.zeros(len(origins))
    for k in np.flatnonzero(hit["primitive"] == primitive):
        many = repeated(take(hit, [k]), side**2)
        u = strata(rng, 1, side), strata(rng, 1, side)
        d = np.full((side**2, 3), 1 / (3 * side**2))
        slope[k] = direct_light_backward(scene, many, *u, d)[1][primitive]
    return slope


# Results of the C++ core for `demo_table`, in 1/10,000: red, green, blue and the derivative of
# their mean with respect to the roughness, for the last five rows; then the recovered values.
_CORE = """
    0 0 0 0  1178 614 197 291  2611 1362 439 945  4997 2612 848 3357  6452 3373 1096 4714
    6421 3357 1090 4740  4990 2608 846 3357  2630 1372 442 936  1174 612 197 291  0 0 0 0
    1262 658 212 391  2033 1061 343 980  3416 1793 592 4052  14160 7653 2805 -12737
    17875 9664 3545 -9483  17984 9724 3570 -9048  14197 7673 2813 -13066  3428 1800 594 4063
    2029 1060 342 979  1259 657 211 390  1219 636 206 545  1679 879 287 1372  3013 1595 543 5385
    15243 8235 3013 -27004  20957 11332 4160 -30288  21018 11365 4173 -30916
    15218 8221 3009 -27488  3012 1595 543 5368  1669 873 285 1373  1214 634 205 545
    1015 530 172 597  1314 689 226 1404  2356 1250 429 4228  8852 4756 1709 -13224
    12687 6826 2463 -16613  12669 6816 2459 -16709  8748 4700 1689 -13695  2365 1254 430 4302
    1314 689 226 1416  1018 532 172 594  851 445 145 587  1049 550 181 1222  1605 849 289 2998
    3235 1727 607 4747  4436 2374 841 6633  4404 2357 835 6691  3226 1722 605 4726
    1600 847 288 3019  1050 551 181 1226  852 445 145 584
"""
_CORE_FOUND = "7907 4999 2035 3396"


def core_answers():
    """Of the core: direct light (7, 10, 3), its roughness gradient (7, 10), recovered (4,)."""
    table = np.array(_CORE.split(), float).reshape(5, 10, 4) / 1e4
    table = np.concatenate([np.zeros((2, 10, 4)), table])
    return table[..., :3], table[..., 3], np.array(_CORE_FOUND.split(), float) / 1e4
