"""`photograd fit`, `evaluate`, `render` and `compare` of a mesh whose texture is fitted."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from photograd.capture.write import write_blender_capture
from photograd.images.read import read_image

from tests.commands.conftest import Photograd
from tests.fit import scene
from tests.fit.mesh_scene import capture, cube, write_obj

KIND = ("--representation", "textured_mesh")


def test_a_texture_is_fitted_to_the_mesh_of_a_file(photograd: Photograd, tmp_path: Path) -> None:
    mesh = write_obj(tmp_path / "cube.obj", cube())
    splits = {
        name: [(view.name, view.camera, view.rgba(), None) for view in views]
        for name, views in (("train", capture().train[:4]), ("test", capture().test))
    }
    photos, model = tmp_path / "photos", tmp_path / "model"
    write_blender_capture(photos, splits, aabb=scene.BOX)
    few = ("--steps", 5, "--rays", 256, "--json")

    without = photograd("fit", photos, "--out", model, *KIND, *few)
    assert without.code != 0
    assert "--start-from mesh.glb" in without.out + without.err

    size = ("--resolution", 24, "--start-from", mesh)
    done = photograd("fit", photos, "--out", model, *KIND, *size, *few)
    assert done.code == 0, done.err
    assert "mesh: 12 triangles, held" in done.err
    assert done.result()["textured_mesh"] == str(model / "mesh.glb")
    assert (model / "mesh.glb").read_bytes()[:4] == b"glTF"

    picture = tmp_path / "picture.png"
    words = ("render", model, "--frames", 1, "--size", 32, "--out", picture)
    assert photograd(*words).code == 0
    assert read_image(picture)[..., :3].std() > 0.05

    words = ("compare", photos, "--candidates", "textured_mesh:16", "--out", tmp_path / "compared")
    # The file that the fit left is a mesh to start from.
    again = photograd(*words, "--start-from", model / "mesh.glb", *few)
    assert again.code == 0, again.err
    assert "KHR_materials_unlit" in again.err
    assert again.result()["scores"][0]["candidate"] == "textured_mesh:16"

    assert photograd(*words, "--start-from", model / "mesh.glb", *few).code == 0
    assert photograd(*words, "--start-from", mesh, *few).code == 0  # the same mesh
    larger = write_obj(tmp_path / "larger.obj", replace(cube(), vertices=1.5 * cube().vertices))
    other = photograd(*words, "--start-from", larger, *few)
    assert other.code == 1
    both = r"start_from: expected .*mesh.glb \(.*started, got .*larger.obj \(.*choose another --out"
    assert re.search(both, other.err), other.err
