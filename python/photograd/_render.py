"""A picture of whatever has one, for somebody who wants to look at it."""

from __future__ import annotations

from typing import overload

import numpy as np
from photograd_course.color import srgb_encode

from photograd._checks import require_instance
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
    spp: int | None = None,
    seed: int | None = None,
    options: PathOptions | None = None,
) -> Array:
    """A picture (H, W, 3) in display values, 0 to 1, row 0 on top, ready to be shown.

    For linear radiance, opacity and depth ask `PathTracer.render` or
    `photograd.fitting.evaluate.render_camera`.

    Args:
        what: a model, drawn over white or over the background that was learned with it; or a scene,
            path traced; a tracer keeps what was built for it, and what was changed in its params.
        camera: where the picture is taken from; a scene has one of its own.
        spp: samples a pixel of a path traced picture, by default 64.
        seed: of its random numbers, by default 0.
        options: of the path tracer there.

    Raises:
        DtypeError: something else than these.
        RangeError: a model without a camera, or with an option of the path tracer; spp below 1.
        Error: radiance that is not finite; names the pixel.

    Example:
        >>> room = photograd.builtin_scene("cornell-box", 16)
        >>> photograd.render(room, spp=4).shape
        (16, 16, 3)
        >>> capture = photograd.load_capture("photos")
        >>> model = photograd.fit(capture, resolution=8, steps=2, rays=16)
        >>> photograd.render(model, capture.test[0].camera).shape
        (16, 16, 3)
    """
    if isinstance(what, Model):
        if camera is None:
            raise RangeError(message("render", "camera", "a camera, a model has none", "None"))
        remedy = "pass its .camera" if hasattr(camera, "camera") else None
        require_instance("render", "camera", camera, Camera, remedy)
        for name, value in (("spp", spp), ("seed", seed), ("options", options)):
            if value is not None:
                expected, remedy = "nothing with a Model, which is not sampled", "leave it out"
                raise RangeError(message("render", name, expected, value, remedy))
        return display_image(what, camera)
    if isinstance(what, Scene):
        what = PathTracer(what)
    if not isinstance(what, PathTracer):
        expected = "a Model, a Scene or a PathTracer"
        raise DtypeError(message("render", "what", expected, type(what).__name__))
    radiance = what.render(
        spp=64 if spp is None else spp,
        seed=0 if seed is None else seed,
        options=DEFAULTS if options is None else options,
        camera=camera,
    ).mean
    return srgb_encode(np.clip(radiance, 0.0, 1.0))
