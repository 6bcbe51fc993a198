"""Derivative pictures: how every pixel changes with one number of a scene.

The mathematics is in cpp/photograd/render/path/tangent.h. Where `PathTracer.render_backward` gives
the derivatives of one number with respect to all parameters, this gives the derivative of all
pixels with respect to one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
from photograd_course.suggest import choose_from

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.transport.accumulation import Accumulation
from photograd.transport.incomplete import changed_names, require_whole
from photograd.transport.path_options import DEFAULTS, PathOptions, checked_view
from photograd.transport.tracer import PathTracer
from photograd.types import Array

SPELLING = re.compile(r"(?P<name>[^\[\]]+)(\[(?P<index>\d+(\s*,\s*\d+)*)\])?")
STILL = ("shapes", "camera", "lens", "shutter", "sdfs")
NO_EDGES = "where things are has no derivative here: edges and shadows would move, too"


@typed_call
def direction_of(params: Mapping[str, Array], parameter: str) -> dict[str, Array]:
    """A step of one along a parameter: {its name: an array of its shape}.

    Args:
        params: those of a `PathTracer`.
        parameter: a name, with the place of one entry or without: "materials.red.albedo[0]",
            "textures.wood[2, 5, 0]". Without, all entries of the array rise together: all texels of
            a texture, all channels of a color.

    Raises:
        RangeError: no such parameter, or no such entry.
    """
    found = SPELLING.fullmatch(parameter.strip())
    name = found["name"] if found else parameter
    if found is None or name not in params:
        still = name.partition(".")[0] in STILL
        remedy = NO_EDGES if still else choose_from(name, params)
        raise RangeError(message("direction_of", "parameter", "one of the scene's", name, remedy))
    shape = params[name].shape
    if found["index"] is None:
        return {name: np.ones(shape)}
    index = tuple(int(part) for part in found["index"].split(","))
    if len(index) != len(shape) or any(i >= n for i, n in zip(index, shape, strict=True)):
        expected = f"a place in an array of shape {shape}"
        raise RangeError(message("direction_of", "parameter", expected, parameter))
    step = np.zeros(shape)
    step[index] = 1.0
    return {name: step}


@typed_call
def derivative_image(
    tracer: PathTracer,
    along: str | Mapping[str, Array],
    *,
    spp: int,
    seed: int,
    options: PathOptions = DEFAULTS,
    camera: Camera | None = None,
) -> tuple[Accumulation, Accumulation]:
    """A picture and its derivative, from the same paths.

    Both are linear radiance (H, W, 3); the derivative is per unit of the parameter. Paths and their
    weights are held fixed, as in `PathTracer.render_backward`, whose interior term this is: edges
    of shadows and silhouettes do not move. Parameters for which that is not the whole derivative
    are refused. In float64, whatever the tracer's dtype.

    Args:
        tracer: the scene, at its present `params`.
        along: what changes: a parameter as `direction_of` spells it, or {name: array} with a
            change for each number of some of the params.
        spp: samples a pixel.
        seed: of all random numbers.
        options: of the path tracer.
        camera: None takes the scene's.

    Returns:
        The picture, and its derivative.

    Raises:
        RangeError: spp below 1, no such parameter, one whose derivative is incomplete, or a change
            that is not finite.
        ShapeError: a change of another shape than its parameter.
        Error: radiance that is not finite; names the pixel.
    """
    view = checked_view("derivative_image", tracer.scene.camera, camera, options)
    picture = Accumulation.empty(view.height, view.width)
    derivative = Accumulation.empty(view.height, view.width)
    add_derivative_samples(
        tracer, picture, derivative, along, spp, seed=seed, options=options, camera=camera
    )
    return picture, derivative


@typed_call
def add_derivative_samples(
    tracer: PathTracer,
    picture: Accumulation,
    derivative: Accumulation,
    along: str | Mapping[str, Array],
    spp: int,
    *,
    seed: int,
    options: PathOptions = DEFAULTS,
    camera: Camera | None = None,
) -> None:
    """Add the next `spp` samples to both sums, in place; arguments as for `derivative_image`.

    Args:
        tracer: of the scene.
        picture: sums of the picture.
        derivative: sums of the derivative, of as many samples.
        along: name of a parameter, or {name: change}.
        spp: samples a pixel.
        seed: of all random numbers.
        options: of the path tracer.
        camera: None takes the scene's.

    Raises:
        RangeError: as `derivative_image`, and for sums of other counts.
        ShapeError: sums of another size.
        Error: as `derivative_image`.
    """
    view = checked_view("derivative_image", tracer.scene.camera, camera, options)
    for name, sums in (("picture", picture), ("derivative", derivative)):
        sums.check_call("derivative_image", (view.height, view.width), spp, name=name)
    if picture.count != derivative.count:
        expected = f"{picture.count} samples, as of the picture"
        raise RangeError(message("derivative_image", "derivative", expected, derivative.count))
    step = direction_of(tracer.params, along) if isinstance(along, str) else along
    require_whole("derivative_image", "along", changed_names(step), tracer.incomplete)
    changes = tracer.wide_changes(_whole_direction(tracer.params, step))
    _core.trace_paths_tangent(
        **tracer.wide_arguments(camera=view),
        **{f"v_{name}": change for name, change in changes.items()},
        options=options.numbers(seed),
        first=picture.count,
        count=spp,
        radiance=picture.radiance,
        squares=picture.squares,
        d_radiance=derivative.radiance,
        d_squares=derivative.squares,
    )
    picture.count += spp
    derivative.count += spp
    picture.check_finite("derivative_image")
    derivative.check_finite("derivative_image")


def _whole_direction(params: Mapping[str, Array], step: Mapping[str, Array]) -> dict[str, Array]:
    """A change of every parameter, 0 where `step` says nothing."""
    call = Arguments("derivative_image", np.float64)
    whole = {name: np.zeros(np.shape(value)) for name, value in params.items()}
    for name, value in step.items():
        if name not in params:
            known = choose_from(name, params)
            raise RangeError(message("derivative_image", "along", "parameters", name, known))
        whole[name] = call.array(name, value, np.shape(params[name]))
    return whole
