"""Task 04.2, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import upper_directions

from ..common import SHARP, lobes
from .common import pairs


@hidden_check(
    "04.2.hidden",
    points=3,
    calls=("ggx_lobe",),
    tolerance=SHARP,
    sole="the same mistakes at unknown directions, and on polished surfaces",
    battery=[Subject("ggx_lobe", pairs, lambda n: Array((n,)), rows=(0, 1, 2))],
)
def lobes_anywhere(t):
    """The lobe is right anywhere, and where it is sharp."""
    wo, wi = upper_directions(t.rng, 60, 0.02), upper_directions(t.rng, 60, 0.02)
    r = t.rng.uniform(0.3, 1.0, 60)
    got = t.call("ggx_lobe", wo, wi, r, returns=Array((60,)))
    t.close("lobe", got, t.reference.ggx_lobe(wo, wi, r))
    for sharp in (0.045, 0.15):
        wi = wo * [-1, -1, 1] + t.rng.normal(size=(60, 3)) * sharp**2 / 3
        wi /= np.linalg.norm(wi, axis=1, keepdims=True)
        right = t.reference.ggx_lobe(wo, wi, np.full(60, sharp))
        t.close(f"lobe at roughness {sharp}", lobes(t, wo, wi, sharp), right)
