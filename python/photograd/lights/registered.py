"""Lights of a few numbers each: those of the core's registry (cpp/photograd/light/registry.h)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from photograd._compiled import _core
from photograd.bsdf import Parameter
from photograd.errors import RangeError, ShapeError, message
from photograd.lights.base import Light, unit_vector
from photograd.types import Array

_DIRECTIONS = {"direction", "axis"}  # made unit vectors here, so that any length may be given


@dataclass(frozen=True, eq=False)
class RegisteredLight(Light):
    """A light whose attributes are the core's parameters and constants, of the same names.

    Numbers are checked when the light is made. Directions are divided by their length.

    Raises:
        RangeError: numbers that are not finite, negative colours, shapes without extent.
        ShapeError: a value of another shape.
    """

    core_name: ClassVar[str]

    def __post_init__(self) -> None:
        for name in _DIRECTIONS & set(vars(self)):
            object.__setattr__(self, name, unit_vector(self.core_name, name, getattr(self, name)))
        core, leading = self.core_call(np.float64)
        core.pdf(*leading, np.zeros((0, 3)), np.zeros((0, 3)))  # the core looks at the numbers

    @classmethod
    def parameters(cls) -> tuple[Parameter, ...]:
        """What is differentiated, in the core's order."""
        return tuple(Parameter(*row) for row in cls._functions().parameters())

    @classmethod
    def constants(cls) -> tuple[Parameter, ...]:
        """What is not: it moves edges, where no derivative exists."""
        return tuple(Parameter(*row) for row in cls._functions().constants())

    @classmethod
    def _functions(cls) -> Any:
        return _core.sampled_lights[cls.core_name]

    def core_call(self, dtype: npt.DTypeLike) -> tuple[Any, tuple[Array, ...]]:
        """The core's class for this light; parameters (P,) and constants (C,)."""
        packed = (self._pack(described) for described in (self.parameters(), self.constants()))
        return self._functions(), tuple(part.astype(dtype) for part in packed)

    def _pack(self, described: tuple[Parameter, ...]) -> Array:
        parts = [np.zeros(0)]
        for parameter in described:
            value = np.asarray(getattr(self, parameter.name), np.float64)
            expected = (parameter.size,) if parameter.size > 1 else ()
            if value.shape != expected:
                raise ShapeError(
                    message(self.core_name, parameter.name, f"shape {expected}", value.shape)
                )
            parts.append(value.reshape(-1))
        return np.concatenate(parts)

    def named(self, derivative: Array) -> dict[str, Array]:
        """{name: () or (3,)} of a derivative (P,)."""
        ends = np.cumsum([parameter.size for parameter in self.parameters()])[:-1]
        return {
            parameter.name: part if parameter.size > 1 else part[0]
            for parameter, part in zip(self.parameters(), np.split(derivative, ends), strict=True)
        }


@dataclass(frozen=True, eq=False)
class PointLight(RegisteredLight):
    """Shines from `position` (3,) to all sides alike; `intensity` (3,) in W/sr."""

    position: Any
    intensity: Any
    core_name: ClassVar[str] = "point"
    is_delta: ClassVar[bool] = True


@dataclass(frozen=True, eq=False)
class SpotLight(RegisteredLight):
    """Shines from `position` (3,) along `axis` (3,) in a cone with a soft rim.

    Attributes:
        intensity: (3,), W/sr, along the axis.
        cos_outer: cosine of the angle between the axis and the rim, in [-1, 1).
        softness: part of the cone, counted in cosines from the rim, over which light fades; (0, 1].
    """

    position: Any
    axis: Any
    intensity: Any
    cos_outer: float
    softness: float
    core_name: ClassVar[str] = "spot"
    is_delta: ClassVar[bool] = True


@dataclass(frozen=True, eq=False)
class DirectionalLight(RegisteredLight):
    """Parallel light; `direction` (3,) points towards it.

    Attributes:
        irradiance: (3,), W/m^2, of a surface that faces it.
    """

    direction: Any
    irradiance: Any
    core_name: ClassVar[str] = "directional"
    is_delta: ClassVar[bool] = True


@dataclass(frozen=True, eq=False)
class ConstantLight(RegisteredLight):
    """The same `radiance` (3,), W/(m^2 sr), from everywhere ("ambient")."""

    radiance: Any
    core_name: ClassVar[str] = "constant"


@dataclass(frozen=True, eq=False)
class SkyLight(RegisteredLight):
    """A dome whose radiance (3,) each, W/(m^2 sr), blends by height (photograd.lights.distant)."""

    zenith: Any
    horizon: Any
    ground: Any
    core_name: ClassVar[str] = "sky"


@dataclass(frozen=True, eq=False)
class SunLight(RegisteredLight):
    """A disc at infinity around `direction` (3,) of equal `radiance` (3,), W/(m^2 sr).

    Attributes:
        height: 1 - cos(angular radius), as `photograd.lights.distant.cap_height` makes it.
    """

    direction: Any
    radiance: Any
    height: float
    core_name: ClassVar[str] = "sun"


@dataclass(frozen=True, eq=False)
class QuadLight(RegisteredLight):
    """A rectangle that glows on the side of edge_x x edge_y, sampled by solid angle.

    Attributes:
        corner: (3,), m.
        edge_x, edge_y: (3,) each, m, perpendicular.
        radiance: (3,), W/(m^2 sr).
    """

    corner: Any
    edge_x: Any
    edge_y: Any
    radiance: Any
    core_name: ClassVar[str] = "quad"


@dataclass(frozen=True, eq=False)
class SphereLight(RegisteredLight):
    """A ball around `center` (3,) of `radius`, m, that glows outwards, `radiance` (3,)."""

    center: Any
    radius: float
    radiance: Any
    core_name: ClassVar[str] = "sphere"


@dataclass(frozen=True, eq=False)
class TriangleLight(RegisteredLight):
    """Corners a, b, c (3,), m, counterclockwise seen from where it glows; `radiance` (3,)."""

    a: Any
    b: Any
    c: Any
    radiance: Any
    core_name: ClassVar[str] = "triangle"


CLASSES: Mapping[str, type[RegisteredLight]] = {
    light.core_name: light
    for light in (
        PointLight,
        SpotLight,
        DirectionalLight,
        ConstantLight,
        SkyLight,
        SunLight,
        QuadLight,
        SphereLight,
        TriangleLight,
    )
}


def from_values(name: str, values: Mapping[str, Any]) -> RegisteredLight:
    """The light of this name in the registry, from {attribute: value}.

    Raises:
        RangeError: an unknown name, attributes that are missing or unknown, or bad values.
    """
    if name not in CLASSES:
        raise RangeError(message("from_values", "name", f"one of {sorted(CLASSES)}", name))
    known = {p.name for p in (*CLASSES[name].parameters(), *CLASSES[name].constants())}
    if set(values) != known:
        raise RangeError(message(name, "values", f"exactly {sorted(known)}", sorted(values)))
    return CLASSES[name](**values)
