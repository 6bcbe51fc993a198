"""Task 12.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, agree, checks_for

from .common import field, flat, like_network, loss_spec, network_of, random_views
from .task_3 import sampled
from .task_5 import EARLIER

CHAINED = Tolerance(1e-7, "right ones differ by at most 1e-9, wrong ones by more than 1e-6")
ALL = (*EARLIER, "sample_distances", "loss_and_grad")
check = checks_for(calls=("train_nerf",), needs=ALL, tolerance=CHAINED)


def trained(t, views, network, steps, seed=5, adapter="train"):
    """`train_nerf` of the submission."""
    parts = Items(like_network(network), Array((steps,)), names=("network", "losses"))
    return t.call(f"adapters.{adapter}", views, network, steps, seed, returns=parts)


def draws(t, views, seed, times):
    """What the steps of a training draw."""
    rays = min(32, len(views["colors"]))
    one = Items(Array((rays,), "i8"), Array((rays, 16)), Array((rays, 16)))
    return t.call("adapters.drawn", views, seed, times, returns=Items(*[one] * times))


def distances_of(t, views, network, drawn):
    """The distances of a step, put together from your functions, and the rays that it takes."""
    chosen, u, numbers = drawn
    names = ("origins", "directions", "colors")
    batch = {**views, **{name: views[name][chosen] for name in names}}
    ends = np.repeat([[views["near"], views["far"]]], len(u), axis=0)
    first = sampled(t, ends, np.ones((len(u), 1)), u)
    cuts = t.call("edges_between", first, *ends[0].tolist(), returns=Array((len(u), 17)))
    p, d = t.call("points_on", batch, first, returns=Items(Array((u.size, 3)), Array((u.size, 3))))
    dense = field(t, network, p, d)[0].reshape(first.shape)
    share = t.call("ray_weights", dense, np.diff(cuts), returns=Array(first.shape))
    second = sampled(t, cuts, share + 0.01, numbers)
    return batch, np.sort(np.hstack([first, second]))


def stepped(network, moments, d_network, k):
    """The network after step k of Adam, by the formulas of assignment 01; moments change."""
    after = {name: list(layers) for name, layers in network.items()}
    slopes = dict(flat(d_network))
    for name in network:
        for i in range(len(network[name])):
            label = f"{name} {'Wb'[i % 2]}{i // 2}"
            g, (m, v) = slopes[label], moments.get(label, (0.0, 0.0))
            m, v = 0.9 * m + 0.1 * g, 0.99 * v + 0.01 * g**2
            moments[label] = m, v
            after[name][i] = network[name][i] - 0.01 / (1 + k / 800) * (m / (1 - 0.9**k)) / (
                np.sqrt(v / (1 - 0.99**k)) + 1e-8
            )
    return after


def close_networks(t, what, got, expected):
    """Each array apart."""
    for (name, mine), (_, theirs) in zip(flat(got), flat(expected), strict=True):
        t.close(f"{name} {what}", mine, theirs)


@check(
    "12.6.first",
    points=4,
    hint="handout, equations (21) to (24), in this order",
    sole="tests the first two steps only",
)
def the_first_steps(t):
    """Two steps, with few rays and with many, end where your own functions say."""
    for rays in (5, 40):
        views, network = random_views(t.rng, rays), network_of(t.rng)
        expected, reached, moments = [], network, {}
        for k, drawn in enumerate(draws(t, views, 5, 2)):
            batch, distances = distances_of(t, views, reached, drawn)
            loss, d_network = t.call(
                "loss_and_grad", reached, batch, distances, returns=loss_spec(network)
            )
            expected.append(loss)
            reached = stepped(reached, moments, d_network, k + 1)
            got, losses = trained(t, views, network, k + 1)
            t.close(f"losses, {rays} rays", losses, np.array(expected))
            close_networks(t, f"after step {k + 1}, {rays} rays", got, reached)


@check(
    "12.6.start",
    points=1,
    hint="often an array of the start is written into, or given back: Adam.step returns new ones",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_start_is_left_alone(t):
    """A second training from the same network finds what the first one did."""
    views, network = random_views(t.rng, 4), network_of(t.rng)
    same = agree(
        trained(t, views, network, 2, adapter="train_again"), trained(t, views, network, 2)
    )
    t.require(same, "a second training from the same start ends elsewhere")
    close_networks(t, "after no steps", trained(t, views, network, 0)[0], network)
