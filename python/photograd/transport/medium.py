"""What fills volumes: fog, milk, colored glass. Absorption, scattering, and where they vary.

The mathematics is in cpp/photograd/medium/medium.h, cpp/photograd/render/path/free_path.h
(sampling) and cpp/photograd/render/path/adjoint.h (what a path carries, and its derivatives).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.bsdf.phase import registry as phase_functions
from photograd.errors import RangeError, message
from photograd.types import Array

BOUNDARY = "boundary"
"""In place of a material: a surface that is only the boundary between two media. Light passes
straight through it, and it is not seen."""
VACUUM = "vacuum"
"""In place of a medium: nothing."""


@typed_call
@dataclass(frozen=True, eq=False)
class DensityGrid:
    """A density that scales a medium's sigma_t from place to place.

    Attributes:
        values: (X, Y, Z) pure numbers of at least 0, at the voxels' centers; at least two along
            each axis. Between centers they are interpolated (trilinear); outside the box is 0.
        world_from_box: (4, 4) of the box [0, 1]^3 that the grid fills; meters.
        majorant: a bound that no value exceeds, also later, when they are fitted; None takes the
            largest value of each rendering. Rendering gets slower the looser it is; a fit that
            starts from empty space needs one above 0, or it would never look there.

    Raises:
        ShapeError: another rank, too few voxels, or a matrix of another shape.
        RangeError: values negative or not finite, a box without volume, or a majorant below them.
    """

    values: Array
    world_from_box: Array = field(default_factory=lambda: np.eye(4))
    majorant: float | None = None

    def __post_init__(self) -> None:
        call = Arguments("DensityGrid", np.float64)
        values = np.array(call.array("values", self.values, ("X", "Y", "Z"), min_length=2, low=0.0))
        matrix = np.array(call.array("world_from_box", self.world_from_box, (4, 4)))
        if abs(np.linalg.det(matrix[:3, :3])) < 1e-30:
            raise RangeError(
                message("DensityGrid", "world_from_box", "a box with a volume", "none")
            )
        if self.majorant is not None:
            Arguments("DensityGrid").number("majorant", self.majorant, low=0)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "world_from_box", matrix)
        self.largest("DensityGrid", "values", values)

    def largest(self, function: str, name: str, values: Array) -> float:
        """The bound of these values (X, Y, Z); raises RangeError for what is no density.

        Args:
            function: on whose behalf the error speaks.
            name: what it calls the values.
            values: (X, Y, Z).
        """
        most = float(Arguments(function).array(name, values, low=0).max())
        if self.majorant is None:
            return most
        if most > self.majorant:
            raise RangeError(message(function, name, f"at most the majorant {self.majorant}", most))
        return float(self.majorant)

    @property
    def box_from_world(self) -> Array:
        """(3, 4), as the core takes it."""
        return np.ascontiguousarray(np.linalg.inv(self.world_from_box)[:3])


@typed_call
@dataclass(frozen=True, eq=False)
class Medium:
    """Particles that absorb and scatter, in the field's usual terms: extinction and albedo.

    Attributes:
        sigma_t: (3,) or a number, extinction in 1/m: what absorption and scattering take out of a
            beam over a meter, sigma_a + sigma_s.
        albedo: (3,) or a number, sigma_s / sigma_t, 0 to 1: how much of that is scattered. None
            makes a medium that only absorbs; unlike one with an albedo of 0, nothing is drawn
            there by chance, and there is no derivative with respect to the albedo. More than 1
            would create light and is refused.
        phase: the phase function, a name of `photograd.bsdf.phase.registry()`;
            unused without albedo.
        values: {parameter of the phase function: number}; g lies between -1 and 1.
        density: scales sigma_t, or None: the same everywhere.

    Raises:
        RangeError: negative or not finite coefficients, an albedo outside 0 to 1, no such phase
            function, or parameters missing, unknown or out of range.
        ShapeError: neither a number nor three.
    """

    sigma_t: Any
    albedo: Any = None
    phase: str = "henyey_greenstein"
    values: Mapping[str, float] = field(default_factory=lambda: {"g": 0.0})
    density: DensityGrid | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma_t", _color("sigma_t", self.sigma_t))
        if self.albedo is not None:
            object.__setattr__(self, "albedo", _color("albedo", self.albedo))
            known = [parameter.name for parameter in phase_functions()[self.phase].parameters]
            if sorted(self.values) != sorted(known):
                got = ", ".join(self.values) or "none"
                raise RangeError(message("Medium", "values", f"{', '.join(known)}", got))
        self.row("Medium", "", self.start)

    @classmethod
    def of(cls, sigma_a: Any, sigma_s: Any, **more: Any) -> Medium:
        """From coefficients of absorption and scattering, (3,) or a number each, in 1/m.

        Args:
            sigma_a: absorption.
            sigma_s: scattering.
            more: other fields of `Medium`.
        """
        a, s = _color("sigma_a", sigma_a), _color("sigma_s", sigma_s)
        for name, value in (("sigma_a", a), ("sigma_s", s)):
            _check("Medium.of", name, value)
        total = a + s
        return cls(total, np.divide(s, total, out=np.zeros(3), where=total > 0), **more)

    @property
    def phase_name(self) -> str:
        """Of the phase function; "" for a medium that only absorbs."""
        return "" if self.albedo is None else self.phase

    @property
    def start(self) -> dict[str, Array]:
        """{parameter: value} of everything that may change, the core's parameters in its order."""
        values = {"sigma_t": self.sigma_t}
        if self.albedo is not None:
            values["albedo"] = self.albedo
            for parameter in phase_functions()[self.phase].parameters:
                values[parameter.name] = np.asarray(self.values[parameter.name], np.float64)
        if self.density is not None:
            values["density"] = self.density.values
        return values

    def row(self, function: str, prefix: str, values: Mapping[str, Array]) -> Array:
        """The parameters (P,) that the core packs; raises RangeError for what is no medium.

        Args:
            function: on whose behalf errors speak.
            prefix: of names in errors.
            values: {parameter: value}.
        """
        parts = []
        for name in self.start:
            if name == "density":
                continue
            value = np.asarray(values[name])
            if name in ("sigma_t", "albedo"):
                _check(function, prefix + name, value, 1 if name == "albedo" else None)
            else:
                Arguments(function).number(prefix + name, float(value), above=-1, below=1)
            parts.append(np.reshape(value, -1))
        return np.concatenate(parts)


def _color(name: str, value: Any) -> Array:
    color = Arguments("Medium", np.float64).array(name, value, (), (3,), finite=False)
    return np.array(np.broadcast_to(color, (3,)))


def _check(function: str, name: str, value: Array, most: float | None = None) -> None:
    Arguments(function).array(name, value, low=0, high=most)
