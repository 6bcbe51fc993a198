"""Specular surfaces as chains meet them, and their gradients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.types import Array, FloatArray


@typed_call
@dataclass(frozen=True, eq=False)
class SpecularMesh:
    """A triangle mesh of smooth glass, or a mirror.

    Attributes:
        vertices: (V, 3) meters.
        faces: (F, 3) counter-clockwise seen from outside.
        normals: (V, 3) of any length, blended within faces; None is flat.
        eta: refractive index inside over outside; None is a mirror, whose inside is black.

    Raises:
        DtypeError, ShapeError: arrays of other types or shapes.
        RangeError: numbers that are not finite, vertex numbers out of range, eta not above 0.
    """

    vertices: Array
    faces: Array
    normals: Array | None = None
    eta: float | None = 1.5

    def __post_init__(self) -> None:
        call = Arguments("SpecularMesh", np.float64)
        object.__setattr__(self, "vertices", call.array("vertices", self.vertices, ("V", 3)))
        last = len(self.vertices) - 1
        faces = call.array("faces", self.faces, ("F", 3), dtype=np.int64, low=0, high=last)
        object.__setattr__(self, "faces", faces)
        if self.normals is not None:
            object.__setattr__(self, "normals", call.array("normals", self.normals, ("V", 3)))
        if self.eta is not None:
            call.number("eta", self.eta, above=0)


@typed_call
@dataclass(frozen=True, eq=False)
class SpecularSphere:
    """A sphere of smooth glass, or a mirror.

    Attributes:
        center: (3,) meters.
        radius: meters, above 0.
        eta: as of `SpecularMesh`.

    Raises:
        ShapeError, RangeError: numbers that are not finite, a radius or eta not above 0.
    """

    center: Array
    radius: float
    eta: float | None = 1.5

    def __post_init__(self) -> None:
        call = Arguments("SpecularSphere", np.float64)
        object.__setattr__(self, "center", call.array("center", self.center, (3,)))
        call.number("radius", self.radius, above=0)
        if self.eta is not None:
            call.number("eta", self.eta, above=0)


Surface = SpecularMesh | SpecularSphere


@typed_call
@dataclass(frozen=True, eq=False)
class SurfaceGradient:
    """dL/d of a surface; what the surface does not have stays 0 or empty.

    Attributes:
        vertices, normals: (V, 3).
        eta: one number.
        center: (3,).
        radius: one number.
    """

    vertices: FloatArray
    normals: FloatArray
    eta: float
    center: FloatArray
    radius: float
