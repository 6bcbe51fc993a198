"""Loops over single numbers: depth-first tree, one ray, one voxel, one corner at a time."""

from __future__ import annotations

import math

import numpy as np

EMPTY, FULL = (0, -1)
START = np.array([0.5, 0.5, 0.5, 0.1])
RATES = np.array([0.05, 0.05, 0.05, 0.4])


def octree_from_dense(full):
    tree = [0]

    def cut(node, i, j, k, side):
        count = sum(
            bool(full[a, b, c])
            for a in range(i, i + side)
            for b in range(j, j + side)
            for c in range(k, k + side)
        )
        if count == side**3:
            tree[node] = -1
        elif count:
            first = tree[node] = len(tree)
            tree.extend([0] * 8)
            h = side // 2
            for e in range(8):
                cut(first + e, i + (e // 4) * h, j + (e // 2 % 2) * h, k + (e % 2) * h, h)

    cut(0, 0, 0, 0, len(full))
    return np.array(tree, dtype=np.int64)


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
    out = np.zeros((len(first), count), dtype=bool)
    for r in range(len(first)):
        k = 0
        while k < count:
            at = first[r] + k * stride[r]
            full, low, side = leaf(at[None])
            samples = count
            for axis in range(3):
                d = float(stride[r, axis])
                if d > 0:
                    samples = min(samples, math.ceil((low[0][axis] + side[0] - at[axis]) / d))
                elif d < 0:
                    # Down to the face and the face itself: it belongs to this leaf.
                    samples = min(samples, math.floor((low[0][axis] - at[axis]) / d) + 1)
            samples = max(1, samples)
            for each in range(k, min(k + samples, count)):
                out[r, each] = full[0]
            k += samples
    return out


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
    entries = table.tolist()
    for (x, y, z), row, start in zip(
        voxels.tolist(), rows.tolist(), hash_slot(voxels, len(table)).tolist(), strict=True
    ):
        at, looked = start, 0
        while entries[at][3] != -1 and entries[at][:3] != [x, y, z]:
            at, looked = (at + 1) % len(entries), looked + 1
            if looked == len(entries):
                raise ValueError("full")
        entries[at] = [x, y, z, row]
    return np.array(entries, dtype=np.int64)


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
    out = [[0.0] * g.shape[1] for _ in range(count)]
    given = g.tolist()
    for rows, weights in zip(row.tolist(), weight.tolist(), strict=True):
        for m, (v, w) in enumerate(zip(rows, weights, strict=True)):
            if v != -1:
                for c, value in enumerate(given[m]):
                    out[v][c] += w * value
    return np.array(out, dtype=np.float64).reshape(count, g.shape[1])


def prune_and_dilate(n, voxels, row, share, threshold, steps):
    best = {}
    for v, s in zip(row.ravel().tolist(), share.ravel().tolist(), strict=True):
        if v >= 0 and s > best.get(v, 0.0):
            best[v] = s
    found = set()
    for v, (i, j, k) in enumerate(voxels.tolist()):
        if best.get(v, 0.0) > threshold:
            for a in range(max(0, i - steps), min(n, i + steps + 1)):
                for b in range(max(0, j - steps), min(n, j + steps + 1)):
                    for c in range(max(0, k - steps), min(n, k + steps + 1)):
                        found.add((a, b, c))
    return np.array(sorted(found), dtype=np.int64).reshape(-1, 3)


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
    left = rounds
    while True:
        table = voxel_hash_insert(new_table(len(voxels)), voxels, np.arange(len(voxels)))
        samples = march(n, voxels, table, rays)
        adam = Adam()
        for _ in range(steps):
            loss, d = loss_and_grad(values, samples, target)
            losses.append(loss)
            values = adam.step(values, d)
            for v in range(len(values)):
                if values[v, 3] < 0:
                    values[v, 3] = 0.0
        left -= 1
        if left == 0:
            return voxels, values, np.array(losses)
        row, share = shares(values, samples)
        chosen = prune_and_dilate(n, voxels, row, share, threshold, grow)
        before = {tuple(v): k for k, v in enumerate(voxels.tolist())}
        values = np.array(
            [values[before[tuple(v)]] if tuple(v) in before else START for v in chosen.tolist()]
        ).reshape(-1, 4)
        voxels = chosen


def active_stats(n, tree, table, values):
    return (8 * 4 * n**3, 8 * tree.size, 8 * table.size, 8 * values.size)
