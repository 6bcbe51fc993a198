"""Task 12.5, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, hidden_check
from photograd_course.grading.adjoint_gate import require_cheap

from ..common import EXACT, ascending, field_spec, flat, loss_spec, network_of, random_views
from ..task_5 import EARLIER, loss_of

SHAPES = network_of(np.random.default_rng(0))
# One forward pass of the field against loss and gradient: 3 to 5 with whole arrays, 30 in loops
# over rays, 3,000 for differences.
COST = 300.0


def given(t, n):
    """Arguments of `loss_and_grad` for n distances on each of three rays."""
    return network_of(t.rng), random_views(t.rng, 3), ascending(t.rng, 3, n)


@hidden_check(
    "12.5.hidden",
    points=3,
    calls=("loss_and_grad",),
    needs=EARLIER,
    tolerance=EXACT,
    sole="the same mistakes in unseen batches",
    battery=[Subject("loss_and_grad", given, lambda _: loss_spec(SHAPES), large=300)],
)
def gradients_of_random_batches(t):
    """Loss and gradient are right for random batches, and cheap."""
    for rays, count in ((1, 1), (2, 7), (100, 2)):
        network, batch = network_of(t.rng, 5, 3), random_views(t.rng, rays)
        distances = ascending(t.rng, rays, count)
        got = loss_of(t, network, batch, distances)
        right = t.reference.loss_and_grad(network, batch, distances)
        t.close("loss", got[0], right[0])
        for (name, mine), (_, theirs) in zip(flat(got[1]), flat(right[1]), strict=True):
            t.close(f"d_{name}", mine, theirs)
    network, batch = network_of(t.rng, 24, 16), random_views(t.rng, 6)
    distances = ascending(t.rng, 6, 8)
    p, d = t.reference.points_on(batch, distances)
    require_cheap(
        t,
        ("radiance_field", (network, p, d), field_spec(48, network)),
        ("loss_and_grad", (network, batch, distances), loss_spec(network)),
        COST,
    )
