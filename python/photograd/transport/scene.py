"""What a scene for path tracing is: shapes with a material each, what shines, and a camera.

World as everywhere: right-handed, +Y up, metres; radiance and reflectances are linear Rec. 709.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.suggest import choose_from

from photograd import bsdf, delta_bsdf
from photograd.data.camera import Camera
from photograd.errors import DtypeError, RangeError, SceneError, ShapeError, message
from photograd.lights import Light
from photograd.transport.lens import PINHOLE, Lens
from photograd.transport.media_list import check_media
from photograd.transport.medium import BOUNDARY, Medium
from photograd.transport.motion import check_motion, checked_closing_places
from photograd.transport.sdf_shape import SdfShape
from photograd.transport.shape_checks import (
    check_range,
    checked_color,
    checked_place,
    float_rows,
    usable_triangles,
)
from photograd.transport.shutter import Shutter
from photograd.transport.texture import NormalMap, OcclusionMap, Texture, TextureUse, checked_uses

Array = npt.NDArray[Any]
MODELS: dict[str, bsdf.BsdfModel | delta_bsdf.DeltaModel] = {
    **bsdf.registry(),
    **delta_bsdf.registry(),
}
"""All reflectance models, rough and smooth, by name."""
ALPHA = bsdf.Parameter("alpha", 1, 0.0, 1.0, "")
"""What any material may have besides the parameters of its model."""


@dataclass(frozen=True)
class Material:
    """A reflectance model and its parameters.

    Attributes:
        model: a name of `MODELS`.
        values: {parameter: number or (3,)}, all of them; and "alpha", if the surface covers only
            that part of what lies behind it (0 to 1): the rest of the light goes straight through.
        textures: {parameter: the texture that scales its value}; the product is brought into the
            parameter's range.
        normal_map: bends the shading normals, or None.
        alpha_cutoff: of a mask, or None: where alpha times its texture is at least this, the
            surface covers all, elsewhere nothing. A mask has no derivative with respect to alpha.
        occlusion: of ambient light, or None. Paths find what is occluded themselves.

    Raises:
        SceneError: no such model, or a cutoff without alpha.
        RangeError, ShapeError: parameters missing, unknown, not finite, outside of their range or
            of another shape.
    """

    model: str
    values: Mapping[str, Any]
    textures: Mapping[str, TextureUse] = field(default_factory=dict)
    normal_map: NormalMap | None = None
    alpha_cutoff: float | None = None
    occlusion: OcclusionMap | None = None

    def __post_init__(self) -> None:
        if self.model not in MODELS:
            known = choose_from(self.model, MODELS)
            raise SceneError(message("Material", "model", "a reflectance model", self.model, known))
        self.row()
        for parameter in self.parameters:
            check_range(self.model, parameter, self.values[parameter.name])
        if self.alpha_cutoff is not None and not (self.sheer and self.alpha_cutoff >= 0):
            expected, got = "at least 0, and a value of alpha", self.alpha_cutoff
            raise SceneError(message("Material", "alpha_cutoff", expected, got))
        sizes = {parameter.name: parameter.size for parameter in self.parameters}
        object.__setattr__(self, "textures", checked_uses(self.model, sizes, self.textures))

    @property
    def needs_uv(self) -> bool:
        """Whether surfaces of this material need texture coordinates."""
        return bool(self.textures) or self.normal_map is not None

    @property
    def sheer(self) -> bool:
        """Whether surfaces of this material cover only a part of what lies behind them."""
        return ALPHA.name in self.values

    @property
    def parameters(self) -> tuple[bsdf.Parameter, ...]:
        """Descriptions of the parameters, in the order in which the core packs them."""
        return MODELS[self.model].parameters + ((ALPHA,) if self.sheer else ())

    def row(self) -> Array:
        """All parameters as one row of numbers (P,), float64."""
        packed: Array = bsdf.pack_rows(self.model, self.parameters, self.values, np.float64)[0]
        return packed


@dataclass(frozen=True, eq=False)
class MeshShape:
    """A triangle mesh in the world.

    Triangles without area, or with corners that are not finite, are dropped with a warning that
    counts them.

    Attributes:
        name: unique in its scene.
        vertices: (V, 3) floating point, metres; kept as float32.
        faces: (F, 3) integers, counter-clockwise seen from the side that emits.
        material: name of one of the scene's materials, or `medium.BOUNDARY`: it is not seen.
        emission: (3,) radiance of the front; 0 for all that does not shine.
        normals: (V, 3) shading normals of any length, or None for flat triangles.
        uv: (V, 2) texture coordinates, v downwards, or None.
        places: world_from_object, (4, 4) each, of instances of this mesh; none places it once,
            where it is. All shine and reflect alike, and are kept in memory once.
        glow: the texture that scales `emission`, three channels of it, or None.
        interior: name of the medium that fills the mesh, which has to be closed, or
            `medium.VACUUM`. None: nothing in glass, and whatever is around in other surfaces.
        closing_places: world_from_object of each of `places` (of the mesh itself, where there are
            none) when the shutter closes: in between, each point moves straight on. None of them:
            it stands still.

    Raises:
        DtypeError, ShapeError: arrays of other types or shapes.
        RangeError: vertex numbers out of range, negative emission, or a place that mirrors or
            flattens.
        SceneError: no triangle is left; for a shape that shines, a light without area.
    """

    name: str
    vertices: Array
    faces: Array
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    normals: Array | None = None
    uv: Array | None = None
    places: tuple[Array, ...] = ()
    glow: TextureUse | None = None
    interior: str | None = None
    closing_places: tuple[Array, ...] = ()

    def __post_init__(self) -> None:
        vertices = float_rows(self.name, "vertices", self.vertices)
        faces = np.asarray(self.faces)
        if faces.dtype.kind not in "iu":
            raise DtypeError(message("MeshShape", f"{self.name}.faces", "integers", faces.dtype))
        if faces.ndim != 2 or faces.shape[1] != 3:
            expected = "shape (F, 3)"
            raise ShapeError(message("MeshShape", f"{self.name}.faces", expected, faces.shape))
        if faces.size and not (int(faces.min()) >= 0 and int(faces.max()) < len(vertices)):
            expected = f"vertex numbers 0 to {len(vertices) - 1}"
            got = f"{int(faces.min())} to {int(faces.max())}"
            raise RangeError(message("MeshShape", f"{self.name}.faces", expected, got))
        emission = checked_color(self.name, "emission", self.emission)
        vertices, faces = usable_triangles(self.name, vertices, faces)
        if not len(faces):
            shines = bool(emission.any())
            expected = "a light with an area" if shines else "a triangle with an area"
            raise SceneError(message("MeshShape", f"{self.name}.faces", expected, "none"))
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", np.ascontiguousarray(faces, np.uint32))
        object.__setattr__(self, "emission", emission)
        if self.normals is not None:
            normals = float_rows(self.name, "normals", self.normals)
            if normals.shape != vertices.shape or not np.isfinite(normals).all():
                expected = f"finite numbers, shape {vertices.shape}"
                wrong = f"shape {normals.shape}"
                raise ShapeError(message("MeshShape", f"{self.name}.normals", expected, wrong))
            object.__setattr__(self, "normals", normals)
        if self.uv is not None:
            uv = np.asarray(self.uv)
            if uv.dtype.kind != "f" or uv.shape != (len(vertices), 2) or not np.isfinite(uv).all():
                expected = f"finite floating point numbers, shape ({len(vertices)}, 2)"
                got = f"{uv.dtype}, shape {uv.shape}"
                raise ShapeError(message("MeshShape", f"{self.name}.uv", expected, got))
            object.__setattr__(self, "uv", np.ascontiguousarray(uv, np.float32))
        object.__setattr__(self, "places", tuple(checked_place(self.name, m) for m in self.places))
        closing = checked_closing_places(self.name, self.places, self.closing_places)
        object.__setattr__(self, "closing_places", closing)

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner of all instances at all times, metres."""
        corners = self.vertices[self.faces.reshape(-1)].astype(np.float64)
        if not self.places and not self.closing_places:
            return np.array([corners.min(axis=0), corners.max(axis=0)])
        ends = np.array([corners.min(axis=0), corners.max(axis=0)])
        matrices = (*(self.places or (np.eye(4),)), *self.closing_places)
        eight = np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i, j, k in np.ndindex(2, 2, 2)])
        world = np.concatenate([eight @ m[:3, :3].T + m[:3, 3] for m in matrices])
        return np.array([world.min(axis=0), world.max(axis=0)])


