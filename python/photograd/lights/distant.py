"""Lights at infinity: the radiance that arrives from a direction of the world, and its derivatives.

All lights come from the core's registry (cpp/photograd/light/registry.h), and are asked through the
functions that photograd.lights uses; a RangeError refuses the same numbers, such as a negative
radiance. Directions are (N, 3) unit vectors towards the light.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd._compiled import _core
from photograd.bsdf import Parameter
from photograd.errors import RangeError, ShapeError, message
from photograd.types import Array


@dataclass(frozen=True)
class LightModel:
    """One registered light.

    Attributes:
        name: in the registry.
        parameters: differentiated, in the core's order.
        constants: not differentiated: they move edges, where no derivative exists.
        core: its functions on arrays, in the core.
    """

    name: str
    parameters: tuple[Parameter, ...]
    constants: tuple[Parameter, ...]
    core: Any

    def pack(
        self, values: Mapping[str, Any], dtype: npt.DTypeLike = np.float64
    ) -> tuple[Array, Array]:
        """Parameters (P,) and constants (C,) of {name: value} in the core's order.

        Raises:
            RangeError: a name that is missing or unknown, or values that are not finite.
            ShapeError: a value of another shape.
        """
        known = [parameter.name for parameter in (*self.parameters, *self.constants)]
        if set(values) != set(known):
            raise RangeError(message(self.name, "values", f"exactly {known}", sorted(values)))
        packed = []
        for group in (self.parameters, self.constants):
            parts = [np.zeros(0)]
            for parameter in group:
                part = np.asarray(values[parameter.name], np.float64)
                expected = (parameter.size,) if parameter.size > 1 else ()
                if part.shape != expected:
                    raise ShapeError(
                        message(self.name, parameter.name, f"shape {expected}", part.shape)
                    )
                if not np.isfinite(part).all():
                    raise RangeError(message(self.name, parameter.name, "finite numbers", part))
                parts.append(part.reshape(-1))
            packed.append(np.concatenate(parts).astype(dtype))
        return packed[0], packed[1]

    def L(self, values: Mapping[str, Any], w: Array) -> Array:
        """Radiance (N, 3) from directions w (N, 3), in the dtype of `w`."""
        w = np.ascontiguousarray(w)
        radiance: Array = self.core.radiance(*self.pack(values, w.dtype), _anywhere(w), w)
        return radiance

    def L_backward(self, values: Mapping[str, Any], w: Array, d_L: Array) -> dict[str, Array]:
        """dL/dparameters of d_L (N, 3) as {name: () or (size,)}."""
        parameters, constants = self.pack(values, w.dtype)
        d_L = np.ascontiguousarray(d_L, w.dtype)
        d = np.zeros_like(parameters)
        w = np.ascontiguousarray(w)
        self.core.radiance_backward(parameters, constants, _anywhere(w), w, d_L, d)
        ends = np.cumsum([parameter.size for parameter in self.parameters])[:-1]
        return {
            parameter.name: part if parameter.size > 1 else part[0]
            for parameter, part in zip(self.parameters, np.split(d, ends), strict=True)
        }

    def sample(self, values: Mapping[str, Any], u2: Array) -> Array:
        """Directions (N, 3) from uniform u2 (N, 2), with the density `pdf`."""
        u2 = np.ascontiguousarray(u2)
        w: Array = self.core.sample(*self.pack(values, u2.dtype), _anywhere(u2), u2)[0]
        return w

    def pdf(self, values: Mapping[str, Any], w: Array) -> Array:
        """Density (N,) of `sample` over solid angle."""
        w = np.ascontiguousarray(w)
        density: Array = self.core.pdf(*self.pack(values, w.dtype), _anywhere(w), w)
        return density


def _anywhere(rows: Array) -> Array:
    """Points (N, 3) from which lights at infinity are seen: they look the same from all."""
    return np.zeros((len(rows), 3), rows.dtype)


def registry() -> dict[str, LightModel]:
    """All lights at infinity of the core, by name."""
    return {
        name: LightModel(
            name,
            tuple(Parameter(*row) for row in light.parameters()),
            tuple(Parameter(*row) for row in light.constants()),
            light,
        )
        for name, light in _core.lights.items()
    }


def cap_height(angular_radius: float) -> float:
    """1 - cos(angular_radius), without cancellation: the sun's constant `height`."""
    return 2.0 * math.sin(0.5 * angular_radius) ** 2
