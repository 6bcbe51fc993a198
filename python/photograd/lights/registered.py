"""Lights of a few numbers each: those of the core's registry (cpp/photograd/light/registry.h)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._compiled import _core
from photograd._registry import ModelParameters, Registry
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.lights.base import Light
from photograd.types import Array

_DIRECTIONS = {"direction", "axis"}  # made unit vectors here, so that any length may be given


@typed_call
@dataclass(frozen=True, eq=False)
class RegisteredLight(Light):
    """A light whose attributes are the core's parameters and constants, of the same names.

    Numbers are checked when the light is made. Directions are divided by their length.

    Raises:
        RangeError: numbers that are not finite, negative colors, shapes without extent.
        ShapeError: a value of another shape.
    """

    core_name: ClassVar[str]

    def __post_init__(self) -> None:
        call = Arguments(type(self).__name__, np.float64)
        for name in _DIRECTIONS & set(vars(self)):
            object.__setattr__(self, name, _unit_vector(call, name, getattr(self, name)))
        leading = tuple(self._pack(call, described) for described in self._described())
        nowhere = np.zeros((0, 3))
        call.run(self._functions().pdf, *leading, nowhere, nowhere)  # the core looks at the numbers

    @classmethod
    def parameters(cls) -> ModelParameters:
        """What is differentiated, in the core's order."""
        return ModelParameters.of(cls._functions().parameters())

    @classmethod
    def constants(cls) -> ModelParameters:
        """What is not: it moves edges, where no derivative exists."""
        return ModelParameters.of(cls._functions().constants())

    @classmethod
    def _described(cls) -> tuple[ModelParameters, ModelParameters]:
        return cls.parameters(), cls.constants()

    @classmethod
    def _functions(cls) -> Any:
        return _core.sampled_lights[cls.core_name]

    def core_call(self, dtype: npt.DTypeLike) -> tuple[Any, tuple[Array, ...]]:
        """The core's class for this light; parameters (P,) and constants (C,)."""
        call = Arguments(type(self).__name__, dtype)
        return self._functions(), tuple(self._pack(call, each) for each in self._described())

    def _pack(self, call: Arguments, described: ModelParameters) -> Array:
        values = {parameter.name: getattr(self, parameter.name) for parameter in described}
        return described.pack_one(call, "", values, positive=False)

    def named(self, derivative: Array) -> dict[str, Array]:
        """{name: () or (3,)} of a derivative (P,)."""
        return self.parameters().unpack(derivative)


def _unit_vector(call: Arguments, name: str, value: Any) -> Array:
    vector = call.array(name, value, (3,))
    norm = float(np.linalg.norm(vector))
    if not 0.0 < norm < np.inf:
        raise RangeError(message(call.function, name, "a direction", vector))
    return np.asarray(vector / norm)


@typed_call
@dataclass(frozen=True, eq=False)
class PointLight(RegisteredLight):
    """Shines from `position` (3,) to all sides alike; `intensity` (3,) in W/sr."""

    position: Any
    intensity: Any
    core_name: ClassVar[str] = "point"
    is_delta: ClassVar[bool] = True


@typed_call
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


@typed_call
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


@typed_call
@dataclass(frozen=True, eq=False)
class ConstantLight(RegisteredLight):
    """The same `radiance` (3,), W/(m^2 sr), from everywhere ("ambient")."""

    radiance: Any
    core_name: ClassVar[str] = "constant"


@typed_call
@dataclass(frozen=True, eq=False)
class SkyLight(RegisteredLight):
    """A dome whose radiance (3,) each, W/(m^2 sr), blends by height."""

    zenith: Any
    horizon: Any
    ground: Any
    core_name: ClassVar[str] = "sky"


@typed_call
@dataclass(frozen=True, eq=False)
class SunLight(RegisteredLight):
    """A disc at infinity around `direction` (3,) of equal `radiance` (3,), W/(m^2 sr).

    Attributes:
        height: 1 - cos(angular radius), as `cap_height` makes it.
    """

    direction: Any
    radiance: Any
    height: float
    core_name: ClassVar[str] = "sun"


@typed_call
@dataclass(frozen=True, eq=False)
class QuadLight(RegisteredLight):
    """A rectangle that emits on the side of edge_x x edge_y, sampled by solid angle.

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


@typed_call
@dataclass(frozen=True, eq=False)
class SphereLight(RegisteredLight):
    """A ball around `center` (3,) of `radius`, m, that emits outwards, `radiance` (3,)."""

    center: Any
    radius: float
    radiance: Any
    core_name: ClassVar[str] = "sphere"


@typed_call
@dataclass(frozen=True, eq=False)
class TriangleLight(RegisteredLight):
    """Corners a, b, c (3,), m, counterclockwise seen from where it emits; `radiance` (3,)."""

    a: Any
    b: Any
    c: Any
    radiance: Any
    core_name: ClassVar[str] = "triangle"


@typed_call
def cap_height(angular_radius: float) -> float:
    """1 - cos(angular_radius), without cancellation: the sun's constant `height`."""
    Arguments("cap_height").number("angular_radius", angular_radius)
    return 2.0 * math.sin(0.5 * angular_radius) ** 2


@typed_call
def registry() -> Registry[type[RegisteredLight]]:
    """The classes of all lights of a few numbers, by their names in the core."""
    classes = (
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
    return Registry("light", {light.core_name: light for light in classes})
