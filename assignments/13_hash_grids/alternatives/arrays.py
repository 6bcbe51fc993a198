"""Whole arrays: leaves merged from below, all corners of a level at once, rows by one sort."""

import numpy as np
from hash_grids import BETA1, BETA2, EPS, PRIMES, Adam, network_loss_and_grad


def _coarser(array, D, reduce):
    """(n/2, ..., rest) of (n, ..., rest): each cube of 2^D entries reduced to one."""
    n = array.shape[0] // 2
    split = array.reshape(*(k for _ in range(D) for k in (n, 2)), *array.shape[D:])
    return reduce(split, axis=tuple(2 * a + 1 for a in range(D)))


def tabulate(field, n, offsets, tolerance):
    D = offsets.shape[1]
    corner = np.moveaxis(np.indices((n,) * D), 0, -1).reshape(-1, D).astype(float)
    total = 0.0
    for offset in offsets:
        total = total + field((corner + offset) / n)
    mean = (total / len(offsets)).reshape(*(n,) * D, -1)
    top, bottom, size = [mean], [mean], n
    while size > 1:
        top.append(_coarser(top[-1], D, np.max))
        bottom.append(_coarser(bottom[-1], D, np.min))
        size //= 2
    level = np.zeros((n,) * D, np.int64)  # log2 of the side of each cell's leaf
    for k in range(1, len(top)):
        alike = (top[k] - bottom[k] <= tolerance).all(axis=-1)
        for a in range(D):
            alike = alike.repeat(2**k, axis=a)
        level[alike] = k
    index = np.moveaxis(np.indices((n,) * D), 0, -1) >> level[..., None]
    key = level
    for a in range(D):
        key = key * n + index[..., a]
    _, leaf = np.unique(key, return_inverse=True)
    count = np.bincount(leaf.ravel())
    flat = mean.reshape(n**D, -1)
    values = [np.bincount(leaf.ravel(), column) / count for column in flat.T]
    return leaf.reshape((n,) * D), np.stack(values, axis=1)


def hash_index(corners, resolution, rows):
    n = resolution + 1
    if n ** corners.shape[1] <= rows:
        return sum(n**a * c for a, c in enumerate(corners.T))
    wrapped = corners.astype(np.uint32) * np.array(PRIMES, np.uint32)[: corners.shape[1]]
    return (np.bitwise_xor.reduce(wrapped, axis=1) % np.uint32(rows)).astype(np.int64)


def _located(points, level):
    n, first, rows = (int(x) for x in level)
    D = points.shape[1]
    scaled = np.minimum(np.maximum(points, 0.0), 1.0) * n
    q = np.minimum(np.floor(scaled), n - 1)
    w = (scaled - q)[:, None]
    e = np.stack(np.meshgrid(*[[0, 1]] * D, indexing="ij"), axis=-1).reshape(-1, D)
    corners = (q.astype(np.int64)[:, None] + e).reshape(-1, D)
    row = first + hash_index(corners, n, rows)
    return n, e, row.reshape(len(points), len(e)), e * w + (1 - e) * (1 - w)


def encode(points, table, levels):
    result = np.zeros((len(points), 0))
    for level in levels:
        _, _, row, weight = _located(points, level)
        part = np.einsum("pe,pef->pf", weight.prod(axis=2), table[row])
        result = np.concatenate([result, part], axis=1)
    return result


def encode_backward(points, table, levels, d_features):
    F = table.shape[1]
    every_row, every_part = [np.zeros(0, np.int64)], [np.zeros((0, F))]
    d_points = np.zeros(points.shape)
    for number, level in enumerate(levels):
        n, e, row, weight = _located(points, level)
        g = d_features[:, number * F : (number + 1) * F]
        part = weight.prod(axis=2)[:, :, None] * g[:, None, :]
        every_row.append(row.ravel())
        every_part.append(part.reshape(-1, F))
        inner = np.einsum("pef,pf->pe", table[row], g)
        for a in range(points.shape[1]):
            changed = weight.copy()
            changed[:, :, a] = n * (2 * e[:, a] - 1)
            d_points[:, a] += np.einsum("pe,pe->p", changed.prod(axis=2), inner)
    d_points[(points < 0) | (points > 1)] = 0.0
    row, part = np.concatenate(every_row), np.concatenate(every_part)
    order = np.argsort(row, kind="stable")
    used, begin = np.unique(row[order], return_index=True)
    d_table = np.zeros(table.shape)
    if len(used):
        d_table[used] = np.add.reduceat(part[order], begin, axis=0)
    return d_table, d_points


def adam_rows(table, d_table, m, v, k, rate):
    used = (d_table != 0).any(axis=1, keepdims=True)
    new_m = np.where(used, BETA1 * m + (1 - BETA1) * d_table, m)
    new_v = np.where(used, BETA2 * v + (1 - BETA2) * d_table * d_table, v)
    with np.errstate(invalid="ignore"):
        root = np.sqrt(new_v / (1 - BETA2**k)) + EPS
    return np.where(used, table - rate * (new_m / (1 - BETA1**k)) / root, table), new_m, new_v


def train_hash_grid(points, target, batches, levels, table, weights, rate):
    optimizer, losses = Adam(len(weights)), np.zeros(len(batches))
    state = table, np.zeros_like(table), np.zeros_like(table)
    for step in range(len(batches)):
        chosen = batches[step]
        encoded = encode(points[chosen], state[0], levels)
        losses[step], d_w, d_f = network_loss_and_grad(weights, encoded, target[chosen])
        d_t = encode_backward(points[chosen], state[0], levels, d_f)[0]
        weights = optimizer.step(weights, d_w, rate)
        state = adam_rows(state[0], d_t, state[1], state[2], step + 1, rate)
    return state[0], weights, losses
