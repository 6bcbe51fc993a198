"""Task 04.6, hidden checks."""

from photograd_course.grading import Array, Items, Subject, hidden_check
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import EXACT, material
from ..task_6 import NAMES, near_mirrors, slopes
from .common import painted


@hidden_check(
    "04.6.hidden",
    points=4,
    calls=("gltf_backward",),
    needs=("ggx_lobe", "gltf"),
    tolerance=EXACT,
    sole="eleven digits, which differences do not have",
    battery=[
        Subject(
            "gltf_backward",
            lambda t, n: (*painted(t, n), random_cotangent(t.rng, (n, 3))),
            lambda n: Items(Array((n, 3)), Array((n,)), Array((n,)), names=NAMES),
            rows=range(6),
        )
    ],
)
def derivatives_anywhere(t):
    """Every part of the adjoint is right to eleven digits."""
    wo, wi = near_mirrors(t.rng, 60)
    color, m, r = material(t.rng, 60)
    g = random_cotangent(t.rng, (60, 3))
    right = t.reference.gltf_backward(wo, wi, color, m, r, g)
    for name, mine, theirs in zip(
        NAMES, slopes(t, wo, wi, color, m, r, g).values(), right, strict=True
    ):
        t.close(name, mine, theirs)
