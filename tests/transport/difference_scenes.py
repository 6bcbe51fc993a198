"""Scenes of 4 by 4 pixels in which one material, or medium, matters at every bounce."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from photograd.lights import PointLight
from photograd.transport import Environment, Material, Medium, Scene, SphereShape, TextureUse
from photograd.transport.builtin import camera_at
from photograd.transport.material import MODELS
from photograd.transport.media_list import transmits
from photograd.transport.shapes import rectangle

from tests.transport.media_scenes import fog_box
from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP, view
from tests.transport.test_alpha import checker, gray, shade

SKY = Environment([0.55, 0.6, 0.8], [0.7, 0.6, 0.5], [0.4, 0.35, 0.3])
BULB = PointLight([-0.9, 1.2, 0.9], [0.9, 0.8, 0.7])
DIM = Environment([0.25, 0.2, 0.2], [0.2, 0.2, 0.2], [0.1, 0.1, 0.15])
SOFT = [1.6, 1.4, 1.2]  # radiance of lights: contrast is noise
COLORS = np.array([0.75, 0.55, 0.3])  # apart, so that tints matter
OWN = {"exponent": 20.0, "iridescence_thickness": 400.0, "rotation": 0.6}
OF_MODELS: dict[str, dict[str, Any]] = {  # what lies on top is seen better over something dark
    "disney": {
        "base_color": 0.5 * COLORS,
        "clearcoat": 0.75,
        "clearcoat_gloss": 0.4,
        "sheen": 0.75,
    },
    "clearcoat": {"base_color": 0.25 * COLORS, "coat": 0.75},
}
# A film's phase turns where the base has its index: no step of eta may cross that.
OF_MODELS |= {
    name: {"iridescence_ior": 1.2}
    for name in ("gltf_layered_volume", "gltf_layered_volume_conserving")
}
FRACTIONS = {"eta": 0.3, "dispersion": 0.3}  # of the range; others 0.5


def own(model: str) -> Material:
    """A model with all of its parameters away from the ends of their ranges."""
    values: dict[str, Any] = {}
    for p in MODELS[model].parameters:
        share = COLORS if p.size > 1 else FRACTIONS.get(p.name, 0.5)
        values[p.name] = OWN.get(p.name, p.lo + (p.hi - p.lo) * share)
    return Material(model, {**values, **OF_MODELS.get(model, {})})


def nook(material: Material) -> Scene:
    """A ball on a floor, both of the material, under area light, point light and colored sky.

    Where light passes the material, the floor is gray.
    """
    below = "gray" if transmits(material.model) else "own"
    shapes = (
        rectangle("floor", *FLOOR, below),
        SphereShape("ball", np.array([0.0, 0.5, 0.0]), 0.5, "own"),
        rectangle("lamp", *LAMP, "black", SOFT),
    )
    materials = {"own": material, "gray": GRAY, "black": BLACK}
    camera = view(4, (0.0, 0.9, 1.9), (0.0, 0.4, 0.0))
    return Scene("nook", shapes, materials, camera, SKY, (BULB,))


def glint(material: Material) -> Scene:
    """The part of a floor that reflects a small light, a ball of the same material beside it.

    Below the floor is another light, for transmission. A lobe that gets wider or rotates shows at
    once, and most light comes from light sampling: low variance.
    """
    shapes = (
        rectangle("floor", *FLOOR, "own"),
        SphereShape("ball", np.array([0.55, 0.4, 0.5]), 0.4, "own"),
        rectangle("lamp", [-0.2, 1.5, -0.2], [0.4, 0, 0], [0, 0, 0.4], "black", [12.0, 10.0, 8.0]),
        rectangle("below", [-0.25, -1.2, 0.8], [0.5, 0, 0], [0, 0, -0.8], "black", [6.0, 5.0, 4.0]),
    )
    camera = camera_at((0.0, 1.0, 1.6), (0.0, 0.0, 0.96), 14.0, 4, 4)
    materials = {"own": material, "black": BLACK}
    return Scene("glint", shapes, materials, camera, DIM, (BULB,))


def fog(medium: Medium) -> Scene:
    """A box of the medium before a dark sky, with a bulb behind it: light that has been turned.

    So thin that more of it sends more light: where that has its maximum no derivative is left. A
    floor and a light are around it.
    """
    scene = fog_box(medium, size=4)
    lamp = replace(scene.shapes[-1], emission=0.5 * np.array(SOFT))
    camera = camera_at((0.0, 0.8, 2.6), (0.0, 0.75, 0.0), 14.0, 4, 4)
    bulb = PointLight([0.4, 1.3, -2.6], [9.0, 8.0, 7.0])
    shapes = (*scene.shapes[:-1], lamp)
    dark = Environment([0.1, 0.1, 0.12], [0.03, 0.03, 0.03], [0.02, 0.02, 0.02])
    return replace(scene, shapes=shapes, environment=dark, lights=(bulb,), camera=camera)


def veil() -> Scene:
    """A card between light and floor whose opacity is a texture."""
    painted = gray(0.8, textures={"alpha": TextureUse("t")})
    return shade(painted, size=4, textures={"t": checker()})


def mask() -> Scene:
    """The same card, cut out where its coverage is below a half."""
    scene = veil()
    card = replace(scene.materials["card"], alpha_cutoff=0.5)
    return replace(scene, materials={**scene.materials, "card": card})
