"""Task 04.3, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import upper_directions

from ..common import SHARP
from .common import pairs


@hidden_check(
    "04.3.hidden",
    points=2,
    calls=("ggx_pdf",),
    needs=("ggx_lobe",),
    tolerance=SHARP,
    sole="the same mistakes at unseen directions",
    battery=[Subject("ggx_pdf", pairs, lambda n: Array((n,)), rows=(0, 1, 2))],
)
def densities_anywhere(t):
    """The density is right anywhere."""
    wo, wi = upper_directions(t.rng, 60, 0.02), upper_directions(t.rng, 60, 0.02)
    r = t.rng.uniform(0.1, 1.0, 60)
    got = t.call("ggx_pdf", wo, wi, r, returns=Array((60,)))
    t.close("density", got, t.reference.ggx_pdf(wo, wi, r))
