"""Loops: over cells, over rows, over bits of the corner's number; scalars wherever they are few."""

import itertools
import math

import numpy as np
from hash_grids import Adam, network_loss_and_grad


def tabulate(field, n, offsets, tolerance):
    D = offsets.shape[1]
    mean = {}
    for number in range(n**D):
        cell = tuple(number // n**a % n for a in range(D))
        answers = field((np.array(cell) + offsets) / n)
        mean[cell] = answers.sum(axis=0) / len(offsets)
    leaf, values = np.empty((n,) * D, dtype=np.int64), []
    waiting = [((0,) * D, n)]
    while waiting:
        low, side = waiting.pop()
        cells = [low]
        for a in range(D):
            cells = [(*c[:a], c[a] + s, *c[a + 1 :]) for c in cells for s in range(side)]
        held = np.stack([mean[c] for c in cells])
        if any(max(channel) - min(channel) > tolerance for channel in held.T):
            h = side // 2
            octants = itertools.product(*[(a, a + h) for a in low])
            waiting += [(octant, h) for octant in octants]
            continue
        for c in cells:
            leaf[c] = len(values)
        values.append(held.sum(axis=0) / len(cells))
    return leaf, np.stack(values)


def hash_index(corners, resolution, rows):
    found = np.zeros(len(corners), dtype=np.int64)
    dense = (resolution + 1) ** corners.shape[1] <= rows
    for m, corner in enumerate(corners.tolist()):
        if dense:
            for c in reversed(corner):
                found[m] = found[m] * (resolution + 1) + c
        else:
            bits = 0
            for c, prime in zip(corner, (1, 2654435761, 805459861), strict=False):
                bits ^= (c * prime) & 0xFFFFFFFF
            found[m] = bits % rows
    return found


def _corner(q, w, number):
    """Corner `number` of each cell, whose bits say upper or lower, and the factors by axis."""
    D = q.shape[1]
    bits = [number >> a & 1 for a in range(D)]
    factors = [w[:, a] if bits[a] else 1.0 - w[:, a] for a in range(D)]
    return q + np.array(bits), bits, factors


def _cell(points, n):
    at = n * np.clip(points, 0.0, 1.0)
    q = at.astype(np.int64)
    q[q == n] = n - 1
    return q, at - q


def encode(points, table, levels):
    F = table.shape[1]
    features = np.zeros((len(points), len(levels) * F))
    for k in range(len(levels)):
        n, first, rows = levels[k]
        q, w = _cell(points, n)
        for number in range(2 ** points.shape[1]):
            corner, _, factors = _corner(q, w, number)
            row = hash_index(corner, int(n), int(rows)) + first
            for f in range(F):
                features[:, k * F + f] += math.prod(factors) * table[row, f]
    return features


def encode_backward(points, table, levels, d_features):
    F, D = table.shape[1], points.shape[1]
    d_table, d_points = np.zeros(table.shape), np.zeros(points.shape)
    clamped = np.clip(points, 0.0, 1.0) != points
    for k in range(len(levels)):
        n, first, rows = levels[k]
        q, w = _cell(points, n)
        for number in range(2**D):
            corner, bits, factors = _corner(q, w, number)
            row = hash_index(corner, int(n), int(rows)) + first
            weight = math.prod(factors)
            for f in range(F):
                g = d_features[:, k * F + f]
                np.add.at(d_table[:, f], row, weight * g)
                for a in range(D):
                    rest = math.prod(factors[:a] + factors[a + 1 :])
                    sign = n if bits[a] else -n
                    d_points[:, a] += sign * rest * table[row, f] * g
    d_points[clamped] = 0.0
    return d_table, d_points


def adam_rows(table, d_table, m, v, k, rate):
    x, m, v = np.array(table), np.array(m), np.array(v)
    c1, c2 = 1.0 - 0.9**k, 1.0 - 0.99**k
    for r in np.flatnonzero(np.abs(d_table).sum(axis=1) > 0):
        d = d_table[r]
        m[r] += 0.1 * (d - m[r])
        v[r] += 0.01 * (d * d - v[r])
        x[r] = x[r] - rate * (m[r] / c1) / (np.sqrt(v[r] / c2) + 1e-15)
    return x, m, v


def train_hash_grid(points, target, batches, levels, table, weights, rate):
    m, v = np.zeros(table.shape), np.zeros(table.shape)
    decoder, losses, k = Adam(len(weights)), [], 0
    while k < len(batches):
        p, wanted = points[batches[k]], target[batches[k]]
        k += 1
        found = network_loss_and_grad(weights, encode(p, table, levels), wanted)
        losses.append(found[0])
        d_table, _ = encode_backward(p, table, levels, found[2])
        table, m, v = adam_rows(table, d_table, m, v, k, rate)
        weights = decoder.step(weights, found[1], rate)
    return table, weights, np.array(losses, dtype=np.float64)
