"""A neural radiance field: a small network from a point and a direction to density and color.

A *multilayer perceptron* (MLP) is a list of arrays [W0, b0, W1, b1, ...]: layer k computes x W + b
from rows x, and each layer but the last is followed by a ReLU, max(x, 0). A *network* is a dict of
two such lists, "trunk" and "head"; handout section 4 says what each of them computes. *Views* are
a dict of rays through the pixels of photographs, all numbers float64:

    "origins", "directions"   (P, 3) each; directions are unit vectors
    "colors"                  (P, 3), linear colors of the pixels, 0 to 1
    "background"              (3,), the color behind the scene
    "near", "far"             floats, in m: the scene lies between these distances on every ray

Your tasks are six functions, one section of the handout each; `photograd course check 12` tells how
far you are. `volume_rendering.py` and `engine.py`, beside this file, must be yours of assignments
08 and 02.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np
from engine import Value, backward
from volume_rendering import composite, composite_adjoint

# Arrays and their shapes; float64 where nothing else is said.
Points = Annotated[np.ndarray, "N D"]
Features = Annotated[np.ndarray, "N D(2L+1)"]
Rows = Annotated[np.ndarray, "N C"]
Vectors = Annotated[np.ndarray, "N 3"]
Colors = Annotated[np.ndarray, "N 3"]
Densities = Annotated[np.ndarray, "N"]
Edges = Annotated[np.ndarray, "R B+1"]
Weights = Annotated[np.ndarray, "R B"]
Uniform = Annotated[np.ndarray, "R n"]
Distances = Annotated[np.ndarray, "R n"]
Losses = Annotated[np.ndarray, "steps"]
Layers = list[np.ndarray]  # W0, b0, W1, b1, ...
Activations = list[np.ndarray]  # the input of each layer, and the output of the last
Network = dict[str, Layers]
Views = dict[str, np.ndarray | float]

BANDS = 4  # frequencies of the encoding of points
DIRECTION_BANDS = 2  # and of directions
RAYS = 32  # in the batch of each step
COARSE, FINE = 16, 16  # distances on each ray: stratified, and where the density is
PADDING = 0.01  # added to the weight of each interval, so that none is never sampled
RATE = 0.01  # of Adam, at the start; it falls as
DECAY = 800  # RATE / (1 + k / DECAY) with the number k of the step


def positional_encoding(x: Points, bands: int) -> tuple[Features, Features]:
    """Sines and cosines of each coordinate, and their derivatives.

    Args:
        x: (N, D), points.
        bands: L, the number of frequencies, 0 or more.

    Returns:
        (features, derivatives), both (N, D (2 L + 1)): the features, and the derivative of each
        feature with respect to the one coordinate that it depends on. Handout equations (4), (5).
    """
    # >>> solution 12.1
    features, derivatives = [x], [np.ones_like(x)]
    for k in range(bands):
        omega = 2**k * np.pi
        sine, cosine = np.sin(omega * x), np.cos(omega * x)
        features += [sine, cosine]
        derivatives += [omega * cosine, -omega * sine]
    return np.concatenate(features, axis=1), np.concatenate(derivatives, axis=1)
    # <<< solution


def make_layers(sizes, rng):
    """Given: an MLP with layers from sizes[0] to sizes[1] numbers and so on [He2015]."""
    layers = []
    for k, outputs in enumerate(sizes[1:]):
        layers.append(rng.normal(size=(sizes[k], outputs)) * np.sqrt(2 / sizes[k]))
        layers.append(np.zeros(outputs))
    return layers


def mlp_forward(layers, x):
    """Given: the forward pass of an MLP.

    Args:
        layers: [W0, b0, W1, b1, ...]; W (inputs, outputs), b (outputs,).
        x: (N, inputs of the first layer).

    Returns:
        the activations [x, h1, h2, ..., y]: the input of each layer, the last the output (N, C).
    """
    activations = [x]
    for k in range(0, len(layers), 2):
        z = activations[-1] @ layers[k] + layers[k + 1]
        activations.append(np.maximum(z, 0.0) if k + 2 < len(layers) else z)
    return activations


def mlp_backward(layers: Layers, activations: Activations, g: Rows) -> tuple[Layers, Rows]:
    """The adjoint (backward pass) of `mlp_forward`.

    Args:
        layers: [W0, b0, W1, b1, ...].
        activations: what `mlp_forward` returned for these layers.
        g: (N, C), the derivative of some loss with respect to each output.

    Returns:
        (d_layers, d_x): a list of arrays of the shapes of `layers`, and (N, inputs), the
        derivatives of that loss with respect to each; handout equations (6) to (8).
    """
    # >>> solution 12.2
    d_layers = []
    for k in reversed(range(len(layers) // 2)):
        d_layers = [activations[k].T @ g, g.sum(axis=0), *d_layers]
        g = g @ layers[2 * k].T
        if k > 0:
            g = g * (activations[k] > 0)
    return d_layers, g
    # <<< solution


def graph_gradients(layers, x, g):
    """Given: what `mlp_backward` returns, by the graph of assignment 02, a Value for each number.

    Slow, and right for any network that can be written with gates: a test of `mlp_backward`.
    """
    as_values = np.vectorize(Value, otypes=[object])
    rectified = np.vectorize(lambda value: value.maximum(0.0), otypes=[object])
    gradients = np.vectorize(lambda value: value.grad, otypes=[np.float64])
    leaves, inputs = [as_values(array) for array in layers], as_values(x)
    rows = inputs
    for k in range(0, len(leaves), 2):
        rows = rows @ leaves[k] + leaves[k + 1]
        rows = rectified(rows) if k + 2 < len(leaves) else rows
    backward(np.sum(rows * g))
    return [gradients(array) for array in leaves], gradients(inputs)


def sample_distances(edges: Edges, weights: Weights, u: Uniform) -> Distances:
    """Stratified samples of a density that is constant in each interval, by inverting its CDF.

    Args:
        edges: (R, B + 1), the ends of B intervals on each ray, ascending.
        weights: (R, B), 0 or more, of any sum above 0: how likely a sample in each interval is.
        u: (R, n), uniform random numbers, 0 <= u < 1.

    Returns:
        (R, n), ascending on each ray; handout equations (9) to (12).
    """
    # >>> solution 12.3
    count, intervals = u.shape[1], weights.shape[1]
    v = (np.arange(count) + u) / count
    cdf = np.cumsum(weights, axis=1) / np.sum(weights, axis=1, keepdims=True)
    cdf = np.concatenate([np.zeros((len(u), 1)), cdf], axis=1)
    inside = np.sum(v[:, :, None] >= cdf[:, None, 1:intervals], axis=2)
    low, high = (np.take_along_axis(cdf, inside + side, axis=1) for side in (0, 1))
    start, end = (np.take_along_axis(edges, inside + side, axis=1) for side in (0, 1))
    return start + (end - start) * (v - low) / (high - low)
    # <<< solution


def edges_between(t, near, far):
    """Given: the interval of each distance: up to the midpoints between it and its neighbors.

    Args:
        t: (R, S), ascending, between near and far.
        near, far: floats.

    Returns:
        (R, S + 1): near, the midpoints, far. The lengths of the intervals sum to far - near.
    """
    ends = np.full((len(t), 1), near), np.full((len(t), 1), far)
    return np.concatenate([ends[0], (t[:, :-1] + t[:, 1:]) / 2, ends[1]], axis=1)


def ray_weights(sigma, dt):
    """Given: the weight T alpha of each step in the color of a ray; sigma and dt (R, S)."""
    tau = np.cumsum(sigma * dt, axis=1)
    return np.exp(sigma * dt - tau) * -np.expm1(-sigma * dt)


def points_on(views, t):
    """Given: points (R S, 3) at distances t (R, S), and the directions (R S, 3) of their rays."""
    points = views["origins"][:, None] + t[:, :, None] * views["directions"][:, None]
    return points.reshape(-1, 3), np.repeat(views["directions"], t.shape[1], axis=0)


def sigmoid(z):
    """Given: 1 / (1 + exp(-z)), without overflow."""
    return 0.5 * (1.0 + np.tanh(0.5 * z))


def softplus(z):
    """Given: log(1 + exp(z)), without overflow: positive everywhere; its derivative is sigmoid."""
    return np.logaddexp(0.0, z)


def make_network(width, features, rng):
    """Given: a network with two hidden layers in its trunk and one in its head."""
    of_points = 3 * (2 * BANDS + 1)
    of_directions = 3 * (2 * DIRECTION_BANDS + 1)
    return {
        "trunk": make_layers([of_points, width, width, 1 + features], rng),
        "head": make_layers([features + of_directions, width // 2, 3], rng),
    }


def radiance_field(
    network: Network, p: Vectors, d: Vectors
) -> tuple[Densities, Colors, Activations, Activations]:
    """Density and color at points, as seen along directions.

    Args:
        network: "trunk" and "head".
        p: (N, 3), points.
        d: (N, 3), unit directions of the rays.

    Returns:
        (sigma, color, trunk, head): (N,), above 0; (N, 3), between 0 and 1; and the activations
        of both MLPs, as `mlp_forward` returns them. Handout equations (13) to (15).
    """
    # >>> solution 12.4
    trunk = mlp_forward(network["trunk"], positional_encoding(p, BANDS)[0])
    aim, _ = positional_encoding(d, DIRECTION_BANDS)
    head = mlp_forward(network["head"], np.concatenate([trunk[-1][:, 1:], aim], axis=1))
    return softplus(trunk[-1][:, 0]), sigmoid(head[-1]), trunk, head
    # <<< solution


def loss_and_grad(network: Network, batch: Views, t: Distances) -> tuple[float, Network]:
    """The loss of a batch of rays, and its derivative with respect to the network.

    Args:
        network: "trunk" and "head".
        batch: views of R rays.
        t: (R, S), ascending distances, between near and far.

    Returns:
        (loss, d_network): a float, and a dict like `network`; handout equations (16) to (20).
    """
    # >>> solution 12.5
    dt = np.diff(edges_between(t, batch["near"], batch["far"]), axis=1)
    sigma, color, trunk, head = radiance_field(network, *points_on(batch, t))
    ray = sigma.reshape(t.shape), color.reshape(*t.shape, 3), dt, batch["background"]
    residual = composite(*ray)[0] - batch["colors"]
    d_pixels = 2 * residual / len(t)
    d_sigma, d_color, _ = composite_adjoint(*ray, d_pixels, np.zeros(len(t)))
    d_head, d_inputs = mlp_backward(
        network["head"], head, d_color.reshape(-1, 3) * color * (1 - color)
    )
    d_out = np.empty_like(trunk[-1])
    d_out[:, 0] = d_sigma.ravel() * sigmoid(trunk[-1][:, 0])
    d_out[:, 1:] = d_inputs[:, : d_out.shape[1] - 1]
    d_trunk, _ = mlp_backward(network["trunk"], trunk, d_out)
    return float(np.sum(residual**2) / len(t)), {"trunk": d_trunk, "head": d_head}
    # <<< solution


class Adam:
    """Adam for a network, as in assignment 01: beta1 = 0.9, beta2 = 0.99, a falling rate."""

    def __init__(self):
        self.m = self.v = None
        self.k = 0

    def step(self, network, d_network):
        """The network after one step; the given one does not change."""
        self.k += 1
        rate = RATE / (1 + self.k / DECAY)
        if self.m is None:
            zeros = {name: [0.0 * array for array in network[name]] for name in network}
            self.m, self.v = zeros, zeros
        self.m = _mix(0.9, self.m, d_network, 1)
        self.v = _mix(0.99, self.v, d_network, 2)
        after = {}
        for name, layers in network.items():
            moments = zip(layers, self.m[name], self.v[name], strict=True)
            after[name] = [
                x - rate * m / (1 - 0.9**self.k) / (np.sqrt(v / (1 - 0.99**self.k)) + 1e-8)
                for x, m, v in moments
            ]
        return after


def _mix(beta, moments, d_network, power):
    """beta times the moments plus 1 - beta times the derivatives to a power."""
    return {
        name: [
            beta * old + (1 - beta) * g**power
            for old, g in zip(moments[name], d_network[name], strict=True)
        ]
        for name in moments
    }


def fit_picture(picture, bands, steps, rng, width=32):
    """Given: train an MLP to give the colors of a picture (H, W, 3) at its points.

    Returns:
        (fitted, losses): (H, W, 3), and (steps,), the mean squared error before each step.
    """
    rows, columns = picture.shape[:2]
    y, x = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    p = np.stack([(x.ravel() + 0.5) / columns, (y.ravel() + 0.5) / rows], axis=1) * 2 - 1
    encoded, truth = positional_encoding(p, bands)[0], picture.reshape(-1, 3)
    network = {"picture": make_layers([encoded.shape[1], width, width, 3], rng)}
    losses, adam = np.zeros(steps), Adam()
    for step in range(steps):
        chosen = rng.choice(len(truth), min(1024, len(truth)), replace=False)
        activations = mlp_forward(network["picture"], encoded[chosen])
        colors = sigmoid(activations[-1])
        wrong = colors - truth[chosen]
        losses[step] = np.mean(wrong**2)
        d_z = 2 * wrong / wrong.size * colors * (1 - colors)
        d_layers, _ = mlp_backward(network["picture"], activations, d_z)
        network = adam.step(network, {"picture": d_layers})
    fitted = sigmoid(mlp_forward(network["picture"], encoded)[-1])
    return fitted.reshape(picture.shape), losses


def draw(views, rng):
    """Given: the random numbers of one step, (chosen, u, u_fine).

    Returns:
        chosen (R,), RAYS different rays, all if there are fewer; u (R, COARSE) and u_fine
        (R, FINE), uniform numbers for the two calls of `sample_distances`, in this order.
    """
    total = len(views["colors"])
    chosen = rng.choice(total, min(RAYS, total), replace=False)
    return chosen, rng.random((len(chosen), COARSE)), rng.random((len(chosen), FINE))


def take(views, chosen):
    """Given: the views of some rays."""
    return {**views, **{name: views[name][chosen] for name in ("origins", "directions", "colors")}}


def train_nerf(
    views: Views, network: Network, steps: int, rng: np.random.Generator
) -> tuple[Network, Losses]:
    """Fit a network to photographs.

    Args:
        views: P rays.
        network: the initial guess; its arrays must not change. After 0 steps it may be returned.
        steps: the number of steps, 0 or more.
        rng: a numpy.random.Generator, for `draw` alone.

    Returns:
        (network, losses): the network after the last step, and (steps,), the loss before each
        step; handout equations (21) to (24).
    """
    # >>> solution 12.6
    losses, adam = np.zeros(steps), Adam()
    near, far = views["near"], views["far"]
    for step in range(steps):
        chosen, u, u_fine = draw(views, rng)
        batch = take(views, chosen)
        whole = np.tile([near, far], (len(chosen), 1))
        coarse = sample_distances(whole, np.ones((len(chosen), 1)), u)
        edges = edges_between(coarse, near, far)
        sigma = radiance_field(network, *points_on(batch, coarse))[0].reshape(coarse.shape)
        weights = ray_weights(sigma, np.diff(edges, axis=1)) + PADDING
        fine = sample_distances(edges, weights, u_fine)
        t = np.sort(np.concatenate([coarse, fine], axis=1), axis=1)
        losses[step], d_network = loss_and_grad(network, batch, t)
        network = adam.step(network, d_network)
    return network, losses
    # <<< solution


def render(network, views, samples=64):
    """Given: the pixels (P, 3) of all rays, in equal steps from near to far."""
    pixels = np.zeros((len(views["origins"]), 3))
    middles = views["near"] + (np.arange(samples) + 0.5) / samples * (views["far"] - views["near"])
    for first in range(0, len(pixels), 1024):
        part = take(views, slice(first, first + 1024))
        t = np.tile(middles, (len(part["origins"]), 1))
        dt = np.diff(edges_between(t, views["near"], views["far"]), axis=1)
        sigma, color, *_ = radiance_field(network, *points_on(part, t))
        ray = sigma.reshape(t.shape), color.reshape(*t.shape, 3), dt, views["background"]
        pixels[first : first + 1024] = composite(*ray)[0]
    return pixels


def density_gradient(network, p):
    """Given: the derivative (N, 3) of the density before `softplus` with respect to each point.

    It points into what is dense, against the normals of surfaces. It needs the derivatives of the
    encoding, which training does not.
    """
    features, derivatives = positional_encoding(p, BANDS)
    trunk = mlp_forward(network["trunk"], features)
    first = np.zeros_like(trunk[-1])
    first[:, 0] = 1.0
    _, d_features = mlp_backward(network["trunk"], trunk, first)
    return (d_features * derivatives).reshape(len(p), -1, 3).sum(axis=1)
