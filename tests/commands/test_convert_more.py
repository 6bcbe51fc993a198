"""`photograd convert` of Gaussians to glTF, of fits to meshes and grids, of captures to cameras."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from photograd.capture import load_capture
from photograd.errors import IoError
from photograd.fitting import load_model
from photograd.grids.vdb import read_vdb
from photograd.splats.coding import differences
from photograd.splats.files import codings_of, is_gaussian_ply, reread, write_gaussians
from photograd.splats.splatting import Gaussians

from tests.commands.conftest import Photograd
from tests.splat import oracle


def test_the_command_reports_what_was_rounded(photograd: Photograd, tmp_path: Path) -> None:
    g = oracle.cloud(50, 1).astype(np.float32)
    write_gaussians(tmp_path / "a.ply", g)
    assert is_gaussian_ply(tmp_path / "a.ply")
    done = photograd("convert", tmp_path / "a.ply", tmp_path / "a.glb", "--json")
    assert done.code == 0, done.err
    changes = {each["attribute"]: each for each in done.result()["changes"]}
    assert changes["means"]["largest_change"] == 0
    assert 0 < changes["opacity"]["largest_change"] <= changes["opacity"]["format_allows"]
    assert "not read back" in json.dumps(done.result()["notes"])
    _, after = reread(tmp_path / "a.glb", g)
    for each in differences(g, after.gaussians, codings_of(tmp_path / "a.glb", g)):
        assert each.largest <= each.bound, each
    with pytest.raises(IoError, match="at least one"):
        write_gaussians(tmp_path / "b.glb", Gaussians(**{k: a[:0] for k, a in g.arrays().items()}))


@pytest.mark.parametrize("name", ["a.ply", "a.glb"])
def test_a_fit_becomes_a_mesh(
    photograd: Photograd, model_folder: Path, tmp_path: Path, name: str
) -> None:
    done = photograd("convert", model_folder, tmp_path / name, "--level", 6, "--json")
    assert done.code == 0, done.err
    told = done.result()
    mesh: Any = trimesh.load(tmp_path / name, force="mesh", process=False)
    assert (len(mesh.vertices), len(mesh.faces)) == (told["vertices"], told["triangles"])
    assert told["level"] == 6
    box = load_model(model_folder).field.box
    assert (mesh.bounds[0] >= box[0]).all()
    assert (mesh.bounds[1] <= box[1]).all()
    assert mesh.volume > 0.05  # counterclockwise from outside


def test_a_fit_becomes_a_grid(photograd: Photograd, model_folder: Path, tmp_path: Path) -> None:
    done = photograd("convert", model_folder / "model.npz", tmp_path / "a.vdb", "--json")
    assert done.code == 0, done.err
    sigma_t, matrix = load_model(model_folder).field.extinction()
    grid = read_vdb(tmp_path / "a.vdb").grid()
    index = np.array([[3, 5, 4], [8, 6, 7]])
    world = index @ matrix[:3, :3].T + matrix[:3, 3]
    np.testing.assert_allclose(grid.sample(world)[:, 0], sigma_t[tuple(index.T)], rtol=1e-5)
    assert sigma_t.max() > 5


@pytest.mark.parametrize("form", ["text", "binary"])
def test_a_capture_becomes_cameras(
    photograd: Photograd, capture_folder: Path, tmp_path: Path, form: str
) -> None:
    done = photograd("convert", capture_folder, tmp_path / "c", "--colmap", form, "--json")
    assert done.code == 0, done.err
    (tmp_path / "c" / "images").symlink_to(capture_folder)
    again = load_capture(tmp_path / "c", allow_outside=True)
    assert len(again.views) == done.result()["views"] == len(load_capture(capture_folder).views)
    assert (tmp_path / "c/sparse/0" / f"cameras.{'txt' if form == 'text' else 'bin'}").is_file()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("MODEL", "a.obj"), "expected a name that ends in .vdb, .npz, .ply, .glb for a model of"),
        (("MODEL", "a.vdb", "--level", 3), "expected a mesh to make, .glb or .ply, with --mesh"),
        (("MODEL", "a.ply", "--level", 1e9), "level: expected a level between"),
        (("CAPTURE", "a.xml"), "of a capture a name that ends in .json, or a folder for a COLMAP"),
        (("CAPTURE", "a", "--colmap", "xml"), "--colmap: expected one of binary, text, got"),
        (("CAPTURE", "a.json", "--mesh"), "IN: expected a fit to make a mesh of with --mesh"),
        (("nothing", "a.json"), "nothing"),
    ],
)
def test_what_means_nothing_is_refused(
    photograd: Photograd,
    model_folder: Path,
    capture_folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[object, ...],
    says: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    places = {"MODEL": model_folder, "CAPTURE": capture_folder}
    done = photograd("convert", *(places.get(str(word), word) for word in words))
    assert done.code == 1
    assert says in done.err
    assert list(tmp_path.iterdir()) == []


def test_marching_cubes_that_are_missing_name_the_extra(
    photograd: Photograd, model_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "skimage.measure", None)
    done = photograd("convert", model_folder, tmp_path / "a.ply")
    assert done.code == 1
    assert "pip install 'photograd[mesh]'" in done.err
