"""A model as a scene: as its file has it, or in a studio, under a pale sky and one large light."""

from __future__ import annotations

import numpy as np
from photograd_course.suggest import choose_from

from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.errors import SceneError, message
from photograd.transport.material import Material
from photograd.transport.mesh_files.model_camera import ModelCamera
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.scene import Environment, Scene
from photograd.transport.shapes import MeshShape, rectangle
from photograd.types import Array

_TURNS, _CAMERA = 12, 1  # 30 degrees from the front, +Z
_LIGHT = "studio light"
STUDIO = "studio"
"""In place of a camera's name."""


@typed_call
def default_scene(
    model: ModelFile, name: str, size: int = 256, *, camera: str | None = None
) -> Scene:
    """A picture of the model, with `size` pixels along its longer edge.

    What the file says comes first: its camera, and its lights. Without a camera the model is seen
    from in front and above, in a square. Without lights it gets a pale sky and a light, as wide as
    the model's sphere and three radii away to the left of that view; but not if the file has a
    camera and something that shines: then it is a scene of its own.

    Args:
        model: what `read_model` returned.
        name: of the scene.
        size: pixels.
        camera: name of one of the file's cameras; by default the first. `STUDIO` looks from in
            front and above, with sky and light alone, whatever the file has.

    Raises:
        SceneError: no camera of that name.
        RangeError: a camera that sees too little or too much.
    """
    lights = () if camera == STUDIO else model.lights
    chosen = _chosen(model, camera)
    shines = any(shape.emission.any() for shape in model.shapes)
    view = _from_in_front(model, size) if chosen is None else chosen.fitted(size)
    if lights or (chosen is not None and shines):
        return Scene(
            name,
            model.shapes,
            model.materials,
            view,
            lights=lights,
            textures=model.textures,
            media=model.media,
        )
    box = model.box
    center, radius = box.mean(axis=0), 0.5 * float(np.linalg.norm(box[1] - box[0]))
    sky = Environment(np.full(3, 0.9), np.full(3, 0.6), np.full(3, 0.25))
    materials = {**model.materials, _LIGHT: Material("lambert", {"albedo": [0.0, 0.0, 0.0]})}
    shapes = (*model.shapes, _light(center, radius))
    return Scene(name, shapes, materials, view, sky, textures=model.textures, media=model.media)


def _chosen(model: ModelFile, name: str | None) -> ModelCamera | None:
    """The camera of this name; None for the studio's."""
    if name == STUDIO or (name is None and not model.cameras):
        return None
    by_name = {camera.name: camera for camera in model.cameras}
    if name is None:
        return model.cameras[0]
    if name not in by_name:
        known = choose_from(name, (*by_name, STUDIO))
        raise SceneError(message("default_scene", "camera", "a camera of the file", name, known))
    return by_name[name]


def _from_in_front(model: ModelFile, size: int) -> Camera:
    return orbit_cameras(model.box, _TURNS, size=size, elevation=20.0)[_CAMERA]


def _light(center: Array, radius: float) -> MeshShape:
    """A square that faces the model."""
    towards = np.array([-0.45, 0.75, 0.5]) / np.linalg.norm([-0.45, 0.75, 0.5])
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    middle = center + 3 * radius * towards
    # Front: edge_u x edge_v = right x (-up) looks back along -towards.
    corner = middle - radius * right + radius * up
    return rectangle(_LIGHT, corner, 2 * radius * right, -2 * radius * up, _LIGHT, [6.0, 5.8, 5.4])
