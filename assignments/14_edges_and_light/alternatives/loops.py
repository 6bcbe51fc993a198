"""One row, pixel, path group or cell after the other."""

import math

import numpy as np
from edges_and_light import (
    DISTANCE,
    ETA,
    bezier,
    brdf_backward,
    closest_hit,
    direct_light,
    direct_light_backward,
    emitted,
    nearest_on_curve,
    next_vertex,
    path_numbers,
    path_radiance,
    pixel_centers,
    round_coverage,
    take,
)


def _inside_part(n, s):
    """Corners of the square on the inner side of an edge, and the ends of the edge."""
    corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    kept, ends = [], []
    for k, p in enumerate(corners):
        q = corners[(k + 1) % 4]
        f, g = s - n[0] * p[0] - n[1] * p[1], s - n[0] * q[0] - n[1] * q[1]
        if f >= 0:
            kept.append(p)
        if (f >= 0) != (g >= 0):
            t = f / (f - g)
            x = (p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]))
            kept.append(x)
            ends.append(x)
    return kept, ends


def edge_coverage(angle, offset):
    found = np.zeros((3, len(angle)))
    for k in range(len(angle)):
        n = math.cos(angle[k]), math.sin(angle[k])
        kept, ends = _inside_part(n, offset[k])
        twice = 0.0
        for p, q in zip(kept, kept[1:] + kept[:1], strict=True):
            twice += p[0] * q[1] - q[0] * p[1]
        found[0, k] = twice / 2
        if len(ends) == 2:
            (x0, y0), (x1, y1) = ends
            found[1, k] = math.hypot(x1 - x0, y1 - y0)
            found[2, k] = -found[1, k] * (n[0] * (y0 + y1) - n[1] * (x0 + x1)) / 2
    return found[0], found[1], found[2]


def edge_sampling_backward(vertices, inside, outside, d_image, u):
    height, width, _ = d_image.shape
    corners = [tuple(map(float, each)) for each in vertices]
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    lengths = [math.dist(p, q) for p, q in edges]
    perimeter = math.fsum(lengths)
    limits = np.cumsum(lengths) / perimeter
    which = np.clip(np.sum(u[:, None] >= limits, axis=1), 0, len(edges) - 1)
    d_vertices = np.zeros(vertices.shape)
    for k, ((x0, y0), (x1, y1)) in enumerate(edges):
        rows = np.flatnonzero(which == k)
        if len(rows) == 0:
            continue
        before = limits[k] - lengths[k] / perimeter
        t = (u[rows] - before) * perimeter / lengths[k]
        x, y = x0 + t * (x1 - x0), y0 + t * (y1 - y0)
        here = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        if not here.any():
            continue
        x, y, t = x[here], y[here], t[here]
        points = np.column_stack([x, y])
        colors = inside(points) - outside(points)
        weight = np.sum(d_image[y.astype(int), x.astype(int)] * colors, axis=1)
        moved = np.array([y1 - y0, x0 - x1]) * perimeter / lengths[k] / len(u)
        d_vertices[k] += np.dot(weight, 1 - t) * moved
        d_vertices[(k + 1) % len(edges)] += np.dot(weight, t) * moved
    return d_vertices


def stroke_backward(curve, width, d_alpha):
    rows, columns = d_alpha.shape
    d_curve, d_width = np.zeros((3, 2)), 0.0
    for i in range(rows):
        p = pixel_centers(rows, columns)[i * columns : (i + 1) * columns]
        t, distance = nearest_on_curve(curve, p)
        toward = bezier(curve, t) - p
        for j in range(columns):
            one = round_coverage(width / 2 - distance[j])[1]
            two = round_coverage(-width / 2 - distance[j])[1]
            d_width += 0.5 * d_alpha[i, j] * (one + two)
            if distance[j] > 0:
                way = d_alpha[i, j] * (two - one) / distance[j] * toward[j]
                d_curve[0] += (1 - t[j]) ** 2 * way
                d_curve[1] += 2 * t[j] * (1 - t[j]) * way
                d_curve[2] += t[j] ** 2 * way
    return d_curve, float(d_width)


