"""What inverse rendering may change: parameters of the tracer, between bounds.

    logit    p = lo + (hi - lo) / (1 + exp(-x))      dp/dx = (p - lo) (hi - p) / (hi - lo)
    log      p = lo + exp(x)                         dp/dx = p - lo

A step of gradient descent changes x, and p cannot leave its bounds. A logit suits what has two ends
(colors, roughness), a log what is positive and of any size (radiance): there a step is a factor.
Held constant: lo and hi.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from photograd_course.portable_math import exp, log, log1p, sigmoid
from photograd_course.suggest import choose_from

from photograd._arrays import Arguments
from photograd._checks import require_choices
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.lights import EnvironmentMap, Light
from photograd.transport.incomplete import require_whole
from photograd.transport.scene import Environment, Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array

ActivationKind = Literal["logit", "log"]
MARGIN = 1e-3
"""How far inside of its range a start is kept; at an end, dp/dx is 0 and nothing would move."""
LARGEST = 60.0
"""Of |x|: beyond it, exp would leave the range of what float32 parameters can be."""


@dataclass(frozen=True)
class Activation:
    """Of numbers between bounds; `hi` means nothing to a log."""

    kind: ActivationKind
    lo: float
    hi: float

    def value(self, x: Array) -> Array:
        """Parameters, shape and dtype of `x`."""
        x = np.clip(x, -LARGEST, LARGEST)
        if self.kind == "log":
            return np.asarray(self.lo + exp(x))
        return np.asarray(self.lo + (self.hi - self.lo) * sigmoid(x))

    def value_backward(self, x: Array, d_value: Array) -> Array:
        """dL/dx of d_value = dL/dp, shape of `x`."""
        value = self.value(x)
        if self.kind == "log":
            return np.asarray(d_value * (value - self.lo))
        return np.asarray(d_value * (value - self.lo) * (self.hi - value) / (self.hi - self.lo))

    def inverse(self, value: Array) -> Array:
        """What gives these parameters; those on a bound are first moved inside by `MARGIN`.

        Args:
            value: parameters inside of the bounds.
        """
        value = np.asarray(value, np.float64)
        if self.kind == "log":
            return np.asarray(log(np.maximum(value - self.lo, MARGIN)))
        part = np.clip((value - self.lo) / (self.hi - self.lo), MARGIN, 1.0 - MARGIN)
        return np.asarray(log(part) - log1p(-part))


# A scene with other numbers: what was found, or where lights are to be asked anew.


@typed_call
def scene_with(scene: Scene, params: Mapping[str, Any]) -> Scene:
    """The scene with parameters changed.

    Args:
        scene: stays as it is.
        params: some of those of `PathTracer.params`, by their names; the others stay.

    Raises:
        RangeError, ShapeError: values that the scene's parts refuse.
    """
    changed: dict[str, dict[str, Any]] = {}
    for name, value in params.items():
        kind, _, rest = name.partition(".")
        changed.setdefault(kind, {})[rest] = value
    materials = dict(scene.materials)
    for path, value in changed.get("materials", {}).items():
        name, _, parameter = path.rpartition(".")
        values = {**materials[name].values, parameter: np.asarray(value, np.float64)}
        materials[name] = replace(materials[name], values=values)
    textures = dict(scene.textures)
    for name, values in changed.get("textures", {}).items():
        textures[name] = replace(textures[name], values=np.asarray(values, np.float32))
    shining = {name: np.asarray(value) for name, value in changed.get("emission", {}).items()}
    shapes = tuple(
        replace(shape, emission=shining[shape.name]) if shape.name in shining else shape
        for shape in scene.shapes
    )
    environment = scene.environment
    if "environment" in changed:
        environment = Environment(*np.asarray(changed["environment"][""], np.float64))
    lights = list(scene.lights)
    for path, value in changed.get("lights", {}).items():
        number, _, parameter = path.partition(".")
        lights[int(number)] = _light_with(lights[int(number)], parameter, value)
    return replace(
        scene,
        shapes=shapes,
        materials=materials,
        environment=environment,
        lights=tuple(lights),
        textures=textures,
    )


def _light_with(light: Light, parameter: str, value: Any) -> Light:
    if isinstance(light, EnvironmentMap):
        value = np.asarray(value, light.texels.dtype)
    changed: Light = replace(light, **{parameter: value})  # type: ignore[type-var]
    return changed


# What inverse rendering may change: a parameter of the tracer, between bounds.


@typed_call
@dataclass(frozen=True, eq=False)
class Parameter:
    """A parameter that is to be found.

    Attributes:
        name: as in `PathTracer.params`: "materials.NAME.PARAMETER", "textures.NAME",
            "emission.SHAPE", "environment", "lights.INDEX.PARAMETER".
        start: where the search begins, of the parameter's shape or one number for all; None begins
            with what the scene says. Kept a thousandth inside of the bounds.
        bounds: (lo, hi); None takes the model's range for a material, (0, 1) for a texture, and
            (0, inf) for all that shines. With hi infinite only lo is a bound.
        activation: "logit" for two bounds, "log" for one; None goes by the bounds.
        rate: factor on the learning rate.

    Raises:
        RangeError: bounds that are not increasing, a log with a finite upper bound or the reverse,
            an unknown activation, or a rate that is not positive.
    """

    name: str
    start: Any = None
    bounds: tuple[float, float] | None = None
    activation: ActivationKind | None = None
    rate: float = 1.0

    def __post_init__(self) -> None:
        require_choices(self)
        Arguments("Parameter").number(f"{self.name}.rate", self.rate, above=0)
        if self.bounds is None:
            return
        lo, hi = self.bounds
        if not (math.isfinite(lo) and lo < hi):
            raise RangeError(message("Parameter", f"{self.name}.bounds", "lo < hi", self.bounds))
        expected = "log" if math.isinf(hi) else "logit"
        if self.activation not in (None, expected):
            got = f"{self.activation} for bounds {self.bounds}"
            raise RangeError(message("Parameter", f"{self.name}.activation", expected, got))

    def activation_in(self, scene: Scene) -> Activation:
        """How numbers become this parameter.

        Raises:
            RangeError: the activation does not fit the bounds that the scene gives.
        """
        lo, hi = self.bounds or default_bounds(self.name, scene)
        kind: ActivationKind = "log" if math.isinf(hi) else "logit"
        if self.activation == "log" and kind == "logit":  # the range of a model has two ends
            hi, kind = math.inf, "log"
        if self.activation == "logit" and kind == "log":
            got = "none"
            raise RangeError(message("Parameter", f"{self.name}.bounds", "an upper bound", got))
        return Activation(kind, float(lo), float(hi))

    def start_in(self, tracer: PathTracer) -> Array:
        """The first value, float64, of the parameter's shape.

        Args:
            tracer: of the scene.

        Raises:
            RangeError: no such parameter, one whose derivative is incomplete, or a start that is
                not finite or out of bounds.
            ShapeError: a start of another shape.
        """
        if self.name not in tracer.params:
            known = choose_from(self.name, tracer.params)
            expected = "a parameter of the scene"
            raise RangeError(message("recover", "parameters", expected, f"'{self.name}'", known))
        require_whole("recover", "parameters", [self.name], tracer.incomplete)
        own = np.asarray(tracer.params[self.name], np.float64)
        if self.start is None:
            return own.copy()
        activation = self.activation_in(tracer.scene)
        call = Arguments("Parameter", np.float64)
        start = call.array(
            f"{self.name}.start",
            self.start,
            (),
            own.shape,
            low=activation.lo,
            high=None if math.isinf(activation.hi) else activation.hi,
        )
        return np.array(np.broadcast_to(start, own.shape))


def default_bounds(name: str, scene: Scene) -> tuple[float, float]:
    """(lo, hi) of a parameter of a scene, hi infinite for what shines.

    Args:
        name: of the parameter.
        scene: that has it.
    """
    kind, _, rest = name.partition(".")
    if kind == "materials":
        material, _, parameter = rest.rpartition(".")
        for described in scene.materials[material].parameters:
            if described.name == parameter:
                return described.lo, described.hi
    if kind == "textures":
        return 0.0, 1.0
    return 0.0, math.inf


def is_light(name: str) -> bool:
    """Whether a parameter is of something that shines, and so decides how often it is asked.

    Args:
        name: of the parameter.
    """
    return name.partition(".")[0] in ("emission", "environment", "lights")
