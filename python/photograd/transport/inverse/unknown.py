"""What a recovery may change: a parameter of the tracer, between bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd.errors import RangeError, ShapeError, message
from photograd.transport.incomplete import require_whole
from photograd.transport.inverse.activation import KINDS, Activation
from photograd.transport.scene import Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class Unknown:
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
    activation: str | None = None
    rate: float = 1.0

    def __post_init__(self) -> None:
        if self.activation is not None and self.activation not in KINDS:
            raise RangeError(message("Unknown", "activation", KINDS, self.activation))
        if not (math.isfinite(self.rate) and self.rate > 0):
            raise RangeError(message("Unknown", f"{self.name}.rate", "above 0", self.rate))
        if self.bounds is None:
            return
        lo, hi = self.bounds
        if not (math.isfinite(lo) and lo < hi):
            raise RangeError(message("Unknown", f"{self.name}.bounds", "lo < hi", self.bounds))
        expected = "log" if math.isinf(hi) else "logit"
        if self.activation not in (None, expected):
            got = f"{self.activation} for bounds {self.bounds}"
            raise RangeError(message("Unknown", f"{self.name}.activation", expected, got))

    def activation_in(self, scene: Scene) -> Activation:
        """How numbers become this parameter.

        Raises:
            RangeError: the activation does not fit the bounds that the scene gives.
        """
        lo, hi = self.bounds or default_bounds(self.name, scene)
        kind = "log" if math.isinf(hi) else "logit"
        if self.activation == "log" and kind == "logit":  # the range of a model has two ends
            hi, kind = math.inf, "log"
        if self.activation == "logit" and kind == "log":
            got = "none"
            raise RangeError(message("Unknown", f"{self.name}.bounds", "an upper bound", got))
        return Activation(kind, float(lo), float(hi))

    def start_in(self, tracer: PathTracer) -> Array:
        """The first value, float64, of the parameter's shape.

        Raises:
            RangeError: no such parameter, one whose derivative is incomplete, or a start that is
                not finite or out of bounds.
            ShapeError: a start of another shape.
        """
        if self.name not in tracer.params:
            known = choose_from(self.name, tracer.params)
            expected = "a parameter of the scene"
            raise RangeError(message("recover", "unknowns", expected, f"'{self.name}'", known))
        require_whole("recover", "unknowns", [self.name], tracer.incomplete)
        own = np.asarray(tracer.params[self.name], np.float64)
        if self.start is None:
            return own.copy()
        start = np.asarray(self.start, np.float64)
        if start.shape not in ((), own.shape):
            expected = f"one number, or shape {own.shape}"
            raise ShapeError(message("Unknown", f"{self.name}.start", expected, start.shape))
        activation = self.activation_in(tracer.scene)
        lo, hi = activation.lo, activation.hi
        if not bool(((start >= lo) & (start <= hi) & np.isfinite(start)).all()):
            got = f"{float(start.min())} to {float(start.max())}"
            raise RangeError(message("Unknown", f"{self.name}.start", f"{lo} to {hi}", got))
        return np.array(np.broadcast_to(start, own.shape))


def default_bounds(name: str, scene: Scene) -> tuple[float, float]:
    """(lo, hi) of a parameter of a scene, hi infinite for what shines."""
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
    """Whether a parameter is of something that shines, and so decides how often it is asked."""
    return name.partition(".")[0] in ("emission", "environment", "lights")
