"""Gradients through edges and light: coverage, edge sampling, strokes, path replay, a caustic.

Pictures are arrays (H, W) or (H, W, C), row 0 on top. In the plane x runs to the right and y down,
one pixel is 1 wide, and the center of the pixel (row, column) is (column + 0.5, row + 0.5). A
*polygon* is an array (V, 2) of vertices (x, y) in an order that makes `polygon_area` positive: on
the screen, where y points down, clockwise. A *curve* is a quadratic Bezier curve, three control
points (3, 2). Scenes and hits are those of assignment 07, in meters. The *heights* of a lens are
(M + 1, M + 1) above a square that is 1 wide.

Your tasks are six functions, one section of the handout each; `photograd course check 14` tells how
far you are. The other functions are given and stay as they are. All numbers are float64, and d_x
stands for the derivative of some loss with respect to x.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np
from path_tracing import (
    assemble,
    brdf,
    brdf_backward,
    brdf_pdf,
    camera_rays,
    closest_hit,
    direct_light,
    direct_light_backward,
    dot,
    emitted,
    rectangle,
    sample_brdf,
    take,
)

# Arrays and their shapes; float64 where nothing else is said.
Numbers = Annotated[np.ndarray, "N"]
Vectors = Annotated[np.ndarray, "N 3"]
Colors = Annotated[np.ndarray, "N 3"]
Points = Annotated[np.ndarray, "N 2"]
Polygon = Annotated[np.ndarray, "V 2"]
Curve = Annotated[np.ndarray, "3 2"]
Image = Annotated[np.ndarray, "H W C"]
Alphas = Annotated[np.ndarray, "H W"]
Heights = Annotated[np.ndarray, "M+1 M+1"]
PrimitiveColors = Annotated[np.ndarray, "T 3"]
PerPrimitive = Annotated[np.ndarray, "T"]
Scene = dict[str, np.ndarray]
Paint = Callable[[Points], np.ndarray]  # colors (N, C) at points (N, 2)

ETA = 1.5  # refractive index of the lens, over that of air
DISTANCE = 1.0  # from the flat side of the lens to the screen, in widths of the lens
PIXEL_RADIUS = np.sqrt(1 / np.pi)  # of a disk of area 1


def descend(x, gradient, steps, rate, low=-np.inf, high=np.inf):
    """Adam, with a learning rate that falls to 0: x after so many steps.

    `gradient(x, step)` is asked in each step, 1, 2, ...; x is kept between `low` and `high`.
    """
    mean, square = np.zeros(np.shape(x)), np.zeros(np.shape(x))
    for step in range(1, steps + 1):
        d_x = gradient(x, step)
        mean, square = 0.8 * mean + 0.2 * d_x, 0.95 * square + 0.05 * d_x**2
        way = mean / (1 - 0.8**step) / np.sqrt(square / (1 - 0.95**step) + 1e-30)
        x = np.clip(x - rate * (1 - step / (steps + 1)) * way, low, high)
    return x


def pixel_centers(height, width):
    """The centers (height width, 2) of the pixels, row by row."""
    y, x = np.mgrid[:height, :width].reshape(2, -1) + 0.5
    return np.stack([x, y], axis=1)


# Edges --------------------------------------------------------------------------------------------


def edge_coverage(angle: Numbers, offset: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """The area of a pixel on the inner side of an edge, and its derivatives.

    The pixel is the square of area 1 around the origin. Row by row, the edge is the line
    n . x = offset with the unit normal n = (cos(angle), sin(angle)), and the inner side is
    n . x < offset.

    Args:
        angle: (N,), in radians.
        offset: (N,), in pixels; the signed distance of the edge from the center of the pixel.

    Returns:
        (area (N,), d_offset (N,), d_angle (N,)): the area, and its derivatives with respect to
        the offset and to the angle. Handout equations (3) to (6).
    """
    # >>> solution 14.1
    cos, sin = np.cos(angle), np.sin(angle)
    large = np.maximum(np.abs(cos), np.abs(sin))
    small = np.minimum(np.abs(cos), np.abs(sin))
    flat = (large - small) / 2
    inner = np.minimum(np.abs(offset), flat)
    slanted = np.clip(np.abs(offset) - flat, 0, small)
    bend = np.divide(slanted**2, 2 * small, out=np.zeros_like(small), where=small > 0)
    area = 0.5 + np.sign(offset) * (inner + slanted - bend) / large
    begin, end = np.full(len(angle), -np.inf), np.full(len(angle), np.inf)
    for at, pace in ((offset * cos, -sin), (offset * sin, cos)):
        crosses = np.abs(pace) > 1e-14
        middle = np.divide(-at, pace, out=np.zeros_like(at), where=crosses)
        half = np.divide(0.5, np.abs(pace), out=np.full_like(at, np.inf), where=crosses)
        begin, end = np.maximum(begin, middle - half), np.minimum(end, middle + half)
    missed = np.abs(offset) >= (large + small) / 2
    chord = np.where(missed, 0.0, np.maximum(end - begin, 0))
    return area, chord, -chord * (begin + end) / 2
    # <<< solution


def half_plane_image(angle, offset, height, width):
    """Exact coverage (height, width) of the pixels by a half-plane, and its derivatives.

    The line is given as for `edge_coverage`, from the center of the picture. Returns (picture,
    d_offset, d_angle), each (height, width).
    """
    p = pixel_centers(height, width) - [width / 2, height / 2]
    n, m = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    area, d_offset, d_angle = edge_coverage(np.full(len(p), float(angle)), offset - p @ n)
    turned = d_angle - d_offset * (p @ m)
    return tuple(each.reshape(height, width) for each in (area, d_offset, turned))


def recover_edge(picture, angle, offset, steps):
    """(angle, offset) of the edge in a picture, by Gauss-Newton steps from a guess."""
    x = np.array([angle, offset], float)
    for _ in range(steps):
        shown, d_offset, d_angle = half_plane_image(*x, *picture.shape)
        jacobian = np.stack([d_angle.ravel(), d_offset.ravel()], axis=1)
        change = np.linalg.lstsq(jacobian, (picture - shown).ravel(), rcond=None)[0]
        x = x + change / max(1.0, *np.abs(change / [0.3, 1.0]))
    return x


def polygon_area(vertices):
    """The signed area of a polygon; all polygons here have a positive one."""
    x, y = vertices.T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def polygon_image(vertices, height, width):
    """Exact coverage (height, width) of the pixels by a polygon.

    In a row of pixels each edge takes away the area to its right, or adds it where it runs upward.
    Along the edge that area is a ramp of x, which is integrated in closed form.
    """
    tips = np.roll(vertices, -1, axis=0)
    (x0, y0), (x1, y1) = vertices.T[:, :, None], tips.T[:, :, None]
    rows = np.arange(height)
    top, bottom = np.clip(y0, rows, rows + 1), np.clip(y1, rows, rows + 1)
    slope = (x1 - x0) / np.where(y1 == y0, np.inf, y1 - y0)
    first, last = ((x0 + (y - y0) * slope)[..., None] for y in (top, bottom))
    right = np.arange(width) + 1.0
    span = last - first
    near = np.abs(span) < 1e-6
    gaps = right - first, right - last
    whole = [np.clip(gap, 0, 1) ** 2 / 2 + np.maximum(gap - 1, 0) for gap in gaps]
    ramp = np.clip(right - (first + last) / 2, 0, 1)
    mean = np.where(near, ramp, (whole[0] - whole[1]) / np.where(near, 1.0, span))
    return -np.sum((bottom - top)[..., None] * mean, axis=0)


def edge_sampling_backward(
    vertices: Polygon, inside: Paint, outside: Paint, d_image: Image, u: Numbers
) -> Polygon:
    """Monte Carlo estimate of the derivative of a loss with respect to a polygon's vertices.

    The color of a pixel is the mean over its area of `inside` where the polygon is, and of
    `outside` elsewhere. Both colors stay where they are when the polygon moves.

    Args:
        vertices: (V, 2).
        inside, outside: functions of points (N, 2) that return colors (N, C).
        d_image: (H, W, C), the derivative of the loss with respect to the picture. What lies beyond
            the picture does not count.
        u: (N,), uniform in [0, 1); each is one point on the boundary, uniform in its length, which
            starts at vertex 0.

    Returns:
        d_vertices (V, 2). Handout equations (8) to (10).
    """
    # >>> solution 14.2
    sides = np.roll(vertices, -1, axis=0) - vertices
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    stops = np.cumsum(lengths)
    reached = u * stops[-1]
    edge = np.searchsorted(stops, reached, side="right")
    share = 1 - (stops[edge] - reached) / lengths[edge]
    spots = vertices[edge] + share[:, None] * sides[edge]
    column, row = np.floor(spots).astype(int).T
    height, width = d_image.shape[:2]
    framed = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    pulls = d_image[np.where(framed, row, 0), np.where(framed, column, 0)]
    pull = framed * np.sum(pulls * (inside(spots) - outside(spots)), axis=1)
    with np.errstate(invalid="ignore"):  # a side of length 0 is never chosen
        normal = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / lengths[:, None]
    push = (stops[-1] / len(u) * pull)[:, None] * normal[edge]
    d_vertices = np.zeros(vertices.shape)
    np.add.at(d_vertices, edge, (1 - share)[:, None] * push)
    np.add.at(d_vertices, (edge + 1) % len(vertices), share[:, None] * push)
    return d_vertices
    # <<< solution


def recover_polygon(picture, vertices, steps, seed, samples=400, smoothness=0.0):
    """Vertices of a white polygon on black in a picture (H, W), from a guess, by your gradient.

    Each step samples the boundary anew. `smoothness` pulls each vertex to the middle of its
    neighbors, which keeps many vertices evenly spaced. Returns (vertices, track (steps, V, 2)).
    """
    rng, track = np.random.default_rng(seed), []
    height, width = picture.shape

    def gradient(x, step):
        del step
        track.append(x.copy())
        d_image = (2 * (polygon_image(x, height, width) - picture))[..., None]
        u = (np.arange(samples) + rng.random(samples)) / samples
        d_x = edge_sampling_backward(x, _white, _black, d_image, u)
        return d_x + smoothness * (2 * x - np.roll(x, 1, axis=0) - np.roll(x, -1, axis=0))

    return descend(vertices, gradient, steps, 0.6), np.array(track)


def _white(points):
    return np.ones((len(points), 1))


def _black(points):
    return np.zeros((len(points), 1))


# Strokes ------------------------------------------------------------------------------------------


def bezier(curve, t):
    """Points (N, 2) of a curve at parameters t (N,)."""
    weights = np.stack([(1 - t) ** 2, 2 * t * (1 - t), t**2], axis=1)
    return weights @ curve


def nearest_on_curve(curve, points):
    """The parameters t (N,) of the nearest points of a curve, and the distances (N,)."""
    t = np.linspace(0, 1, 33)
    far = np.sum((points[:, None] - bezier(curve, t)) ** 2, axis=2)
    t = t[far.argmin(axis=1)]
    bend = 2 * (curve[0] - 2 * curve[1] + curve[2])
    for _ in range(12):
        away = bezier(curve, t) - points
        along = 2 * (curve[1] - curve[0]) + t[:, None] * bend
        curvature = np.maximum(dot(along, along) + away @ bend, 1e-9)
        t = np.clip(t - dot(away, along) / curvature, 0, 1)
    return t, np.linalg.norm(points - bezier(curve, t), axis=1)


def round_coverage(offset):
    """Area (N,) of a round pixel of area 1 on the inner side of an edge, and its derivative (N,).

    `offset` is the distance of the edge from the center, positive where the center is inside.
    """
    s = np.clip(offset, -PIXEL_RADIUS, PIXEL_RADIUS)
    half = np.sqrt(PIXEL_RADIUS**2 - s**2)
    return 0.5 + (s * half + PIXEL_RADIUS**2 * np.arcsin(s / PIXEL_RADIUS)), 2 * half


def stroke_image(curve, width, rows, columns):
    """Coverage (rows, columns) of round pixels by a stroke of this width along a curve."""
    _, distance = nearest_on_curve(curve, pixel_centers(rows, columns))
    alpha = round_coverage(width / 2 - distance)[0] - round_coverage(-width / 2 - distance)[0]
    return alpha.reshape(rows, columns)


def stroke_backward(curve: Curve, width: float, d_alpha: Alphas) -> tuple[Curve, float]:
    """The adjoint of `stroke_image`.

    Args:
        curve: (3, 2), the control points.
        width: of the stroke, in pixels.
        d_alpha: (H, W), the derivative of a loss with respect to the picture of the stroke.

    Returns:
        (d_curve (3, 2), d_width): a float for the width. Handout equations (11) to (14).
    """
    # >>> solution 14.3
    centers = pixel_centers(*d_alpha.shape)
    nearest, distance = nearest_on_curve(curve, centers)
    rim = round_coverage(width / 2 - distance)[1]
    back_rim = round_coverage(-width / 2 - distance)[1]
    pull = d_alpha.ravel()
    toward = (bezier(curve, nearest) - centers) / np.maximum(distance, 1e-300)[:, None]
    push = (pull * (back_rim - rim))[:, None] * toward
    shares = np.stack([(1 - nearest) ** 2, 2 * nearest * (1 - nearest), nearest**2])
    return shares @ push, float(np.sum(pull * (rim + back_rim)) / 2)
    # <<< solution


def recover_stroke(picture, curve, width, steps):
    """(curve, width) of the stroke in a picture (H, W), from a guess, by your gradient."""

    def gradient(x, step):
        del step
        shown = stroke_image(x[:6].reshape(3, 2), x[6], *picture.shape)
        d_curve, d_width = stroke_backward(x[:6].reshape(3, 2), x[6], 2 * (shown - picture))
        return np.append(d_curve, d_width)

    low = np.append(np.full(6, -np.inf), 0.4)
    x = descend(np.append(curve, width), gradient, steps, 0.3, low)
    return x[:6].reshape(3, 2), float(x[6])


# Light paths --------------------------------------------------------------------------------------


def path_numbers(seed, bounce, n):
    """Random numbers (3, n, 3) of n paths at a bounce: for equal arguments always the same."""
    return np.random.default_rng([seed, bounce]).random((3, n, 3))


def next_vertex(scene, hit, u3, proposal=None):
    """Continue paths: (wi (N, 3), f (N, 3), factor (N,), the next hit).

    wi is sampled with the BRDF of `proposal` (by default of `scene`), f is the BRDF of `scene`, and
    `factor` the cosine over the density, 0 where the density is 0: the throughput is multiplied by
    f and by `factor`.
    """
    source = scene if proposal is None else proposal
    wi = sample_brdf(source, hit, u3)
    density, points = brdf_pdf(source, hit, wi), hit["points"]
    factor, sampled = np.zeros(len(density)), density > 0
    factor[sampled] = dot(wi, hit["normals"])[sampled] / density[sampled]
    return wi, brdf(scene, hit, wi), factor, closest_hit(scene, points, wi)


def path_radiance(scene, origins, directions, depth, seed, proposal=None):
    """Radiance (N, 3) along rays by paths of at most `depth` segments, without roulette.

    As `trace_paths` of assignment 07, with the numbers of `path_numbers`: the same seed gives the
    same paths. Directions, densities and weights come from the scene `proposal` where one is given.
    """
    vertices = closest_hit(scene, origins, directions)
    total, beta = emitted(scene, vertices), np.ones((len(origins), 3))
    live = np.flatnonzero(vertices["primitive"] >= 0)
    vertices = take(vertices, live)
    for bounce in range(depth - 1):
        u = path_numbers(seed, bounce, len(origins))[:, live]
        total[live] += beta[live] * direct_light(scene, vertices, u[0], u[1], proposal)
        _, f, factor, found = next_vertex(scene, vertices, u[2], proposal)
        beta[live] *= f * factor[:, None]
        goes_on = (found["primitive"] >= 0) & beta[live].any(axis=1)
        vertices, live = take(found, goes_on), live[goes_on]
    return total


def replay_backward(
    scene: Scene,
    origins: Vectors,
    directions: Vectors,
    depth: int,
    seed: int,
    radiance: Colors,
    d_radiance: Colors,
) -> tuple[PrimitiveColors, PerPrimitive]:
    """The adjoint of `path_radiance` with respect to the materials, by path replay.

    Directions, densities and weights are held fixed, as in `direct_light_backward`. The paths are
    traced a second time, and nothing of the first pass is needed but its result.

    Args:
        scene, origins, directions, depth, seed: as for `path_radiance`.
        radiance: (N, 3), what `path_radiance` has returned for them.
        d_radiance: (N, 3), the derivative of some loss with respect to it.

    Returns:
        (d_base_color (T, 3), d_roughness (T,)), a row for each primitive. Where a channel of a BRDF
        is 0 it gets no derivative from what lies behind it. Handout equations (15) to (18).
    """
    # >>> solution 14.4
    n, primitives = len(origins), len(scene["matte"])
    d_base_color, d_roughness = np.zeros((primitives, 3)), np.zeros(primitives)
    vertex = closest_hit(scene, origins, directions)
    behind, beta = radiance - emitted(scene, vertex), np.ones((n, 3))
    live = np.flatnonzero(vertex["primitive"] >= 0)
    vertex = take(vertex, live)
    for bounce in range(depth - 1):
        u = path_numbers(seed, bounce, n)[:, live]
        behind[live] -= beta[live] * direct_light(scene, vertex, u[0], u[1])
        by_light = direct_light_backward(scene, vertex, u[0], u[1], beta[live] * d_radiance[live])
        wi, f, factor, found = next_vertex(scene, vertex, u[2])
        rest = d_radiance[live] * behind[live]
        d_f = np.divide(rest, f, out=np.zeros_like(rest), where=f > 0)
        by_color, by_rough = brdf_backward(scene, vertex, wi, d_f)
        np.add.at(d_base_color, vertex["primitive"], by_color)
        np.add.at(d_roughness, vertex["primitive"], by_rough)
        d_base_color, d_roughness = d_base_color + by_light[0], d_roughness + by_light[1]
        beta[live] *= f * factor[:, None]
        goes_on = found["primitive"] >= 0
        vertex, live = take(found, goes_on), live[goes_on]
    return d_base_color, d_roughness
    # <<< solution


def noisy_loss_and_grad(
    scene: Scene,
    origins: Vectors,
    directions: Vectors,
    picture: Colors,
    depth: int,
    samples: int,
    seeds: tuple[int, int],
) -> tuple[float, PrimitiveColors, PerPrimitive]:
    """An unbiased estimate of the relative squared error of a rendering, and its derivatives.

    Args:
        scene, origins, directions, depth: as for `path_radiance`; a ray for each of N pixels.
        picture: (N, 3), the target.
        samples: paths per pixel in each of two renderings. The rays of a pixel follow each other:
            row k of the picture belongs to rays samples k to samples (k + 1) - 1.
        seeds: two, one for each rendering.

    Returns:
        (loss, d_base_color (T, 3), d_roughness (T,)): the product of the two residuals over
        (picture + 0.1)^2, averaged over pixels and channels. Handout equations (19) to (21).
    """
    # >>> solution 14.5
    many = [np.repeat(rays, samples, axis=0) for rays in (origins, directions)]
    shots = [path_radiance(scene, *many, depth, seed) for seed in seeds]
    off = [shot.reshape(len(picture), samples, 3).mean(axis=1) - picture for shot in shots]
    scale = 1 / (picture + 0.1) ** 2 / picture.size
    d_base_color, d_roughness = np.zeros(scene["base_color"].shape), np.zeros(len(scene["matte"]))
    for seed, shot, other in zip(seeds, shots, off[::-1], strict=True):
        d_shot = np.repeat(scale * other / samples, samples, axis=0)
        by_color, by_rough = replay_backward(scene, *many, depth, seed, shot, d_shot)
        d_base_color, d_roughness = d_base_color + by_color, d_roughness + by_rough
    return float(np.sum(scale * off[0] * off[1])), d_base_color, d_roughness
    # <<< solution


def recover_material(scene, primitive, origins, directions, picture, depth, steps, seed):
    """Recover base color and roughness of a primitive from an image of light on all its ways.

    `scene` is known but for the two, which are a guess; only pixels that show the primitive are
    looked at, with 2 x 32 paths each. Returns (base_color (3,), roughness, track (steps, 4)): the
    mean of the last third of the steps, and what each step started from.
    """
    own = {name: scene[name].copy() for name in scene}
    shown = closest_hit(scene, origins, directions)["primitive"] == primitive
    given = origins[shown], directions[shown], picture[shown], depth, 32
    track = []

    def gradient(x, step):
        track.append(x.copy())
        own["base_color"][primitive], own["roughness"][primitive] = x[:3], x[3]
        seeds = (seed + 2 * step, seed + 2 * step + 1)
        _, d_base_color, d_roughness = noisy_loss_and_grad(own, *given, seeds)
        return np.append(d_base_color[primitive], d_roughness[primitive])

    start = np.append(scene["base_color"][primitive], scene["roughness"][primitive])
    descend(start, gradient, steps, 0.06, 0.02, 0.98)
    found = np.array(track)[-max(1, steps // 3) :].mean(axis=0)
    return found[:3], float(found[3]), np.array(track)


def demo_niche(base_color=(0.8, 0.5, 0.2), roughness=0.35):
    """A glossy table, primitive 0, in a niche of colored walls, below a light: primitive 4."""
    walls = [
        rectangle([-1, 0, -1], [2, 0, 0], [0, 1.6, 0], base_color=[0.75, 0.75, 0.7]),
        rectangle([-1, 0, -1], [0, 1.6, 0], [0, 0, 2], base_color=[0.7, 0.12, 0.1]),
        rectangle([1, 0, -1], [0, 0, 2], [0, 1.6, 0], base_color=[0.12, 0.3, 0.7]),
    ]
    table = rectangle(
        [-1, 0, -1], [0, 0, 2], [2, 0, 0], base_color=base_color, roughness=roughness, metalness=0.3
    )
    light = rectangle([-0.6, 1.5, -0.7], [1.2, 0, 0], [0, 0.3, 0.8], emission=[7, 6.5, 6])
    return assemble([table, *walls, light])


def niche_rays(width=10, height=8):
    """The rays (origins, directions) of an image of `demo_niche`."""
    return camera_rays(width, height, [0, 1.1, 2.6], [0, 0.35, -0.2], 42)


# A caustic ----------------------------------------------------------------------------------------


def landing_points(heights):
    """Where light lands on the screen: points (M^2, 2), a ray through the middle of each cell.

    Parallel light enters the flat side of the lens at right angles, z = 0, and leaves it through
    the surface z = heights, where it is refracted. The screen is at z = DISTANCE.
    """
    cells = len(heights) - 1
    a, b, c, d = heights[:-1, :-1], heights[:-1, 1:], heights[1:, :-1], heights[1:, 1:]
    level = (a + b + c + d) / 4
    slope = np.stack([b + d - a - c, c + d - a - b], axis=-1) * cells / 2
    q = np.sum(slope**2, axis=-1)
    k = (np.sqrt(1 + (1 - ETA**2) * q) - ETA) / (1 + q)
    tangent = -slope * (k / (ETA + k))[..., None]
    places = pixel_centers(cells, cells).reshape(cells, cells, 2) / cells
    return (places + (DISTANCE - level)[..., None] * tangent).reshape(-1, 2)


def landing_backward(heights: Heights, d_points: Points) -> Heights:
    """The adjoint of `landing_points`.

    Args:
        heights: (M + 1, M + 1), of the lens.
        d_points: (M^2, 2), the derivative of a loss with respect to the points on the screen.

    Returns:
        d_heights (M + 1, M + 1). Handout equations (22) to (26).
    """
    # >>> solution 14.6
    cells = len(heights) - 1
    slope_x = (heights[:, 1:] - heights[:, :-1]) * cells
    slope_y = (heights[1:] - heights[:-1]) * cells
    slopes = np.stack(
        [(slope_x[1:] + slope_x[:-1]) / 2, (slope_y[:, 1:] + slope_y[:, :-1]) / 2], axis=-1
    )
    columns = (heights[1:] + heights[:-1]) / 2
    path = DISTANCE - (columns[:, 1:] + columns[:, :-1]) / 2
    steep = np.sum(slopes**2, axis=-1)
    root = np.sqrt(1 + (1 - ETA**2) * steep)
    turn = (root - ETA) / (1 + steep)
    bending = -turn / (ETA + turn)
    d_turn = ((1 - ETA**2) / (2 * root) - turn) / (1 + steep)
    d_bending = -ETA / (ETA + turn) ** 2 * d_turn
    pull = d_points.reshape(cells, cells, 2)
    along = np.sum(pull * slopes, axis=-1)
    d_level = -along * bending
    d_slopes = (path * bending)[..., None] * pull
    d_slopes += (2 * path * along * d_bending)[..., None] * slopes
    d_heights = np.zeros(heights.shape)
    for down in (0, 1):
        for right in (0, 1):
            share = d_level / 4
            share = share + cells / 2 * (2 * right - 1) * d_slopes[..., 0]
            share = share + cells / 2 * (2 * down - 1) * d_slopes[..., 1]
            d_heights[down : down + cells, right : right + cells] += share
    return d_heights
    # <<< solution


def _spline(x):
    """For places x (N,) in pixels: three pixels (N, 3), their weights and derivatives of those."""
    pixel = np.floor(x)
    f = x - pixel - 0.5
    weights = [(0.5 - f) ** 2 / 2, 0.75 - f**2, (0.5 + f) ** 2 / 2]
    slopes = [f - 0.5, -2 * f, f + 0.5]
    return pixel.astype(int)[:, None] + [-1, 0, 1], np.stack(weights, 1), np.stack(slopes, 1)


def splat(points, size):
    """Irradiance (size, size) of the screen, 1 on average, from points (N, 2) in [0, 1]^2."""
    (column, wx, _), (row, wy, _) = _spline(points[:, 0] * size), _spline(points[:, 1] * size)
    picture = np.zeros((size + 2, size + 2))
    row, column = np.clip(row + 1, 0, size + 1), np.clip(column + 1, 0, size + 1)
    np.add.at(picture, (row[:, :, None], column[:, None]), wy[:, :, None] * wx[:, None])
    return picture[1:-1, 1:-1] * size**2 / len(points)


def splat_backward(points, d_picture):
    """The adjoint of `splat`: d_points (N, 2)."""
    size = len(d_picture)
    (column, wx, dx), (row, wy, dy) = _spline(points[:, 0] * size), _spline(points[:, 1] * size)
    row, column = np.clip(row + 1, 0, size + 1), np.clip(column + 1, 0, size + 1)
    d = np.pad(d_picture, 1)[row[:, :, None], column[:, None]] * size**3 / len(points)
    return np.stack([np.einsum("nij,ni,nj->n", d, *w) for w in ((wy, dx), (dy, wx))], axis=1)


def cosines(count):
    """The orthonormal cosine transform (count, count), and the eigenvalues of the Laplacian."""
    k = np.arange(count)
    rows = np.cos(np.pi * np.outer(k, k + 0.5) / count) * np.sqrt(2 / count)
    rows[0] /= np.sqrt(2)
    return rows, (2 - 2 * np.cos(np.pi * k / count)) * count**2


def design_caustic(target, cells, steps, rate=6e-4):
    """Heights of a lens that throws the picture `target` (S, S), of mean 1, on the screen.

    From a flat lens, by your gradient: first of pictures of S / 4 pixels, then S / 2, then S. The
    gradient is divided by the eigenvalues of the Laplacian, which makes it smooth: light moves by
    slopes. Returns (heights, losses).
    """
    transform, eigen = cosines(cells + 1)
    divisor = eigen[:, None] + eigen
    divisor[0, 0] = np.inf
    heights, losses = np.zeros((cells + 1, cells + 1)), []
    for coarse in (4, 2, 1):
        size = len(target) // coarse
        goal = target.reshape(size, coarse, size, coarse).mean(axis=(1, 3))
        mean, square = np.zeros_like(heights), 0.0
        for step in range(1, steps + 1):
            points = landing_points(heights)
            residual = splat(points, size) - goal
            losses.append(float(np.mean(residual**2)))
            d_points = splat_backward(points, 2 * residual / residual.size)
            d_heights = landing_backward(heights, d_points)
            d_heights = transform.T @ (transform @ d_heights @ transform.T / divisor) @ transform
            mean = 0.8 * mean + 0.2 * d_heights
            square = 0.95 * square + 0.05 * np.mean(d_heights**2)
            way = mean / (1 - 0.8**step) / np.sqrt(square / (1 - 0.95**step) + 1e-30)
            heights = heights - rate * np.sqrt(1 - step / (steps + 1)) * way
    return heights, np.array(losses)


def finer(heights, factor):
    """The same smooth surface with `factor` times as many cells, by its cosine series."""
    count = len(heights)
    transform, _ = cosines(count)
    x = np.arange((count - 1) * factor + 1) / factor + 0.5
    rows = np.cos(np.pi * np.outer(x, np.arange(count)) / count) * np.sqrt(2 / count)
    rows[:, 0] /= np.sqrt(2)
    return rows @ (transform @ heights @ transform.T) @ rows.T


# Letters of 5 x 7 dots, a row of five bits after the other; 35 bits each.
_GLYPHS = (
    "3a31fc631 7a31f463e 3a308422e 7a318c63e 7e10f421f 7e10f4210 3a30bc62e 4631fc631 38842108e"
    " 1c4210a4c 4654c5251 42108421f 4775ac631 4735ace31 3a318c62e 7a31f4210 3a318d64d 7a31f5251"
    " 3e107043e 7c8421084 46318c62e 46318a944 4631ad771 462a22a31 462a21084 7c222221f"
)


def initials_of(text):
    """Two letters that a checksum of a text decides, such as the text of your module."""
    number = int.from_bytes(text.encode("utf-8"), "big") % 1_000_003
    return chr(ord("A") + number % 26) + chr(ord("A") + number // 26 % 26)


def letters_image(letters, size, dim=0.12):
    """Two capital letters, bright on dim, as a picture (size, size) of mean 1."""
    dots = np.zeros((14, 14))
    for k, letter in enumerate(letters):
        bits = f"{int(_GLYPHS.split()[ord(letter) - ord('A')], 16):035b}"
        dots[3:10, 1 + 7 * k : 6 + 7 * k] = np.array(list(bits), float).reshape(7, 5)
    picture = np.kron(dots, np.ones((size, size))).reshape(size, 14, size, 14).mean(axis=(1, 3))
    return (picture + dim) / np.mean(picture + dim)
