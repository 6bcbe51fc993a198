"""A model as a scene: seen from in front and above, under a pale sky and one large lamp."""

from __future__ import annotations

import numpy as np

from photograd.orbit import orbit_cameras
from photograd.transport.mesh_files.model_file import ModelFile
from photograd.transport.scene import Array, Environment, Material, MeshShape, Scene
from photograd.transport.shapes import rectangle

_TURNS, _SEEN_FROM = 12, 1  # 30 degrees from the front, +Z
_LAMP = "studio lamp"


def model_scene(model: ModelFile, name: str, size: int = 256) -> Scene:
    """The model alone in a square picture of `size` pixels.

    The lamp is as wide as the model's sphere and three radii away, to the left of the camera.
    """
    box = model.box
    centre, radius = box.mean(axis=0), 0.5 * float(np.linalg.norm(box[1] - box[0]))
    camera = orbit_cameras(box, _TURNS, size=size, elevation=20.0)[_SEEN_FROM]
    sky = Environment(np.full(3, 0.9), np.full(3, 0.6), np.full(3, 0.25))
    materials = {**model.materials, _LAMP: Material("lambert", {"albedo": [0.0, 0.0, 0.0]})}
    shapes = (*model.shapes, _lamp(centre, radius))
    return Scene(name, shapes, materials, camera, sky, textures=model.textures, media=model.media)


def _lamp(centre: Array, radius: float) -> MeshShape:
    """A square that faces the model."""
    towards = np.array([-0.45, 0.75, 0.5]) / np.linalg.norm([-0.45, 0.75, 0.5])
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    middle = centre + 3 * radius * towards
    # Front: edge_u x edge_v = right x (-up) looks back along -towards.
    corner = middle - radius * right + radius * up
    return rectangle(_LAMP, corner, 2 * radius * right, -2 * radius * up, _LAMP, [6.0, 5.8, 5.4])
