"""Path tracing of a scene, and the derivatives of its picture by everything that is a number.

The mathematics is in cpp/photograd/render/path/tracer.h and cpp/photograd/render/path/adjoint.h.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.suggest import choose_from

from photograd._arrays import Arguments
from photograd._checks import require_instance
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import DtypeError, RangeError, ShapeError, message
from photograd.transport.accumulation import Accumulation, Spread, sample_counts
from photograd.transport.core_arrays import (
    blocks_of,
    camera_numbers,
    cutoffs_of,
    glows_of,
    instances_of,
    light_shapes,
    mean_emission,
    packed_lights,
    textures_of,
)
from photograd.transport.incomplete import WholeGradients, incomplete_derivatives
from photograd.transport.media_list import PackedMedia
from photograd.transport.motion import closing_arrays, refuse_motion
from photograd.transport.path_options import DEFAULTS, PathOptions, checked_view
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, SdfShape, Shape, SphereShape
from photograd.types import Array

ORDER = (MeshShape, SphereShape, SdfShape)  # in which the core numbers shapes


@typed_call
class PathTracer:
    """A scene ready to be traced.

    Attributes:
        scene: what it was built from.
        params: {name: array}, to be changed freely between renderings:
            "materials.NAME.PARAMETER", () or (3,), "materials.NAME.alpha" where it has one;
            "textures.NAME" (H, W, C), linear;
            "emission.SHAPE" (3,) of shapes that shine;
            "environment" (3, 3), the radiance of zenith, horizon and ground;
            "lights.INDEX.PARAMETER" of the list, such as "lights.0.intensity" (3,) or
            "lights.0.texels" (H, 2 H, 3). How often a light is asked stays as it was when the
            tracer was built: pictures stay right, but a tracer that is built again is less noisy
            where a light has become much stronger. Places and directions of lights are fixed;
            "media.NAME.sigma_t" and ".albedo" (3,), ".g" (), ".density" (X, Y, Z).
        incomplete: {name: what is missing} of those params whose derivative is not handed out.
        core_shapes: the scene's shapes and its lights with a surface, in the core's order.
        core_owner: (S,) which of them each shape of the core is; a mesh has one for each instance.

    Example:
        >>> room = photograd.PathTracer(photograd.builtin_scene("cornell-box", 8))
        >>> image = room.render(spp=4, seed=0).mean
        >>> room.render_backward(2 * image, spp=4, seed=1)["materials.red.albedo"].shape
        (3,)
    """

    def __init__(
        self, scene: Scene, *, dtype: npt.DTypeLike = np.float32, allow_incomplete: bool = False
    ) -> None:
        """Build the hierarchy.

        Args:
            scene: from `read_scene`, `read_model` or `builtin_scene`.
            dtype: of the parameters and of the computation, float32 or float64.
            allow_incomplete: hand out incomplete derivatives, too: the part with paths fixed.

        Raises:
            DtypeError: no `Scene`, or dtype is neither float32 nor float64.
            SceneError: geometry that cannot be traced, or a light without area.
        """
        remedy = "read_scene reads a file; default_scene makes one of what read_model reads"
        require_instance("PathTracer", "scene", scene, Scene, remedy)
        self.dtype = np.dtype(dtype)
        if self.dtype.char not in "fd":
            raise DtypeError(message("PathTracer", "dtype", "float32 or float64", self.dtype))
        self.scene = scene
        self.incomplete = {} if allow_incomplete else incomplete_derivatives(scene)
        self._lights = packed_lights(scene)
        self._media = PackedMedia(scene.media, scene.materials, scene.world)
        names = {name: number for number, name in enumerate(scene.materials)}
        # (name of the emission among the params, shape, number of its material); lights reflect
        # nothing, by a material that is no parameter, and boundaries have none.
        placed: list[tuple[str, Shape, int]] = [
            *((f"emission.{s.name}", s, names.get(s.material, len(names))) for s in scene.shapes),
            *((name, s, len(names)) for name, s in light_shapes(scene).items()),
        ]
        placed.sort(key=lambda entry: ORDER.index(type(entry[1])))
        self.core_shapes: list[Shape] = [shape for _, shape, _ in placed]
        self._emissions = [name for name, _, _ in placed]
        meshes = [shape for shape in self.core_shapes if isinstance(shape, MeshShape)]
        spheres = [shape for shape in self.core_shapes if isinstance(shape, SphereShape)]
        sdfs = [shape.ready.parts for shape in self.core_shapes if isinstance(shape, SdfShape)]
        numbers, matrices = instances_of(meshes)
        # What the core counts as a shape is an instance; `_owner` says of which of ours.
        self.core_owner = np.concatenate([numbers, np.arange(len(meshes), len(self.core_shapes))])
        materials = np.array([material for _, _, material in placed], np.int32)
        emission = np.array([mean_emission(scene, s) for s in self.core_shapes], np.float64)
        balls = [[*shape.center, shape.radius] for shape in spheres]
        self.params: dict[str, Array] = self._initial_params()
        self._param_shapes = {name: value.shape for name, value in self.params.items()}
        self._geometry = _core.PathGeometry(
            meshes=[(mesh.vertices, mesh.faces, mesh.normals, mesh.uv) for mesh in meshes],
            instances=numbers,
            matrices=matrices,
            spheres=np.array(balls, np.float32).reshape(-1, 4),
            sdfs=sdfs,
            **closing_arrays(meshes, spheres),
            material=materials[self.core_owner],
            emission=emission[self.core_owner],
            lights=[light.row(light.start, np.float64) for light in self._lights],
        )
        glows = glows_of(scene, [self.core_shapes[owner] for owner in self.core_owner])
        self._geometry.set_textures(*textures_of(scene), cutoffs_of(scene), glows)
        media = self._media.core_arguments(self.core_shapes, self.core_owner)
        if media is not None:
            self._geometry.set_media(**media)
        marked = [m.model + "+alpha" * m.has_opacity for m in scene.materials.values()]
        self._models = [*marked, "lambert"]

    def _initial_params(self) -> dict[str, Array]:
        params: dict[str, Any] = {}
        for name, material in self.scene.materials.items():
            for parameter in material.parameters:
                params[f"materials.{name}.{parameter.name}"] = material.values[parameter.name]
        for name, texture in self.scene.textures.items():
            params[f"textures.{name}"] = texture.values
        for name, shape in zip(self._emissions, self.core_shapes, strict=True):
            if shape.emission.any() or name.startswith("lights."):
                params[name] = shape.emission
        for light in self._lights:
            params.update(light.start)
        params.update(self._media.start)
        return {name: np.array(value, self.dtype) for name, value in params.items()}

    def render(
        self, *, spp: int, seed: int, options: PathOptions = DEFAULTS, camera: Camera | None = None
    ) -> Accumulation:
        """A picture of `spp` samples a pixel; the same seed gives the same bits on any threads.

        Args:
            spp, seed: samples a pixel, and the seed of all random numbers.
            options: of the path tracer.
            camera: None takes the scene's.

        Raises:
            RangeError: spp below 1.
            Error: radiance that is not finite; names the pixel.
        """
        view = checked_view("PathTracer.render", self.scene.camera, camera, options)
        sums = Accumulation.empty(view.height, view.width)
        self.add_samples(sums, spp, seed=seed, options=options, camera=camera)
        return sums

    def add_samples(
        self,
        sums: Accumulation,
        spp: int,
        *,
        seed: int,
        options: PathOptions = DEFAULTS,
        camera: Camera | None = None,
        sampling_params: dict[str, Array] | None = None,
        hits: Array | None = None,
    ) -> None:
        """Add the next `spp` samples to `sums`, in place.

        Args:
            sums: of the same seed, options and camera, or empty.
            spp, seed, options, camera: as for `render`.
            sampling_params: what decides where paths go, if not `params`: `render_backward` is the
                derivative of pictures whose `params` change while these do not.
            hits: (H, W) float64, or None. If given, camera rays that see the background alone add
                nothing to `sums`, and `hits` counts the others: `hits / sums.count` is alpha.

        Raises:
            RangeError, Error: as `render`.
            ShapeError: sums or hits of another size.
        """
        view = checked_view("PathTracer.render", self.scene.camera, camera, options)
        sums.check_call("add_samples", (view.height, view.width), spp)
        other = None if sampling_params is None else self._material_row(sampling_params)
        texels = None if sampling_params is None else self._texels(sampling_params)
        media = None if sampling_params is None else self._media.rows(sampling_params, self.dtype)
        _core.trace_paths(
            **self.core_arguments(view),
            sampling_parameters=other,
            sampling_textures=texels,
            sampling_media=media,
            options=options.numbers(seed),
            first=sums.count,
            count=spp,
            radiance=sums.radiance,
            squares=sums.squares,
            hits=hits,
        )
        sums.count += spp
        sums.check_finite("PathTracer.render")

    def render_backward(
        self,
        d_image: Array,
        *,
        spp: int,
        seed: int,
        options: PathOptions = DEFAULTS,
        camera: Camera | None = None,
        spread: Spread = "uniform",
    ) -> dict[str, Array]:
        """dL/dparams for dL/dimage (H, W, 3), estimated with `spp` paths a pixel.

        With the seed and spp of a rendering it is the derivative of that very picture, its paths
        held fixed, and with them the probabilities of sampling and of Russian roulette. Finite
        differences at one seed agree if `add_samples` is given the unperturbed parameters as
        `sampling_params`. To fit, take another seed: the noise of `d_image` is then independent of
        this estimate's, and their product is unbiased. Geometry is held fixed: edges of shadows
        and silhouettes. What that leaves incomplete (`incomplete`) is absent from the result, and
        asking for it raises.

        Args:
            d_image: dL/dimage (H, W, 3).
            spp: paths a pixel, on average.
            seed: of all random numbers.
            options: of the path tracer.
            camera: None takes the scene's.
            spread: "uniform" gives each pixel as many paths, "cotangent" more where the loss
                looks; then `seed` must not be that of the picture.

        Raises:
            ShapeError: d_image of another shape than the picture.
            RangeError: spp below 1, another spread, or d_image with numbers that are not finite.
        """
        call = Arguments("PathTracer.render_backward", np.float64)
        view = checked_view(call.function, self.scene.camera, camera, options)
        d_image = call.array("d_image", d_image, (view.height, view.width, 3))
        call.integer("spp", spp, low=1)
        return self.add_up(
            "render_backward",
            _core.trace_paths_backward,
            view,
            options=options.numbers(seed),
            spp=spp,
            counts=sample_counts(d_image, spp, spread),
            d_image=d_image,
        )

    def add_up(self, function: str, backward: Any, view: Camera, **given: Any) -> WholeGradients:
        """What `backward` of the core makes of `view` and `given`, by name, for a `function`."""
        arguments = self.core_arguments(view)
        gradient = {name: np.zeros_like(value) for name, value in blocks_of(arguments).items()}
        backward(**arguments, **given, gradient=gradient)
        d_shapes = np.zeros((len(self.core_shapes), 3), self.dtype)
        np.add.at(d_shapes, self.core_owner, gradient["emission"])
        gradients = dict(zip(self._emissions, d_shapes, strict=True))
        for i, name in enumerate(self.scene.textures):
            gradients[f"textures.{name}"] = gradient[f"textures.{i}"]
        start = 0
        for name, material in self.scene.materials.items():
            for parameter in material.parameters:
                part = gradient["parameters"][start : start + parameter.size]
                key = f"materials.{name}.{parameter.name}"
                gradients[key] = part.reshape(self.params[key].shape)
                start += parameter.size
        for i, light in enumerate(self._lights):
            gradients.update(light.named(gradient[f"lights.{i}"]))
        gradients.update(self._media.named(gradient))
        return WholeGradients(function, gradients, self.params, self.incomplete)

    def add_occlusion(
        self, sums: Accumulation, spp: int, *, seed: int, radius: float = np.inf
    ) -> None:
        """Add `spp` samples of ambient occlusion to `sums`, in place; all channels are the same.

        A sample is 1 where the scene's camera sees nothing, or nothing lies within `radius` meters
        of what it sees in one direction, drawn in proportion to the cosine; otherwise 0.

        Args:
            sums: of the same seed and radius, or empty.
            spp: samples a pixel.
            seed: of all random numbers.
            radius: in meters.

        Raises:
            RangeError: spp below 1, or a radius that is not positive.
            SceneError: shapes that move.
            ShapeError: sums of another size.
        """
        refuse_motion("add_occlusion", self.scene.shapes)
        view = self.scene.camera
        sums.check_call("add_occlusion", (view.height, view.width), spp)
        free = np.zeros((view.height, view.width))
        given = (self._geometry, camera_numbers(view), radius, seed, sums.count, spp, free)
        Arguments("PathTracer.add_occlusion").run(_core.ambient_occlusion, *given)
        sums.radiance += free[..., None]
        sums.squares += free[..., None]  # 0 and 1 are their own squares
        sums.count += spp

    def path(
        self, pixel: int, sample: int, *, seed: int, options: PathOptions = DEFAULTS
    ) -> list[dict[str, Any]]:
        """One path of the scene's camera, a dictionary a vertex: what was met, asked and chosen.

        It is `sample` of `pixel`, row * width + column, with `seed` and `options`, in float64.
        """
        arguments = self.wide_arguments()
        given = {**arguments, "options": options.numbers(seed)}
        found: list[dict[str, Any]] = _core.trace_path(**given, pixel=pixel, sample=sample)
        return found

    def _material_row(self, params: dict[str, Array]) -> Array:
        """All parameters of all materials, one after another, (P,); then those of lights."""
        parts = [
            np.reshape(params[f"materials.{name}.{parameter.name}"], -1)
            for name, material in self.scene.materials.items()
            for parameter in material.parameters
        ]
        return np.ascontiguousarray(np.concatenate([*parts, np.zeros(3)]), self.dtype)

    def _texels(self, params: dict[str, Array]) -> list[Array]:
        """Values (H, W, C) of each texture, in the scene's order."""
        return [
            np.ascontiguousarray(params[f"textures.{name}"], self.dtype)
            for name in self.scene.textures
        ]

    def wide_arguments(
        self, params: dict[str, Array] | None = None, camera: Camera | None = None
    ) -> dict[str, Any]:
        """The scene as functions of the core take it that calculate in double.

        `params` is what to say instead of the tracer's own; `camera` None takes the scene's.
        """
        given = self.params if params is None else params
        arguments = self.core_arguments(self.scene.camera if camera is None else camera, given)
        return {**arguments, **self._wide(given), "media": self._media.rows(given, np.float64)}

    def wide_changes(self, step: dict[str, Array]) -> dict[str, Any]:
        """What of `wide_arguments` is numbers, for a `step` {name: change} of all parameters."""
        return {**self._wide(step), "media": self._media.changes(step)}

    def _wide(self, params: dict[str, Array]) -> dict[str, Any]:
        numbers = self._surfaces(params)
        for name in ("parameters", "emission"):
            numbers[name] = numbers[name].astype(np.float64)
        numbers["textures"] = [texels.astype(np.float64) for texels in numbers["textures"]]
        return {**numbers, "lights": [light.row(params, np.float64) for light in self._lights]}

    def _surfaces(self, params: dict[str, Array]) -> dict[str, Any]:
        black = np.zeros(3, self.dtype)
        shining = np.array([params.get(name, black) for name in self._emissions], self.dtype)
        return {
            "parameters": self._material_row(params),
            "emission": shining[self.core_owner],
            "textures": self._texels(params),
        }

    def core_arguments(
        self, camera: Camera, params: dict[str, Array] | None = None
    ) -> dict[str, Any]:
        """The scene in the tracer's dtype, with a `camera`; `params` None takes its own."""
        given = self.params if params is None else params
        self._check_params(given)
        lens = self.scene.lens.radius, self.scene.lens.focus
        motion: tuple[Any, ...] = ()
        if self.scene.shutter is not None and camera is self.scene.camera:
            motion = tuple(part.tolist() for part in self.scene.shutter.motion(camera))
        return {
            "geometry": self._geometry,
            "models": self._models,
            **self._surfaces(given),
            "lights": [light.row(given, self.dtype) for light in self._lights],
            "media": self._media.rows(given, self.dtype),
            "camera": (*camera_numbers(camera), *lens, *motion),
        }

    def _check_params(self, given: dict[str, Array]) -> None:
        """Raises RangeError or ShapeError where names or shapes are not those of the scene."""
        known = self._param_shapes
        for name in sorted(given.keys() - known.keys() - set(self._emissions)):
            expected, near = "names of the scene", choose_from(name, known)
            raise RangeError(message("PathTracer", "params", expected, f"{name!r}", near))
        for name in sorted(known.keys() - given.keys()):
            raise RangeError(message("PathTracer", f"params[{name!r}]", "an array", "none"))
        for name, shape in known.items():
            if np.shape(given[name]) != shape:
                got = f"{np.shape(given[name])}"
                raise ShapeError(message("PathTracer", f"params[{name!r}]", f"shape {shape}", got))
