"""Diffusion profiles beside random walks: `python docs/figures_diffusion.py` writes diffusion.png.

On top, how much light leaves a half space at a distance from where a thin beam enters it: the
random walk of the path tracer, the dipole and normalized diffusion, for three albedos. Below, a
disc of light on the same half space, path traced, and by convolution with each profile. `check`
asserts what the caption says.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.lights import SpotLight
from photograd.subsurface import (
    diffusion_cdf,
    dipole,
    dipole_albedo,
    half_space_albedo,
    normalized_diffusion,
)
from photograd.transport import (
    BOUNDARY,
    Material,
    Medium,
    ParticleOptions,
    PathTracer,
    Receiver,
    Scene,
    emit_particles,
    trace_light,
)
from photograd.transport.camera_place import camera_at
from photograd.transport.shapes import box

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
ALBEDOS = (0.5, 0.9, 0.99)
# Lengths are in mean free paths, 1 / (sigma_s' + sigma_a). The half space is a box of 200 by 200
# by 40 of them: light falls off as exp(-q z), q = 0.17 for an albedo of 0.99, and has to come back.
WIDTH, DEPTH = 200.0, 40.0
EDGES = np.array([0.0, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0])
PARTICLES, PIXELS = 1_000_000, 72
# The lit disc: red light goes far and is hardly absorbed, blue light neither.
WAX = Medium([1.0, 2.0, 4.0], [0.99, 0.97, 0.9])
DISC, VIEW = 1.5, 8.0  # radius of the disc, side of the picture


def medium(albedo: float, g: float = 0.0) -> Medium:
    """Of reduced extinction 1 and reduced albedo `albedo`: similarity theory."""
    sigma_s, sigma_a = albedo / (1 - g), 1 - albedo
    return Medium(sigma_s + sigma_a, sigma_s / (sigma_s + sigma_a), values={"g": g})


def half_space(inside: Medium, light: Any, *, eta: float = 1.0) -> Scene:
    """Z < 0 filled with a medium, behind a boundary that refracts if eta is not 1."""
    material = BOUNDARY if eta == 1 else "surface"
    slab = replace(
        box("slab", [0, 0, -DEPTH / 2], [WIDTH, WIDTH, DEPTH], material), interior="inside"
    )
    glass = {"surface": Material("glass", {"eta": eta, "tint": [1.0, 1.0, 1.0]})}
    seen = camera_at([0, 0, 1], [0, 0, 0], 1.0, 1, 1)  # nothing is seen: particles are counted
    return Scene(
        "half space", (slab,), {} if eta == 1 else glass, seen, None, (light,),
        media={"inside": inside},
    )  # fmt: skip


def walks(inside: Medium) -> ParticleOptions:
    """No chance but that of the walk, up to where 1e-5 of a particle is left."""
    depth = np.log(1e-5) / np.log(float(np.max(inside.albedo)))
    return ParticleOptions(min(4000, int(depth) + 2), roulette_from=None)


@dataclass(frozen=True)
class Walk:
    """Light that leaves a half space, of a thin beam along the normal, each of what has entered.

    Attributes:
        total, total_error: all of it, and its standard error.
        rings, ring_errors: (K,) what leaves between two radii of EDGES.
        areas: (K,) of the rings, as the sensor's cells make them.
    """

    total: float
    total_error: float
    rings: Array
    ring_errors: Array
    areas: Array


def walk(
    albedo: float, particles: int, *, seed: int, eta: float = 1.0, g: float = 0.0, cells: int = 400
) -> Walk:
    """Particles of the path tracer into a half space, counted just above it."""
    beam = SpotLight([0, 0, 0.1], [0, 0, -1], [1.0, 1.0, 1.0], 1 - 1e-9, 1e-3)
    inside = medium(albedo, g)
    tracer = PathTracer(half_space(inside, beam, eta=eta), dtype=np.float64)
    power = float(emit_particles(tracer, 1, seed=seed).flux[0, 0])
    # What is mirrored has not entered, and comes back straight up.
    mirrored = ((eta - 1) / (eta + 1)) ** 2

    def sensor(width: float, n: int) -> tuple[Array, Array, Receiver]:
        corner, height = width / 2, 1e-2  # above what counts as lying on the boundary
        receiver = Receiver([-corner, corner, height], [width, 0, 0], [0, -width, 0], n, n)
        found = trace_light(tracer, receiver, particles, seed=seed, options=walks(inside))
        scale = receiver.cell_area / (power * (1 - mirrored))
        return found.mean[..., 0] * scale, found.standard_error[..., 0] * scale, receiver

    whole, whole_error, _ = sensor(WIDTH, 1)
    total = float(whole[0, 0]) - mirrored / (1 - mirrored)
    if cells == 0:
        none = np.zeros(0)
        return Walk(total, float(whole_error[0, 0]), none, none, none)
    leaves, errors, receiver = sensor(2 * EDGES[-1], cells)
    middles = (np.arange(cells) + 0.5) / cells * 2 * EDGES[-1] - EDGES[-1]
    ring = np.digitize(np.hypot(middles[:, None], middles), EDGES).ravel() - 1
    count = len(EDGES) - 1

    def summed(values: Array) -> Array:
        return np.bincount(ring, values.ravel(), minlength=count + 1)[:count]

    rings = summed(leaves)
    rings[0] -= mirrored / (1 - mirrored)
    areas = summed(np.full_like(leaves, receiver.cell_area))
    return Walk(total, float(whole_error[0, 0]), rings, np.sqrt(summed(errors**2)), areas)


def dipole_rings(albedo: float, eta: float = 1.0) -> Array:
    """(K,) what the dipole lets out between two radii of EDGES."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    low, high = EDGES[:-1, None], EDGES[1:, None]
    r = 0.5 * (high + low) + 0.5 * (high - low) * nodes
    found = 2 * np.pi * r * dipole(r, albedo, 1 - albedo, eta)
    return np.asarray((found * weights).sum(axis=1) * 0.5 * (high - low)[:, 0])


