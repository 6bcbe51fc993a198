"""Task 14.5, hidden checks."""

from functools import cache

import numpy as np
from photograd_course.grading import Array, Items, Number, Subject, Tolerance, checks_for

from ..common import corner_scene, material_spec, rays_down
from ..task_5 import case, judged

check = checks_for(calls=("noisy_loss_and_grad",), needs=("replay_backward",), visibility="hidden")

REPLAYED = Tolerance(1e-8, "right ones differ by 1e-13, wrong ones by 1e-3 or more")


def arguments(t, n):
    """Arguments of `noisy_loss_and_grad` for n pixels."""
    picture = t.rng.uniform(0.1, 0.6, (n, 3))
    return corner_scene(t.rng), *rays_down(t.rng, n), picture, 3, 2, [4, 9]


@check(
    "14.5.hidden",
    points=2,
    tolerance=REPLAYED,
    sole="unseen scenes",
    battery=[
        Subject(
            "noisy_loss_and_grad",
            arguments,
            lambda _: Items(Number(), *material_spec({"matte": range(4)})),
            large=300,
        )
    ],
)
def unseen_scenes(t):
    """A corner, compared with the solution."""
    scene, rays, picture, seeds = case(t, 20)
    right = t.reference.noisy_loss_and_grad(scene, *rays, picture, 4, 4, seeds)
    loss, got = judged(t, scene, rays, picture, 4, 4, seeds)
    t.close("loss", loss, right[0])
    t.close("d_base_color", got["base_color"], right[1])
    t.close("d_roughness", got["roughness"], right[2])


COLOR, ROUGHNESS = (0.5691, 0.4716, 0.4845), 0.4062  # of the table to be recovered


@cache
def photograph(reference):
    """The pixels of the table in the niche, by 10,000 paths each."""
    scene, rays = reference.demo_niche(COLOR, ROUGHNESS), reference.niche_rays(8, 6)
    shown = reference.closest_hit(scene, *rays)["primitive"] == 0
    many = [np.repeat(each[shown], 1000, axis=0) for each in rays]
    seen = [reference.path_radiance(scene, *many, 3, 60 + k) for k in range(10)]
    return np.mean(seen, axis=0).reshape(-1, 1000, 3).mean(axis=1)


@check(
    "14.5.recover",
    points=3,
    seconds=30,
    sole="the application: a material, from an image of light that has been reflected twice",
)
def a_material_is_recovered(t):
    """The base color within 0.01 and the roughness within 0.02, from an unseen image.

    Material and seeds are fixed, so that every right submission finds the same to many digits.
    """
    start, rays = t.reference.demo_niche([0.5] * 3, 0.45), t.reference.niche_rays(8, 6)
    shown = t.reference.closest_hit(start, *rays)["primitive"] == 0
    rays = [each[shown] for each in rays]
    parts = Items(Array((3,)), Number(), names=("base_color", "roughness"))
    picture = photograph(t.reference)
    found = t.call("adapters.material_found", start, *rays, picture, 3, 24, 601, returns=parts)
    off = [*np.abs(found[0] - COLOR) / 0.01, abs(found[1] - ROUGHNESS) / 0.02]
    worst = float(np.max(off))
    t.require(worst <= 1, f"what is found is off by {worst:.2f} times what is allowed")
