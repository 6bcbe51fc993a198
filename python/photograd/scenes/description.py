"""What a scene is: meshes with an albedo, a sun, a sky, a box, and perhaps a cloud of density.

A description holds arrays and numbers only; a renderer builds what it needs from them.
World as everywhere: right-handed, +Y up, meters. Radiance and albedo are linear Rec. 709.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course.checks import require_number

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, SceneError, message
from photograd.types import Array

Points: TypeAlias = npt.NDArray[np.float64]
"""(N, 3) positions in the world, or a (3,) vector."""

Density: TypeAlias = Callable[[Points], npt.NDArray[np.float64]]
"""Points (N, 3) -> sigma_t (N,) in 1/m."""

_BOX_SLACK = 1e-6
"""Vertices are float32: near 1 m they are off by up to 6e-8, so this is a few ten roundings."""


@typed_call
@dataclass(frozen=True, eq=False)
class SceneMesh:
    """Triangles, counter-clockwise seen from outside, with a diffuse albedo in 0..1.

    Attributes:
        vertices: (V, 3) float32, meters.
        faces: (F, 3) uint32 indices of vertices.
        albedo: float32; (3,) one color, (V, 3) colors of vertices, or (H, W, 3) a texture.
        uv: (V, 2) float32 texture coordinates, u right and v down, (0, 0) the texture's top left
            corner; needed by a texture, otherwise optional.

    Raises:
        ShapeError, DtypeError: arrays of other shapes, or not float32; only lists are converted.
        RangeError: non-finite numbers, indices of no vertex, albedo outside 0..1.
        SceneError: triangles without area, or a texture without uv.
    """

    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.uint32]
    albedo: npt.NDArray[np.float32]
    uv: npt.NDArray[np.float32] | None = None

    def __post_init__(self) -> None:
        call = Arguments("SceneMesh", np.float32, convert=False)
        vertices = call.array("vertices", self.vertices, ("V", 3), min_length=1)
        faces = call.array("faces", self.faces, ("F", 3), dtype=np.uint32, min_length=1)
        if int(faces.max()) >= len(vertices):
            expected = f"indices below V = {len(vertices)}"
            raise RangeError(message("SceneMesh", "faces", expected, int(faces.max())))
        _check_areas(vertices, faces)
        shapes = ((3,), ("V", 3), ("H", "W", 3))
        albedo = call.array("albedo", self.albedo, *shapes, min_length=1, low=0.0, high=1.0)
        uv = None if self.uv is None else call.array("uv", self.uv, ("V", 2))
        if albedo.ndim == 3 and uv is None:
            remedy = "a texture needs coordinates"
            raise SceneError(message("SceneMesh", "uv", "shape (V, 2)", "None", remedy))
        for name, array in (
            ("vertices", vertices),
            ("faces", faces),
            ("albedo", albedo),
            ("uv", uv),
        ):
            object.__setattr__(self, name, None if array is None else _read_only(array))

    @property
    def albedo_kind(self) -> Literal["constant", "vertices", "texture"]:
        """How `albedo` is to be read."""
        kinds: dict[int, Literal["constant", "vertices", "texture"]]
        kinds = {1: "constant", 2: "vertices", 3: "texture"}
        return kinds[self.albedo.ndim]

    @property
    def box(self) -> Points:
        """(2, 3) smallest and largest coordinates."""
        corners = [self.vertices.min(axis=0), self.vertices.max(axis=0)]
        return np.asarray(corners, dtype=np.float64)


@typed_call
@dataclass(frozen=True, eq=False)
class SunDescription:
    """A disc of equal radiance at infinity.

    Attributes:
        direction: (3,) unit vector towards the sun's middle.
        radiance: (3,) of the disc.
        angular_radius: of the disc, in radians; the penumbra grows with it. The real sun has
            0.00465.

    Raises:
        ShapeError, RangeError: not (3,), not finite, not of length 1, negative radiance, or a
            radius outside 0..pi/2.
    """

    direction: Points
    radiance: Points
    angular_radius: float

    def __post_init__(self) -> None:
        direction = _vector("SunDescription", "direction", self.direction)
        length = float(np.linalg.norm(direction))
        if abs(length - 1.0) > 1e-6:
            raise RangeError(message("SunDescription", "direction", "length 1", f"{length:.9g}"))
        radius = self.angular_radius
        require_number(
            "SunDescription", "angular_radius", radius, least=0.0, most=np.pi / 2, open_ends=True
        )
        object.__setattr__(self, "direction", direction)
        object.__setattr__(self, "radiance", _color("SunDescription", "radiance", self.radiance))

    @classmethod
    def from_irradiance(
        cls, towards: Points, irradiance: Points, angular_radius: float
    ) -> SunDescription:
        """The sun whose disc gives `irradiance` (3,) on a surface that faces it.

        The integral of L cos(theta) over a cap of radius a around the normal is pi L sin^2(a).

        Args:
            towards: (3,) direction of the sun, of any length but 0.
            irradiance: (3,).
            angular_radius: radians.

        Raises:
            ShapeError, RangeError: as the constructor does.
        """
        towards = _vector("from_irradiance", "towards", towards)
        length = float(np.linalg.norm(towards))
        if length == 0.0:
            raise RangeError(message("from_irradiance", "towards", "a direction", "a zero vector"))
        require_number(
            "from_irradiance",
            "angular_radius",
            angular_radius,
            least=0.0,
            most=np.pi / 2,
            open_ends=True,
        )
        irradiance = _color("from_irradiance", "irradiance", irradiance)
        radiance = irradiance / (np.pi * np.sin(angular_radius) ** 2)
        return cls(towards / length, radiance, angular_radius)


@typed_call
@dataclass(frozen=True, eq=False)
class SkyDescription:
    """Radiance (3,) from straight above, from the horizon and from straight below.

    Between them it is for the renderer to blend by the height of the direction.

    Raises:
        ShapeError, RangeError: not (3,), not finite, or negative.
    """

    zenith: Points
    horizon: Points
    ground: Points

    def __post_init__(self) -> None:
        for name in ("zenith", "horizon", "ground"):
            object.__setattr__(self, name, _color("SkyDescription", name, getattr(self, name)))


@typed_call
@dataclass(frozen=True, eq=False)
class SceneDescription:
    """Everything that a renderer needs to know of a scene.

    Attributes:
        name: what the registry calls it.
        meshes: at least one.
        sun, sky: all the light there is.
        bounds: (2, 3) box with all vertices and all density inside.
        density: None, or a function from points (N, 3) to sigma_t (N,) in 1/m, 0 outside `bounds`.

    Raises:
        SceneError: no meshes, or vertices outside the bounds.
        ShapeError, RangeError: bounds not (2, 3), not finite, or not low < high.
    """

    name: str
    meshes: tuple[SceneMesh, ...]
    sun: SunDescription
    sky: SkyDescription
    bounds: Points
    density: Density | None = None

    def __post_init__(self) -> None:
        if not self.meshes:
            raise SceneError(message("SceneDescription", "meshes", "at least one", "none"))
        call = Arguments("SceneDescription", np.float64)
        bounds = _read_only(call.box("bounds", self.bounds))
        for index, mesh in enumerate(self.meshes):
            low, high = mesh.box
            if (low < bounds[0] - _BOX_SLACK).any() or (high > bounds[1] + _BOX_SLACK).any():
                got = f"a box {mesh.box.round(4).tolist()}"
                expected = f"all vertices inside {bounds.tolist()}"
                where = f"meshes[{index}]"
                raise SceneError(message("SceneDescription", where, expected, got))
        object.__setattr__(self, "bounds", bounds)


@typed_call
def bounds_of(meshes: tuple[SceneMesh, ...], *, margin: float = 0.02) -> Points:
    """Box (2, 3) of all vertices, with `margin` meters left free on every side."""
    boxes = np.stack([mesh.box for mesh in meshes])
    return np.stack([boxes[:, 0].min(axis=0) - margin, boxes[:, 1].max(axis=0) + margin])


def _read_only(array: Array) -> Array:
    copy = np.array(array, order="C")
    copy.setflags(write=False)
    return copy


def _check_areas(vertices: npt.NDArray[np.generic], faces: npt.NDArray[np.generic]) -> None:
    """Refuse triangles whose corners lie on a line, in double precision."""
    corners = vertices.astype(np.float64)[faces.astype(np.int64)]
    sides = corners[:, 1:] - corners[:, :1]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    if not bool((areas > 0.0).all()):
        got = f"{int((areas <= 0.0).sum())} without, first faces[{int(np.argmin(areas))}]"
        raise SceneError(message("SceneMesh", "faces", "triangles with an area", got))


def _vector(function: str, name: str, value: Points) -> Points:
    return _read_only(Arguments(function, np.float64).array(name, value, (3,)))


def _color(function: str, name: str, value: Points) -> Points:
    return _read_only(Arguments(function, np.float64).array(name, value, (3,), low=0.0))
