"""Loops over single numbers: depth-first tree, one ray, one voxel, one corner at a time."""

import math

import numpy as np
from sparse_grids import START, Adam, loss_and_grad, march, shares

EMPTY, FULL = (0, -1)


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


def sample_sparse_adjoint(voxel_count, row, weight, g):
    out = [[0.0] * g.shape[1] for _ in range(voxel_count)]
    given = g.tolist()
    for rows, weights in zip(row.tolist(), weight.tolist(), strict=True):
        for m, (v, w) in enumerate(zip(rows, weights, strict=True)):
            if v != -1:
                for c, value in enumerate(given[m]):
                    out[v][c] += w * value
    return np.array(out, dtype=np.float64).reshape(voxel_count, g.shape[1])


def prune_and_dilate(n, voxels, row, share, threshold, grow):
    best = {}
    for v, s in zip(row.ravel().tolist(), share.ravel().tolist(), strict=True):
        if v >= 0 and s > best.get(v, 0.0):
            best[v] = s
    found = set()
    for v, (i, j, k) in enumerate(voxels.tolist()):
        if best.get(v, 0.0) > threshold:
            for a in range(max(0, i - grow), min(n, i + grow + 1)):
                for b in range(max(0, j - grow), min(n, j + grow + 1)):
                    for c in range(max(0, k - grow), min(n, k + grow + 1)):
                        found.add((a, b, c))
    return np.array(sorted(found), dtype=np.int64).reshape(-1, 3)


def fit_sparse(n, voxels, values, rays, target, rounds, steps, threshold, grow):
    losses = []
    left = rounds
    while True:
        samples = march(n, voxels, rays)
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
