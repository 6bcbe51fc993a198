"""From the handout alone: recursion over halves, a parameter of the ray, sets of neighbours."""

from __future__ import annotations

import numpy as np

EMPTY, FULL = (0, -1)
START = np.array([0.5, 0.5, 0.5, 0.1])
RATES = np.array([0.05, 0.05, 0.05, 0.4])


def octree_from_dense(full):
    nodes = [EMPTY]

    def fill(number, cube):
        if not np.any(cube):
            nodes[number] = EMPTY
            return
        if np.all(cube):
            nodes[number] = FULL
            return
        h = cube.shape[0] // 2
        child = len(nodes)
        nodes[number] = child
        nodes.extend([EMPTY] * 8)
        for a in (0, 1):
            for b in (0, 1):
                for c in (0, 1):
                    x, y, z = (
                        (slice(0, h), slice(h, None))[a],
                        (slice(0, h), slice(h, None))[b],
                        (slice(0, h), slice(h, None))[c],
                    )
                    fill(child + 4 * a + 2 * b + c, cube[x, y, z])

    fill(0, full)
    return np.array(nodes)


def octree_leaf(tree, n, places):
    node = np.zeros(len(places), np.int64)
    low, side = (np.zeros(places.shape), np.full(len(places), float(n)))
    while (inner := (tree[node] > 0)).any():
        side = np.where(inner, side / 2, side)
        upper = (places >= low + side[:, None]) & inner[:, None]
        low = low + upper * side[:, None]
        node = np.where(inner, tree[node] + upper @ np.array([4, 2, 1]), node)
    return (tree[node] == FULL, low, side)


def skip_empty(leaf, first, stride, count):
    R = len(first)
    k, result = np.zeros(R, int), np.zeros((R, count), bool)
    while (k < count).any():
        active = np.nonzero(k < count)[0]
        p = first[active] + k[active][:, None] * stride[active]
        full, low, side = leaf(p)
        m = np.full(len(active), float(count))
        for axis in range(3):
            d = stride[active][:, axis]
            up, down = d > 0, d < 0
            a = low[:, axis]
            m[up] = np.minimum(m[up], ((a + side - p[:, axis])[up] / d[up]))
            m[down] = np.minimum(m[down], ((a - p[:, axis])[down] / d[down]))
        m = np.maximum(np.ceil(m), 1).astype(int)
        for r, start, length, f in zip(active, k[active], m, full, strict=True):
            if f:
                result[r, start : start + length] = True
        k[active] += m
    return result


def new_table(count):
    table = np.zeros((2 * count + 1, 4), np.int64)
    table[:, 3] = -1
    return table


def hash_slot(voxels, slots):
    x, y, z = voxels.T
    return (x * 73856093 ^ y * 19349663 ^ z * 83492791) % slots


def voxel_hash_find(table, voxels):
    rows, looking = (np.full(len(voxels), -1, np.int64), np.arange(len(voxels)))
    slot = hash_slot(voxels, len(table))
    for _ in range(len(table)):
        entry = table[slot]
        taken = entry[:, 3] >= 0
        same = taken & (entry[:, :3] == voxels[looking]).all(axis=1)
        rows[looking[same]] = entry[same, 3]
        on = taken & ~same
        looking, slot = (looking[on], (slot[on] + 1) % len(table))
        if not len(looking):
            break
    return rows


def voxel_hash_insert(table, voxels, rows):
    result = table.copy()
    n = len(result)
    for j in range(len(voxels)):
        h = hash_slot(voxels[j : j + 1], n)[0]
        for s in range(n):
            x, y, z, row = result[(h + s) % n]
            if row == -1 or (x, y, z) == tuple(voxels[j]):
                result[(h + s) % n, :3] = voxels[j]
                result[(h + s) % n, 3] = rows[j]
                break
            if s == n - 1:
                raise ValueError("no room")
    return result


def corners(table, places):
    low = np.floor(places - 0.5).astype(np.int64)
    part = places - 0.5 - low
    row, weight = ([], [])
    for corner in np.ndindex(2, 2, 2):
        row.append(voxel_hash_find(table, low + corner))
        weight.append(np.prod(np.where(corner, part, 1 - part), axis=1))
    return (np.stack(row), np.stack(weight))


def sample_sparse(values, row, weight):
    padded = np.concatenate([values, np.zeros((1, values.shape[1]))])
    return np.einsum("em,emc->mc", weight, padded[row])


def sample_sparse_adjoint(count, row, weight, g):
    padded = np.zeros((count + 1, g.shape[1]))
    for e in range(len(row)):
        np.add.at(padded, row[e], weight[e][:, None] * g)
    return padded[:-1]


