"""Scenes with something between their surfaces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    BOUNDARY,
    VACUUM,
    DensityGrid,
    Material,
    Medium,
    Scene,
    Shutter,
    Texture,
)
from photograd.transport.shapes import box, rectangle

from fingerprint_cases.scenes import GLASS, POINT, SKY, Scenes, ball, dome, panel, stage, view
from fingerprint_cases.scenes_light import LIGHTS
from fingerprint_cases.scenes_surface import CARD, OPACITY, card, of_model

FOG = Medium([0.9, 0.6, 0.4], [0.8, 0.7, 0.9], values={"g": 0.4})
WAX = Medium([4.0, 5.0, 6.0], [0.95, 0.9, 0.8], "cornette_shanks", {"g": 0.2})
INK = Medium([0.3, 1.1, 2.2])
FROSTED = Material("rough_dielectric", {"eta": 1.4, "roughness": 0.6})


def smoke(**more: Any) -> Medium:
    """A medium with a grid that fills the box of `fog_box`."""
    place = np.diag([1.8, 1.3, 1.8, 1.0])
    place[:3, 3] = [-0.9, 0.05, -0.9]
    values = 0.1 + 0.9 * np.random.default_rng(3).random((3, 4, 5))
    albedo = more.pop("albedo", [0.8, 0.7, 0.9])
    grid = DensityGrid(values, place, **more)
    return Medium([1.8, 1.4, 1.0], albedo, values={"g": 0.3}, density=grid)


def fog_box(medium: Medium = FOG, *shapes: Any, **more: Any) -> Scene:
    """A box of a medium on the floor, whose surface is a mere boundary."""
    walls = replace(box("fog", [0, 0.7, 0], [1.8, 1.3, 1.8], BOUNDARY), interior="fog")
    media = {"fog": medium, **more.pop("media", {})}
    return stage(walls, *shapes, media=media, **more)


def nested(outer: Medium = FOG) -> Scene:
    """In a box of fog a ball of wax, within it a bubble of nothing, and a ball of glass and ink."""
    shapes = (
        ball(BOUNDARY, (-0.4, 0.5, 0.0), 0.35, name="wax", interior="wax"),
        ball(BOUNDARY, (-0.4, 0.5, 0.1), 0.15, name="bubble", interior=VACUUM),
        ball("glass", (0.4, 0.45, 0.1), 0.3, name="bottle", interior="ink"),
        ball("frosted", (0.35, 0.9, -0.3), 0.2, name="frosted", interior="wax"),
    )
    return fog_box(
        outer,
        *shapes,
        materials={"glass": GLASS, "frosted": FROSTED},
        media={"wax": WAX, "ink": INK},
    )


def haze(medium: Medium = FOG, **more: Any) -> Scene:
    """A medium around everything, a clear ball of glass and one of vacuum in it."""
    shapes = (
        ball("glass", (0.4, 0.4, 0.0), 0.4, name="glass"),
        ball(BOUNDARY, (-0.5, 0.5, 0.3), 0.3, name="bubble", interior=VACUUM),
    )
    given = {"environment": None, **more}
    return stage(*shapes, materials={"glass": GLASS}, media={"haze": medium}, world="haze", **given)


def with_opacity(medium: Medium, **more: Any) -> Scene:
    """Fog whose box lets light through a painted card, a mask and a sheet in and beside it."""
    opacity = Texture(np.random.default_rng(5).uniform(0.1, 0.9, (6, 4, 1)))
    shapes = (
        rectangle("card", *CARD, "card"),
        rectangle("mask", [-0.8, 0.5, -0.5], [1.6, 0, 0], [0, 0.2, 1.0], "mask"),
        dome("sheet", scale=0.4),
        ball("shell", (0.5, 0.5, 0.4), 0.2, name="shell", interior="ink"),
    )
    materials = {
        "card": card(0.8, textures=OPACITY),
        "mask": card(0.9, textures=OPACITY, alpha_cutoff=0.5),
        "sheet": of_model("gltf_transmission", values={"alpha": 0.6}),
        "shell": of_model("gltf_refraction", values={"alpha": 0.7}),
    }
    return fog_box(
        medium,
        *shapes,
        materials=materials,
        textures={"opacity": opacity},
        media={"ink": INK},
        **more,
    )


def camera_inside(medium: Medium, *, moving: bool = False) -> Scene:
    """A camera in a ball of glass in a box of fog; while its shutter is open it may leave both."""
    shapes = (ball("glass", (0.0, 0.6, 0.3), 0.25, name="around", interior="ink"),)
    camera = view((0.0, 0.6, 0.3), (0.0, 0.3, -0.8))
    end = camera.world_from_camera.copy()
    end[:3, 3] += [0.3, 0.2, 1.5]
    return fog_box(
        medium,
        *shapes,
        materials={"glass": GLASS},
        media={"ink": INK},
        camera=camera,
        shutter=Shutter(end) if moving else None,
    )


def moving_media() -> Scene:
    """A ball of wax that moves, past a camera in fog."""
    shapes = (
        ball(
            BOUNDARY,
            (-0.3, 0.5, 0.2),
            0.3,
            name="wax",
            interior="wax",
            closing=np.array([0.4, 0.7, 0.0]),
        ),
        ball(
            "glass",
            (0.0, 0.7, 0.9),
            0.2,
            name="glass",
            interior="ink",
            closing=np.array([0.0, 0.7, 2.2]),
        ),
    )
    return fog_box(
        FOG,
        *shapes,
        materials={"glass": GLASS},
        media={"wax": WAX, "ink": INK},
        camera=view((0.0, 0.7, 0.9), (0.0, 0.4, -0.6)),
    )


MEDIA: Scenes = {
    "fog": fog_box,
    "fog-cornette-shanks": lambda: fog_box(WAX),
    "fog-absorbing": lambda: fog_box(INK),
    "fog-lights": lambda: fog_box(FOG, lights=tuple(make() for make in LIGHTS.values())),
    "smoke": lambda: fog_box(smoke()),
    "smoke-from-above": lambda: fog_box(
        smoke(), lights=(DirectionalLight([0.0, 1.0, 0.0], [2.0, 1.5, 1.0]),)
    ),
    "smoke-majorant": lambda: fog_box(smoke(majorant=1.7)),
    "smoke-absorbing": lambda: fog_box(smoke(albedo=None)),
    "nested": nested,
    "nested-smoke": lambda: nested(smoke()),
    "boundary-alone": lambda: stage(ball(BOUNDARY), panel_ball()),
    "haze": haze,
    "haze-absorbing": lambda: haze(INK),
    "haze-smoke": lambda: haze(smoke(), lights=(POINT,)),
    "haze-lights-at-infinity": lambda: haze(
        FOG, environment=SKY, lights=(POINT, DirectionalLight([0.5, 1, 0.4], [2.0, 1.5, 1.0]))
    ),
    "opacity-fog": lambda: with_opacity(FOG),
    "opacity-smoke": lambda: with_opacity(smoke()),
    "opacity-haze": lambda: replace(with_opacity(FOG), world="fog", environment=None),
    "camera-inside": lambda: camera_inside(FOG),
    "camera-inside-smoke": lambda: camera_inside(smoke()),
    "camera-leaves": lambda: camera_inside(FOG, moving=True),
    "moving-media": moving_media,
    "point-light-in-fog": lambda: fog_box(FOG, lights=(PointLight([0, 0.8, 0], [1.0, 0.9, 0.8]),)),
}


def panel_ball() -> Any:
    """A second light, below the first."""
    return replace(panel(2.0), name="lower", vertices=panel().vertices - [0, 0.4, 0])
