"""From the handout alone: a function for each equation, the inverse interval by interval."""

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
    gamma, slope = np.array(x), np.ones(x.shape)
    for k in range(bands):
        w = (2.0**k) * np.pi
        gamma = np.hstack([gamma, np.sin(w * x), np.cos(w * x)])
        slope = np.hstack([slope, w * np.cos(w * x), -w * np.sin(w * x)])
    return gamma, slope


def linear_backward(W, x, g):
    return x.T @ g, np.sum(g, axis=0), g @ W.T


def mlp_backward(layers, activations, g):
    found = []
    for k in range(len(layers) // 2 - 1, -1, -1):
        d_W, d_b, g = linear_backward(layers[2 * k], activations[k], g)
        found = [d_W, d_b, *found]
        if k >= 1:
            g = np.where(activations[k] > 0, g, 0.0)
    return found, g


def sample_distances(edges, weights, u):
    n = u.shape[1]
    rows = []
    for ray in range(len(u)):
        F = np.append(0.0, np.cumsum(weights[ray]))
        v = (np.arange(n) + u[ray]) / n
        ends = edges[ray]
        shares, spans = [], []
        for k in range(weights.shape[1]):
            if weights[ray, k] > 0:
                shares.append((F[k] / F[-1], F[k + 1] / F[-1]))
                spans.append((ends[k], ends[k + 1]))
        found = np.zeros(n)
        for (a, b), (low, high) in zip(shares, spans, strict=True):
            here = (v >= a) & ((v < b) | (b == shares[-1][1]))
            found[here] = low + (high - low) * (v[here] - a) / (b - a)
        rows.append(found)
    return np.array(rows).reshape(u.shape)


def radiance_field(network, p, d):
    gamma_p, _ = positional_encoding(p, BANDS)
    gamma_d, _ = positional_encoding(d, DIRECTION_BANDS)
    trunk = mlp_forward(network["trunk"], gamma_p)
    s, f = trunk[-1][:, 0], trunk[-1][:, 1:]
    head = mlp_forward(network["head"], np.hstack([f, gamma_d]))
    return softplus(s), sigmoid(head[-1]), trunk, head


def loss_and_grad(network, batch, t):
    R, S = t.shape
    edges = edges_between(t, batch["near"], batch["far"])
    dt = edges[:, 1:] - edges[:, :-1]
    p, d = points_on(batch, t)
    sigma, color, trunk, head = radiance_field(network, p, d)
    given = (sigma.reshape(R, S), color.reshape(R, S, 3), dt, batch["background"])
    pixel, _ = composite(*given)
    off = pixel - batch["colors"]
    L = np.mean(np.sum(off**2, axis=1))
    d_sigma, d_color, _ = composite_adjoint(*given, 2 / R * off, np.zeros(R))
    d_color = d_color.reshape(R * S, 3)
    d_head, d_in = mlp_backward(network["head"], head, d_color * color * (1 - color))
    d_s = d_sigma.reshape(R * S, 1) * sigmoid(trunk[-1][:, :1])
    d_f = d_in[:, : trunk[-1].shape[1] - 1]
    d_trunk, _ = mlp_backward(network["trunk"], trunk, np.hstack([d_s, d_f]))
    return float(L), {"trunk": d_trunk, "head": d_head}


def train_nerf(views, network, steps, rng):
    adam = Adam()
    noted = np.empty(steps)
    for k in range(steps):
        chosen, u, v = draw(views, rng)
        batch, near, far = take(views, chosen), views["near"], views["far"]
        R = len(chosen)
        ends = np.stack([np.full(R, near), np.full(R, far)], axis=1)
        t_coarse = sample_distances(ends, np.ones((R, 1)), u)
        edges = edges_between(t_coarse, near, far)
        p, d = points_on(batch, t_coarse)
        sigma = radiance_field(network, p, d)[0].reshape(R, -1)
        w = ray_weights(sigma, edges[:, 1:] - edges[:, :-1])
        t_fine = sample_distances(edges, w + PADDING, v)
        both = np.hstack([t_fine, t_coarse])
        both.sort(axis=1)
        noted[k], d_network = loss_and_grad(network, batch, both)
        network = adam.step(network, d_network)
    return network, noted
