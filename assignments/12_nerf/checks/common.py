"""Helpers for the checks of several tasks."""

from itertools import pairwise

import numpy as np
from photograd_course.grading import Array, Items, Number, Record, Tolerance

# Evidence: worst of the solution and three alternatives; every named wrong solution that a
# tolerance decides about is off by ten times the tolerance or more.
EXACT = Tolerance(1e-11, "right ones differ by at most 2e-14, wrong ones by more than 1e-10")
GATE = Tolerance(1e-6, "finite differences leave 6e-8, wrong ones are off by more than 1e-5")
KINK = 1e-3  # finite differences move nothing across the kink of a ReLU


def layers_of(rng, sizes):
    """An MLP with random biases, so that ReLUs of both kinds occur."""
    layers = []
    for inputs, outputs in pairwise(sizes):
        layers.append(rng.normal(size=(inputs, outputs)) * np.sqrt(2 / inputs))
        layers.append(rng.uniform(-0.3, 0.3, outputs))
    return layers


def is_away_from_kinks(layers, activations):
    """Whether no ReLU is near its kink."""
    hidden = range(0, len(layers) - 2, 2)
    before = [activations[k // 2] @ layers[k] + layers[k + 1] for k in hidden]
    return all(bool((np.abs(z) > KINK).all()) for z in before)


def activations_spec(n, layers):
    """What `mlp_forward` returns for n rows."""
    return Items(Array((n, layers[0].shape[0])), *[Array((n, len(b))) for b in layers[1::2]])


def like(layers):
    """Arrays of the shapes of an MLP."""
    names = [f"{kind}{k // 2}" for k, kind in enumerate("Wb" * (len(layers) // 2))]
    return Items(*[Array(each.shape) for each in layers], names=tuple(names))


def like_network(network):
    """Arrays of the shapes of a network."""
    return Record({name: like(layers) for name, layers in network.items()})


def network_of(rng, width=4, features=2):
    """A small network for the encodings of the assignment, with random biases."""
    return {
        "trunk": layers_of(rng, [27, width, width, 1 + features]),
        "head": layers_of(rng, [features + 15, 2, 3]),
    }


def unit(v):
    """Rows of length 1."""
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def random_views(rng, rays=5):
    """Rays through random colors, from random points toward the middle."""
    origins = 3.0 * unit(rng.normal(size=(rays, 3)))
    return {
        "origins": origins,
        "directions": unit(rng.uniform(-0.6, 0.6, (rays, 3)) - origins),
        "colors": rng.uniform(0.0, 1.0, (rays, 3)),
        "background": rng.uniform(0.0, 1.0, 3),
        "near": 2.0,
        "far": 4.0,
    }


def ascending(rng, rays, count, near=2.0, far=4.0):
    """Distances that ascend on each ray."""
    return np.sort(rng.uniform(near, far, (rays, count)), axis=1)


def field_spec(n, network):
    """What `radiance_field` returns for n points."""
    parts = (activations_spec(n, network[name]) for name in ("trunk", "head"))
    names = ("sigma", "color", "trunk", "head")
    return Items(Array((n,), above=0.0), Array((n, 3)), *parts, names=names)


def field(t, network, p, d):
    """`radiance_field` of the submission."""
    return t.call("radiance_field", network, p, d, returns=field_spec(len(p), network))


def loss_spec(network):
    """What `loss_and_grad` returns."""
    return Items(Number(), like_network(network), names=("loss", "d_network"))


def flat(network):
    """(name, array) for each array of a network."""
    for name, layers in network.items():
        for k, array in enumerate(layers):
            yield f"{name} {'Wb'[k % 2]}{k // 2}", array
