"""Scenes with instances, motion, a lens, and signed distance fields."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from photograd.geometry.sdf import box as sdf_box
from photograd.geometry.sdf import placed, smooth_union, sphere
from photograd.transport import BOUNDARY, Lens, NormalMap, Scene, SdfShape, Shutter, Texture

from fingerprint_cases.scenes import GLASS, GLOSS, Scenes, ball, dome, stage
from fingerprint_cases.scenes_media import FOG, INK, fog_box
from fingerprint_cases.scenes_surface import card, painted, texels


def place(x: float, z: float, turn: float, size: Any) -> Any:
    """world_from_object (4, 4): a turn about +Y, a size along each axis, a shift."""
    c, s = np.cos(turn), np.sin(turn)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) * np.asarray(size, float)
    matrix[:3, 3] = [x, 0.05, z]
    return matrix


PLACES = place(-0.6, 0.0, 0.3, [1, 1, 1]), place(0.5, -0.3, 1.2, [0.7, 1.6, 1.0])
CLOSING = place(-0.3, 0.2, 0.8, [1.1, 0.9, 1]), place(0.6, 0.1, 0.9, [0.8, 1.2, 1.0])


def instances(*, moving: bool = False, transparent: bool = False, **more: Any) -> Scene:
    """Two textured domes of one mesh and a ball; they may move."""
    tilt = NormalMap(np.broadcast_to([0.2, 0.1, 1.0], (2, 2, 3)).copy())
    domes = dome("gloss", instances=PLACES, closing_instances=CLOSING if moving else ())
    end = np.array([0.5, 0.7, -0.2]) if moving else None
    flying = ball("card" if transparent else "glass", (0.2, 0.3, 0.6), 0.25, closing=end)
    return stage(
        domes,
        flying,
        materials={
            "gloss": replace(painted("gltf"), normal_map=tilt),
            "glass": GLASS,
            "card": card(0.6),
        },
        textures={"paint": Texture(texels(), filter="mip")},
        **more,
    )


def with_shutter(scene: Scene) -> Scene:
    """The camera moves and turns while its shutter is open."""
    c, s = np.cos(0.15), np.sin(0.15)
    end = scene.camera.world_from_camera @ np.array(
        [[c, 0, s, 0.1], [0, 1, 0, -0.05], [-s, 0, c, 0.2], [0, 0, 0, 1.0]]
    )
    return replace(scene, shutter=Shutter(end))


def bodies() -> Scene:
    """Signed distance fields of gloss, of glass filled with ink, and as a boundary of fog."""
    lump = smooth_union(placed(sdf_box([0.25] * 3), [0.1, 0, 0]), sphere(0.3), 0.1)
    shapes = (
        SdfShape("gloss", placed(lump, [-0.6, 0.4, 0.0], [0.9, 0.1, 0.3, 0.0]), "gloss"),
        SdfShape("glass", placed(sphere(0.3), [0.1, 0.4, 0.4]), "glass", interior="ink"),
        SdfShape(
            "fog", placed(sdf_box([0.3, 0.5, 0.3]), [0.7, 0.6, -0.3]), BOUNDARY, interior="fog"
        ),
    )
    return stage(
        *shapes, materials={"gloss": GLOSS, "glass": GLASS}, media={"ink": INK, "fog": FOG}
    )


MOTION: Scenes = {
    "instances": instances,
    "moving": lambda: instances(moving=True),
    "moving-opacity": lambda: instances(moving=True, transparent=True),
    "shutter": lambda: with_shutter(instances()),
    "shutter-moving": lambda: with_shutter(instances(moving=True)),
    "shutter-fog": lambda: with_shutter(fog_box(FOG)),
    "lens": lambda: instances(lens=Lens(0.08, 2.0)),
    "lens-shutter": lambda: with_shutter(instances(moving=True, lens=Lens(0.05, 2.0))),
    "lens-fog": lambda: fog_box(FOG, lens=Lens(0.08, 2.0)),
    "signed-distances": bodies,
}
