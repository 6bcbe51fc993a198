"""`photograd trace` of mesh files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.commands.trace import load_scene
from photograd.errors import SceneError
from photograd.images.exr import read_exr

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
    np.testing.assert_allclose(image[23, 0, :3], image[23, 0, 0], rtol=1e-3)  # the gray sky
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


def test_which_camera_is_taken(tmp_path: Path) -> None:
    glb, path = square(), tmp_path / "s.glb"
    lens = {"yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1}
    glb.seen({"type": "perspective", "name": "near", "perspective": lens}, translation=[0, 0, 3])
    path.write_bytes(glb.bytes())
    own, fingerprint = load_scene(str(path), 24)
    assert (own.camera.width, own.camera.height) == (24, 16)
    np.testing.assert_array_equal(own.camera.position, [0, 0, 3])
    studio, other = load_scene(str(path), 24, "studio")
    assert studio.camera.height == 24
    assert fingerprint != other  # samples of one are not added to those of the other
    with pytest.raises(SceneError, match="camera: expected a camera of the file, got neer"):
        load_scene(str(path), 24, "neer")
    with pytest.raises(SceneError, match=r"SCENE: expected a mesh file .* with --camera"):
        load_scene("cornell-box", 24, "near")
