"""From the handout alone: levels of cubes, a table of corners, one level after the other."""

import itertools

import numpy as np
from hash_grids import BETA1, BETA2, EPS, PRIMES, Adam, network_loss_and_grad


def tabulate(field, n, offsets, tolerance):
    S, D = offsets.shape
    grid = np.array(list(itertools.product(range(n), repeat=D)))
    points = np.repeat(grid, S, axis=0) + np.tile(offsets, (len(grid), 1))
    answer = field(points / n)
    C = answer.shape[1]
    table = answer.reshape(len(grid), S, C).mean(axis=1)
    number = -np.ones(len(grid), dtype=np.int64)
    values = []
    side = n
    while side >= 1:
        # Cubes of this side, of the cells that have no leaf yet.
        cube = (grid // side) @ (n // side) ** np.arange(D)[::-1]
        order = np.argsort(cube, kind="stable").reshape(-1, side**D)
        for members in order:
            if number[members[0]] >= 0:
                continue
            here = table[members]
            if np.all(here.max(axis=0) - here.min(axis=0) <= tolerance):
                number[members] = len(values)
                values.append(np.mean(here, axis=0))
        side //= 2
    return number.reshape([n] * D), np.array(values)


def hash_index(corners, resolution, rows):
    n1 = resolution + 1
    D = len(corners[0]) if len(corners) else corners.shape[1]
    x, y = corners[:, 0], corners[:, 1]
    z = corners[:, 2] if D == 3 else np.zeros_like(x)
    if n1**D <= rows:
        return x + n1 * (y + n1 * z)
    mask = 2**32 - 1
    return ((x * PRIMES[0] & mask) ^ (y * PRIMES[1] & mask) ^ (z * PRIMES[2] & mask)) % rows


def _corners_of(points, n, first, rows):
    p = np.where(points < 0, 0, np.where(points > 1, 1, points))
    q = np.floor(n * p)
    q = np.where(q > n - 1, n - 1, q)
    w = n * p - q
    result = []
    for e in itertools.product((0, 1), repeat=points.shape[1]):
        row = first + hash_index((q + e).astype(np.int64), n, rows)
        result.append((e, row, [w[:, a] if e[a] == 1 else 1 - w[:, a] for a in range(len(e))]))
    return result


def encode(points, table, levels):
    F = table.shape[1]
    out = np.zeros((len(points), len(levels), F))
    for level, (n, first, rows) in enumerate(levels):
        for _, row, factors in _corners_of(points, int(n), int(first), int(rows)):
            out[:, level] += table[row] * np.prod(factors, axis=0)[:, None]
    return out.reshape((len(points), len(levels) * F))


def encode_backward(points, table, levels, d_features):
    N, D = points.shape
    F = table.shape[1]
    g = d_features.reshape((N, len(levels), F))
    d_table = np.zeros(table.shape)
    d_points = np.zeros((N, D))
    for level, (n, first, rows) in enumerate(levels):
        for e, row, factors in _corners_of(points, int(n), int(first), int(rows)):
            np.add.at(d_table, row, np.prod(factors, axis=0)[:, None] * g[:, level])
            dot = (table[row] * g[:, level]).sum(axis=1)
            for a in range(D):
                other = np.ones(N)
                for b in range(D):
                    if b != a:
                        other = other * factors[b]
                sign = 1 if e[a] == 1 else -1
                d_points[:, a] += n * sign * other * dot
    return d_table, np.where((points < 0) | (points > 1), 0, d_points)


def adam_rows(table, d_table, m, v, k, rate):
    used = np.any(d_table != 0, axis=1)
    m2, v2, x2 = m.copy(), v.copy(), table.copy()
    m2[used] = BETA1 * m2[used] + (1 - BETA1) * d_table[used]
    v2[used] = BETA2 * v2[used] + (1 - BETA2) * d_table[used] ** 2
    m_hat = m2 / (1 - BETA1**k)
    v_hat = v2 / (1 - BETA2**k)
    x2[used] = x2[used] - rate * m_hat[used] / (np.sqrt(v_hat[used]) + EPS)
    return x2, m2, v2


def train_hash_grid(points, target, batches, levels, table, weights, rate):
    adam = Adam(len(weights))
    m, v, losses = np.zeros(table.shape), np.zeros(table.shape), []
    for k in range(1, len(batches) + 1):
        p, t = points[batches[k - 1]], target[batches[k - 1]]
        features = encode(p, table, levels)
        loss, d_weights, d_features = network_loss_and_grad(weights, features, t)
        d_table = encode_backward(p, table, levels, d_features)[0]
        table, m, v = adam_rows(table, d_table, m, v, k, rate)
        weights = adam.step(weights, d_weights, rate)
        losses.append(loss)
    return table, weights, np.array(losses)
