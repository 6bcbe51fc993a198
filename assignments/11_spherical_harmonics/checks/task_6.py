"""Task 11.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, agree, checks_for
from photograd_course.grading.generators import random_rotation, unit_vectors

from .common import EXACT

CHAINED = Tolerance(
    1e-7, "right ones differ by at most 4e-16, the nearest wrong one (density_first) by 0.017"
)


def photographs(rng, views, pixels, away=3.2, view_angle=0.75):
    """Rays (2, views pixels^2, 3) of cameras distributed uniformly, that look at the center."""
    height = 1 - (np.arange(views) + 0.5) * 2 / views
    phi = np.arange(views) * np.pi * (3 - np.sqrt(5))
    ring = np.sqrt(1 - height**2)
    positions = np.stack(
        [ring * np.cos(phi), ring * np.sin(phi), height], axis=1
    ) @ random_rotation(rng)
    tangent = ((np.arange(pixels) + 0.5) / pixels * 2 - 1) * np.tan(view_angle / 2)
    origins, directions = [], []
    for position in positions:
        right = np.cross(position, unit_vectors(rng, 1)[0])
        right /= np.linalg.norm(right)
        down = np.cross(position, right)
        d = -position + (tangent[:, None, None] * down + tangent[None, :, None] * right)
        directions.append((d / np.linalg.norm(d, axis=-1, keepdims=True)).reshape(-1, 3))
        origins.append(np.tile(away * position, (pixels**2, 1)))
    return np.stack([np.concatenate(origins), np.concatenate(directions)])


def fitted(t, density, coefficients, rays, target, levels, steps, function="fit_plenoxels"):
    """`fit_plenoxels` of the submission."""
    fine = tuple(side * 2 ** (levels - 1) for side in density.shape)
    parts = (Array(fine), Array((*fine, *coefficients.shape[3:])), Array((levels * steps,)))
    spec = Items(*parts, names=("density", "coefficients", "losses"))
    args = (density, coefficients, rays, target, levels, steps)
    return t.call(function, *args, returns=spec)


def small_case(rng, shape=(2, 3, 2), channels=1):
    """Density, coefficients, rays and target, small and without meaning."""
    density = rng.uniform(0.5, 1.5, shape)
    rays = photographs(rng, 3, 4)
    c = rng.uniform(-0.5, 0.5, (*shape, 4, channels))
    return density, c, rays, rng.uniform(0.0, 1.0, (rays.shape[1], channels))


EARLIER = ("sh_basis", "sh_color_adjoint")

check = checks_for(calls=("fit_plenoxels",), needs=EARLIER)


@check(
    "11.6.refine",
    points=3,
    tolerance=EXACT,
    hint="handout, equation (21): where do the eight new cells lie in the old ones? An array "
    "twice too large: refinement stands between levels, not after the last",
    sole="tests the refinement only",
)
def refinement_keeps_what_is_even(t):
    """Without steps, two levels only refine: linear functions stay, border values repeat."""
    shape = np.array([3, 2, 4])
    rays = photographs(t.rng, 1, 2)
    slopes, four = t.rng.uniform(0.1, 0.5, 3), t.rng.uniform(-1.0, 1.0, (4, 2))
    cells = np.stack(np.indices(tuple(shape)), axis=-1)
    density = 0.5 + cells @ slopes
    got, c, _ = fitted(
        t, density, density[..., None, None] * four, rays, np.zeros((rays.shape[1], 2)), 2, 0
    )
    place = np.stack(np.indices(tuple(2 * shape)), axis=-1) / 2 - 0.25
    expected = 0.5 + np.clip(place, 0, shape - 1) @ slopes
    t.close("density", got, expected, reveal=True)
    t.close("coefficients", c, expected[..., None, None] * four)


@check(
    "11.6.first",
    points=2,
    tolerance=CHAINED,
    hint="handout, equations (22) and (23), both in each step",
    sole="tests the first two steps only",
)
def the_first_steps(t):
    """Adam's first step has the length RATE against the gradient; none sees a density below 0."""
    density, c, rays, target = small_case(t.rng)
    density = density / 10
    parts = Items(
        Number(),
        Array(density.shape),
        Array(c.shape),
        names=("loss", "d_density", "d_coefficients"),
    )
    given = t.call("adapters.gradient", density, c, rays, target, returns=parts)
    got = fitted(t, density, c, rays, target, 1, 1)
    loss, d_density, d_c = (np.asarray(each) for each in given)
    moved = density - 0.1 * d_density / (np.abs(d_density) + 1e-8)
    t.require(bool((moved < 0).any() and (moved > 0).any()), "the test case is not informative")
    t.close("coefficients", got[1], c - 0.1 * d_c / (np.abs(d_c) + 1e-8))
    t.close("density", got[0], np.maximum(moved, 0))
    t.close("losses", got[2], loss[None])
    given = t.call("adapters.gradient", *got[:2], rays, target, returns=parts)
    then = fitted(t, density, c, rays, target, 1, 2)
    for name, k, first in (("density", 0, d_density), ("coefficients", 1, d_c)):
        second = np.asarray(given[k + 1])
        m = (0.09 * first + 0.1 * second) / (1 - 0.9**2)
        v = (0.0099 * first**2 + 0.01 * second**2) / (1 - 0.99**2)
        moved = got[k] - 0.1 * m / (np.sqrt(v) + 1e-8)
        expected = np.maximum(moved, 0) if name == "density" else moved
        t.close(f"{name} after two steps", then[k], expected)


@check(
    "11.6.chain",
    points=2,
    tolerance=CHAINED,
    hint="refine before every level but the first; then march, two new Adams, `steps` steps",
    sole="counts levels, steps and losses",
)
def levels_can_be_chained(t):
    """Two levels are one level, a refinement, and one level more."""
    density, c, rays, target = small_case(t.rng, channels=2)
    both = fitted(t, density, c, rays, target, 2, 3)
    one = fitted(t, density, c, rays, target, 1, 3)
    finer = fitted(t, one[0], one[1], rays, target, 2, 0)
    two = fitted(t, finer[0], finer[1], rays, target, 1, 3)
    t.close("losses", both[2], np.concatenate([one[2], two[2]]))
    t.close("density", both[0], two[0])
    t.close("coefficients", both[1], two[1])


@check(
    "11.6.start",
    points=1,
    hint="often an array of the start is written into, or given back: copy it first",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_start_is_left_alone(t):
    """A second fit from the same arrays finds what the first one found."""
    given = (*small_case(t.rng), 2, 2)
    same = agree(fitted(t, *given, function="adapters.fit_again"), fitted(t, *given))
    t.require(same, "a second fit from the same start ends elsewhere")
