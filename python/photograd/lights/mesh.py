"""A mesh whose triangles glow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.core import _core
from photograd.errors import RangeError, ShapeError, message
from photograd.lights.base import Array, Light


@dataclass(frozen=True, eq=False)
class MeshLight(Light):
    """Triangles that glow on their front sides, counterclockwise seen; sampled by area.

    `L` and `pdf` ask what w meets first of the mesh, by trying every triangle: meant for
    small lamps and for proofs. `sample` does not look whether the mesh hides the point it draws.

    Attributes:
        vertices: (V, 3), m, in the world.
        faces: (F, 3), numbers of vertices.
        radiance: (3,), W/(m^2 sr).

    Raises:
        SceneError: no faces, faces without area or of unknown vertices, vertices not finite.
        ShapeError, RangeError: arrays of another shape, numbers of vertices that are negative, a
            radiance that is negative or not finite.
    """

    vertices: Array
    faces: Array
    radiance: Any

    def __post_init__(self) -> None:
        radiance = np.asarray(self.radiance, np.float64)
        if radiance.shape != (3,):
            raise ShapeError(message("MeshLight", "radiance", "shape (3,)", radiance.shape))
        vertices = np.ascontiguousarray(self.vertices, np.float64)
        faces = np.asarray(self.faces)
        if faces.size and (faces.dtype.kind not in "iu" or faces.min() < 0):
            raise RangeError(message("MeshLight", "faces", "numbers of vertices, from 0", faces))
        faces = np.ascontiguousarray(faces, np.uint32)
        object.__setattr__(self, "radiance", radiance)
        object.__setattr__(self, "_mesh", _core.EmittingMesh(vertices, faces))
        self.pdf(np.zeros((0, 3)), np.zeros((0, 3)))  # the core looks at the radiance

    @property
    def area(self) -> float:
        """Sum of all faces, m^2."""
        area: float = self.core_call(np.float64)[0].area
        return area

    def core_call(self, dtype: npt.DTypeLike) -> tuple[Any, tuple[Array, ...]]:
        """The core's mesh; radiance (3,)."""
        return vars(self)["_mesh"], (self.radiance.astype(dtype),)

    def named(self, derivative: Array) -> dict[str, Array]:
        """{"radiance": (3,)}."""
        return {"radiance": derivative}
