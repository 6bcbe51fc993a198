"""Task 12.2, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for
from photograd_course.grading.adjoint_gate import (
    central_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, GATE, activations_spec, is_away_from_kinks, layers_of, like

check = checks_for(calls=("mlp_backward",), tolerance=GATE)
GRAPH = Tolerance(1e-10, "right ones differ by at most 1e-15, wrong ones by more than 1e-9")


def case(t, sizes, rows):
    """(layers, x, activations, g) of a random MLP, no ReLU near its kink."""
    for _ in range(200):
        layers, x = layers_of(t.rng, sizes), t.rng.normal(size=(rows, sizes[0]))
        activations = t.call("mlp_forward", layers, x, returns=activations_spec(rows, layers))
        dead = any(bool((each == 0).all()) for each in activations[1:])
        if is_away_from_kinks(layers, activations) and not dead:
            return layers, x, activations, random_cotangent(t.rng, (rows, sizes[-1]))
    return t.require(False, "not telling")


def derivatives(t, layers, x, g, function="adapters.backward_of"):
    """(d_layers, d_x) of the submission."""
    parts = Items(like(layers), Array(x.shape), names=("d_layers", "d_x"))
    return t.call(function, layers, x, g, returns=parts)


@check(
    "12.2.layer",
    points=2,
    tolerance=EXACT,
    hint="handout, equations (6) and (7): one linear layer, no ReLU",
    sole="a single layer, worked out by hand",
)
def one_linear_layer(t):
    """One layer: derivatives of the weights, the biases and the input, each alone."""
    layers = [np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]), np.array([0.5, -0.5])]
    x, g = np.array([[1.0, 0.0, -1.0], [2.0, 1.0, 0.0]]), np.array([[1.0, -1.0], [0.5, 2.0]])
    (d_W, d_b), d_x = derivatives(t, layers, x, g)
    t.close("d_b", d_b, np.array([1.5, 1.0]), reveal=True)
    t.close("d_W", d_W, np.array([[2.0, 3.0], [0.5, 2.0], [-1.0, 1.0]]), reveal=True)
    t.close("d_x", d_x, np.array([[-1.0, -1.0, -1.0], [4.5, 9.5, 14.5]]), reveal=True)


@check(
    "12.2.differences",
    points=5,
    hint="handout, equations (6) to (8): the layers in reverse order; is each ReLU in its place?",
    sole="the gradient itself, without the reference",
)
def the_backward_pass_agrees_with_differences(t):
    """A small change of a weight, a bias or an input changes the output as you say."""
    # Between layers of equal width a wrong matrix or mask has the right shape.
    for sizes, rows in (((3, 5, 4, 2), 3), ((3, 4, 4, 2), 3), ((2, 6, 1), 4)):
        layers, x, activations, g = case(t, sizes, rows)
        d_layers, d_x = derivatives(t, layers, x, g)
        point = {f"{'Wb'[k % 2]}{k // 2}": array for k, array in enumerate(layers)} | {"x": x}

        def forward(at, layers=layers, rows=rows):
            moved = [at[f"{'Wb'[k % 2]}{k // 2}"] for k in range(len(layers))]
            spec = activations_spec(rows, layers)
            return t.call("mlp_forward", moved, at["x"], returns=spec)[-1]

        for group, got in zip(point, [*d_layers, d_x], strict=True):
            expected = central_differences(forward, point, group, g)
            t.require(bool(expected.any()), "not telling")
            t.close(f"d_{group}", got, expected)
    parts = Items(like(layers), Array(x.shape), names=("d_layers", "d_x"))
    t.look("mlp_backward", layers, activations, g, returns=parts)
    d_layers, d_x = derivatives(t, layers, x, 0.0 * g)
    require_zero_for_zero(t, {"x": d_x} | dict(zip("Wbvc", d_layers, strict=True)))


ENGINE = "engine.py, your assignment 02, is wrong; photograd course check 02"


@check(
    "12.2.graph",
    points=3,
    tolerance=GRAPH,
    hint="the same derivatives twice: which of the two do the checks above confirm?",
    sole="two backward passes written by the same student, one by hand and one by a graph",
)
def the_graph_says_the_same(t):
    """Your graph of assignment 02, a Value for each number, gives the same derivatives."""
    a, b = float(t.rng.uniform(0.5, 2.0)), float(t.rng.uniform(0.5, 2.0))
    known = t.call("adapters.small_graph", a, b, returns=Array((2,)))
    t.close(
        "engine.py of 02: gradients of max(a b, 0) + a a",
        known,
        np.array([b + 2 * a, a]),
        hint=ENGINE,
    )
    layers, x, _, g = case(t, (2, 4, 4, 3), 4)
    by_hand = derivatives(t, layers, x, g)
    by_graph = derivatives(t, layers, x, g, "graph_gradients")
    names = [f"d_{'Wb'[k % 2]}{k // 2}" for k in range(len(layers))]
    for name, mine, theirs in zip(names, by_hand[0], by_graph[0], strict=True):
        t.close(f"{name} by hand and by graph", mine, theirs)
    t.close("d_x by hand and by graph", by_hand[1], by_graph[1])


def waves(t, side):
    """A picture (side, side, 3) of waves, too fast for a network without encoding."""
    rows, columns = np.indices((side, side)) / side
    paint = []
    for _ in range(3):
        across, down = t.rng.uniform(2.0, 3.0, 2) * t.rng.choice([-1, 1], 2)
        phase = t.rng.uniform(0.0, 6.0)
        paint.append(0.5 + 0.45 * np.sin(6.2832 * (across * columns + down * rows) + phase))
    return np.stack(paint, axis=2)


@check(
    "12.2.picture",
    points=3,
    seconds=30.0,
    needs=("positional_encoding",),
    hint="the fit uses positional_encoding, and mlp_backward with two hidden layers of one width",
    sole="the encoding and the backward pass together, on the handout's first experiment",
)
def a_picture_needs_the_encoding(t):
    """A picture of waves: with four bands the fit is at least 12 dB better than with none."""
    picture, seed, decibels = waves(t, 20), int(t.rng.integers(1 << 30)), []
    for bands in (0, 4):
        spec = Array(picture.shape)
        fitted = t.call("adapters.fitted_picture", picture, bands, 150, seed, returns=spec)
        decibels.append(-10 * np.log10(max(float(np.mean((fitted - picture) ** 2)), 1e-12)))
    none, four = decibels
    said = f"L = 4 reaches {four:.1f} dB, L = 0 {none:.1f} dB: threshold 12 dB more"
    t.require(four >= none + 12.0, said)
