"""Task 04.5, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Subject, hidden_check
from photograd_course.grading.generators import upper_directions

from ..common import EXACT, material, shaded
from .common import painted


@hidden_check(
    "04.5.hidden",
    points=3,
    calls=("gltf",),
    needs=("ggx_lobe",),
    tolerance=EXACT,
    sole="the same mistakes with unseen materials",
    battery=[Subject("gltf", painted, lambda n: Array((n, 3)), rows=range(5))],
)
def materials_anywhere(t):
    """Random materials, the ends of all parameters among them."""
    wo, wi = upper_directions(t.rng, 60, 0.02), upper_directions(t.rng, 60, 0.02)
    color, m, r = material(t.rng, 60)
    m[:10], m[10:20], color[20:30] = 0.0, 1.0, np.eye(3)[t.rng.integers(0, 3, 10)]
    t.close("f", shaded(t, wo, wi, color, m, r), t.reference.gltf(wo, wi, color, m, r))
