"""`photograd trace --set`: other numbers for parameters of the scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy as np
import typer
from photograd_course.suggest import choose_from

from photograd.errors import RangeError, ShapeError, message
from photograd.transport.inverse.parameters import scene_with
from photograd.transport.scene import Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array, FloatArray

EXAMPLE = "for example --set materials.red.albedo=0.2,0.3,0.4"

SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=NUMBERS",
        help="Give a parameter of the scene other numbers, such as "
        "materials.red.albedo=0.2,0.3,0.4, or one number for all its entries. May be repeated.",
    ),
]


def traced(scene: Scene, settings: Sequence[str]) -> PathTracer:
    """The tracer of a scene with the settings of `--set`.

    Raises:
        RangeError: no NAME=NUMBERS, no such parameter, a parameter twice, or numbers that the model
            does not take.
        ShapeError: another number of entries than the parameter has.
    """
    tracer = PathTracer(scene)
    if not settings:
        return tracer
    values: dict[str, Array] = {}
    for setting in settings:
        name, value = _parsed(setting, tracer.params)
        if name in values:
            raise RangeError(message("trace", "--set", "each parameter once", f"{name} twice"))
        values[name] = value
    # Media are no part of what `scene_with` changes: the tracer's own numbers are.
    inside = {name: value for name, value in values.items() if name.startswith("media.")}
    tracer = PathTracer(
        scene_with(scene, {name: value for name, value in values.items() if name not in inside})
    )
    for name, value in inside.items():
        most = 1.0 if name.endswith(".albedo") else np.inf
        if not name.endswith(".g") and not ((value >= 0) & (value <= most)).all():
            raise RangeError(message("trace", f"--set {name}", f"numbers of 0 to {most}", value))
        tracer.params[name][...] = value
    return tracer


def _parsed(setting: str, params: Mapping[str, Array]) -> tuple[str, FloatArray]:
    """Name, and values of the parameter's shape."""
    name, equals, text = setting.partition("=")
    name = name.strip()
    try:
        numbers = np.array([float(part) for part in text.split(",")])
    except ValueError:
        numbers = np.array([np.nan])
    if not equals or not np.isfinite(numbers).all():
        raise RangeError(message("trace", "--set", "NAME=NUMBER,NUMBER,...", setting, EXAMPLE))
    if name not in params:
        expected, remedy = "a parameter of the scene", choose_from(name, params)
        raise RangeError(message("trace", "--set", expected, f"'{name}'", remedy))
    shape = params[name].shape
    if numbers.size not in (1, int(np.prod(shape[-1:], initial=1))):
        entries = int(np.prod(shape[-1:], initial=1))
        expected = f"1 or {entries} numbers" if entries > 1 else "1 number"
        raise ShapeError(message("trace", f"--set {name}", expected, numbers.size))
    numbers = numbers[0] if numbers.size == 1 else numbers
    return name, np.array(np.broadcast_to(numbers, shape), np.float64)
