"""`photograd trace` of mesh files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from photograd.data.exr import read_exr

from tests.commands.conftest import Photograd
from tests.transport.gltf_samples import core, extension, square


def test_a_mesh_file_is_seen_from_outside(photograd: Photograd, tmp_path: Path) -> None:
    red = square(**core(baseColorFactor=[0.9, 0.05, 0.05, 1], metallicFactor=0))
    red.json["materials"][0] |= extension("unlit")
    model, out = tmp_path / "red.glb", tmp_path / "red.exr"
    model.write_bytes(red.bytes())
    done = photograd("trace", model, "--size", 24, "--spp", 16, "--out", out)
    assert done.code == 0, done.err
    told = " ".join(done.err.split())
    assert "red.glb: materials[0]: extensions: KHR_materials_unlit: not supported" in told
    image = read_exr(out)
    assert image.shape == (24, 24, 4)
    middle = image[12, 12]
    assert middle[0] > 3 * middle[1]
    np.testing.assert_allclose(image[23, 0, :3], image[23, 0, 0], rtol=1e-3)  # the grey sky
    again = photograd("trace", model, "--size", 24, "--spp", 32, "--out", out, "--resume")
    assert again.code == 0, again.err
    assert "resumed at 16 of 32" in again.err


def test_what_cannot_be_read_is_named(photograd: Photograd, tmp_path: Path) -> None:
    bad = tmp_path / "bad.glb"
    bad.write_bytes(b"glTF and nothing else")
    for path, words in ((bad, "a whole .glb of version 2"), (tmp_path / "gone.obj", "gone.obj")):
        done = photograd("trace", path, "--out", tmp_path / "o.exr")
        assert done.code == 1
        assert words in " ".join(done.err.split())