@dataclass(frozen=True, eq=False)
class SphereShape:
    """A perfect sphere; its outside emits.

    Attributes:
        name: unique in its scene.
        center: (3,) metres.
        radius: metres, above 0.
        material, interior: as for `MeshShape`.
        emission: (3,) radiance.
        closing: (3,) the centre when the shutter closes, metres: it moves there straight on. None
            stands still.

    Raises:
        RangeError, ShapeError: numbers that are not finite, a radius of 0, negative emission.
    """

    name: str
    center: Array
    radius: float
    material: str
    emission: Array = field(default_factory=lambda: np.zeros(3))
    interior: str | None = None
    closing: Array | None = None

    def __post_init__(self) -> None:
        for key in ("center", "closing"):
            given = getattr(self, key)
            if key == "closing" and given is None:
                continue
            point = np.asarray(given, np.float64)
            if point.shape != (3,) or not np.isfinite(point).all():
                expected = "three finite numbers"
                raise ShapeError(message("SphereShape", f"{self.name}.{key}", expected, given))
            object.__setattr__(self, key, point)
        emission = checked_color(self.name, "emission", self.emission)
        if not (np.isfinite(self.radius) and np.float32(self.radius) > 0):
            expected = "above 0 m (a light needs an area)" if emission.any() else "above 0 m"
            raise RangeError(message("SphereShape", f"{self.name}.radius", expected, self.radius))
        object.__setattr__(self, "emission", emission)

    @property
    def box(self) -> Array:
        """(2, 3) lower and upper corner at all times, metres."""
        ends = np.array([self.center, self.center if self.closing is None else self.closing])
        return np.array([ends.min(axis=0) - self.radius, ends.max(axis=0) + self.radius])


