"""Direct light by ray tracing: what a camera sees of a described scene, and its adjoint.

The mathematics is in cpp/photograd/render/direct.h. Parameters are arrays: `albedo` (A, 3), the
colours of all surfaces one after another, and `lights` (4, 3), the radiances of the sun, of the
zenith, of the horizon and of the ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.core import _core
from photograd.data.camera import Camera
from photograd.errors import DtypeError, Error, RangeError, ShapeError, message
from photograd.mesh import Bvh, Mesh
from photograd.scenes.description import SceneDescription, SceneMesh

Array = npt.NDArray[Any]
KINDS = {"constant": 0, "vertices": 1, "texture": 2}


@dataclass(frozen=True, eq=False)
class DirectImage:
    """What a camera sees; a sample without surface counts as zero in all three.

    Attributes:
        radiance: (H, W, 3) linear, premultiplied by alpha.
        alpha: (H, W) share of the samples that met a surface.
        depth: (H, W) mean of the distance in metres, premultiplied likewise.
    """

    radiance: Array
    alpha: Array
    depth: Array


class TracedScene:
    """A scene ready to be rendered from any number of cameras.

    Attributes:
        params: {"albedo": (A, 3), "lights": (4, 3)}; change them freely between renderings.
    """

    def __init__(self, scene: SceneDescription, *, dtype: npt.DTypeLike = np.float32) -> None:
        """Build the hierarchy and lay out the colours.

        Raises:
            DtypeError: dtype is neither float32 nor float64.
            SceneError: a mesh that cannot be traced.
        """
        if np.dtype(dtype) not in (np.dtype(np.float32), np.dtype(np.float64)):
            expected = "float32 or float64"
            raise DtypeError(message("TracedScene", "dtype", expected, np.dtype(dtype)))
        self.scene = scene
        self._bvh = Bvh([Mesh(part.vertices, part.faces, part.uv) for part in scene.meshes])
        self._layouts: list[tuple[int, int, int, int]] = []
        colors, first = [], 0
        for part in scene.meshes:
            height, width = part.albedo.shape[:2] if part.albedo.ndim == 3 else (1, 1)
            self._layouts.append((KINDS[part.albedo_kind], first, width, height))
            colors.append(part.albedo.reshape(-1, 3))
            first += len(colors[-1])
        sky = scene.sky
        lights = [scene.sun.radiance, sky.zenith, sky.horizon, sky.ground]
        self.params: dict[str, Array] = {
            "albedo": np.concatenate(colors).astype(dtype),
            "lights": np.array(lights, dtype),
        }

    def albedo_of(self, mesh: int) -> Array:
        """View of a mesh's own colours in params["albedo"], in the shape of its description."""
        part: SceneMesh = self.scene.meshes[mesh]
        first = self._layouts[mesh][1]
        count = part.albedo.size // 3
        return self.params["albedo"][first : first + count].reshape(part.albedo.shape)

    def render(self, camera: Camera, *, spp: int, seed: int) -> DirectImage:
        """Render with `spp` samples a pixel; the same seed gives the same bits on any thread count.

        Raises:
            RangeError: spp below 1.
            Error: the result is not finite; names the pixel.
        """
        radiance, alpha, depth = _core.render_direct(**self._arguments(camera, spp, seed))
        if not np.isfinite(radiance).all():
            row, column = np.argwhere(~np.isfinite(radiance))[0][:2]
            got = f"a value that is not, first in pixel ({column}, {row})"
            raise Error(message("TracedScene.render", "radiance", "finite values", got))
        return DirectImage(radiance, alpha, depth)

    def render_backward(
        self, camera: Camera, d_radiance: Array, *, spp: int, seed: int
    ) -> dict[str, Array]:
        """dL/dparams for dL/dradiance (H, W, 3) of the rendering with the same spp and seed.

        Interior term only: shadow edges and silhouettes are held fixed.

        Raises:
            ShapeError: d_radiance has another shape than the image.
        """
        shape = (camera.height, camera.width, 3)
        if np.shape(d_radiance) != shape:
            got = np.shape(d_radiance)
            raise ShapeError(message("render_backward", "d_radiance", f"shape {shape}", got))
        gradients = {name: np.zeros_like(value) for name, value in self.params.items()}
        dtype = self.params["albedo"].dtype
        _core.render_direct_backward(
            **self._arguments(camera, spp, seed),
            d_radiance=np.ascontiguousarray(d_radiance, dtype),
            d_albedo=gradients["albedo"],
            d_lights=gradients["lights"],
        )
        return gradients

    def render_view(self, camera: Camera, spp: int, seed: int) -> tuple[Array, Array]:
        """Radiance and alpha alone, as `photograd.scenes.capture.capture_scene` asks for them."""
        image = self.render(camera, spp=spp, seed=seed)
        return image.radiance, image.alpha

    def _arguments(self, camera: Camera, spp: int, seed: int) -> dict[str, Any]:
        if spp < 1:
            raise RangeError(message("TracedScene", "spp", "at least 1", spp))
        sun = self.scene.sun
        pose = camera.world_from_camera[:3].tolist()
        numbers = (
            camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, pose,
        )  # fmt: skip
        return {
            "bvh": self._bvh.core, "layouts": self._layouts, "albedo": self.params["albedo"],
            "lights": self.params["lights"], "sun_direction": sun.direction.tolist(),
            "sun_radius": sun.angular_radius, "camera": numbers, "spp": spp, "seed": seed,
        }  # fmt: skip
