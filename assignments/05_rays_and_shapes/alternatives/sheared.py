"""Unit directions, triangles in a plane across the ray, tangents for glass, a queue by entry."""

import heapq

import numpy as np
from rays import CLOSE, LEAF, T_MIN


def hit_sphere(origins, directions, center, radius):
    size = np.linalg.norm(directions, axis=1)
    d = directions / size[:, None]
    f = center - origins
    middle = np.einsum("rc,rc->r", f, d)
    beside = f - middle[:, None] * d
    room = radius**2 - np.einsum("rc,rc->r", beside, beside)
    half = np.sqrt(np.maximum(room, 0))
    both = np.stack([middle - half, middle + half]) / size
    both[:, room < 0] = np.inf
    both[both <= T_MIN] = np.inf
    return both.min(axis=0)


def hit_triangle(origin, direction, corners):
    # Axes permuted so that the direction is longest along the last; then sheared onto it.
    last = int(np.argmax(np.abs(direction)))
    turned = np.roll(np.arange(3), -last - 1)
    d = direction[turned]
    p = (corners - origin)[:, :, turned]
    x, y = p[..., 0] - d[0] / d[2] * p[..., 2], p[..., 1] - d[1] / d[2] * p[..., 2]
    ahead = p[..., 2] / d[2]

    def area(i, j):
        return x[:, i] * y[:, j] - y[:, i] * x[:, j]

    parts = np.stack([area(1, 2), area(2, 0), area(0, 1)], axis=1)
    total = parts.sum(axis=1)
    hit = ~((parts < 0).any(axis=1) & (parts > 0).any(axis=1)) & (total != 0)
    share = np.zeros(parts.shape)
    share[hit] = parts[hit] / total[hit, None]
    t = np.einsum("mk,mk->m", share, ahead)
    hit &= t > T_MIN
    share[~hit] = 0.0
    return np.where(hit, t, np.inf), share[:, 1:].copy()


def refract(directions, normals, eta):
    cosine = np.einsum("rc,rc->r", directions, normals)
    inside = cosine > 0
    towards = np.where(inside[:, None], normals, -normals)  # the way that the ray goes
    flat = directions - np.abs(cosine)[:, None] * towards
    sine = flat * np.where(inside, eta, 1 / eta)[:, None]
    left = 1 - np.einsum("rc,rc->r", sine, sine)
    out = flat - np.abs(cosine)[:, None] * towards
    good = left > 0
    out[good] = (sine + np.sqrt(np.maximum(left, 0))[:, None] * towards)[good]
    return out, good


def march_sdf(sdf, origins, directions, t_max, steps):
    count = len(origins)
    t, d_t = np.zeros(count), np.zeros(count)
    active, arrived = np.ones(count, bool), np.zeros(count, bool)
    for _ in range(steps):
        if not active.any():
            break
        places = origins + t[:, None] * directions
        distance, rate, change = np.full(count, np.inf), np.ones(count), np.zeros(count)
        distance[active], gradient, change[active] = sdf(places[active])
        rate[active] = np.einsum("rc,rc->r", gradient, directions[active])
        new = active & (np.abs(distance) < CLOSE)
        d_t[new] = -(change / rate)[new]
        arrived |= new
        active &= ~new
        t[active] += np.abs(distance[active])
        active &= t <= t_max
    return np.where(arrived, t, np.inf), d_t


def build_bvh(low, high):
    middle = (low + high) / 2
    level = [np.arange(len(low))]
    groups = []
    # Level by level: the nodes of one level, then all their children.
    first, count, order, used = [], [], [], 0
    while level:
        following = []
        ahead = len(groups) + len(level)
        for mine in level:
            groups.append(mine)
            if len(mine) <= LEAF:
                first.append(used)
                count.append(len(mine))
                order.append(mine)
                used += len(mine)
                continue
            spread = middle[mine].max(axis=0) - middle[mine].min(axis=0)
            ranked = mine[np.argsort(middle[mine, int(spread.argmax())], kind="stable")]
            first.append(ahead + len(following))
            count.append(0)
            following += [ranked[: (len(mine) + 1) // 2], ranked[(len(mine) + 1) // 2 :]]
        level = following
    boxes = np.stack([[low[g].min(axis=0), high[g].max(axis=0)] for g in groups])
    return boxes, np.array(first), np.array(count), np.concatenate(order)


def traverse(first, count, order, box, intersect, origin, direction):
    def enter(node):
        low, high = np.asarray(box(node))
        still = direction == 0
        if np.any(still & ((origin < low) | (origin > high))):
            return None
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (low - origin) / direction, (high - origin) / direction
        near = np.where(still, 0.0, np.minimum(one, two)).max(initial=0.0)
        far = np.where(still, np.inf, np.maximum(one, two)).min()
        return float(near) if near <= far else None

    queue, best, number = [], np.inf, -1

    def push(node):
        near = enter(node)
        if near is not None:
            heapq.heappush(queue, (near, node))

    push(0)
    while queue:
        near, node = heapq.heappop(queue)
        if near >= best:
            break
        start = int(first[node])
        if not count[node]:
            push(start)
            push(start + 1)
            continue
        for primitive in order[start : start + int(count[node])]:
            t = float(intersect(np.array([primitive]))[0])
            if t < best:
                best, number = t, int(primitive)
    return float(best), number
