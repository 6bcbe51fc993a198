"""Loops over bands, rows, rays and samples; sums written out."""

import numpy as np
from nerf import (
    BANDS,
    DIRECTION_BANDS,
    PADDING,
    Adam,
    draw,
    edges_between,
    mlp_forward,
    points_on,
    ray_weights,
    sigmoid,
    softplus,
    take,
)
from volume_rendering import composite, composite_adjoint


def positional_encoding(x, bands):
    N, D = x.shape
    values = np.zeros((N, D * (2 * bands + 1)))
    slopes = np.zeros_like(values)
    for j in range(D):
        values[:, j], slopes[:, j] = x[:, j], 1.0
        for band in range(bands):
            times = np.pi * (1 << band)
            column = D * (1 + 2 * band) + j
            values[:, column] = np.sin(times * x[:, j])
            slopes[:, column] = times * np.cos(times * x[:, j])
            values[:, column + D] = np.cos(times * x[:, j])
            slopes[:, column + D] = -times * np.sin(times * x[:, j])
    return values, slopes


def mlp_backward(layers, activations, g):
    d = [np.zeros(each.shape) for each in layers]
    rows = []
    for n in range(len(g)):
        back = g[n].copy()
        k = len(layers) - 2
        while k >= 0:
            into = activations[k // 2][n]
            d[k] += np.outer(into, back)
            d[k + 1] += back
            back = layers[k] @ back
            if k:
                back[into <= 0] = 0.0
            k -= 2
        rows.append(back)
    return d, np.array(rows).reshape(len(g), -1)


def sample_distances(edges, weights, u):
    R, n = u.shape
    t = np.zeros((R, n))
    for r in range(R):
        total = weights[r].sum()
        for i in range(n):
            wanted = (i + u[r, i]) / n * total
            k, passed = 0, 0.0
            while k + 1 < weights.shape[1] and passed + weights[r, k] <= wanted:
                passed += weights[r, k]
                k += 1
            part = (wanted - passed) / weights[r, k]
            t[r, i] = edges[r, k] * (1 - part) + edges[r, k + 1] * part
    return t


def radiance_field(network, p, d):
    trunk = mlp_forward(network["trunk"], positional_encoding(p, BANDS)[0])
    of_directions = positional_encoding(d, DIRECTION_BANDS)[0]
    rows = [np.append(out[1:], aim) for out, aim in zip(trunk[-1], of_directions, strict=True)]
    head = mlp_forward(network["head"], np.array(rows).reshape(len(p), -1))
    sigma = np.array([softplus(out[0]) for out in trunk[-1]])
    return sigma, sigmoid(head[-1]), trunk, head


def loss_and_grad(network, batch, t):
    R, S = t.shape
    loss, total = 0.0, None
    for r in range(R):
        one = take(batch, slice(r, r + 1))
        dt = np.diff(edges_between(t[r : r + 1], batch["near"], batch["far"]))
        p, d = points_on(one, t[r : r + 1])
        sigma, color, trunk, head = radiance_field(network, p, d)
        ray = (sigma[None], color[None], dt, batch["background"])
        off = composite(*ray)[0][0] - batch["colors"][r]
        loss += float(off @ off) / R
        d_sigma, d_color, _ = composite_adjoint(*ray, 2 * off[None] / R, np.zeros(1))
        d_head, back = mlp_backward(network["head"], head, d_color[0] * color * (1 - color))
        g = np.zeros((S, trunk[-1].shape[1]))
        for s in range(S):
            g[s, 0] = d_sigma[0, s] / (1 + np.exp(-trunk[-1][s, 0]))
            for f in range(1, g.shape[1]):
                g[s, f] = back[s, f - 1]
        d_trunk, _ = mlp_backward(network["trunk"], trunk, g)
        one = {"trunk": d_trunk, "head": d_head}
        if total is None:
            total = one
        else:
            total = {
                name: [a + b for a, b in zip(total[name], one[name], strict=True)] for name in one
            }
    return loss, total


def train_nerf(views, network, steps, rng):
    optimizer, losses = Adam(), []
    for _ in range(steps):
        chosen, u, v = draw(views, rng)
        batch = take(views, chosen)
        t = []
        for r in range(len(chosen)):
            ends = np.array([[views["near"], views["far"]]])
            one = take(batch, slice(r, r + 1))
            first = sample_distances(ends, np.ones((1, 1)), u[r : r + 1])
            cuts = edges_between(first, views["near"], views["far"])
            sigma = radiance_field(network, *points_on(one, first))[0][None]
            likely = PADDING + ray_weights(sigma, np.diff(cuts))
            second = sample_distances(cuts, likely, v[r : r + 1])
            t.append(sorted([*first[0], *second[0]]))
        loss, slopes = loss_and_grad(network, batch, np.array(t))
        losses.append(loss)
        network = optimizer.step(network, slopes)
    return network, np.array(losses, dtype=float)
