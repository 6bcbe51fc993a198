"""Task 12.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, checks_for

from .common import EXACT, activations_spec, field, network_of, unit

check = checks_for(calls=("radiance_field",), needs=("positional_encoding",), tolerance=EXACT)


def samples(t, n):
    """Points, and unit directions."""
    return t.rng.uniform(-1.0, 1.0, (n, 3)), unit(t.rng.normal(size=(n, 3)))


@check(
    "12.4.direction",
    points=4,
    hint="handout, figure 4: the direction enters the head alone",
    sole="the property that keeps shapes the same from all sides",
)
def density_is_the_same_from_all_sides(t):
    """Another direction changes colors and no bit of any density; another point changes both."""
    network = network_of(t.rng)
    p, d = samples(t, 8)
    sigma, color, _, _ = field(t, network, p, d)
    other, painted, _, _ = field(t, network, p, unit(t.rng.normal(size=(8, 3))))
    t.require(np.array_equal(sigma, other), "the density changes with the direction")
    t.require(bool((color != painted).any()), "no color changes with the direction")
    moved, painted, _, _ = field(t, network, -p, d)
    t.require(bool((sigma != moved).any()), "no density changes with the point")
    t.require(bool((color != painted).any()), "no color changes with the point")


@check(
    "12.4.outputs",
    points=2,
    hint="handout, equation (15): softplus for density, sigmoid for colors",
    sole="small enough to work out by hand",
)
def outputs_of_biases(t):
    """With weights of 0 density and color follow from the last biases alone."""
    network = {name: [0.0 * a for a in layers] for name, layers in network_of(t.rng).items()}
    p, d = samples(t, 3)
    sigma, color, _, _ = field(t, network, p, d)
    t.close("density of a bias of 0", sigma, np.full(3, np.log(2)), reveal=True)
    t.close("color of biases of 0", color, np.full((3, 3), 0.5), reveal=True)
    network["trunk"][-1] = np.array([np.log(np.e - 1), 5.0, -5.0])
    network["head"][-1] = np.log(np.array([1.0, 3.0, 0.25]))
    sigma, color, _, _ = field(t, network, p, d)
    t.close("density of a bias of log(e - 1)", sigma, np.ones(3), reveal=True)
    t.close("colors of biases log 1, log 3, log 1/4", color, [[0.5, 0.75, 0.2]] * 3, reveal=True)
    network["trunk"][-1][0] = 900.0
    t.close("density of a bias of 900", field(t, network, p, d)[0], np.full(3, 900.0), reveal=True)


@check(
    "12.4.parts",
    points=3,
    hint="handout, equations (13) and (14): which numbers does each network get, in which order?",
    sole="looks at what enters and leaves both networks, one after the other",
)
def what_the_networks_get(t):
    """The trunk gets encoded points, the head features and encoded directions, in this order."""
    network = network_of(t.rng, features=3)
    p, d = samples(t, 4)
    sigma, _, trunk, head = field(t, network, p, d)
    for name, layers, got in (("trunk", network["trunk"], trunk), ("head", network["head"], head)):
        # From its own first activation: what comes after it is the given forward pass.
        right = t.call("mlp_forward", layers, got[0], returns=activations_spec(4, layers))
        for k, (mine, theirs) in enumerate(zip(got, right, strict=True)):
            t.close(f"{name}, activation {k}", mine, theirs)
    for name, got, x, bands in (("points", trunk[0], p, 4), ("directions", head[0][:, 3:], d, 2)):
        columns = Array((4, 3 * (2 * bands + 1)))
        encoded = t.call("positional_encoding", x, bands, returns=Items(columns, columns))[0]
        t.close(f"encoded {name}", got, encoded)
    t.close("features in the head", head[0][:, :3], trunk[-1][:, 1:])
    t.close("density", sigma, np.log1p(np.exp(trunk[-1][:, 0])))