def replay_backward(scene, origins, directions, depth, seed, radiance, d_radiance):
    shape = scene["base_color"].shape
    parts = [(np.zeros(shape), np.zeros(shape[0]))]

    def follow(hit, rows, beta, left, bounce):
        if bounce == depth - 1 or len(rows) == 0:
            return
        u = path_numbers(seed, bounce, len(origins))
        light, surface, onward = (each[rows] for each in u)
        given = d_radiance[rows]
        parts.append(direct_light_backward(scene, hit, light, surface, beta * given))
        left = left - beta * direct_light(scene, hit, light, surface)
        wi, f, factor, there = next_vertex(scene, hit, onward)
        safe = np.where(f > 0, f, np.inf)
        by_row = brdf_backward(scene, hit, wi, given * left / safe)
        one_hot = (hit["primitive"] == np.arange(shape[0])[:, None]).astype(float)
        parts.append((one_hot @ by_row[0], one_hot @ by_row[1]))
        on = there["primitive"] >= 0
        beta = beta * factor[:, None] * f
        follow(take(there, on), rows[on], beta[on], left[on], bounce + 1)

    first = closest_hit(scene, origins, directions)
    seen = np.flatnonzero(first["primitive"] >= 0)
    left = (radiance - emitted(scene, first))[seen]
    follow(take(first, seen), seen, np.ones((len(seen), 3)), left, 0)
    return sum(each[0] for each in parts), sum(each[1] for each in parts)


def noisy_loss_and_grad(scene, origins, directions, picture, depth, samples, seeds):
    rows = np.arange(len(picture)).repeat(samples)
    o, d = origins[rows], directions[rows]
    seen, residual = [], []
    for seed in seeds:
        seen.append(path_radiance(scene, o, d, depth, seed))
        sums = np.zeros(picture.shape)
        np.add.at(sums, rows, seen[-1])
        residual.append(sums / samples - picture)
    norm = picture.size * (picture + 0.1) ** 2
    total = None
    for k in (0, 1):
        back = (residual[1 - k] / norm / samples)[rows]
        got = replay_backward(scene, o, d, depth, seeds[k], seen[k], back)
        total = got if total is None else (total[0] + got[0], total[1] + got[1])
    return float(np.sum(residual[0] * residual[1] / norm)), total[0], total[1]


def landing_backward(heights, d_points):
    cells = len(heights) - 1
    patch = np.stack([heights[i : i + cells, j : j + cells] for i in (0, 1) for j in (0, 1)])
    level = patch.mean(axis=0)
    s = cells / 2 * np.array([[-1, 1, -1, 1], [-1, -1, 1, 1]])
    slope = np.tensordot(s, patch, axes=1)
    q = slope[0] ** 2 + slope[1] ** 2
    t = np.sqrt(1 + q)
    # Snell: sines in the plane of incidence, angles from the normal.
    sin_in, cos_in = np.sqrt(q) / t, 1 / t
    cos_out = np.sqrt(1 - (ETA * sin_in) ** 2)
    k = (cos_out - ETA * cos_in) * cos_in
    ratio = -k / (ETA + k)
    d_cos_in = -0.5 * cos_in / (1 + q)
    d_cos_out = -(ETA**2) * 0.5 / (1 + q) ** 2 / cos_out
    d_k = (d_cos_out - ETA * d_cos_in) * cos_in + (cos_out - ETA * cos_in) * d_cos_in
    d_ratio = -ETA * d_k / (ETA + k) ** 2
    g = d_points.T.reshape(2, cells, cells)
    along = g[0] * slope[0] + g[1] * slope[1]
    far = DISTANCE - level
    d_slope = far * (ratio * g + 2 * d_ratio * along * slope)
    per_corner = np.tensordot(s.T, d_slope, axes=1) - ratio * along / 4
    d_heights = np.zeros(heights.shape)
    for number, (i, j) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
        d_heights[i : i + cells, j : j + cells] += per_corner[number]
    return d_heights
