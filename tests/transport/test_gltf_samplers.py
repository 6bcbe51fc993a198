"""Filters of glTF samplers: which lookup each becomes, what is named, and what comes back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.lights import DirectionalLight
from photograd.transport import (
    Environment,
    Material,
    ModelFile,
    PathOptions,
    PathTracer,
    Scene,
    Texture,
    TextureUse,
    read_scene,
    save_gltf,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle
from photograd.transport.texture import FILTERS

from tests.transport.gltf_models import same
from tests.transport.gltf_samples import Glb, core, square
from tests.transport.test_gltf_save import json_of, written
from tests.transport.test_mesh_files import read

pytestmark = pytest.mark.usefixtures("core")
BLACK = {"albedo": [0.0] * 3, "alpha": 1.0}
GRAY = np.full((4, 4, 3), 128, np.uint8)
NO_MIPS = "mip maps of its sampler: not supported, sampled without mip maps"


def sampled(**sampler: Any) -> Glb:
    """A square painted through a sampler."""
    glb = square(**core(baseColorTexture={"index": 0}, metallicFactor=0))
    glb.image(GRAY)
    glb.json["samplers"] = [sampler]
    glb.json["textures"][0]["sampler"] = 0
    return glb


@pytest.mark.parametrize(
    ("sampler", "filter", "words"),
    [
        ({}, "bilinear", None),
        ({"minFilter": 9729, "magFilter": 9729}, "bilinear", None),
        ({"minFilter": 9987, "magFilter": 9729}, "mip", None),
        ({"minFilter": 9728}, "bilinear", "minFilter: NEAREST, read as LINEAR"),
        ({"magFilter": 9728}, "bilinear", "magFilter: NEAREST, read as LINEAR"),
        (
            {"minFilter": 9984},
            "mip",
            "minFilter: NEAREST_MIPMAP_NEAREST, read as LINEAR_MIPMAP_LINEAR",
        ),
        (
            {"minFilter": 9985},
            "mip",
            "minFilter: LINEAR_MIPMAP_NEAREST, read as LINEAR_MIPMAP_LINEAR",
        ),
        (
            {"minFilter": 9986},
            "mip",
            "minFilter: NEAREST_MIPMAP_LINEAR, read as LINEAR_MIPMAP_LINEAR",
        ),
        ({"minFilter": 9988}, "bilinear", "minFilter: 9988: unknown, read as LINEAR"),
        ({"magFilter": 9987}, "bilinear", "magFilter: 9987: unknown, read as LINEAR"),
        ({"wrapS": 5}, "bilinear", "wrapS: 5: unknown, read as REPEAT"),
    ],
)
def test_a_filter_is_followed_or_named(
    tmp_path: Path, sampler: Any, filter: str, words: str | None
) -> None:
    model, told = read(tmp_path, sampled(**sampler).bytes())
    (texture,) = model.textures.values()
    assert texture.filter == filter
    assert texture.wrap == ("repeat", "repeat")
    assert told == ([] if words is None else [f"m.glb: samplers[0]: {words}"])


@pytest.mark.parametrize("value", [-1, 9729.5, "LINEAR", 1 << 20])
def test_what_is_no_filter_is_refused(tmp_path: Path, value: Any) -> None:
    with pytest.raises(OSError, match=r"m\.glb: samplers\[0\]: minFilter: expected a"):
        read(tmp_path, sampled(minFilter=value).bytes())


def test_what_is_sampled_without_mip_maps_is_named(tmp_path: Path) -> None:
    glb = sampled(minFilter=9987)
    glb.json["materials"][0] |= {
        "normalTexture": {"index": 0},
        "emissiveTexture": {"index": 0},
        "emissiveFactor": [1, 1, 1],
    }
    _, told = read(tmp_path, glb.bytes())
    place = "m.glb: materials[0]"
    assert told == [f"{place}: normalTexture: {NO_MIPS}", f"{place}: emissiveTexture: {NO_MIPS}"]


def net(mode: str) -> Glb:
    """A quarter of it is there: 16 x 16 wires of one texel in four."""
    wires = np.zeros((32, 32, 4), np.uint8)
    wires[::2, ::2] = 255
    glb = Glb()
    paint = core(baseColorTexture={"index": glb.image(wires)}, metallicFactor=0)
    glb.json["samplers"] = [{"minFilter": 9987}]
    glb.json["textures"][0]["sampler"] = 0
    glb.node(glb.mesh(material=glb.material(name="m", alphaMode=mode, alphaCutoff=0.5, **paint)))
    return glb


def test_a_mask_far_away_is_still_a_net(tmp_path: Path) -> None:
    shown = {}
    for mode in ("MASK", "BLEND"):
        model, told = read(tmp_path, net(mode).bytes())
        place = "m.glb: materials[0]: pbrMetallicRoughness: baseColorTexture"
        assert told == ([f"{place}: {NO_MIPS}"] if mode == "MASK" else [])
        uses = model.materials["m"].textures
        assert model.textures[uses["base_color"].texture].filter == "mip"
        alpha = model.textures[uses["alpha"].texture]
        assert alpha.filter == ("bilinear" if mode == "MASK" else "mip")
        again, said = written(model, tmp_path / "again.glb")
        assert said == ([f"again.glb: read back: again.glb{place[5:]}: {NO_MIPS}"] if told else [])
        same(model, again)
        # Black before an even sky of 1, in a picture of 8 x 8: what is there is missing from it.
        black = {
            "m": replace(
                model.materials["m"],
                model="lambert",
                values=BLACK,
                textures={"alpha": uses["alpha"]},
            )
        }
        camera = camera_at([0.5, 0.5, 10.0], [0.5, 0.5, 0.0], 5.0, 8, 8)
        for filter in FILTERS:
            seen = {uses["alpha"].texture: replace(alpha, filter=filter)}
            scene = Scene(
                "n", model.shapes, black, camera, Environment.constant(1.0), textures=seen
            )
            shown[mode, filter] = 1 - PathTracer(scene).render(spp=64, seed=1).mean.mean()
    # Between texels alpha is (1 - |x|) (1 - |y|), of which (1 - ln 2) / 2 lies above the cutoff.
    assert shown["BLEND", "mip"] == pytest.approx(0.25, abs=0.01)
    assert shown["BLEND", "bilinear"] == pytest.approx(0.25, abs=0.01)
    assert shown["MASK", "bilinear"] == pytest.approx(0.1534, abs=0.015)  # measured: 0.161
    assert shown["MASK", "mip"] == 0  # why it is not followed there


def painted(filter: str, other: str | None = None) -> ModelFile:
    """A fine checkerboard; `other` is the filter of its roughness."""
    squares = np.indices((64, 64)).sum(axis=0) % 2
    board = Texture(np.repeat(squares[..., None], 3, axis=2).astype(float), filter=filter)
    textures, uses = {"t": board}, {"base_color": TextureUse("t")}
    if other is not None:
        textures |= {"r": board, "m": replace(board, filter=other)}
        uses |= {"roughness": TextureUse("r"), "metalness": TextureUse("m")}
    values = {"base_color": [1.0] * 3, "metalness": 0.0, "roughness": 1.0}
    wall = rectangle("wall", [-1, -1, 0], [2, 0, 0], [0, 2, 0], "m")
    return ModelFile((wall,), {"m": Material("gltf", values, uses)}, textures)


def test_a_filter_comes_back_and_filters(tmp_path: Path) -> None:
    noise = {}
    for filter in ("bilinear", "mip"):
        before = painted(filter)
        after, said = written(before, tmp_path / "m.glb")
        assert said == []
        samplers = json_of(tmp_path / "m.glb").get("samplers", [])
        mip = {"magFilter": 9729, "minFilter": 9987}
        assert samplers == ([mip] if filter == "mip" else [])
        camera = camera_at([0.0, 0.0, 20.0], [0.0, 0.0, 0.0], 5.7, 16, 16)
        sun = DirectionalLight([0.0, 0.0, 1.0], [1.0] * 3)
        pictures = [
            PathTracer(
                Scene("s", m.shapes, m.materials, camera, lights=(sun,), textures=m.textures)
            )
            .render(spp=1, seed=1, options=PathOptions("light", max_depth=2))
            .mean
            for m in (before, after)
        ]
        np.testing.assert_array_equal(*pictures)
        noise[filter] = float(pictures[0].std() / pictures[0].mean())
    # A pixel holds 4 x 4 squares: those of one level are all the same.
    assert noise["bilinear"] > 0.2  # measured: 0.32
    assert noise["mip"] < 0.01  # measured: 5e-6


def test_one_image_has_one_filter(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="one size, wrap and filter for metallicRoughnessTexture"):
        save_gltf(painted("bilinear", "mip"), tmp_path / "m.glb")
    assert not (tmp_path / "m.glb").exists()


def test_a_scene_file_may_choose_another_filter(tmp_path: Path) -> None:
    (tmp_path / "m.glb").write_bytes(sampled(minFilter=9987).bytes())
    text = """
[camera]
position = [0, 1, 4]
look_at = [0, 0, 0]
size = [2, 2]
field_of_view = 40
[[shapes]]
kind = "mesh"
name = "wall"
file = "m.glb"
"""
    file = tmp_path / "s.toml"
    for line, expected in (("", "mip"), ('filter = "bilinear"', "bilinear")):
        file.write_text(text + line, encoding="utf-8")
        (texture,) = read_scene(file).textures.values()
        assert texture.filter == expected
    file.write_text(text + 'filter = "cubic"', encoding="utf-8")
    with pytest.raises(SceneError, match=r"line 11: shapes\.0\.filter: expected one of bilinear"):
        read_scene(file)
