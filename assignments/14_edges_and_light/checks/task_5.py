"""Task 14.5, public checks."""

import numpy as np
from photograd_course.grading import Items, Number, Tolerance, checks_for

from .common import (
    EXACT,
    agrees_with_differences,
    corner_scene,
    material_spec,
    radiance_of,
    rays_down,
)

check = checks_for(calls=("noisy_loss_and_grad",), needs=("replay_backward",))

PATHS = Tolerance(1e-6, "central differences have an error of 1e-8, wrong ones of 1e-3 or more")


def judged(t, scene, rays, picture, depth, samples, seeds):
    """(loss, {name: derivative}) of `noisy_loss_and_grad`."""
    parts = Items(Number(), *material_spec(scene), names=("loss", "d_base_color", "d_roughness"))
    got = t.call("noisy_loss_and_grad", scene, *rays, picture, depth, samples, seeds, returns=parts)
    return got[0], {"base_color": got[1], "roughness": got[2]}


def residuals(t, scene, rays, picture, depth, samples, seed, proposal=None):
    """Pixels of one rendering, minus the picture."""
    copies = [np.repeat(each, samples, axis=0) for each in rays]
    seen = radiance_of(t, scene, copies, depth, seed, proposal)
    return seen.reshape(len(picture), samples, 3).mean(axis=1) - picture


def case(t, n=6):
    scene, rays = corner_scene(t.rng), rays_down(t.rng, n)
    seeds = [int(each) for each in t.rng.choice(10**6, 2, replace=False)]
    return scene, rays, t.rng.uniform(0.1, 0.6, (n, 3)), seeds


@check(
    "14.5.loss",
    points=2,
    tolerance=EXACT,
    hint="equation (19): the residuals of two renderings, multiplied pixel by pixel",
    sole="the loss by its definition",
)
def the_loss_of_two_renderings(t):
    """The loss, from two renderings with the given `path_radiance`."""
    for samples in (1, 3):
        scene, rays, picture, seeds = case(t)
        loss, _ = judged(t, scene, rays, picture, 3, samples, seeds)
        first, second = (residuals(t, scene, rays, picture, 3, samples, seed) for seed in seeds)
        t.close("loss", loss, np.mean(first * second / (picture + 0.1) ** 2), reveal=True)


@check(
    "14.5.differences",
    points=4,
    tolerance=PATHS,
    hint="equations (20) and (21): the derivative of each rendering meets the other's residual",
    sole="the definition: finite differences of the loss",
)
def the_gradient_agrees_with_differences(t):
    """Against finite differences of the loss, with directions and densities held fixed."""
    scene, rays, picture, seeds = case(t, 4)

    def forward(moved):
        off = [residuals(t, moved, rays, picture, 3, 2, seed, scene) for seed in seeds]
        return off[0] * off[1] / (picture + 0.1) ** 2

    _, got = judged(t, scene, rays, picture, 3, 2, seeds)
    agrees_with_differences(t, got, scene, forward, 1 / picture.size)