def prune_and_dilate(n, voxels, row, share, threshold, steps):
    worth = np.full(len(voxels), -np.inf)
    order = np.argsort(share, axis=None)
    rows, sorted_shares = row.ravel()[order], share.ravel()[order]
    real = rows != -1
    worth[rows[real]] = sorted_shares[real]  # ascending: the largest is written last
    kept = {tuple(v) for v, w in zip(voxels.tolist(), worth, strict=True) if w > threshold}
    for _ in range(steps):
        kept = {
            (i + a, j + b, k + c)
            for i, j, k in kept
            for a in (-1, 0, 1)
            for b in (-1, 0, 1)
            for c in (-1, 0, 1)
            if 0 <= i + a < n and 0 <= j + b < n and 0 <= k + c < n
        }
    if not kept:
        return np.zeros((0, 3), dtype=np.int64)
    return np.array(sorted(kept))


def march(n, voxels, table, rays):
    origin, direction = rays
    with np.errstate(divide="ignore"):
        ends = (np.array([[[-1.0]], [[1.0]]]) - origin) / direction
    near = np.maximum(ends.min(axis=0).max(axis=1), 0)
    step = np.maximum(ends.max(axis=0).min(axis=1) - near, 0) / (2 * n)
    first = (origin + (near + step / 2)[:, None] * direction + 1) * (n / 2)
    stride = step[:, None] * direction * (n / 2)
    alone = np.arange(len(voxels))[None]
    reached = prune_and_dilate(n, voxels, alone, np.ones(alone.shape), 0.0, 1)
    touched = np.zeros((n, n, n), bool)
    touched[tuple(reached.T)] = True
    tree = octree_from_dense(touched)
    wanted, hits = (np.zeros((len(step), 2 * n), bool), step > 0)
    wanted[hits] = skip_empty(
        lambda places: octree_leaf(tree, n, places), first[hits], stride[hits], 2 * n
    )
    ray, k = np.nonzero(wanted)
    return (wanted, step, *corners(table, first[ray] + k[:, None] * stride[ray]))


def _along_rays(values, samples):
    wanted, step, row, weight = samples
    at = np.zeros((*wanted.shape, 4))
    at[wanted] = sample_sparse(values, row, weight)
    kept = np.exp(-np.cumsum(at[:, :, 3] * step[:, None], axis=1))
    T = np.concatenate([np.ones((len(step), 1)), kept[:, :-1]], axis=1)
    return (at, T - kept, kept)


def render(values, samples):
    at, w, _ = _along_rays(values, samples)
    return np.einsum("rs,rsc->rc", w, at[:, :, :3])


def loss_and_grad(values, samples, target):
    wanted, step, row, weight = samples
    at, w, kept = _along_rays(values, samples)
    residual = np.einsum("rs,rsc->rc", w, at[:, :, :3]) - target
    d_pixel = 2 * residual / residual.size
    d_at = np.zeros(at.shape)
    d_at[:, :, :3] = w[:, :, None] * d_pixel[:, None]
    d_w = np.einsum("rsc,rc->rs", at[:, :, :3], d_pixel)
    behind = np.cumsum((w * d_w)[:, ::-1], axis=1)[:, ::-1] - w * d_w
    d_at[:, :, 3] = step[:, None] * (kept * d_w - behind)
    d_values = sample_sparse_adjoint(len(values), row, weight, d_at[wanted])
    return (float(np.mean(residual**2)), d_values)


def shares(values, samples):
    wanted, _, row, weight = samples
    return (row, weight * _along_rays(values, samples)[1][wanted])


class Adam:
    def __init__(self):
        self.m = self.v = self.k = 0

    def step(self, x, d_x):
        self.k += 1
        self.m = 0.9 * self.m + 0.1 * d_x
        self.v = 0.99 * self.v + 0.01 * d_x**2
        m, v = (self.m / (1 - 0.9**self.k), self.v / (1 - 0.99**self.k))
        return x - RATES * m / (np.sqrt(v) + 1e-10)


def fit_sparse(n, voxels, values, rays, target, rounds, steps, threshold, grow):
    losses = []
    voxels, values = voxels.copy(), values.copy()
    for r in range(rounds):
        V = len(voxels)
        table = voxel_hash_insert(new_table(V), voxels, np.arange(V))
        samples = march(n, voxels, table, rays)
        adam = Adam()
        for _ in range(steps):
            loss, d_values = loss_and_grad(values, samples, target)
            losses += [loss]
            values = adam.step(values, d_values)
            values[:, 3] = np.where(values[:, 3] < 0, 0, values[:, 3])
        if r < rounds - 1:
            row, share = shares(values, samples)
            new = prune_and_dilate(n, voxels, row, share, threshold, grow)
            start = np.zeros((len(new), 4))
            for i, old in enumerate(voxel_hash_find(table, new)):
                start[i] = values[old] if old != -1 else START
            voxels, values = new, start
    return voxels, values, np.array(losses)


def active_stats(n, tree, table, values):
    return (8 * 4 * n**3, 8 * tree.size, 8 * table.size, 8 * values.size)
