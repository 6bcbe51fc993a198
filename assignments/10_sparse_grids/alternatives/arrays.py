"""Whole arrays only: tree from the cells upwards, growth axis by axis."""

import numpy as np
from sparse_grids import START, Adam, find_rows, loss_and_grad, march, row_table, shares

EMPTY, FULL = (0, -1)


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


def skip_empty(leaf, first, stride, count):
    # The samples of each leaf are found by asking which ones lie in its box.
    points = first[:, None] + np.arange(count)[:, None] * stride[:, None]
    wanted = np.zeros((len(first), count), bool)
    known = np.zeros((len(first), count), bool)
    while not known.all():
        ray = np.flatnonzero(~known.all(axis=1))
        k = np.argmin(known[ray], axis=1)
        full, low, side = leaf(points[ray, k])
        low, high = low[:, None], low[:, None] + side[:, None, None]
        inside = ((points[ray] >= low) & (points[ray] < high)).all(axis=2)
        inside[np.arange(len(ray)), k] = True
        known[ray] |= inside
        wanted[ray] |= inside & full[:, None]
    return wanted


def sample_sparse_adjoint(voxel_count, row, weight, g):
    # Missing voxels hand theirs to a row more, which is then left out.
    where = np.where(row < 0, voxel_count, row).ravel()
    sums = [np.bincount(where, (weight * c).ravel(), voxel_count + 1)[:voxel_count] for c in g.T]
    return np.stack(sums, axis=1)


def prune_and_dilate(n, voxels, row, share, threshold, grow):
    flat, s = row.ravel(), share.ravel()
    enough = np.zeros(len(voxels), bool)
    enough[flat[(s > threshold) & (flat >= 0)]] = True
    active = np.zeros((n, n, n), bool)
    i, j, k = voxels[enough].T
    active[i, j, k] = True
    for axis in range(3):
        wide = np.pad(np.moveaxis(active, axis, 0), ((grow, grow), (0, 0), (0, 0)))
        grown = np.any([wide[a : a + n] for a in range(2 * grow + 1)], axis=0)
        active = np.moveaxis(grown, 0, axis)
    return np.stack(np.nonzero(active), axis=1).astype(np.int64)


def fit_sparse(n, voxels, values, rays, target, rounds, steps, threshold, grow):
    losses = np.zeros((rounds, steps))
    table = row_table(n, voxels)
    for r in range(rounds):
        samples = march(n, voxels, rays)
        optimizer = Adam()
        for s in range(steps):
            losses[r, s], d_values = loss_and_grad(values, samples, target)
            values = optimizer.step(values, d_values)
            values = np.concatenate([values[:, :3], np.clip(values[:, 3:], 0, None)], axis=1)
        if r + 1 < rounds:
            after = prune_and_dilate(n, voxels, *shares(values, samples), threshold, grow)
            rows = find_rows(table, after)
            fresh = np.tile(START, (len(after), 1))
            fresh[rows >= 0] = values[rows[rows >= 0]]
            voxels, values, table = after, fresh, row_table(n, after)
    return voxels, values, losses.ravel()
