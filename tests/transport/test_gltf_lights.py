"""Lights of glTF files: their irradiance, invalid files, and files that are written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error
from photograd.lights import DirectionalLight, PointLight, SkyLight, SpotLight, SunLight
from photograd.transport import Material, ModelFile, PathOptions, PathTracer, Scene
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle

from tests.transport.gltf_samples import LIGHTS, Glb, square
from tests.transport.test_gltf_save import json_of, written
from tests.transport.test_mesh_files import read

pytestmark = pytest.mark.usefixtures("core")
HALF = float(np.sqrt(0.5))
DOWN = [-HALF, 0, 0, HALF]
"""Turns -Z to -Y."""
FLOOR = np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], np.float32)
COLOR = [1.0, 0.5, 0.25]
CONE = {"innerConeAngle": 0.3, "outerConeAngle": 0.6}


def lit_floor(light: Any, **place: Any) -> Glb:
    """A floor, and a light below a node that turns, scales and moves."""
    glb = Glb()
    glb.node(glb.mesh(FLOOR, material=glb.material(name="m")))
    glb.lit(light, **place)
    glb.json["scenes"][0]["nodes"].pop()
    # A quarter turn about Y, three times as large: local (x, y, z) is at (3 z, 3 y + 1, -3 x).
    parent = glb.node(0, rotation=[0, HALF, 0, HALF], scale=[3, 3, 3], translation=[0, 1, 0])
    del parent["mesh"]
    parent["children"] = [1]
    return glb


def irradiance(folder: Path, glb: Glb, x: float) -> Any:
    """(3,) on the floor at (x, 0, 0), from the radiance that its albedo of 0.5 returns."""
    model, told = read(folder, glb.bytes())
    assert told == []
    assert len(model.lights) == 1
    camera = camera_at([x, 1.0, 1e-3], [x, 0.0, 0.0], 1e-3, 1, 1)
    matt = {"m": Material("lambert", {"albedo": [0.5] * 3})}
    scene = Scene("f", model.shapes, matt, camera, lights=model.lights)
    options = PathOptions("light", max_depth=2)
    return PathTracer(scene, dtype=np.float64).render(spp=1, seed=1, options=options).mean[0, 0] * (
        np.pi / 0.5
    )


def at_share(t: float) -> float:
    """Meters from the axis on the floor, 4 m below a spot of `CONE`, at a share of its cosines."""
    inner, outer = np.cos(CONE["innerConeAngle"]), np.cos(CONE["outerConeAngle"])
    return float(4 * np.tan(np.arccos(outer + t * (inner - outer))))


@pytest.mark.parametrize(
    ("light", "place", "x", "expected"),
    [
        # (0, 4, -1.5): r^2 = 16 + 2.25 + 1 for x = 1.
        (
            {"type": "point", "intensity": 7.0, "color": COLOR},
            {"translation": [0.5, 1, 0]},
            1.0,
            7 * 4 / 19.25**1.5,
        ),
        ({"type": "point", "color": COLOR}, {"translation": [0, 1, 0]}, 0.0, 1 / 16),
        # (0, 4, 0), straight down: within, in the middle of the rim's cosines, and beyond.
        (
            {"type": "spot", "intensity": 5.0, "color": COLOR, "spot": CONE},
            {"translation": [0, 1, 0], "rotation": DOWN},
            1.0,
            5 * 4 / 17**1.5,
        ),
        (
            {"type": "spot", "intensity": 5.0, "color": COLOR, "spot": CONE},
            {"translation": [0, 1, 0], "rotation": DOWN},
            at_share(0.5),
            0.5 * 5 * 4 / (16 + at_share(0.5) ** 2) ** 1.5,
        ),
        (
            {"type": "spot", "intensity": 5.0, "color": COLOR, "spot": CONE},
            {"translation": [0, 1, 0], "rotation": DOWN},
            at_share(-0.01),
            0.0,
        ),
        # Without angles light fades from the axis to 45 degrees.
        (
            {"type": "spot", "color": COLOR},
            {"translation": [0, 1, 0], "rotation": DOWN},
            0.0,
            1 / 16,
        ),
        # -Z of the parent is -X of the world: turned by 30 degrees about its X, down again.
        (
            {"type": "directional", "intensity": 3.0, "color": COLOR},
            {"rotation": [-np.sin(np.pi / 12), 0, 0, np.cos(np.pi / 12)]},
            0.0,
            3 * 0.5,
        ),
    ],
)
def test_irradiance_has_a_closed_form(
    tmp_path: Path, light: Any, place: Any, x: float, expected: float
) -> None:
    found = irradiance(tmp_path, lit_floor(light, **place), x)
    # Where the ray meets the floor is a float: measured at most 1.5e-6.
    np.testing.assert_allclose(found, expected * np.array(COLOR), rtol=5e-6, atol=1e-12)


@pytest.mark.parametrize(
    ("light", "words"),
    [
        ({"type": "point", "intensity": -1}, "lights[0]: intensity: expected a number from 0"),
        ({"type": "point", "intensity": 1e31}, "lights[0]: intensity: expected a number from 0"),
        ({"type": "point", "intensity": "x"}, "lights[0]: intensity: expected a number, got str"),
        ({"type": "point", "color": [1, 2, 0]}, "lights[0]: color: expected three numbers from 0"),
        ({"type": "point", "color": [1, -1, 0]}, "lights[0]: color: expected three numbers from"),
        ({"type": "point", "color": [1, 1]}, "lights[0]: color: expected numbers of shape (3,)"),
        ({"type": "area"}, "lights[0]: type: expected one of point, spot, directional, got area"),
        ({"intensity": 1}, "lights[0]: expected a member 'type'"),
        ({"type": "spot", "spot": {"outerConeAngle": 1.6}}, "spot: outerConeAngle: expected rad"),
        ({"type": "spot", "spot": {"outerConeAngle": 0}}, "spot: outerConeAngle: expected radians"),
        (
            {"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}},
            "spot: innerConeAngle: expected radians from 0 to below 0.5, got 0.5",
        ),
        ({"type": "spot", "spot": {"innerConeAngle": -0.1}}, "spot: innerConeAngle: expected rad"),
        ({"type": "spot", "spot": {"innerConeAngle": 0.8}}, "spot: innerConeAngle: expected rad"),
        ({"type": "spot", "spot": 3}, "lights[0]: spot: expected"),
    ],
)
def test_what_is_no_light_is_refused_by_place(tmp_path: Path, light: Any, words: str) -> None:
    glb = square()
    glb.lit(light)
    with pytest.raises(Error) as caught:
        read(tmp_path, glb.bytes())
    assert f"m.glb: extensions: {LIGHTS}: lights[0]" in str(caught.value)
    assert words in str(caught.value)


@pytest.mark.parametrize("number", [1, -1, 0.5, "lamp"])
def test_numbers_of_lights_that_do_not_exist(tmp_path: Path, number: Any) -> None:
    glb = square()
    node = glb.lit({"type": "point"})
    node["extensions"][LIGHTS]["light"] = number
    with pytest.raises(OSError, match=rf"m\.glb: nodes\[1\]: extensions: {LIGHTS}: light: exp"):
        read(tmp_path, glb.bytes())
    del glb.json["extensions"]
    node["extensions"][LIGHTS]["light"] = 0
    with pytest.raises(OSError, match=rf"m\.glb: nodes\[1\]: extensions: {LIGHTS}: light: exp"):
        read(tmp_path, glb.bytes())


def test_what_is_left_out_is_named(tmp_path: Path) -> None:
    glb = square()
    glb.lit({"type": "point", "range": 5.0})
    glb.lit({"type": "directional"}, scale=[1, 1, 0])
    glb.lit({"type": "point"}, translation=[1e10, 0, 0])
    model, told = read(tmp_path, glb.bytes())
    assert [type(light).__name__ for light in model.lights] == ["PointLight"]
    assert told == [
        f"m.glb: extensions: {LIGHTS}: lights[0]: range: left out: light falls with the square of "
        "distance alone",
        "m.glb: nodes[2]: a light without direction or out of reach, left out (and in 1 more)",
    ]


def some_lights(g: np.random.Generator) -> tuple[Any, ...]:
    way = g.normal(size=(2, 3))
    place = g.normal(size=(2, 3))
    strong = g.uniform(0, 10.0 ** g.integers(-2, 5), (3, 3))
    cone = float(np.cos(g.uniform(0.01, np.pi / 2))), float(g.uniform(0.01, 1))
    return (
        PointLight(place[0], strong[0]),
        SpotLight(place[1], way[0], strong[1], *cone),
        DirectionalLight(way[1], strong[2]),
    )


def test_lights_come_back(tmp_path: Path) -> None:
    wall = rectangle("wall", [-1, -1, 0], [2, 0, 0], [0, 2, 0], "m")
    paint = Material("gltf", {"base_color": [0.5] * 3, "metalness": 0.0, "roughness": 1.0})
    g = np.random.default_rng(7)
    ends = (
        SpotLight([0, 0, 0], [0, 0, -1], [0] * 3, 0.0, 1.0),
        SpotLight([0, 0, 0], [0, 1, 0], [1] * 3, np.cos(2e-3), 0.01),
        DirectionalLight([0, 0, -1], [0, 0, 1e-9]),
    )
    for lights in [ends, *(some_lights(g) for _ in range(10))]:
        model = ModelFile((wall,), {"m": paint}, lights=lights)
        found, said = written(model, tmp_path / "m.glb")
        assert said == []
        for mine, its in zip(lights, found.lights, strict=True):
            assert type(mine) is type(its)
            for name, value in vars(mine).items():
                np.testing.assert_allclose(getattr(its, name), value, rtol=1e-11, atol=1e-13)
            strength = "irradiance" if isinstance(mine, DirectionalLight) else "intensity"
            np.testing.assert_array_equal(getattr(its, strength), getattr(mine, strength))
        for entry in json_of(tmp_path / "m.glb")["extensions"][LIGHTS]["lights"]:
            assert max(entry["color"]) <= 1


def test_lights_without_words_are_named(tmp_path: Path) -> None:
    wall = rectangle("wall", [-1, -1, 0], [2, 0, 0], [0, 2, 0], "m")
    paint = Material("gltf", {"base_color": [0.5] * 3, "metalness": 0.0, "roughness": 1.0})
    lights = (
        SkyLight([1] * 3, [1] * 3, [1] * 3),
        PointLight([0, 0, 1], [1] * 3),
        SpotLight([0, 0, 1], [0, 0, -1], [1] * 3, -0.1, 0.5),
        SunLight([0, 1, 0], [1] * 3, 0.01),
        PointLight([0, 0, 1], [1e30, 1, 1]),
    )
    found, said = written(ModelFile((wall,), {"m": paint}, lights=lights), tmp_path / "m.glb")
    assert said == [
        "m.glb: not written: lights[0] (SkyLight), lights[2] (SpotLight), "
        "lights[3] (SunLight), lights[4] (PointLight)"
    ]
    assert [type(light).__name__ for light in found.lights] == ["PointLight"]
    assert json_of(tmp_path / "m.glb")["extensionsUsed"] == [LIGHTS]
