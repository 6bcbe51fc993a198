"""From the handout alone: recursion over halves, a parameter of the ray, sets of neighbors."""

import numpy as np
from sparse_grids import START, Adam, find_rows, loss_and_grad, march, row_table, shares

EMPTY, FULL = (0, -1)


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


def sample_sparse_adjoint(voxel_count, row, weight, g):
    padded = np.zeros((voxel_count + 1, g.shape[1]))
    for e in range(len(row)):
        np.add.at(padded, row[e], weight[e][:, None] * g)
    return padded[:-1]


def prune_and_dilate(n, voxels, row, share, threshold, grow):
    worth = np.full(len(voxels), -np.inf)
    order = np.argsort(share, axis=None)
    rows, sorted_shares = row.ravel()[order], share.ravel()[order]
    real = rows != -1
    worth[rows[real]] = sorted_shares[real]  # ascending: the largest is written last
    kept = {tuple(v) for v, w in zip(voxels.tolist(), worth, strict=True) if w > threshold}
    for _ in range(grow):
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


def fit_sparse(n, voxels, values, rays, target, rounds, steps, threshold, grow):
    losses = []
    voxels, values = voxels.copy(), values.copy()
    for r in range(rounds):
        samples = march(n, voxels, rays)
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
            for i, old in enumerate(find_rows(row_table(n, voxels), new)):
                start[i] = values[old] if old != -1 else START
            voxels, values = new, start
    return voxels, values, np.array(losses)
