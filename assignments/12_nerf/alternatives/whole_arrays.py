"""Whole arrays throughout: outer products, einsum, one search for all rays, no transposes."""

import numpy as np
from nerf import (
    BANDS,
    COARSE,
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
    rates = np.exp2(np.arange(bands))[:, None] * np.pi
    angles = rates * x[:, None, :]  # (N, L, D)
    wave = np.stack([np.sin(angles), np.cos(angles)], axis=2)
    slope = np.stack([rates * wave[:, :, 1], -rates * wave[:, :, 0]], axis=2)
    columns = 2 * bands * x.shape[1]
    return (
        np.concatenate([x, wave.reshape(len(x), columns)], axis=1),
        np.concatenate([np.ones(x.shape), slope.reshape(len(x), columns)], axis=1),
    )


def mlp_backward(layers, activations, g):
    weights = layers[::2]
    arriving = [g]
    for W, into in zip(weights[:0:-1], activations[-2:0:-1], strict=True):
        arriving.append(np.einsum("nc,ic->ni", arriving[-1], W) * np.sign(into))
    arriving.reverse()
    found = []
    for into, here in zip(activations[:-1], arriving, strict=True):
        found.append(np.einsum("ni,nc->ic", into, here))
        found.append(np.einsum("nc->c", here))
    return found, np.einsum("nc,ic->ni", arriving[0], weights[0])


def sample_distances(edges, weights, u):
    rays, n = u.shape
    bins = weights.shape[1]
    total = weights.sum(axis=1, keepdims=True)
    wanted = (u + np.arange(n)[None]) * total / n
    upto = weights.cumsum(axis=1)
    # One search in all rays: each is lifted above the one before.
    lift = np.arange(rays)[:, None] * (2 * upto.max() + 1)
    k = np.searchsorted((upto + lift).ravel(), (wanted + lift).ravel(), side="right")
    k = np.minimum(k.reshape(rays, n) - np.arange(rays)[:, None] * bins, bins - 1)
    row = np.arange(rays)[:, None]
    left = upto[row, k] - wanted
    return edges[row, k + 1] - (edges[row, k + 1] - edges[row, k]) * left / weights[row, k]


def radiance_field(network, p, d):
    trunk = mlp_forward(network["trunk"], positional_encoding(p, BANDS)[0])
    out = trunk[-1]
    into = np.empty((len(p), out.shape[1] - 1 + 3 * (2 * DIRECTION_BANDS + 1)))
    into[:, : out.shape[1] - 1] = out[:, 1:]
    into[:, out.shape[1] - 1 :] = positional_encoding(d, DIRECTION_BANDS)[0]
    head = mlp_forward(network["head"], into)
    return softplus(out[:, 0]), sigmoid(head[-1]), trunk, head


def loss_and_grad(network, batch, t):
    rays, count = t.shape
    sigma, color, trunk, head = radiance_field(network, *points_on(batch, t))
    dt = np.diff(edges_between(t, batch["near"], batch["far"]), axis=1)
    ray = (sigma.reshape(rays, count), color.reshape(rays, count, 3), dt, batch["background"])
    error = composite(*ray)[0] - batch["colors"]
    slopes = composite_adjoint(*ray, 2 * error, np.zeros(rays))
    # Divided by the rays at the end, as everything here is linear in the derivative of the pixels.
    d_head, d_into = mlp_backward(
        network["head"], head, slopes[1].reshape(-1, 3) * (color - color**2)
    )
    d_out = np.concatenate([slopes[0].reshape(-1, 1), d_into], axis=1)[:, : trunk[-1].shape[1]]
    d_out[:, 0] *= 1 - np.exp(-sigma)  # sigmoid(z), where sigma = softplus(z)
    d_trunk, _ = mlp_backward(network["trunk"], trunk, d_out)
    whole = {"trunk": d_trunk, "head": d_head}
    return float(np.vdot(error, error) / rays), {
        name: [each / rays for each in whole[name]] for name in whole
    }


def train_nerf(views, network, steps, rng):
    adam, losses = Adam(), np.zeros(steps)
    span = np.array([views["near"], views["far"]])
    for k in range(steps):
        chosen, *numbers = draw(views, rng)
        batch = take(views, chosen)
        t = np.zeros((len(chosen), COARSE))
        edges, likely = np.broadcast_to(span, (len(chosen), 2)), np.ones((len(chosen), 1))
        found = []
        for u in numbers:
            found.append(sample_distances(edges, likely, u))
            if len(found) == 1:
                t = found[0]
                edges = edges_between(t, *span)
                sigma = radiance_field(network, *points_on(batch, t))[0]
                likely = PADDING + ray_weights(sigma.reshape(t.shape), np.diff(edges, axis=1))
        losses[k], slopes = loss_and_grad(
            network, batch, np.sort(np.concatenate(found, axis=1), axis=1)
        )
        network = adam.step(network, slopes)
    return network, losses
