"""Task 12.5, public checks."""

import numpy as np
from photograd_course.grading import checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from .common import (
    EXACT,
    GATE,
    ascending,
    field,
    flat,
    is_away_from_kinks,
    loss_spec,
    network_of,
    random_views,
)

EARLIER = (
    "positional_encoding",
    "mlp_backward",
    "radiance_field",
    "composite",
    "composite_adjoint",
)
check = checks_for(calls=("loss_and_grad",), needs=EARLIER, tolerance=EXACT)


def loss_of(t, network, batch, distances):
    """`loss_and_grad` of the submission."""
    return t.call("loss_and_grad", network, batch, distances, returns=loss_spec(network))


def case(t, rays, count):
    """(network, batch, t), no ReLU near its kink."""
    for _ in range(200):
        network, batch = network_of(t.rng), random_views(t.rng, rays)
        distances = ascending(t.rng, rays, count)
        p = batch["origins"][:, None] + distances[..., None] * batch["directions"][:, None]
        d = np.repeat(batch["directions"], count, axis=0)
        _, _, *passed = field(t, network, p.reshape(-1, 3), d)
        pairs = zip(network.values(), passed, strict=True)
        if all(is_away_from_kinks(layers, each) for layers, each in pairs):
            return network, batch, distances
    return t.require(False, "not telling")


def moved(network, array, change):
    """The network with one of its arrays changed."""
    return {
        name: [each + change if each is array else each for each in layers]
        for name, layers in network.items()
    }


@check(
    "12.5.fog",
    points=3,
    hint="handout, equations (16), (17): lengths of steps sum to far - near; mean over rays",
    sole="a case with a closed form, for distances of any kind",
)
def the_loss_of_even_fog(t):
    """A constant field: pixels have a closed form, whatever the distances are."""
    network = {name: [0.0 * a for a in layers] for name, layers in network_of(t.rng).items()}
    network["trunk"][-1][0] = 0.3
    network["head"][-1] = np.log(np.array([1.0, 3.0, 0.25]))
    through = np.exp(-2.0 * np.log1p(np.exp(0.3)))
    for rays, count in ((1, 1), (4, 3), (6, 9)):
        batch = random_views(t.rng, rays)
        pixel = (1 - through) * np.array([0.5, 0.75, 0.2]) + through * batch["background"]
        expected = np.sum((pixel - batch["colors"]) ** 2, axis=1).mean()
        loss, _ = loss_of(t, network, batch, ascending(t.rng, rays, count))
        t.close(f"loss of {rays} rays with {count} distances", loss, expected, reveal=True)


@check(
    "12.5.differences",
    points=5,
    tolerance=GATE,
    hint="handout, equations (18) to (20), backward: pixels, head, features, trunk",
    sole="the whole chain, each array of the network apart, without the reference",
)
def the_gradient_agrees_with_differences(t):
    """A small change of any weight or bias changes your loss as your derivative says."""
    network, batch, distances = case(t, 3, 4)
    _, d_network = loss_of(t, network, batch, distances)
    slopes = dict(flat(d_network))
    for label, array in flat(network):
        for _ in range(4):
            way = random_cotangent(t.rng, array.shape)
            ahead, behind = (
                loss_of(t, moved(network, array, step * way), batch, distances)[0]
                for step in (1e-5, -1e-5)
            )
            got, expected = np.vdot(slopes[label], way), (ahead - behind) / 2e-5
            t.close(f"derivative with respect to {label}, along a line", got, expected)


@check(
    "12.5.split",
    points=2,
    hint="a mean over rays: half of the batch has a gradient of the same size",
    sole="says that batches of any size have comparable gradients",
)
def a_batch_is_the_mean_of_its_halves(t):
    """Loss and gradient of six rays are the means of those of the first and last three."""
    network, batch = network_of(t.rng), random_views(t.rng, 6)
    distances = ascending(t.rng, 6, 5)
    whole, parts = loss_of(t, network, batch, distances), []
    for chosen in (slice(0, 3), slice(3, 6)):
        names = ("origins", "directions", "colors")
        half = {**batch, **{name: batch[name][chosen] for name in names}}
        parts.append(loss_of(t, network, half, distances[chosen]))
    t.close("loss", whole[0], (parts[0][0] + parts[1][0]) / 2)
    both = zip(flat(whole[1]), flat(parts[0][1]), flat(parts[1][1]), strict=True)
    for (name, mine), (_, first), (_, second) in both:
        t.close(f"d_{name}", mine, (first + second) / 2)
