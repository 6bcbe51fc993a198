"""Written from the handout's equations alone, with whole arrays and masks; no stack but calls."""

import numpy as np
from rays import CLOSE, LEAF, T_MIN


def hit_sphere(origins, directions, center, radius):
    d2 = (directions * directions).sum(1)
    f = origins - center
    s = -(f * directions).sum(1) / d2
    l = f + directions * s[:, None]  # noqa: E741
    h2 = (radius * radius - (l * l).sum(1)) / d2
    t = np.full(len(origins), np.inf)
    for sign in (1, -1):  # the nearer one last, so that it wins
        root = s + sign * np.sqrt(np.where(h2 < 0, 0, h2))
        good = (h2 >= 0) & (root > T_MIN)
        t[good] = root[good]
    return t


def triple(a, b, d):
    return (np.cross(a, b) * d).sum(-1)


def hit_triangle(origin, direction, corners):
    a, b, c = (corners[:, k] - origin for k in range(3))
    u, v, w = triple(b, c, direction), triple(c, a, direction), triple(a, b, direction)
    total = u + v + w
    same = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0))
    good = same & (total != 0)
    safe = np.where(good, total, 1)
    alpha, beta, gamma = u / safe, v / safe, w / safe
    place = alpha[:, None] * a + beta[:, None] * b + gamma[:, None] * c
    t = (place * direction).sum(1) / (direction * direction).sum()
    good = good & (t > T_MIN)
    t[~good] = np.inf
    return t, np.stack([beta * good, gamma * good], axis=1)


def refract(directions, normals, eta):
    cos = -(directions * normals).sum(1)
    s = np.where(cos > 0, 1.0, -1.0)
    e = np.where(cos > 0, eta, 1 / eta)
    c2 = 1 - (1 - cos * cos) / (e * e)
    through = c2 > 0
    root = np.sqrt(np.where(through, c2, 0))
    tangent = directions + cos[:, None] * normals
    straight = np.where(through, -s * root, cos)
    scale = np.where(through, e, 1)
    return tangent / scale[:, None] + straight[:, None] * normals, through


def march_sdf(sdf, origins, directions, t_max, steps):
    t, d_t = np.full(len(origins), np.inf), np.zeros(len(origins))
    rays, at = np.arange(len(origins)), np.zeros(len(origins))
    for _ in range(steps):
        f, gradient, change = sdf(origins[rays] + at[:, None] * directions[rays])
        near = np.abs(f) < CLOSE
        t[rays[near]] = at[near]
        d_t[rays[near]] = (-change / (gradient * directions[rays]).sum(1))[near]
        at = at + np.abs(f)
        on = ~near & (at <= t_max)
        rays, at = rays[on], at[on]
        if rays.size == 0:
            break
    return t, d_t


def build_bvh(low, high):
    nodes, order = [None], []

    def fill(node, mine):
        box = np.array([low[mine].min(0), high[mine].max(0)])
        if len(mine) <= LEAF:
            nodes[node] = box, len(order), len(mine)
            order.extend(mine.tolist())
            return
        middle = (low[mine] + high[mine]) / 2
        axis = int(np.argmax(middle.max(0) - middle.min(0)))
        mine = mine[np.argsort(middle[:, axis])]
        nodes[node] = box, len(nodes), 0
        nodes.extend([None, None])
        fill(nodes[node][1], mine[: len(mine) // 2])
        fill(nodes[node][1] + 1, mine[len(mine) // 2 :])

    fill(0, np.arange(len(low)))
    boxes, first, count = zip(*nodes, strict=True)
    return np.array(boxes), np.array(first), np.array(count), np.array(order)


def traverse(first, count, order, box, intersect, origin, direction):
    def entry(node):
        low, high = box(node)
        near, far = [0.0], [np.inf]
        for lo, hi, o, d in zip(low, high, origin, direction, strict=True):
            if d != 0:
                near.append(min((lo - o) / d, (hi - o) / d))
                far.append(max((lo - o) / d, (hi - o) / d))
            elif o < lo or o > hi:
                return np.inf
        return max(near) if max(near) <= min(far) else np.inf

    def search(node, near, best):
        if near >= best[0]:
            return best
        if count[node] > 0:
            primitives = order[first[node] : first[node] + count[node]]
            t = intersect(primitives)
            k = int(np.argmin(t))
            return (float(t[k]), int(primitives[k])) if t[k] < best[0] else best
        entries = {child: entry(child) for child in (int(first[node]), int(first[node]) + 1)}
        for child in sorted(entries, key=entries.get):
            best = search(child, entries[child], best)
        return best

    return search(0, entry(0), (np.inf, -1))
