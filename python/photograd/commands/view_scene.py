"""A path traced scene in `photograd view`: sliders for its parameters, and what a click hits.

Sliders follow the ranges of the reflectance models. What shines has a factor on its radiance, in
powers of two, since it has no upper end.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from photograd_course.color import srgb_decode, srgb_encode

from photograd._compiled import _core
from photograd.capture.camera import Camera
from photograd.commands.view_hits import (
    Pick,
    closed,
    nearest_triangle,
    numbers,
    only_at,
    ray_through,
)
from photograd.geometry.mesh import Mesh
from photograd.transport.inverse.parameters import default_bounds
from photograd.transport.path_options import PathOptions
from photograd.transport.scene import Scene
from photograd.transport.shapes import MeshShape, SdfShape, Shape, SphereShape
from photograd.transport.tracer import PathTracer
from photograd.types import Array, FloatArray

STOPS = 4.0
"""A factor on radiance goes from 2 to the power of minus this to its inverse."""
MOST = 120
"""Parameters with a slider."""
SHINES = ("emission", "environment", "lights")


@dataclass(frozen=True)
class Control:
    """A parameter of a scene, and the means to change it.

    Attributes:
        name: as in `PathTracer.params`.
        group: what it belongs to, such as a material.
        label: of the slider.
        kind: "number", "color" (display values), or "stops", of which 2^stops is a factor.
        low, high: of a number.
    """

    name: str
    group: str
    label: str
    kind: Literal["number", "color", "stops"]
    low: float
    high: float


def controls(tracer: PathTracer) -> list[Control]:
    """What sliders can change: numbers and colors of materials, and what shines.

    Textures, volumes of density and what a texture replaces have none.

    Args:
        tracer: of the scene.
    """
    found = []
    for name, value in tracer.params.items():
        kind, _, rest = name.partition(".")
        if kind == "materials":
            material, _, label = rest.rpartition(".")
            if label not in tracer.scene.materials[material].textures:
                found.append(_of_number(name, material, label, value, tracer.scene))
        elif kind == "media" and value.ndim < 2 and rest.rpartition(".")[2] != "sigma_t":
            medium, _, label = rest.rpartition(".")
            low = -0.99 if label == "g" else 0.0
            color = value.shape == (3,)
            found.append(Control(name, medium, label, "color" if color else "number", low, 0.99))
        elif kind in SHINES or rest.endswith(".sigma_t"):
            label = rest.rpartition(".")[2] if kind in ("lights", "media") else "radiance"
            if value.size and (kind == "media" or value.any()):
                group = rest.partition(".")[0] if rest else kind
                group = f"light {group}" if kind == "lights" else group
                found.append(Control(name, group, label, "stops", -STOPS, STOPS))
    return [each for each in found if each is not None][:MOST]


def _of_number(name: str, group: str, label: str, value: Array, scene: Scene) -> Control | None:
    low, high = default_bounds(name, scene)
    if not (math.isfinite(low) and math.isfinite(high)):
        return None
    if value.shape == (3,) and (low, high) == (0.0, 1.0):
        return Control(name, group, label, "color", low, high)
    return Control(name, group, label, "number", low, high) if value.size == 1 else None


class SceneParameters:
    """The parameters of a tracer as controls show and change them."""

    def __init__(self, tracer: PathTracer) -> None:
        """Remember where all of them begin.

        Args:
            tracer: whose parameters are changed.
        """
        self.tracer = tracer
        self.first = {name: value.copy() for name, value in tracer.params.items()}

    def shown(self, control: Control) -> Any:
        """What a control begins with: a number, or three of 0 to 255.

        Args:
            control: of a parameter.
        """
        value = self.tracer.params[control.name]
        if control.kind == "color":
            red, green, blue = np.rint(255 * srgb_encode(np.clip(value, 0.0, 1.0))).tolist()
            return int(red), int(green), int(blue)
        if control.kind == "number":
            return float(np.clip(value.reshape(-1)[0], control.low, control.high))
        return 0.0

    def change(self, control: Control, told: Any) -> None:
        """Set a parameter to what a control says; the dictionary of all is replaced as a whole.

        Args:
            control: of a parameter.
            told: a number, or three of 0 to 255.
        """
        first = self.first[control.name]
        if control.kind == "color":
            value = srgb_decode(np.array(told[:3], np.float64) / 255)
        elif control.kind == "number":
            value = np.broadcast_to(float(told), first.shape)
        else:
            value = first * 2.0 ** float(told)
        params = {**self.tracer.params, control.name: np.array(value, first.dtype)}
        self.tracer.params = params

    def reset(self) -> None:
        """All as they were."""
        self.tracer.params = {name: value.copy() for name, value in self.first.items()}


def pick_in_scene(tracer: PathTracer, camera: Camera, at: tuple[float, float]) -> Pick | None:
    """The shape that a camera ray meets first, masks looked through, and its triangle.

    Args:
        tracer: of the scene.
        camera: of the picture.
        at: (column, row) in pixels.
    """
    given = tracer.wide_arguments(camera=only_at(camera, at))
    options = PathOptions(max_depth=2).numbers(0)
    path = _core.trace_path(**given, options=options, pixel=0, sample=0)
    met = [int(row["shape"]) for row in path if not row["is_null"] and int(row["shape"]) >= 0]
    if not met:
        return None
    shape = tracer.core_shapes[int(tracer.core_owner[met[0]])]
    origin, direction = ray_through(camera, at)
    title, position, lines = _where(shape, origin, direction)
    facts = {"shape": shape.name, "material": shape.material}
    material = tracer.scene.materials.get(shape.material)
    if material is not None:
        facts["model"] = material.model
        prefix = f"materials.{shape.material}."
        for name, value in tracer.params.items():
            if name.startswith(prefix):
                use = material.textures.get(name.removeprefix(prefix))
                told = numbers(value) if use is None else f"texture {use.texture}"
                facts[name.removeprefix(prefix)] = told
    if shape.emission.any():
        facts["emission"] = numbers(tracer.params.get(f"emission.{shape.name}", shape.emission))
    facts["gradient"] = "none: a scene has no photographs to be compared with"
    return Pick(title, facts, position, lines)


def _where(
    shape: Shape, origin: FloatArray, direction: FloatArray
) -> tuple[str, FloatArray, FloatArray]:
    """What was met, where, and lines that mark it."""
    unknown = np.full(3, np.nan), np.zeros((0, 2, 3))
    if isinstance(shape, MeshShape):
        meshes = [
            Mesh(shape.vertices @ matrix[:3, :3].T + matrix[:3, 3], shape.faces)
            for matrix in (shape.instances or (np.eye(4),))
        ]
        found = nearest_triangle(meshes, origin, direction)
        if found is None:  # it moves while the shutter is open
            return f"Mesh {shape.name}", *unknown
        of = f" of instance {found.mesh}" if shape.instances else ""
        position = found.weights @ found.corners
        return f"Triangle {found.face}{of}", position, closed(found.corners)
    if isinstance(shape, SphereShape):
        t = _sphere_distance(shape, origin, direction)
        return f"Sphere {shape.name}", *_cross(origin + t * direction, 0.1 * shape.radius)
    assert isinstance(shape, SdfShape)
    hits = shape.ready.trace(origin[None], direction[None])
    if not hits.hit[0]:
        return f"Signed distance field {shape.name}", *unknown
    position = origin + float(hits.t[0]) * direction
    reach = 0.02 * float(np.linalg.norm(shape.box[1] - shape.box[0]))
    return f"Signed distance field {shape.name}", *_cross(position, reach)


def _sphere_distance(shape: SphereShape, origin: FloatArray, direction: FloatArray) -> float:
    """The nearest distance in front of the origin; NaN if there is none."""
    off = origin - shape.center
    middle, square = -float(off @ direction), float(off @ off) - shape.radius**2
    inside = middle * middle - square
    if inside < 0:
        return math.nan
    near, far = middle - math.sqrt(inside), middle + math.sqrt(inside)
    return near if near > 0 else far


def _cross(position: FloatArray, reach: float) -> tuple[FloatArray, FloatArray]:
    """A position, and three short lines through it."""
    return position, np.stack([position - reach * np.eye(3), position + reach * np.eye(3)], axis=1)


def add_controls(gui: Any, parameters: SceneParameters, on_change: Callable[[], None]) -> None:
    """A folder of sliders for each material, light and medium, and a button that undoes all.

    Args:
        gui: of viser's server.
        parameters: of the scene.
        on_change: called after each change.
    """
    groups: dict[str, list[Control]] = {}
    for control in controls(parameters.tracer):
        groups.setdefault(control.group, []).append(control)
    handles: list[tuple[Control, Any]] = []
    for group, members in groups.items():
        with gui.add_folder(group, expand_by_default=len(groups) <= 3):
            for control in members:
                handle = _widget(gui, control, parameters.shown(control))
                handles.append((control, handle))

                @handle.on_update  # type: ignore[untyped-decorator]
                def _(_: Any, control: Control = control, handle: Any = handle) -> None:
                    parameters.change(control, handle.value)
                    on_change()

    if not handles:
        return
    button = gui.add_button("Reset parameters")

    @button.on_click  # type: ignore[untyped-decorator]
    def _(_: Any) -> None:
        parameters.reset()
        for control, handle in handles:
            handle.value = parameters.shown(control)
        parameters.reset()  # what the handles of clamped values have set again
        on_change()


def _widget(gui: Any, control: Control, value: Any) -> Any:
    if control.kind == "color":
        return gui.add_rgb(control.label, value, hint=control.name)
    step = (control.high - control.low) / 200
    label = f"{control.label}, stops" if control.kind == "stops" else control.label
    bounds = {"min": control.low, "max": control.high, "step": step}
    return gui.add_slider(label, **bounds, initial_value=value, hint=control.name)
