"""Loops over single rays, triangles and primitives, in plain numbers."""

import math

import numpy as np
from rays import CLOSE, LEAF, T_MIN


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def along(o, t, d):
    return (o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2])


def hit_sphere(origins, directions, center, radius):
    found = []
    for o, d in zip(origins.tolist(), directions.tolist(), strict=True):
        f = minus(o, center.tolist())
        s = -dot(f, d) / dot(d, d)
        p = along(f, s, d)
        h2 = (radius * radius - dot(p, p)) / dot(d, d)
        t = math.inf
        if h2 >= 0:
            for root in (s - math.sqrt(h2), s + math.sqrt(h2)):
                if root > T_MIN:
                    t = root
                    break
        found.append(t)
    return np.array(found)


def hit_triangle(origin, direction, corners):
    o, d = origin.tolist(), direction.tolist()
    times, weights = [], []
    for triangle in corners.tolist():
        a, b, c = (minus(corner, o) for corner in triangle)
        u, v, w = dot(cross(b, c), d), dot(cross(c, a), d), dot(cross(a, b), d)
        t, pair = math.inf, (0.0, 0.0)
        negative, positive = min(u, v, w) < 0, max(u, v, w) > 0
        if u + v + w != 0 and not (negative and positive):
            whole = u + v + w
            place = (u * dot(a, d) + v * dot(b, d) + w * dot(c, d)) / whole / dot(d, d)
            if place > T_MIN:
                t, pair = place, (v / whole, w / whole)
        times.append(t)
        weights.append(pair)
    return np.array(times), np.array(weights)


def refract(directions, normals, eta):
    out, through = [], []
    for d, outward in zip(directions.tolist(), normals.tolist(), strict=True):
        n, cosine = outward, -dot(d, outward)
        ratio = eta
        if cosine < 0:  # from inside: turn the normal round
            n, cosine, ratio = (-n[0], -n[1], -n[2]), -cosine, 1 / eta
        square = 1 - (1 - cosine * cosine) / (ratio * ratio)
        if square > 0:
            out.append(along([x / ratio for x in d], cosine / ratio - math.sqrt(square), n))
        else:
            out.append(along(d, 2 * cosine, n))
        through.append(square > 0)
    return np.array(out), np.array(through)


def march_sdf(sdf, origins, directions, t_max, steps):
    found, slopes = [], []
    for o, d in zip(origins, directions, strict=True):
        t, answer = 0.0, (math.inf, 0.0)
        for _ in range(steps):
            distance, gradient, by_parameter = sdf((o + t * d)[None])
            if abs(distance[0]) < CLOSE:
                answer = t, -float(by_parameter[0]) / dot(gradient[0], d)
                break
            t += abs(float(distance[0]))
            if t > t_max:
                break
        found.append(answer[0])
        slopes.append(answer[1])
    return np.array(found), np.array(slopes)


def build_bvh(low, high):
    order = list(range(len(low)))
    boxes, first, count = [None], [0], [0]

    def make(node, start, stop):
        mine = order[start:stop]
        boxes[node] = [
            [min(low[k][a] for k in mine) for a in range(3)],
            [max(high[k][a] for k in mine) for a in range(3)],
        ]
        if stop - start <= LEAF:
            first[node], count[node] = start, stop - start
            return
        middles = [[(low[k][a] + high[k][a]) / 2 for k in mine] for a in range(3)]
        spread = [max(m) - min(m) for m in middles]
        axis = spread.index(max(spread))
        mine.sort(key=lambda k: (low[k][axis] + high[k][axis]) / 2)
        order[start:stop] = mine
        first[node] = len(boxes)
        for each in (boxes, first, count):
            each.extend([0, 0])
        half = start + (stop - start) // 2
        make(first[node], start, half)
        make(first[node] + 1, half, stop)

    make(0, 0, len(order))
    return np.array(boxes, float), np.array(first), np.array(count), np.array(order)


def traverse(first, count, order, box, intersect, origin, direction):
    def enter(node):
        low, high = box(node)
        near, far = 0.0, math.inf
        for a in range(3):
            if direction[a] == 0:
                if not low[a] <= origin[a] <= high[a]:
                    return math.inf
                continue
            ends = (low[a] - origin[a]) / direction[a], (high[a] - origin[a]) / direction[a]
            near, far = max(near, min(ends)), min(far, max(ends))
        return near if near <= far else math.inf

    best = [math.inf, -1]

    def visit(node, near):
        if near >= best[0]:
            return
        at = int(first[node])
        if count[node]:
            primitives = order[at : at + int(count[node])]
            for t, primitive in zip(intersect(primitives), primitives, strict=True):
                if t < best[0]:
                    best[:] = float(t), int(primitive)
            return
        one, two = enter(at), enter(at + 1)
        ways = [(at, one), (at + 1, two)]
        for child, entry in ways if one <= two else ways[::-1]:
            visit(child, entry)

    visit(0, enter(0))
    return best[0], best[1]
