"""Task 06.6, public checks."""

from itertools import product

import numpy as np
from photograd_course.grading import Array, Items, checks_for
from photograd_course.grading.adjoint_gate import (
    agrees_with_finite_differences,
    random_cotangent,
    require_zero_for_zero,
)

from .common import EXACT, FAITHFUL, GATE, rays_of, unit

check = checks_for(calls=("ambient_occlusion",), tolerance=EXACT)
REACH, BIAS = 0.8, 0.08


def occluded(t, depth, *rest):
    """(open_sky, d_settings) of the submission."""
    spec = Items(Array(depth.shape), Array((3,)), names=("open_sky", "d_settings"))
    return t.call("ambient_occlusion", depth, *rest, returns=spec)


def disk(t, height, width, samples):
    """Offsets (H, W, S, 2) at random in a disk of radius 1."""
    phi = t.rng.uniform(0, 2 * np.pi, (height, width, samples))
    r = np.sqrt(t.rng.uniform(0.01, 1.0, phi.shape))
    return np.stack([r * np.cos(phi), r * np.sin(phi)], axis=3)


def bumpy(t, height, width, samples=6):
    """depth, normals, focal, offsets, settings, d_open: a rough wall with holes."""
    focal = 1.2 * width
    depth = 3.0 + 0.25 * t.rng.random((height, width))
    depth[t.rng.random((height, width)) < 0.1] = np.inf
    normals = -unit(rays_of(height, width, focal)) + 0.3 * t.rng.normal(size=(height, width, 3))
    settings = np.array([t.rng.uniform(0.7, 1.1), t.rng.uniform(2.2, 3.0), t.rng.uniform(1.0, 2.0)])
    offsets = disk(t, height, width, samples)
    return depth, unit(normals), focal, offsets, settings, random_cotangent(t.rng, depth.shape)


@check(
    "06.6.plane",
    points=2,
    tolerance=FAITHFUL,
    hint="handout, equations (24) to (26): the points of a plane are not above it; BIAS keeps "
    "rounding from lifting some of them",
    sole="planes and sky",
)
def a_plane_hides_nothing(t):
    """A plane is open everywhere, at any slant, beside holes and at the picture's border too."""
    height, width, focal = 16, 22, 20.0
    rays = rays_of(height, width, focal)
    for slant in (0.0, 0.7, 1.1):
        turn = t.rng.uniform(0, 2 * np.pi)
        n = np.array([np.sin(slant) * np.cos(turn), np.sin(slant) * np.sin(turn), -np.cos(slant)])
        depth = np.maximum(-3.0 * np.cos(slant) / np.minimum(rays @ n, -0.05), 0.5)
        depth[(rays @ n > -0.05) | (t.rng.random((height, width)) < 0.2)] = np.inf
        normals = np.tile(n, (height, width, 1))
        rest = normals, focal, disk(t, height, width, 8), np.array([8.0, 1.0, 3.0])
        open_sky, d_settings = occluded(t, depth, *rest, np.ones((height, width)))
        t.close("open sky", open_sky, np.ones((height, width)), reveal=True)
        given = ", ".join(f"{value:.2g}" for value in d_settings)
        t.require(
            not d_settings.any(), f"where nothing is hidden, d_settings is 0; yours is {given}"
        )


@check(
    "06.6.step",
    points=4,
    hint="handout, equations (24) to (28): a sample reads the pixel of (24), whose + ½ is the "
    "center; it hides by the sine of its elevation and by its distance",
    sole="a closed form, one sample at a time",
)
def a_step_in_depth(t):
    """Next to a step in depth a sample hides what elevation and distance say; more if higher."""
    height, width, focal, far = 9, 30, 40.0, 3.0
    normals = np.tile([0.0, 0.0, -1.0], (height, width, 1))
    r, k, factor = 1.5, 2.5, 1.4
    row, column, moves = 4, 10, np.array([5, 2])
    right, found = [], []
    # From the center of the pixel: a little to the right and up of the other's, then left and down.
    for step, aside in product((0.0, 0.1, 0.2, 0.4), ((0.2, -0.3), (-0.3, 0.2))):
        offset = (moves + np.array(aside)) * far / (REACH * focal)
        depth = np.full((height, width), far)
        depth[:, 13:] = far - step
        offsets = np.zeros((height, width, 2, 2))
        offsets[row, column, 0] = offset
        rest = normals, focal, offsets, np.array([r, k, factor])
        open_sky, _ = occluded(t, depth, *rest, np.zeros((height, width)))
        ends = rays_of(height, width, focal)[[row, row + 2], [column, column + 5]]
        away = (ends[1] * (far - step) - ends[0] * far) @ np.eye(3)
        square = away @ away
        hides = max(step / np.sqrt(square) - BIAS, 0.0) * (1 - square / r**2) ** k
        right.append(1 - factor * hides / 2)
        found.append(open_sky[row, column])
        rest = normals, focal, disk(t, height, width, 12), np.array([2.0, 1.0, 1.0])
        open_sky, _ = occluded(t, depth, *rest, np.zeros((height, width)))
        found.append(open_sky[:, 8:13].mean())
    t.close("open sky of a pixel", np.array(found[::2]), np.array(right), reveal=True)
    t.require(bool((np.diff(found[1::4]) < 0).all()), "a higher step hides more")


@check(
    "06.6.differences",
    points=4,
    tolerance=GATE,
    hint="handout, equation (29): derivatives with respect to radius, falloff and strength",
    adjoints=("ambient_occlusion",),
    sole="the adjoint against finite differences",
)
def the_adjoint_agrees_with_finite_differences(t):
    """Derivatives with respect to each setting, of your own forward pass."""
    for _ in range(2):
        *rest, settings, g = bumpy(t, 12, 15)
        _, d_settings = occluded(t, *rest, settings, g)
        for k, name in enumerate(("radius", "falloff", "strength")):

            def forward(at, k=k, rest=rest, settings=settings):
                moved = settings.copy()
                moved[k] = at["setting"][0]
                return occluded(t, *rest, moved, np.zeros(rest[0].shape))[0]

            point = {"setting": settings[[k]]}
            got = {"setting": d_settings[[k]]}
            t.require(
                bool(d_settings[k]), f"d_settings: the derivative with respect to {name} is not 0"
            )
            agrees_with_finite_differences(t, got, forward, point, g)
    *_, zero = occluded(t, *rest, settings, np.zeros_like(g))
    require_zero_for_zero(t, {"settings": zero})


@check(
    "06.6.tuned",
    points=1,
    seconds=60.0,
    needs=("rasterize", "hit_sphere", "hit_triangle"),
    hint="the experiment also uses your rasterize, and your hit_sphere and hit_triangle of 05",
    sole="the experiment: descent through the adjoint, toward the truth",
)
def settings_are_found_by_descent(t):
    """In the scene, descent brings the occlusion nearer to the traced one, by a fifth at least."""
    spec = Items(Array((3,)), Array((25,)), names=("settings", "losses"))
    start = np.array([0.5, 1.0, 1.0])
    settings, losses = t.call("adapters.tuned", 25, 40, start, 25, returns=spec)
    before, after = np.sqrt(losses[[0, -1]])
    said = f"the error is {before:.3f} before and {after:.3f} after 25 steps"
    # Solution: 0.23 and 0.13.
    t.require(bool(after < 0.8 * before), f"{said}: threshold 0.8 of the error before")
    t.require(bool((settings > 0).all()), "settings stay above 0")
