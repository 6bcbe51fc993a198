"""Cases of what starts from lights, of photon maps and of ambient occlusion."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from photograd.transport import (
    Accumulation,
    IrradianceSensor,
    ParticleOptions,
    PathOptions,
    PhotonMap,
    bake_ambient_occlusion,
    emit_particles,
    trace_light,
)

from fingerprint_cases.case import Arrays, Case
from fingerprint_cases.paths import sums_of, tracer_of

SENSOR = IrradianceSensor([-1.0, 0.05, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0], 5, 6)
PARTICLES = 3000
OPTIONS = {
    "default": ParticleOptions(),
    "depth-1": ParticleOptions(max_depth=1),
    "no-roulette": ParticleOptions(max_depth=5, roulette_from=None),
    "roulette-0": ParticleOptions(roulette_from=0),
}
SURFACES = (
    "stage",
    "model-glass",
    "model-disney",
    "model-gltf_refraction",
    "texture-mirror-mip",
    "opacity-textured",
    "mask",
    "lights-all",
    "lights-far-and-sky",
    "emitting-shapes",
    "instances",
    "bent-floor",
)
MEDIA = (
    "fog",
    "fog-lights",
    "fog-absorbing",
    "smoke",
    "smoke-majorant",
    "nested",
    "nested-smoke",
    "haze",
    "haze-lights-at-infinity",
    "haze-smoke",
    "signed-distances",
    "opacity-fog",
    "opacity-smoke",
    "boundary-alone",
)


def irradiance(scene: str, options: ParticleOptions, seed: int) -> Arrays:
    """What lands on a rectangle above the floor, in two parts."""
    sums = Accumulation.empty(SENSOR.height, SENSOR.width)
    for count in (PARTICLES - 1000, 1000):
        trace_light(tracer_of(scene, "f64"), SENSOR, count, seed=seed, options=options, sums=sums)
    return sums_of(sums)


def emitted(scene: str, seed: int) -> Arrays:
    """Particles as they leave their lights."""
    return vars(emit_particles(tracer_of(scene, "f64"), 300, seed=seed, first=20))


def photons(scene: str, options: ParticleOptions, direct: bool, seed: int) -> Arrays:
    """The irradiance of points on the floor, and a picture."""
    found = PhotonMap(
        tracer_of(scene, "f64"), PARTICLES, radius=0.3, seed=seed, options=options, direct=direct
    )
    g = np.random.default_rng(3)
    points = np.stack([g.uniform(-1, 1, 40), np.zeros(40), g.uniform(-1, 1, 40)], axis=1)
    normals = np.tile([0.0, 1.0, 0.0], (40, 1))
    sums = found.render(spp=2, seed=seed, options=PathOptions(max_depth=8))
    return {
        **sums_of(sums),
        "count": np.array(len(found)),
        "irradiance": found.irradiance(points, normals),
    }


def occlusion(scene: str, radius: float, seed: int) -> Arrays:
    """A picture of ambient occlusion, in two parts."""
    tracer = tracer_of(scene, "f64")
    sums = Accumulation.empty(tracer.scene.camera.height, tracer.scene.camera.width)
    for count in (3, 2):
        tracer.add_occlusion(sums, count, seed=seed, radius=radius)
    return {"free": sums.radiance}


def baked(scene: str, shape: str, radius: float, seed: int) -> Arrays:
    """Ambient occlusion of texels."""
    found = bake_ambient_occlusion(
        tracer_of(scene, "f64").scene, shape, (9, 12), radius=radius, spp=8, seed=seed
    )
    return {"values": found.values}


def particle_cases() -> Iterator[Case]:
    """Everything that particles, photons and occlusion compute."""
    for scene in (*SURFACES, *MEDIA):
        yield Case(f"emitted/{scene}", partial(emitted, scene))
        for name, options in OPTIONS.items():
            if name == "default" or scene in ("stage", "lights-all", "opacity-textured", "nested"):
                run = partial(irradiance, scene, options)
                yield Case(f"irradiance/{scene}/{name}", run, ("radiance",))
    for scene in ("fog", "fog-lights", "smoke", "nested", "haze-smoke", "opacity-fog"):
        run = partial(photons, scene, OPTIONS["default"], True)
        yield Case(f"photons/{scene}/default-all", run, ("radiance",))
    for scene in SURFACES:
        for name, options in OPTIONS.items():
            for direct in (True, False) if name == "default" else (True,):
                if name != "default" and scene != "stage":
                    continue
                kept = "all" if direct else "indirect"
                run = partial(photons, scene, options, direct)
                yield Case(f"photons/{scene}/{name}-{kept}", run, ("radiance",))
    for scene in ("stage", "instances", "signed-distances", "opacity", "fog"):
        for name, radius in (("far", np.inf), ("near", 0.6)):
            run = partial(occlusion, scene, radius)
            yield Case(f"occlusion/{scene}/{name}", run, ("free",))
    for name, radius in (("far", np.inf), ("near", 0.6)):
        run = partial(baked, "stage", "floor", radius)
        yield Case(f"occlusion-baked/stage/{name}", run, ("values",))
