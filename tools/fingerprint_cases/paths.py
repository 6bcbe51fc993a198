"""Cases of the path tracer: scenes, crossed with options, precisions and what is computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import Any

import numpy as np
from photograd.transport import Accumulation, PathOptions, PathTracer, derivative_image
from photograd.transport.inverse.loss import loss_and_gradients
from photograd.transport.path_options import SAMPLERS

from fingerprint_cases.case import PRECISIONS, Array, Arrays, Case, numbers_of
from fingerprint_cases.scenes import BASIC, Scenes, view, without_unused
from fingerprint_cases.scenes_light import LIT
from fingerprint_cases.scenes_media import MEDIA
from fingerprint_cases.scenes_motion import MOTION
from fingerprint_cases.scenes_surface import MODEL_SCENES, SURFACES

SCENES: Scenes = {**BASIC, **MODEL_SCENES, **SURFACES, **LIT, **MEDIA, **MOTION}
SPP = 8
DEFAULT = PathOptions()
ESTIMATORS = {
    "light": PathOptions("light", max_depth=6),
    "bsdf": PathOptions("bsdf", max_depth=6),
    "mis-balance": PathOptions("mis", "balance", max_depth=6),
    "mis-power": PathOptions("mis", "power", max_depth=6),
}
CROSSED = ("large-surfaces", "lights-all", "opacity-textured", "fog-lights", "opacity-smoke")
"""Scenes for which all estimators, samplers and ends of paths are tried."""
ENDS = {
    "depth-1": PathOptions(max_depth=1),
    "depth-2": PathOptions(max_depth=2),
    "no-roulette": PathOptions(max_depth=5, roulette_from=None),
    "roulette-0": PathOptions(roulette_from=0),
}


def crossed_options() -> dict[str, PathOptions]:
    """All estimators with all samplers, and ways to end a path."""
    both = {
        f"{name}-{sampler}": PathOptions(o.strategy, o.heuristic, o.max_depth, 3, sampler)
        for name, o in ESTIMATORS.items()
        for sampler in SAMPLERS
    }
    return {**both, **ENDS}


@lru_cache(maxsize=2)
def tracer_of(scene: str, precision: str) -> PathTracer:
    """The tracer of a scene by name, which hands out incomplete gradients as well."""
    return PathTracer(
        without_unused(SCENES[scene]()), dtype=PRECISIONS[precision], allow_incomplete=True
    )


def cotangent(tracer: PathTracer, seed: int = 7) -> Array:
    """Random numbers (H, W, 3) between -1 and 1."""
    camera = tracer.scene.camera
    rows = np.random.default_rng(seed).uniform(-1, 1, (camera.height, camera.width, 3))
    return np.asarray(rows)


def sums_of(sums: Accumulation) -> Arrays:
    """What a rendering adds up."""
    return {"radiance": sums.radiance, "squares": sums.squares}


def picture(scene: str, precision: str, options: PathOptions, seed: int) -> Arrays:
    """A rendering."""
    return sums_of(tracer_of(scene, precision).render(spp=SPP, seed=seed, options=options))


def backward(scene: str, precision: str, options: PathOptions, seed: int) -> Arrays:
    """Gradients with respect to all parameters."""
    tracer = tracer_of(scene, precision)
    return dict(tracer.render_backward(cotangent(tracer), spp=SPP, seed=seed, options=options))


def dual(scene: str, precision: str, options: PathOptions, seed: int, **more: Any) -> Arrays:
    """The dual-buffer loss and its gradients."""
    tracer = tracer_of(scene, precision)
    target = 0.3 + 0.1 * cotangent(tracer, 8)
    weight = 1.0 + 0.5 * cotangent(tracer, 9)
    loss, gradients = loss_and_gradients(
        tracer, target, weight, spp=SPP, seeds=(seed, seed + 1000), options=options, **more
    )
    return {"loss": np.array(loss), **gradients}


def tangent(scene: str, precision: str, options: PathOptions, seed: int) -> Arrays:
    """A picture and how it changes as all parameters do, each in its own way."""
    tracer = tracer_of(scene, precision)
    g = np.random.default_rng(11)
    along = {name: g.uniform(-1, 1, np.shape(value)) for name, value in tracer.params.items()}
    value, change = derivative_image(tracer, along, spp=SPP, seed=seed, options=options)
    return {**sums_of(value), "d_radiance": change.radiance, "d_squares": change.squares}


def vertices(scene: str, precision: str, options: PathOptions, seed: int) -> Arrays:
    """All that is known of the vertices of a few paths."""
    tracer = tracer_of(scene, precision)
    camera = tracer.scene.camera
    pixels = range(0, camera.height * camera.width, 7)
    found = [tracer.path(pixel, 1, seed=seed, options=options) for pixel in pixels]
    return {
        "counts": np.array([len(path) for path in found]),
        "numbers": np.array(numbers_of(found), np.float64),
    }


Compute = Callable[[str, str, PathOptions, int], Arrays]
BOTH, PICTURE, GRADIENTS = ("f32", "f64"), ("radiance",), ("*",)
KINDS: dict[str, tuple[Compute, tuple[str, ...], tuple[str, ...]]] = {
    "picture": (picture, BOTH, PICTURE),
    "backward": (backward, BOTH, GRADIENTS),
    "dual": (dual, BOTH, ()),
    "tangent": (tangent, ("f64",), ("d_radiance",)),
    "vertices": (vertices, ("f64",), ()),
}
"""What is computed: how, in which precisions, and which of its arrays are estimates."""
PATHS_OF = (
    "stage",
    "model-glass",
    "model-rough_dielectric",
    "opacity-textured",
    "lights-all",
    "emitting-shapes",
    "fog",
    "nested-smoke",
    "opacity-smoke",
    "haze",
    "moving-opacity",
    "signed-distances",
)
"""Scenes whose vertices are looked at one by one."""


def rows(scene: str, name: str, options: PathOptions, *kinds: str) -> Iterator[Case]:
    """The cases of a scene under some options."""
    for kind in kinds:
        compute, precisions, estimates = KINDS[kind]
        for precision in precisions:
            run = partial(compute, scene, precision, options)
            yield Case(f"path/{scene}/{name}/{precision}/{kind}", run, estimates)


def path_cases() -> Iterator[Case]:
    """Everything that the path tracer computes."""
    for scene in SCENES:
        yield from rows(scene, "default", DEFAULT, "picture", "backward", "dual", "tangent")
        if scene in PATHS_OF:
            yield from rows(scene, "default", DEFAULT, "vertices")
    for scene in CROSSED:
        for name, options in crossed_options().items():
            yield from rows(scene, name, options, "picture", "backward")
        for name in ("light-sobol", "bsdf-independent", "no-roulette"):
            yield from rows(scene, name, crossed_options()[name], "dual", "tangent")
    yield from call_cases()


def ranges(scene: str, precision: str, seed: int) -> Arrays:
    """Samples in two parts, from another camera."""
    tracer, camera = tracer_of(scene, precision), view((0.4, 0.9, 2.0), width=10, height=8)
    sums = Accumulation.empty(8, 10)
    for count in (3, 2):
        tracer.add_samples(sums, count, seed=seed, camera=camera)
    return sums_of(sums)


def other_sampling(scene: str, precision: str, seed: int) -> Arrays:
    """A picture whose paths other parameters chose."""
    tracer = tracer_of(scene, precision)
    chosen = {name: value * np.asarray(0.9, value.dtype) for name, value in tracer.params.items()}
    sums = Accumulation.empty(tracer.scene.camera.height, tracer.scene.camera.width)
    tracer.add_samples(sums, SPP, seed=seed, sampling_params=chosen)
    return sums_of(sums)


def no_background(scene: str, precision: str, seed: int) -> Arrays:
    """A picture without what lies behind everything, and alpha as a number of samples."""
    tracer, camera = tracer_of(scene, precision), view((0.4, 0.9, 2.0), width=10, height=8)
    sums, hits = Accumulation.empty(8, 10), np.zeros((8, 10))
    tracer.add_samples(sums, SPP, seed=seed, camera=camera, hits=hits)
    return {**sums_of(sums), "hits": hits}


def spread(scene: str, precision: str, seed: int) -> Arrays:
    """Gradients with more paths where the cotangent is large."""
    tracer = tracer_of(scene, precision)
    found = tracer.render_backward(cotangent(tracer), spp=SPP, seed=seed, spread="cotangent")
    return dict(found)


def spread_dual(scene: str, precision: str, seed: int) -> Arrays:
    """The dual-buffer loss with more paths where it is noisy."""
    return dual(scene, precision, DEFAULT, seed, spread="cotangent")


def incomplete(scene: str, precision: str, seed: int) -> Arrays:
    """Names of the parameters whose gradients are refused, and the others' gradients."""
    tracer = PathTracer(without_unused(SCENES[scene]()), dtype=PRECISIONS[precision])
    found = tracer.render_backward(cotangent(tracer), spp=SPP, seed=seed)
    names = "\n".join(tracer.incomplete).encode()
    return {"refused": np.frombuffer(names, np.uint8), **found}


