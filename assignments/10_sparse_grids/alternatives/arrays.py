"""Whole arrays only: tree from the cells upwards, slots claimed in rounds, growth axis by axis."""

from __future__ import annotations

import numpy as np

EMPTY, FULL = (0, -1)
START = np.array([0.5, 0.5, 0.5, 0.1])
RATES = np.array([0.05, 0.05, 0.05, 0.4])


def octree_from_dense(full):
    # From the cells upwards: of each level, which cubes are all full and which have any full.
    every, some = [full], [full]
    while len(every[-1]) > 1:
        m = len(every[-1]) // 2
        split = (m, 2, m, 2, m, 2)
        every.append(every[-1].reshape(split).all(axis=(1, 3, 5)))
        some.append(some[-1].reshape(split).any(axis=(1, 3, 5)))
    octants = np.array(list(np.ndindex(2, 2, 2)))
    cubes, tree = np.zeros((1, 3), np.int64), []
    start = 0
    for are_full, have_full in zip(every[::-1], some[::-1], strict=True):
        at = tuple(cubes.T)
        mixed = have_full[at] & ~are_full[at]
        nodes = np.where(are_full[at], -1, 0)
        nodes[mixed] = start + len(cubes) + 8 * np.arange(int(mixed.sum()))
        tree.append(nodes)
        start += len(cubes)
        cubes = (2 * cubes[mixed][:, None] + octants).reshape(-1, 3)
        if len(cubes) == 0:
            break
    return np.concatenate(tree).astype(np.int64)


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
    # The samples of each leaf are found by asking which ones lie in its box.
    places = first[:, None] + np.arange(count)[:, None] * stride[:, None]
    wanted = np.zeros((len(first), count), bool)
    known = np.zeros((len(first), count), bool)
    while not known.all():
        ray = np.flatnonzero(~known.all(axis=1))
        k = np.argmin(known[ray], axis=1)
        full, low, side = leaf(places[ray, k])
        low, high = low[:, None], low[:, None] + side[:, None, None]
        inside = ((places[ray] >= low) & (places[ray] < high)).all(axis=2)
        inside[np.arange(len(ray)), k] = True
        known[ray] |= inside
        wanted[ray] |= inside & full[:, None]
    return wanted


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
    # All look at once; of those who want the same free slot, the first in the list gets it.
    table = np.array(table)
    _, last = np.unique(voxels[::-1], axis=0, return_index=True)
    keep = np.sort(len(voxels) - 1 - last)
    voxels, rows = voxels[keep], rows[keep]
    slot = hash_slot(voxels, len(table))
    waiting = np.arange(len(voxels))
    for _ in range(len(table)):
        if len(waiting) == 0:
            return table
        at = slot[waiting]
        same = (table[at, 3] >= 0) & (table[at, :3] == voxels[waiting]).all(axis=1)
        table[at[same], 3] = rows[waiting[same]]
        free = np.flatnonzero(table[at, 3] < 0)
        _, first = np.unique(at[free], return_index=True)
        lucky = free[first]
        table[at[lucky], :3] = voxels[waiting[lucky]]
        table[at[lucky], 3] = rows[waiting[lucky]]
        same[lucky] = True
        waiting = waiting[~same]
        slot[waiting] = (slot[waiting] + 1) % len(table)
    if len(waiting):
        raise ValueError("the table is full")
    return table


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
    # Missing voxels hand theirs to a row more, which is then left out.
    where = np.where(row < 0, count, row).ravel()
    sums = [np.bincount(where, (weight * c).ravel(), count + 1)[:count] for c in g.T]
    return np.stack(sums, axis=1)


def prune_and_dilate(n, voxels, row, share, threshold, steps):
    flat, s = row.ravel(), share.ravel()
    enough = np.zeros(len(voxels), bool)
    enough[flat[(s > threshold) & (flat >= 0)]] = True
    active = np.zeros((n, n, n), bool)
    i, j, k = voxels[enough].T
    active[i, j, k] = True
    for axis in range(3):
        wide = np.pad(np.moveaxis(active, axis, 0), ((steps, steps), (0, 0), (0, 0)))
        grown = np.any([wide[a : a + n] for a in range(2 * steps + 1)], axis=0)
        active = np.moveaxis(grown, 0, axis)
    return np.stack(np.nonzero(active), axis=1).astype(np.int64)


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
    def table_of(voxels):
        return voxel_hash_insert(new_table(len(voxels)), voxels, np.arange(len(voxels)))

    losses = np.zeros((rounds, steps))
    table = table_of(voxels)
    for r in range(rounds):
        samples = march(n, voxels, table, rays)
        optimiser = Adam()
        for s in range(steps):
            losses[r, s], d_values = loss_and_grad(values, samples, target)
            values = optimiser.step(values, d_values)
            values = np.concatenate([values[:, :3], np.clip(values[:, 3:], 0, None)], axis=1)
        if r + 1 < rounds:
            after = prune_and_dilate(n, voxels, *shares(values, samples), threshold, grow)
            rows = voxel_hash_find(table, after)
            fresh = np.tile(START, (len(after), 1))
            fresh[rows >= 0] = values[rows[rows >= 0]]
            voxels, values, table = after, fresh, table_of(after)
    return voxels, values, losses.ravel()


def active_stats(n, tree, table, values):
    return (8 * 4 * n**3, 8 * tree.size, 8 * table.size, 8 * values.size)