def normalized_rings(surface_albedo: float) -> Array:
    """(K,) the same of normalized diffusion."""
    inside = np.append(0.0, diffusion_cdf(EDGES[1:], surface_albedo, 1.0))
    return surface_albedo * np.diff(inside)


def misplaced(rings: Array, walked: Walk) -> float:
    """The part of the light that a profile lets out in another ring than the walk does."""
    return float(np.abs(rings - walked.rings).sum() / walked.rings.sum())


def disc_by_walks(particles: int, pixels: int, seed: int = 1) -> Array:
    """(pixels, pixels, 3) the exitance of a lit disc, over its irradiance."""
    height = 1000.0
    cos_outer = float(np.cos(np.arctan(DISC / height)))
    light = SpotLight([0, 0, height], [0, 0, -1], [height**2] * 3, cos_outer, 1e-3)
    tracer = PathTracer(half_space(WAX, light), dtype=np.float64)
    receiver = Receiver([-VIEW / 2, VIEW / 2, 1e-2], [VIEW, 0, 0], [0, -VIEW, 0], pixels, pixels)
    return trace_light(tracer, receiver, particles, seed=seed, options=walks(WAX)).mean


def disc_by_profile(profile: Any, pixels: int) -> Array:
    """(pixels, pixels) the same by convolution with profile(r): what of each circle is lit."""
    nodes, weights = np.polynomial.legendre.leggauss(300)
    r = np.exp(-3.5 + 7.5 * nodes)  # 1e-5 to 50
    around = 7.5 * weights * 2 * np.pi * r**2 * profile(r)
    rho = np.linspace(1e-6, VIEW, 600)[:, None]
    lit = np.arccos(np.clip((rho**2 + r**2 - DISC**2) / (2 * rho * r), -1, 1)) / np.pi
    middles = (np.arange(pixels) + 0.5) / pixels * VIEW - VIEW / 2
    return np.interp(np.hypot(middles[:, None], middles), rho[:, 0], lit @ around)


def discs(particles: int = PARTICLES, pixels: int = PIXELS) -> dict[str, Array]:
    """{title: exitance (pixels, pixels, 3) of the lit disc over its irradiance}."""
    sigma_t, albedo = np.asarray(WAX.sigma_t), np.asarray(WAX.albedo)
    surface = half_space_albedo(albedo)

    def channels(profile: Any) -> Array:
        return np.stack(
            [disc_by_profile(lambda r, c=c: profile(r, c), pixels) for c in range(3)], axis=2
        )

    middles = (np.arange(pixels) + 0.5) / pixels * VIEW - VIEW / 2
    inside = np.hypot(middles[:, None], middles) < DISC
    return {
        "no subsurface scattering": inside[..., None] * surface,
        "random walk": disc_by_walks(particles, pixels),
        "dipole": channels(
            lambda r, c: dipole(r, albedo[c] * sigma_t[c], (1 - albedo[c]) * sigma_t[c])
        ),
        "normalized diffusion": channels(
            lambda r, c: normalized_diffusion(r, surface[c], 1 / sigma_t[c])
        ),
    }


def outside_of_the_disc(picture: Array) -> Array:
    """(3,) the part of the light in the picture that leaves where none enters."""
    middles = (np.arange(len(picture)) + 0.5) / len(picture) * VIEW - VIEW / 2
    dark = np.hypot(middles[:, None], middles) > DISC
    return np.asarray(picture[dark].sum(axis=0) / picture.sum(axis=(0, 1)))


def check(walked: dict[float, Walk], pictures: dict[str, Array]) -> dict[str, float]:
    """Raises AssertionError unless the caption is true; returns the numbers that it rests on."""
    numbers: dict[str, float] = {}
    for albedo, found in walked.items():
        whole = float(dipole_albedo(albedo, 1 - albedo))
        numbers[f"dipole over walk, {albedo}"] = whole / found.total
        surface = float(half_space_albedo(albedo))
        numbers[f"normalized over walk, {albedo}"] = surface / found.total
        numbers[f"misplaced by the dipole, {albedo}"] = misplaced(dipole_rings(albedo), found)
        placed = normalized_rings(surface)
        numbers[f"misplaced by normalized diffusion, {albedo}"] = misplaced(placed, found)
    for title, picture in pictures.items():
        numbers[f"red outside, {title}"] = float(outside_of_the_disc(picture)[0])
        numbers[f"blue outside, {title}"] = float(outside_of_the_disc(picture)[2])
    return numbers
