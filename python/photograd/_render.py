"""A picture of whatever has one, for somebody who wants to look at it."""

from __future__ import annotations

from typing import overload

import numpy as np
from photograd_course.color import srgb_encode

from photograd.capture.camera import Camera
from photograd.errors import DtypeError, RangeError, message
from photograd.fitting.evaluate import display_image
from photograd.fitting.model import Model
from photograd.transport.path_options import DEFAULTS, PathOptions
from photograd.transport.scene import Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array


@overload
def render(what: Model, camera: Camera) -> Array: ...


@overload
def render(
    what: Scene | PathTracer,
    camera: Camera | None = None,
    *,
    spp: int = 64,
    seed: int = 0,
    options: PathOptions = DEFAULTS,
) -> Array: ...


def render(
    what: Model | Scene | PathTracer,
    camera: Camera | None = None,
    *,
    spp: int = 64,
    seed: int = 0,
    options: PathOptions = DEFAULTS,
) -> Array:
    """A picture (H, W, 3) in display values, 0 to 1, row 0 on top, ready to be shown.

    For linear radiance, opacity and depth ask `PathTracer.render` or
    `photograd.fitting.evaluate.render_camera`.

    Args:
        what: a model, drawn over white or over the background that was learned with it; or a scene,
            path traced; a tracer keeps what was built for it, and what was changed in its params.
        camera: where the picture is taken from; a scene has one of its own.
        spp: samples a pixel of a path traced picture.
        seed: of its random numbers.
        options: of the path tracer there.

    Raises:
        DtypeError: something else than these.
        RangeError: a model without a camera; spp below 1.
        Error: radiance that is not finite; names the pixel.
    """
    if isinstance(what, Model):
        if camera is None:
            raise RangeError(message("render", "camera", "a camera, a model has none", "None"))
        return display_image(what, camera)
    if isinstance(what, Scene):
        what = PathTracer(what)
    if not isinstance(what, PathTracer):
        expected = "a Model, a Scene or a PathTracer"
        raise DtypeError(message("render", "what", expected, type(what).__name__))
    radiance = what.render(spp=spp, seed=seed, options=options, camera=camera).mean
    return srgb_encode(np.clip(radiance, 0.0, 1.0))
