"""Damaged mesh files: taken or refused with a typed error, in little memory."""

from __future__ import annotations

import json
import os
import time
import tracemalloc
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.errors import IoError, RangeError, SceneError
from photograd.transport import ModelFile, read_model
from tests.transport.gltf_samples import Glb, core
from tests.transport.test_mesh_files import obj, ply, stl

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 40
MOST_BYTES = 64 << 20
WORDS = (b"\xff\xff\xff\xff", b"\0\0\0\0", b"\x7f", b"nan", b"-1", b"1e308", b"9" * 40, b"/", b"\n")
NUMBERS = (-1, 0, 1, 3, 255, 2**31 - 1, 2**63, 1e300, float("nan"), 0.5)


def sample() -> Glb:
    """A file with a bit of everything."""
    glb = Glb()
    pixels = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
    textures = {
        "baseColorTexture": {"index": glb.image(pixels)},
        "metallicRoughnessTexture": {"index": glb.image(pixels)},
    }
    coat = {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0}}
    material = glb.material(
        name="m",
        normalTexture={"index": 1, "scale": 0.5},
        emissiveFactor=[1, 1, 1],
        extensions={"KHR_materials_clearcoat": coat},
        **core(**textures),
    )
    parent = glb.node(glb.mesh(material=material), rotation=[0, 0, 0, 1], scale=[1, 2, 1])
    glb.json["nodes"].append({"mesh": 0, "translation": [1, 2, 3]})
    parent["children"] = [1]
    lens = {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.01}
    glb.seen({"type": "perspective", "perspective": lens}, translation=[0, 0, 5])
    glb.lit({"type": "point", "intensity": 3, "color": [1, 0.5, 0], "range": 9}, scale=[1, 2, 3])
    cone = {"innerConeAngle": 0.2, "outerConeAngle": 0.4}
    glb.lit({"type": "spot", "spot": cone}, rotation=[0, 0, 0, 1])
    glb.json["samplers"] = [{"minFilter": 9987, "magFilter": 9729, "wrapS": 33071}]
    glb.json["textures"][0]["sampler"] = 0
    return glb


@st.composite
def damaged_bytes(draw: st.DrawFn, whole: bytes) -> bytes:
    """Pieces of the file replaced, up to three times, and sometimes its end cut off."""
    data = whole
    for _ in range(draw(st.integers(1, 3))):
        start, length = draw(st.integers(0, len(data))), draw(st.sampled_from([0, 1, 2, 4, 30]))
        word = draw(st.sampled_from(WORDS) | st.binary(max_size=4))
        data = data[:start] + word + data[start + length :]
    return data[: draw(st.integers(0, len(data)))] if draw(st.integers(0, 7)) == 0 else data


@st.composite
def damaged_json(draw: st.DrawFn, tables: tuple[str, ...] = ()) -> bytes:
    """A .glb with values of its JSON replaced, removed or doubled; the rest is in order.

    With `tables`, only in those of the file.
    """
    glb = sample()
    glb.bytes()
    for _ in range(draw(st.integers(1, 3))):
        node: Any = glb.json[draw(st.sampled_from(tables))] if tables else glb.json
        while True:
            keys = list(node) if isinstance(node, dict) else list(range(len(node)))
            if not keys:
                break
            key = draw(st.sampled_from(keys))
            deeper = isinstance(node[key], dict | list) and node[key]
            if deeper and draw(st.integers(0, 4)):
                node = node[key]
                continue
            change = draw(st.integers(0, 3))
            if change == 0 and isinstance(node, dict):
                del node[key]
            elif change == 1 and isinstance(node, list):
                node.append(json.loads(json.dumps(node[key])))
            else:
                node[key] = draw(
                    st.sampled_from(NUMBERS) | st.sampled_from(["x", None, True, [], {}])
                )
            break
    return glb.bytes()


MTL = """newmtl a
Kd 1 0.5 0
Ks 0.1 0.1 0.1
Ns 50
Ni 1.5
d 0.5
Pr 0.4
Pm 1
map_Kd gone.png
newmtl b
Ke 1 2 3
"""
CASES: dict[str, tuple[str, Callable[[], st.SearchStrategy[bytes]]]] = {
    "glb": ("m.glb", lambda: damaged_bytes(sample().bytes())),
    "json": ("m.glb", damaged_json),
    "views": ("m.glb", lambda: damaged_json(("cameras", "extensions", "nodes", "samplers"))),
    "obj": ("m.obj", lambda: damaged_bytes(("mtllib m.mtl\nusemtl a\n" + obj()).encode())),
    "mtl": ("m.mtl", lambda: damaged_bytes(MTL.encode())),
    "ply": ("m.ply", lambda: damaged_bytes(ply().encode())),
    "stl": ("m.stl", lambda: damaged_bytes(stl())),
}


@pytest.mark.parametrize("case", CASES)
def test_damaged_meshes(tmp_path: Path, case: str) -> None:
    name, strategy = CASES[case]
    path = tmp_path / name
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\n")
    asked = path
    if case == "mtl":  # what is wrong with a material is left out and said
        asked = tmp_path / "m.obj"
        asked.write_text("mtllib m.mtl\nusemtl a\n" + obj())
    answers: set[str] = set()
    end = time.monotonic() + SECONDS
    rounds = 0
    while time.monotonic() < end or rounds == 0:

        @seed(rounds)
        @settings(
            max_examples=EXAMPLES_A_ROUND,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(strategy())
        def survive(bad: bytes) -> None:
            path.write_bytes(bad)
            tracemalloc.start()
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    model = read_model(asked)
                assert isinstance(model, ModelFile)
                assert all(np.isfinite(shape.box).all() for shape in model.shapes)
                assert all(
                    np.isfinite(light.core_call(float)[1][0]).all() for light in model.lights
                )
                for camera in model.cameras:
                    assert np.isfinite(camera.world_from_camera).all()
                answers.add("taken")
            except (IoError, RangeError, SceneError) as refusal:
                answers.add("refused" if "read_model" in str(refusal) else f"{refusal}")
            finally:
                peak = tracemalloc.get_traced_memory()[1]
                tracemalloc.stop()
            assert peak < MOST_BYTES

        survive()
        rounds += 1
    # Whether damage can be harmless depends on how many examples there was time for.
    assert answers - {"taken"} == ({"refused"} if case != "mtl" else set())
