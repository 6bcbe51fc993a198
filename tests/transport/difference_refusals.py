"""What has no derivative, and what is said to whoever asks for it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from photograd.errors import Error
from photograd.lights import RegisteredLight
from photograd.transport import PathTracer, derivative_image

from tests.transport.difference_rows import OTHERS
from tests.transport.difference_scenes import veil
from tests.transport.light_scenes import LIGHTS, lit_by

MORE = {"map": ("world_from_map",), "mesh": ("vertices",)}


def said(tracer: PathTracer, key: str) -> str:
    """The error of asking for the derivative by `key`."""
    try:
        derivative_image(tracer, key, spp=1, seed=0)
    except Error as error:
        return str(error)
    raise AssertionError(key)


def refused() -> Iterator[tuple[str, str, str]]:
    """(light, what is fixed, message for the first of it) for all lights; and a mask's coverage."""
    for name, (light, *_) in LIGHTS.items():
        if name in ("all", "turned map"):
            continue
        known = isinstance(light, RegisteredLight)
        names = [p.name for p in light.constants()] if known else MORE[name]
        tracer = PathTracer(lit_by(light, size=2))
        answers = [said(tracer, f"lights.0.{constant}") for constant in names]
        if answers:
            thing = light.core_name if known else OTHERS[name]
            yield thing, ", ".join(names), answers[0].partition(" (")[0]
    scene = veil()
    card = replace(scene.materials["card"], alpha_cutoff=0.5)
    tracer = PathTracer(replace(scene, materials={**scene.materials, "card": card}))
    gradient = tracer.render_backward(np.ones((4, 4, 3)), spp=4, seed=0)
    if gradient["materials.card.alpha"].any() or gradient["textures.t"].any():
        raise AssertionError("a mask has derivatives")
    yield "mask", "alpha, and its texture", "0: what a mask cuts out moves edges"
