"""Task 12.4, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, hidden_check

from ..common import EXACT, field, field_spec, network_of
from ..task_4 import samples

NETWORK = {"width": 5, "features": 3}
SHAPES = network_of(np.random.default_rng(0), **NETWORK)


def given(t, n):
    """Arguments of `radiance_field` for n points."""
    return network_of(t.rng, **NETWORK), *samples(t, n)


@hidden_check(
    "12.4.hidden",
    points=2,
    calls=("radiance_field",),
    needs=("positional_encoding",),
    tolerance=EXACT,
    sole="the same mistakes in unseen networks",
    battery=[Subject("radiance_field", given, lambda n: field_spec(n, SHAPES))],
)
def fields_of_random_networks(t):
    """Densities, colors and activations are right for random networks."""
    wide = network_of(t.rng, 120, 40), *samples(t, 3)
    for network, p, d in (given(t, 1), given(t, 6), wide):
        got, right = field(t, network, p, d), t.reference.radiance_field(network, p, d)
        for name, mine, theirs in zip(("sigma", "color"), got, right, strict=False):
            t.close(name, mine, theirs)
        for mine, theirs in zip((*got[2], *got[3]), (*right[2], *right[3]), strict=True):
            t.close("activations", mine, theirs)
