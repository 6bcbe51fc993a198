"""Task 07.6, hidden checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Subject, checks_for
from photograd_course.grading.adjoint_gate import random_cotangent

from ..common import TASK_3, furnace, nodes, scene_of
from ..task_6 import GATE, slopes
from .common import estimated, looked_at, mixed_room

check = checks_for(calls=("direct_light_backward",), visibility="hidden")


def surrounded(t, n):
    """Arguments of `direct_light_backward`, for n rows whose samples all hit an emitter."""
    return *furnace(t, n), *t.rng.random((2, n, 3)), random_cotangent(t.rng, (n, 3))


@check(
    "07.6.hidden",
    points=2,
    needs=TASK_3,
    tolerance=GATE,
    sole="two lights, shadows, a ball and a matte primitive",
    battery=[
        Subject(
            "direct_light_backward",
            lambda t, n: (*estimated(t, n), random_cotangent(t.rng, (n, 3))),
            lambda _: Items(Array((5, 3)), Array((5,))),
        ),
        Subject("direct_light_backward", surrounded, lambda _: Items(Array((7, 3)), Array((7,)))),
    ],
)
def the_gradient_of_a_room(t):
    """A room with two lights, a ball and shadows, compared with the solution."""
    scene = mixed_room(t)
    hit = looked_at(t, scene, 1000)  # fewer: too few BSDF samples hit a light
    n = len(hit["primitive"])
    u, d = t.rng.random((2, n, 3)), random_cotangent(t.rng, (n, 3))
    right = t.reference.direct_light_backward(scene, hit, u[0], u[1], d)
    got = slopes(t, scene, hit, d, u)
    t.close("d_base_color", got["base_color"], right[0])
    t.close("d_roughness", got["roughness"], right[1])


def glossy_table(color, metalness, roughness):
    """A table under a light, and the rays of a small image of it."""
    table = ((-1, 0, -1), (0, 0, 2), (2, 0, 0))
    light = ((-0.5, 0.4, -1.0), (1.0, 0, 0), (0, 0.5, 0.4), {"emission": [6, 5, 4]})
    given = {"base_color": color, "metalness": metalness, "roughness": roughness}
    return scene_of([(*table, given), light])


@check(
    "07.6.recover",
    points=3,
    needs=(*TASK_3, "direct_light"),
    sole="the application: a base color and a roughness, recovered from an image",
)
def a_material_is_recovered(t):
    """The base color within 0.01 and the roughness within 0.02, from an unseen image."""
    # A smooth table, or one channel far from the others, takes more steps than these.
    color, roughness = t.rng.uniform(0.3, 0.8, 3), float(t.rng.uniform(0.35, 0.5))
    truth = glossy_table(color, 0.5, roughness)
    start = glossy_table([0.5, 0.5, 0.5], 0.5, 0.6)
    origins, directions = t.reference.camera_rays(10, 7, [0, 0.9, 1.2], [0, 0, -0.3], 45)
    hit = t.reference.closest_hit(truth, origins, directions)
    seen = hit["primitive"] == 0
    uv, weights = nodes(12)
    many = t.reference.repeated(t.reference.take(hit, seen), len(uv))
    u3 = np.tile(np.column_stack([0 * uv[:, 0], uv]), (int(seen.sum()), 1))
    wi, far, light = t.reference.sample_light(truth, many["points"], u3)
    pdf = t.reference.light_pdf(truth, light, wi, far)
    factor = np.maximum(np.sum(wi * many["normals"], axis=1), 0) / pdf
    sent = t.reference.brdf(truth, many, wi) * factor[:, None] * truth["emission"][1]
    picture = np.zeros((len(seen), 3))
    picture[seen] = np.einsum("nkc,k->nc", sent.reshape(-1, len(uv), 3), weights)
    parts = Items(Array((3,)), Number(), names=("base_color", "roughness"))

    def off():
        seed = int(t.rng.integers(2**31))
        found, rough = t.call(
            "adapters.recovered", start, 0, origins, directions, picture, 60, seed, returns=parts
        )
        return max(float(np.abs(found - color).max()) / 0.01, abs(rough - roughness) / 0.02)

    worst = off()
    worst = off() if worst > 1 else worst
    t.require(worst <= 1, f"what is found is off by {worst:.1f} times what is allowed")
