"""Alpha of glTF materials: factor, texture and mode."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.transport.texture import decode

from tests.transport.gltf_samples import core, square
from tests.transport.test_gltf_materials import PIXELS, made, only
from tests.transport.test_mesh_files import read


@pytest.mark.parametrize(("mode", "cutoff"), [("BLEND", None), ("MASK", 0.25)])
def test_alpha_is_factor_times_texture(tmp_path: Path, mode: str, cutoff: float | None) -> None:
    glb = square()
    opacity = np.array([[0, 64], [128, 255]], np.uint8)
    pixels = np.concatenate([PIXELS, opacity[..., None]], axis=2)
    glb.json["materials"][0] |= core(
        baseColorFactor=[1, 1, 1, 0.75], baseColorTexture={"index": glb.image(pixels)}
    ) | {"alphaMode": mode, "alphaCutoff": 0.25}
    model, told = read(tmp_path, glb.bytes())
    assert told == []
    material = only(model)
    assert material.values["alpha"] == 0.75
    assert material.alpha_cutoff == cutoff
    found = model.textures[material.textures["alpha"].texture].values
    np.testing.assert_allclose(found[..., 0], opacity / 255, atol=1e-7)
    # The colors of such an image are as they stand there.
    colors = model.textures[material.textures["base_color"].texture].values
    np.testing.assert_allclose(colors, decode(PIXELS / 255), rtol=1e-6)


@pytest.mark.parametrize(
    ("alpha", "entries", "sheer"),
    [
        (0.5, {}, False),  # opaque is what is not said otherwise
        (0.5, {"alphaMode": "BLEND"}, True),
        (1.0, {"alphaMode": "BLEND"}, False),
        (0.6, {"alphaMode": "MASK"}, False),
        (0.4, {"alphaMode": "MASK"}, True),
    ],
)
def test_what_covers_everything_has_no_alpha(
    tmp_path: Path, alpha: float, entries: dict[str, Any], sheer: bool
) -> None:
    material, told = made(tmp_path, **core(baseColorFactor=[1, 1, 1, alpha]), **entries)
    assert told == []
    assert material.has_opacity == sheer
