"""Scenes of every reflectance model, textured slots, normal maps, opacity and masks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from photograd.transport import Material, MeshShape, NormalMap, Scene, Texture, TextureUse
from photograd.transport.material import MODELS
from photograd.transport.shapes import rectangle

from fingerprint_cases.scenes import GLASS, GLOSS, GRAY, Scenes, ball, dome, stage

SHARES = np.array([0.75, 0.55, 0.3])  # of a color's range, apart so that tints matter
FRACTIONS = {"eta": 0.3, "dispersion": 0.3}  # of a number's range; others 0.5
VALUES = {
    "exponent": 20.0,
    "iridescence_thickness": 400.0,
    "rotation": 0.6,
    # The middle, (0, 0), is no tangent: it counts as (1, 0) and has no derivative.
    "anisotropy_x": 0.8,
    "anisotropy_y": -0.5,
}
CARD = ([-1.0, 0.8, -1.0], [2.0, 0, 0], [0, 0, 2.0])  # between light and floor, faces down


def of_model(model: str, **more: Any) -> Material:
    """A model with all parameters away from the ends of their ranges."""
    values: dict[str, Any] = {}
    for p in MODELS[model].parameters:
        share = SHARES if p.size > 1 else FRACTIONS.get(p.name, 0.5)
        values[p.name] = VALUES.get(p.name, p.lo + (p.hi - p.lo) * share)
    return Material(model, {**values, **more.pop("values", {})}, **more)


def texels(channels: int = 4, *, seed: int = 1, size: tuple[int, int] = (7, 5)) -> Any:
    """Values (H, W, C) between 0.6 and 1.1: products with them stay within most ranges."""
    return np.random.default_rng(seed).uniform(0.6, 1.1, (*size, channels))


def painted(model: str, texture: str = "paint", **more: Any) -> Material:
    """A model of which a texture scales every parameter."""
    given = of_model(model, **more)
    uses = {p.name: TextureUse(texture, 0 if p.size == 3 else 3) for p in given.parameters}
    return replace(given, textures=uses)


def model_scene(model: str) -> Scene:
    """A ball of a model, and a dome of it with every parameter textured."""
    shapes = (ball("ball", (-0.5, 0.45, 0.1), 0.45), dome("dome", at=(0.5, 0.05, 0.2)))
    return stage(
        *shapes,
        materials={"ball": of_model(model), "dome": painted(model)},
        textures={"paint": Texture(texels(), ("mirror", "mirror"))},
    )


def textured(wrap: str, kind: str, *, bent: bool = True) -> Scene:
    """A floor and a dome whose coordinates leave 0..1, under a texture and a normal map."""
    g = np.random.default_rng(2)
    tilt = g.uniform(-0.3, 0.3, (3, 4, 3)) + np.array([0, 0, 1.0])
    normals = NormalMap(tilt, (wrap, wrap)) if bent else None
    material = replace(painted("gltf"), normal_map=normals)
    scene = stage(
        dome("dome", uv=2.7),
        materials={"dome": material},
        textures={"paint": Texture(texels(), (wrap, wrap), kind)},
    )
    floor = rectangle("floor", [-2, 0, 2], [4, 0, 0], [0, 0, -4], "dome")
    floor = replace(floor, uv=None if floor.uv is None else 1.0 - 3.0 * floor.uv)
    return replace(scene, shapes=(floor, *scene.shapes[1:]))


def channels(kind: str) -> Scene:
    """Domes under textures of one, two and three channels."""
    uses = {
        "one": {"roughness": TextureUse("one")},
        "two": {"metalness": TextureUse("two", 1), "roughness": TextureUse("two")},
        "three": {"base_color": TextureUse("three")},
    }
    domes = [
        dome(name, name=name, at=(x, 0.05, 0.4), scale=0.4)
        for name, x in zip(uses, (-0.8, 0.0, 0.8), strict=True)
    ]
    return stage(
        *domes,
        materials={name: replace(GLOSS, textures=use) for name, use in uses.items()},
        textures={name: Texture(texels(k), filter=kind) for k, name in enumerate(uses, 1)},
    )


def many_layers(count: int = 260) -> Scene:
    """More sheets, one above the other, than a shadow ray looks through."""
    corners = np.array([[-1, 0, -1], [0.2, 0, -1], [0.2, 0, 1], [-1, 0, 1.0]])
    heights = np.linspace(0.3, 1.2, count)[:, None, None] * [0, 1, 0]
    faces = 4 * np.arange(count)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    sheets = MeshShape("sheets", (corners + heights).reshape(-1, 3), faces.reshape(-1, 3), "sheet")
    return stage(sheets, materials={"sheet": card(0.004)})


def card(alpha: float, **more: Any) -> Material:
    """A colored sheet of some opacity."""
    return Material("lambert", {"albedo": [0.3, 0.4, 0.5], "alpha": alpha}, **more)


def shaded(material: Material, *, kind: str = "bilinear", **more: Any) -> Scene:
    """A card of some opacity between the light and the floor, a ball of glass below it."""
    opacity = np.random.default_rng(5).uniform(0.1, 0.9, (6, 4, 1))
    sheet = of_model("gltf_transmission", values={"alpha": 0.6})
    shapes = (
        rectangle("card", *CARD, "card"),
        rectangle("sheet", [-1.0, 0.4, -1.0], [2.0, 0, 0], [0, 0, 2.0], "sheet"),
        ball("glass", (0.3, 0.25, 0.5), 0.25),
    )
    return stage(
        *shapes,
        materials={"card": material, "sheet": sheet, "glass": GLASS},
        textures={"opacity": Texture(opacity, filter=kind)},
        **more,
    )


def transparent_models() -> Scene:
    """Smooth and rough surfaces with an opacity."""
    names = ("mirror", "glass", "rough_dielectric", "disney", "gltf")
    places = [(-1.0 + 0.5 * k, 0.3, 0.2 * (k % 2)) for k in range(len(names))]
    shapes = [ball(name, place, 0.28, name=name) for name, place in zip(names, places, strict=True)]
    transparent = {
        name: of_model(name, values={"alpha": 0.3 + 0.1 * k}) for k, name in enumerate(names)
    }
    return stage(*shapes, materials=transparent)


OPACITY = {"alpha": TextureUse("opacity")}


def _model(name: str) -> Callable[[], Scene]:
    return lambda: model_scene(name)


def _textured(wrap: str, kind: str) -> Callable[[], Scene]:
    return lambda: textured(wrap, kind)


MODEL_SCENES: Scenes = {f"model-{name}": _model(name) for name in MODELS}
SURFACES: Scenes = {
    **{
        f"texture-{wrap}-{kind}": _textured(wrap, kind)
        for wrap in ("repeat", "mirror", "clamp")
        for kind in ("bilinear", "mip")
    },
    "texture-without-normal-map": lambda: textured("repeat", "mip", bent=False),
    "texture-channels-bilinear": lambda: channels("bilinear"),
    "texture-channels-mip": lambda: channels("mip"),
    "opacity-many-layers": many_layers,
    "opacity": lambda: shaded(card(0.7)),
    "opacity-textured": lambda: shaded(card(0.8, textures=OPACITY)),
    "opacity-mip": lambda: shaded(card(0.8, textures=OPACITY), kind="mip"),
    "opacity-models": transparent_models,
    "mask": lambda: shaded(card(0.9, textures=OPACITY, alpha_cutoff=0.5)),
    "mask-mip": lambda: shaded(card(0.9, textures=OPACITY, alpha_cutoff=0.5), kind="mip"),
    "smooth-and-rough-glass": lambda: stage(
        ball("smooth", (-0.5, 0.45, 0.0), 0.45),
        ball("rough", (0.5, 0.45, 0.2), 0.45, name="other"),
        materials={"smooth": GLASS, "rough": of_model("rough_dielectric")},
    ),
    "no-environment": lambda: stage(ball(), materials={"ball": GLOSS}, environment=None),
    "no-delta-lights": lambda: stage(ball(), materials={"ball": GRAY}, lights=()),
}
