"""Task 07.3, hidden checks."""

from photograd_course.grading import Array, Subject, hidden_check

from ..common import EXACT, TASK_3, direct
from .common import estimated, looked_at, mixed_room


@hidden_check(
    "07.3.hidden",
    points=6,
    calls=("direct_light",),
    needs=TASK_3,
    tolerance=EXACT,
    sole="the same random numbers, two lights, shadows, and another proposal",
    battery=[Subject("direct_light", estimated, lambda n: Array((n, 3)), rows=(1, 2, 3))],
)
def direct_light_of_a_room(t):
    """A room with two lights, a ball and shadows, compared with the solution number by number."""
    scene = mixed_room(t)
    other = {
        **scene,
        "roughness": scene["roughness"] + 0.15,
        "matte": ~scene["matte"],
        "base_color": scene["base_color"] / 2,
    }
    hit = looked_at(t, scene, 300)
    u = t.rng.random((2, len(hit["primitive"]), 3))
    for proposal in (None, other):
        right = t.reference.direct_light(scene, hit, u[0], u[1], proposal)
        t.close("direct light", direct(t, scene, hit, u, proposal), right)