Shape = MeshShape | SphereShape | SdfShape


@dataclass(frozen=True, eq=False)
class Environment:
    """The radiance of a dome around everything, by height alone; three equal colours are constant.

    Attributes:
        zenith, horizon, ground: (3,) radiance from straight above, the horizon, straight below.

    Raises:
        RangeError: negative or not finite.
    """

    zenith: Array
    horizon: Array
    ground: Array

    def __post_init__(self) -> None:
        for name in ("zenith", "horizon", "ground"):
            object.__setattr__(self, name, checked_color("environment", name, getattr(self, name)))

    @classmethod
    def constant(cls, radiance: Any) -> Environment:
        """The same radiance, a number or (3,), from everywhere."""
        color = np.broadcast_to(np.asarray(radiance, np.float64), (3,))
        return cls(color, color, color)


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a path tracer needs.

    Attributes:
        name: for titles and messages.
        shapes: what there is; meshes, spheres and bodies of signed distances in any order.
        materials: by the names that shapes use.
        camera: where the picture is taken from.
        environment: what lies behind everything; None is black.
        lights: of `photograd.lights`, more than one of a kind if need be. Those with a surface are
            seen by rays like shapes and reflect nothing; lights at infinity add up, together with
            the environment.
        textures: by the names that materials use.
        lens: of the camera.
        media: by the names that interiors use.
        world: name of the medium around everything, or None. It has no end: what lies behind
            everything, lights at infinity included, is not seen through it. Fog under a sky is
            the interior of a large box.
        shutter: the camera moves while it is open; None stands still, as other cameras do that
            pictures may be taken from.

    Raises:
        SceneError: no shape, two of one name, a material, texture or medium that does not exist, or
            a textured shape without texture coordinates, a light that is none, a shape that shines
            and covers only in part, or moves, or an interior of a shape that is open or lets no
            light in.
    """

    name: str
    shapes: tuple[Shape, ...]
    materials: Mapping[str, Material]
    camera: Camera
    environment: Environment | None = None
    lights: tuple[Light, ...] = ()
    textures: Mapping[str, Texture] = field(default_factory=dict)
    lens: Lens = PINHOLE
    media: Mapping[str, Medium] = field(default_factory=dict)
    world: str | None = None
    shutter: Shutter | None = None

    def __post_init__(self) -> None:
        if self.shutter is not None:
            self.shutter.motion(self.camera)
        for i, light in enumerate(self.lights):
            if not isinstance(light, Light):
                expected, got = "a light of photograd.lights", type(light).__name__
                raise SceneError(message("Scene", f"lights[{i}]", expected, got))
        if not self.shapes:
            raise SceneError(message("Scene", "shapes", "at least one", "none"))
        for name, material in self.materials.items():
            _check_textures(name, material, self.textures)
        names = Counter(shape.name for shape in self.shapes)
        for shape in self.shapes:
            if names[shape.name] > 1:
                got = f"two of the name '{shape.name}'"
                raise SceneError(message("Scene", "shapes", "names of their own", got))
            if shape.material == BOUNDARY:
                continue
            if shape.material not in self.materials:
                known = choose_from(shape.material, self.materials)
                argument = f"{shape.name}.material"
                expected = "one of the scene's materials"
                raise SceneError(message("Scene", argument, expected, shape.material, known))
            _check_glow(shape, self.materials[shape.material], self.textures)
            if self.materials[shape.material].needs_uv and getattr(shape, "uv", None) is None:
                expected = f"texture coordinates, which '{shape.material}' needs"
                raise SceneError(message("Scene", f"{shape.name}.uv", expected, "none"))
        check_media(self)
        check_motion(self)


def _check_textures(name: str, material: Material, textures: Mapping[str, Texture]) -> None:
    sizes = {parameter.name: parameter.size for parameter in material.parameters}
    for parameter, use in material.textures.items():
        argument = f"materials.{name}.textures.{parameter}"
        if use.texture not in textures:
            known = choose_from(use.texture, textures)
            raise SceneError(
                message("Scene", argument, "one of the scene's textures", use.texture, known)
            )
        last = use.channel + sizes[parameter]
        if last > textures[use.texture].channels:
            got = f"{textures[use.texture].channels} in '{use.texture}'"
            raise SceneError(message("Scene", argument, f"at least {last} channels", got))


def _check_glow(shape: Shape, material: Material, textures: Mapping[str, Texture]) -> None:
    if material.sheer and shape.emission.any():
        expected = "a shape that shines, or a material with alpha"
        raise SceneError(message("Scene", f"{shape.name}.material", expected, "both"))
    if not isinstance(shape, MeshShape) or shape.glow is None:
        return
    argument, use = f"{shape.name}.glow", shape.glow
    if use.texture not in textures:
        known = choose_from(use.texture, textures)
        expected = "one of the scene's textures"
        raise SceneError(message("Scene", argument, expected, use.texture, known))
    if use.channel < 0 or use.channel + 3 > textures[use.texture].channels:
        got = f"{textures[use.texture].channels} in '{use.texture}'"
        raise SceneError(message("Scene", argument, f"at least {use.channel + 3} channels", got))
    if shape.uv is None:
        raise SceneError(message("Scene", f"{shape.name}.uv", "texture coordinates", "none"))
