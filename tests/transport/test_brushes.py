"""Models that look different when they are turned have frames that follow the texture."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import bsdf
from photograd.transport import Material, MeshShape, PathOptions, PathTracer, Scene
from photograd.transport.core_arrays import BRUSHES
from photograd.transport.shapes import rectangle

from support.bsdf_proofs import hemisphere
from tests.transport.scenes import BLACK, any_material, view
from tests.transport.test_textures import WALL

MODELS = bsdf.registry()
BRUSHED: dict[str, Any] = {
    "roughness": 0.3,
    "anisotropy": 0.8,
    "rotation": 0.0,
    "metalness": 1.0,
    "coat": 0.0,
    "iridescence_factor": 0.0,
    "sheen_color_factor": [0, 0, 0],
}
SHINY: dict[str, dict[str, Any]] = {
    "ggx_anisotropic": {"roughness": 0.3, "anisotropy": 0.8, "rotation": 0.0},
    **{name: BRUSHED for name in MODELS if name.startswith("gltf_layered")},
    "disney": {"roughness": 0.3, "anisotropic": 0.9, "metalness": 1.0, "clearcoat": 0.0},
}


def test_every_model_that_can_be_turned_is_brushed() -> None:
    wo, wi = (hemisphere(50, seed=91, stream=k) for k in (1, 2))
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    found = set()
    for name, model in MODELS.items():
        values = model.at(0.5)
        here = model.f(values, wo, wi)
        there = model.f(values, np.ascontiguousarray(wo @ turn), np.ascontiguousarray(wi @ turn))
        if np.abs(there - here).max() > 1e-6 * here.max():
            found.add(name)
    assert found == set(SHINY)
    assert found == {n for n, m in MODELS.items() if {p.name for p in m.parameters} & {*BRUSHES}}


def lit(model: str, quarters: int) -> tuple[Any, Any]:
    """A wall beside a light, its texture coordinates turned; picture and noise."""
    values = {**any_material(model, 0.5).values, **SHINY[model]}
    shape = rectangle("wall", *WALL, "wall")
    uv = np.asarray(shape.uv)
    for _ in range(quarters):
        uv = uv[:, ::-1] * [-1.0, 1.0]
    shape = MeshShape("wall", shape.vertices, shape.faces, "wall", uv=uv)
    lamp = rectangle("lamp", [1.2, -0.3, 1.0], [0, 0, 0.6], [0, 0.6, 0], "black", [9.0] * 3)
    materials = {"wall": Material(model, values), "black": BLACK}
    camera = view(6, (0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    sums = PathTracer(Scene("s", (shape, lamp), materials, camera)).render(
        spp=512, seed=1 + quarters, options=PathOptions(max_depth=2, sampler="independent")
    )
    return sums.mean, sums.standard_error


@pytest.mark.parametrize("model", SHINY)
def test_a_brush_turns_with_the_coordinates(model: str) -> None:
    plain, turned, twice = (lit(model, quarters) for quarters in (0, 1, 2))
    assert plain[0].mean() > 0.02

    def apart(a: Any, b: Any) -> float:
        return float((np.abs(a[0] - b[0]) / (np.hypot(a[1], b[1]) + 1e-6)).max())

    assert apart(plain, turned) > 8
    assert apart(plain, twice) < 5  # half a turn is none; of 108 numbers, false alarm: 6e-5
