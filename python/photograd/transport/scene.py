"""What a scene for path tracing is: shapes with a material each, what shines, and a camera.

World as everywhere: right-handed, +Y up, meters; radiance and reflectances are linear Rec. 709.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from photograd_course.suggest import choose_from

from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import SceneError, message
from photograd.lights import Light
from photograd.transport.lens import PINHOLE, Lens, Shutter
from photograd.transport.material import Material
from photograd.transport.media_list import check_media
from photograd.transport.medium import BOUNDARY, Medium
from photograd.transport.motion import check_motion
from photograd.transport.shape_checks import checked_color
from photograd.transport.shapes import MeshShape, Shape
from photograd.transport.texture import Texture
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Environment:
    """The radiance of a dome around everything, by height alone; three equal colors are constant.

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
            object.__setattr__(self, name, checked_color("Environment", name, getattr(self, name)))

    @classmethod
    def constant(cls, radiance: Any) -> Environment:
        """The same radiance, a number or (3,), from everywhere."""
        color = np.broadcast_to(np.asarray(radiance, np.float64), (3,))
        return cls(color, color, color)


@typed_call
@dataclass(frozen=True, eq=False)
class Scene:
    """All that a path tracer needs.

    Attributes:
        name: for titles and messages.
        shapes: what there is; meshes, spheres and signed distance functions in any order.
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
            _check_emission_texture(shape, self.materials[shape.material], self.textures)
            if self.materials[shape.material].needs_uv and getattr(shape, "uv", None) is None:
                expected = f"texture coordinates, which '{shape.material}' needs"
                raise SceneError(message("Scene", f"{shape.name}.uv", expected, "none"))
        check_media(self.shapes, self.materials, self.media, self.world)
        check_motion(self.shapes)


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


def _check_emission_texture(
    shape: Shape, material: Material, textures: Mapping[str, Texture]
) -> None:
    if material.has_opacity and shape.emission.any():
        expected = "a shape that shines, or a material with alpha"
        raise SceneError(message("Scene", f"{shape.name}.material", expected, "both"))
    if not isinstance(shape, MeshShape) or shape.emission_texture is None:
        return
    argument, use = f"{shape.name}.emission_texture", shape.emission_texture
    if use.texture not in textures:
        known = choose_from(use.texture, textures)
        expected = "one of the scene's textures"
        raise SceneError(message("Scene", argument, expected, use.texture, known))
    if use.channel < 0 or use.channel + 3 > textures[use.texture].channels:
        got = f"{textures[use.texture].channels} in '{use.texture}'"
        raise SceneError(message("Scene", argument, f"at least {use.channel + 3} channels", got))
    if shape.uv is None:
        raise SceneError(message("Scene", f"{shape.name}.uv", "texture coordinates", "none"))
