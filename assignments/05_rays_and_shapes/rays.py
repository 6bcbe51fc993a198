"""Intersections of rays with shapes, and the closest hit without a test of every primitive.

A ray has an origin o and a direction d; the point at t is o + t d. Directions have any length but
zero, unless a function requires length 1. The *closest hit* is the first intersection at t > T_MIN,
so that a ray that starts on a surface does not hit it there again. Where nothing is hit t is
infinite. The world is right-handed with y up; a camera looks along its own +z, with x to the right
and y down, as in OpenCV.

Your tasks are six functions, one section of the handout each; `photograd course check 05` tells how
far you are. The other functions are given and stay as they are. Values are float64, indices int64.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Vector = Annotated[np.ndarray, "3"]
Vectors = Annotated[np.ndarray, "R 3"]
PerRay = Annotated[np.ndarray, "R"]
Triangles = Annotated[np.ndarray, "M 3 3"]
PerTriangle = Annotated[np.ndarray, "M"]
Weights = Annotated[np.ndarray, "M 2"]
Boxes = Annotated[np.ndarray, "N 2 3"]
Box = Annotated[np.ndarray, "2 3"]
PerPrimitive = Annotated[np.ndarray, "K"]
Corners = Annotated[np.ndarray, "P 3"]
Indices = Annotated[np.ndarray, "N"]  # int64
Sdf = Callable[[Vectors], tuple[PerRay, Vectors, PerRay]]

T_MIN = 1e-9  # nearer intersections do not count
CLOSE = 1e-9  # distance below which sphere tracing has converged
LEAF = 2  # largest number of primitives in a leaf


def camera_rays(width, height, fx, fy, cx, cy, world_from_camera):
    """One ray through the center of each pixel of a pinhole camera.

    Args:
        width, height: of the image, in pixels.
        fx, fy, cx, cy: focal lengths and principal point, in pixels.
        world_from_camera: (3, 4), a rotation and a translation that take points of the camera's
            frame into the world.

    Returns:
        (origins, directions), both (height width, 3), row by row from the top; unit directions.
    """
    v, u = np.mgrid[:height, :width].reshape(2, -1) + 0.5
    local = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones(len(u))], axis=1)
    local /= np.linalg.norm(local, axis=1, keepdims=True)
    directions = local @ world_from_camera[:, :3].T
    return np.tile(world_from_camera[:, 3], (len(u), 1)), directions


def ring(turns, sides):
    """Triangles (2 turns sides, 3, 3) of a ring around y, coordinates that float32 has exactly."""
    turn = 2 * np.pi * np.arange(turns) / turns
    across = 2 * np.pi * np.arange(sides) / sides
    far = 2 + 0.75 * np.cos(across)
    high = np.broadcast_to(0.75 * np.sin(across), (turns, sides))
    a = np.stack([far * np.cos(turn)[:, None], high, far * np.sin(turn)[:, None]], axis=2)
    a = a.astype(np.float32).astype(float)
    b, d = np.roll(a, -1, axis=1), np.roll(a, -1, axis=0)
    c = np.roll(b, -1, axis=0)
    both = np.stack([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    return both.reshape(-1, 3, 3)


def floor_and_sky(origins, directions):
    """Colors (R, 3) of a checkered floor at y = -1.2 and of the sky, for rays that hit nothing."""
    down = directions[:, 1] < -1e-6
    t = np.where(down, (-1.2 - origins[:, 1]) / np.where(down, directions[:, 1], -1.0), 0.0)
    x, z = (np.floor(1.5 * (origins[:, k] + t * directions[:, k]) + 0.3) for k in (0, 2))
    tiles = np.where(((x + z) % 2 == 0)[:, None], (0.85, 0.45, 0.2), (0.95, 0.95, 0.9))
    fade, up = np.exp(-t / 25)[:, None], directions[:, 1]
    sky = np.stack([0.5 - 0.3 * up, 0.7 - 0.2 * up, np.ones(len(up))], axis=1)
    return np.where(down[:, None], fade * tiles + (1 - fade) * 0.8, sky)


def hit_sphere(origins: Vectors, directions: Vectors, center: Vector, radius: float) -> PerRay:
    """Intersections of rays with a sphere.

    Args:
        origins, directions: (R, 3); directions of any length.
        center: (3,).
        radius: a number above 0.

    Returns:
        t (R,) of the first intersection above T_MIN, from outside or from inside; infinite where
        there is none. A tangent ray hits the sphere. Handout equations (5) and (6).
    """
    # >>> solution 05.1
    offset = origins - center
    square = np.sum(directions**2, axis=1)
    nearest = -np.sum(offset * directions, axis=1) / square
    aside = offset + nearest[:, None] * directions
    rest = (radius**2 - np.sum(aside**2, axis=1)) / square
    half = np.sqrt(np.abs(rest))
    t = np.where(nearest - half > T_MIN, nearest - half, nearest + half)
    return np.where((rest >= 0) & (t > T_MIN), t, np.inf)
    # <<< solution


def hit_triangle(
    origin: Vector, direction: Vector, corners: Triangles
) -> tuple[PerTriangle, Weights]:
    """Intersections of one ray with many triangles, from either side.

    Args:
        origin, direction: (3,); a direction of any length.
        corners: (M, 3, 3), the corners a, b, c of each triangle.

    Returns:
        (t, weights): t (M,), infinite where the triangle is missed, lies in the plane of the ray or
        has no area; weights (M, 2), the barycentric coordinates of the hit for the corners b and c,
        zeros for a miss. Of two triangles with a common edge, a ray exactly through the edge hits
        one or both. Handout equations (7) to (9).
    """
    # >>> solution 05.2
    a, b, c = np.moveaxis(corners - origin, 1, 0)
    volumes = np.sum(np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)]) * direction, axis=2)
    whole = np.sum(volumes, axis=0)
    inside = ((volumes >= 0).all(axis=0) | (volumes <= 0).all(axis=0)) & (whole != 0)
    weights = volumes / np.where(inside, whole, 1.0)
    ahead = np.sum(np.stack([a, b, c]) * direction, axis=2) / np.sum(direction**2)
    t = np.sum(weights * ahead, axis=0)
    met = inside & (t > T_MIN)
    return np.where(met, t, np.inf), np.where(met, weights[1:], 0.0).T
    # <<< solution


def refract(directions: Vectors, normals: Vectors, eta: float) -> tuple[Vectors, PerRay]:
    """Refraction or total internal reflection at a smooth surface, by Snell's law.

    Args:
        directions: (R, 3), unit, of travel: they point *into* the surface.
        normals: (R, 3), unit, always to the outside, whichever side the ray comes from.
        eta: the index of refraction inside over that outside, above 0.

    Returns:
        (out, through): out (R, 3), unit: the refracted direction, or the reflected one for total
        internal reflection; through (R,) of bool, whether it is refracted. Handout equations (10)
        to (12).
    """
    # >>> solution 05.3
    cosine = -np.sum(directions * normals, axis=1, keepdims=True)
    side = np.sign(cosine)
    ratio = eta**side
    square = 1 - (1 - cosine**2) / ratio**2
    through = square > 0
    along = directions + cosine * normals
    bent = along / ratio - side * np.sqrt(np.abs(square)) * normals
    mirrored = along + cosine * normals
    return np.where(through, bent, mirrored), through[:, 0]
    # <<< solution


def march_sdf(
    sdf: Sdf, origins: Vectors, directions: Vectors, t_max: float, steps: int
) -> tuple[PerRay, PerRay]:
    """Sphere tracing of a signed distance field, and the derivative of t.

    Args:
        sdf: a function from points (M, 3) to (distance (M,), gradient (M, 3), by_parameter (M,)):
            the distance to the surface, below 0 inside; its derivatives with respect to the point
            and with respect to some parameter p of the shape. Evaluations are counted: use as few
            points as you can, and never an empty array.
        origins, directions: (R, 3); unit directions.
        t_max: a surface farther away is missed.
        steps: a ray that has not converged after this many evaluations misses, 1 or more.

    Returns:
        (t, d_t), both (R,): the first t at which |distance| is below CLOSE, infinite where there is
        none; its derivative with respect to p, zero where there is none. Handout equations (13) to
        (15).
    """
    # >>> solution 05.4
    t, found, d_t = np.zeros(len(origins)), np.full(len(origins), np.inf), np.zeros(len(origins))
    live = np.arange(len(origins))
    for _ in range(steps):
        if len(live) == 0:
            break
        distance, gradient, by_parameter = sdf(origins[live] + t[live, None] * directions[live])
        there = np.abs(distance) < CLOSE
        done = live[there]
        found[done] = t[done]
        d_t[done] = -by_parameter[there] / np.sum(gradient[there] * directions[done], axis=1)
        t[live] += np.abs(distance)
        live = live[~there & (t[live] <= t_max)]
    return found, d_t
    # <<< solution


def build_bvh(low: Corners, high: Corners) -> tuple[Boxes, Indices, Indices, Indices]:
    """A bounding volume hierarchy of primitives, given by their boxes.

    Args:
        low, high: (P, 3), the lower and the upper corner of each primitive's box; P is 1 or more.

    Returns:
        (boxes, first, count, order) with N nodes, of which 0 is the root: boxes (N, 2, 3), the
        smallest that bound all primitives of a node; count (N,), the number of primitives in a
        leaf, 1 to LEAF, and 0 for any other node; first (N,): the primitives of a leaf are
        order[first] to order[first + count - 1], the children of another node are the nodes first
        and first + 1; order (P,), the indices of all primitives. Handout equations (16) and (17).
    """
    # >>> solution 05.5
    twice_middle = low + high
    order = np.arange(len(low))
    boxes, first, count, todo = [], [], [], [(0, len(low))]
    for start, stop in todo:  # grows during the loop
        mine = order[start:stop]
        boxes.append([low[mine].min(axis=0), high[mine].max(axis=0)])
        if stop - start <= LEAF:
            first.append(start)
            count.append(stop - start)
        else:
            axis = np.ptp(twice_middle[mine], axis=0).argmax()
            order[start:stop] = mine[np.argsort(twice_middle[mine, axis])]
            half = (start + stop) // 2
            first.append(len(todo))
            count.append(0)
            todo += [(start, half), (half, stop)]
    return np.array(boxes), np.array(first), np.array(count), order
    # <<< solution


def traverse(
    first: Indices,
    count: Indices,
    order: Indices,
    box: Callable[[int], Box],
    intersect: Callable[[Indices], PerPrimitive],
    origin: Vector,
    direction: Vector,
) -> tuple[float, int]:
    """The closest hit of a ray, with few tests.

    Args:
        first (N,), count (N,), order (P,): of `build_bvh`.
        box: a function from the index of a node to its box (2, 3).
        intersect: a function from the indices (K,) of primitives to t (K,), where the ray hits
            each, infinite for a miss. Calls of both are counted: make as few as you can.
        origin, direction: (3,); a direction of any length, single components may be zero.

    Returns:
        (t, number): t and the index of the nearest primitive; infinite and -1 for a miss. Handout
        equations (18) to (20).
    """
    # >>> solution 05.6
    moves = direction != 0

    def enter(node):
        low, high = box(node)
        if ((origin < low) | (origin > high))[~moves].any():
            return np.inf
        faces = (np.stack([low, high]) - origin)[:, moves] / direction[moves]
        near, far = max(faces.min(axis=0).max(), 0.0), faces.max(axis=0).min()
        return near if near <= far else np.inf

    best, number = np.inf, -1
    todo = [(enter(0), 0)]
    while todo:
        near, node = todo.pop()
        if near >= best:
            continue
        if count[node] == 0:
            children = [(enter(child), child) for child in (first[node], first[node] + 1)]
            todo += sorted(children, reverse=True)
            continue
        primitives = order[first[node] : first[node] + count[node]]
        t = intersect(primitives)
        if t.min() < best:
            best, number = t.min(), primitives[t.argmin()]
    return float(best), int(number)
    # <<< solution


def trace_mesh(corners, origins, directions):
    """The closest triangle of each ray, by your tree.

    Args:
        corners: (M, 3, 3), triangles.
        origins, directions: (R, 3).

    Returns:
        (t (R,), number (R,)); infinite and -1 for rays that hit nothing.
    """
    boxes, first, count, order = build_bvh(corners.min(axis=1), corners.max(axis=1))
    found = [
        traverse(
            first,
            count,
            order,
            lambda node: boxes[node],
            lambda primitives, o=o, d=d: hit_triangle(o, d, corners[primitives])[0],
            o,
            d,
        )
        for o, d in zip(origins, directions, strict=True)
    ]
    return np.array([t for t, _ in found]), np.array([number for _, number in found])