def chosen_lights(scene: str, precision: str, seed: int) -> Arrays:
    """Lights and their probabilities."""
    u = np.random.default_rng(seed).random(200)
    entries, pmf = tracer_of(scene, precision)._geometry.choose_lights(u)
    return {"entries": entries, "pmf": pmf}


Call = Callable[[str, str, int], Arrays]
CALLS: tuple[tuple[str, Call, tuple[str, ...], tuple[str, ...]], ...] = (
    ("ranges", ranges, PICTURE, ("stage", "fog", "moving", "lens", "shutter")),
    (
        "other-sampling",
        other_sampling,
        PICTURE,
        ("model-gltf", "model-glass", "texture-mirror-mip", "opacity-textured", "nested-smoke"),
    ),
    ("spread", spread, GRADIENTS, ("stage", "lights-all", "opacity-textured", "nested-smoke")),
    ("spread-dual", spread_dual, (), ("stage", "lights-all", "opacity-textured", "nested-smoke")),
    (
        "incomplete",
        incomplete,
        (),
        ("model-glass", "model-dispersive_glass", "mask", "opacity-fog"),
    ),
    ("chosen-lights", chosen_lights, (), ("lights-all", "emitting-shapes")),
    ("no-background", no_background, PICTURE, ("stage", "opacity-textured", "fog")),
)
"""(name, how it is computed, its estimates, scenes)."""


def call_cases() -> Iterator[Case]:
    """Calls with arguments of their own."""
    for name, call, estimates, scenes in CALLS:
        for scene in scenes:
            for precision in PRECISIONS:
                run = partial(call, scene, precision)
                yield Case(f"call/{name}/{scene}/{precision}", run, estimates)
