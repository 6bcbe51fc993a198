"""A mesh with texture and opacity as a .glb file: nothing is lost, for us and for others."""

from __future__ import annotations

import json
import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.orbit import spiral_cameras
from photograd.errors import RangeError, SceneError
from photograd.fields import TexturedSurface
from photograd.fields.layered_picture import Unwrapped
from photograd.fitting.drawing import render_field
from photograd.fitting.loss import decibels
from photograd.geometry.octahedron import unwrapped_sphere
from photograd.transport.mesh_files import read_textured_surface

from support.missing import need_module
from tests.fit.mesh_scene import cube, write_obj


def field_of(channels: int, seed: int = 1) -> TexturedSurface:
    """A bent sphere with seams, and 20 x 14 texels that reach from dark to light."""
    sphere, uv, corners, vertex = unwrapped_sphere(6)
    bent = sphere * np.array([0.7, 0.4, 0.55]) + 0.05 * np.sin(5 * sphere[:, [1, 2, 0]])
    texels = 3 * np.random.default_rng(seed).normal(size=(14, 20, channels))
    return TexturedSurface.of_mesh(bent, Unwrapped(uv, corners, vertex), texels)


def glb_json(path: Path) -> Any:
    data = path.read_bytes()
    return json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])


def texture_bits(field: TexturedSurface) -> Any:
    return np.rint(255 * field.rgba()).astype(np.uint8)


@pytest.mark.parametrize(("channels", "mode"), [(4, "BLEND"), (3, None)])
def test_nothing_is_lost_for_our_own_reader(tmp_path: Path, channels: int, mode: Any) -> None:
    field, path = field_of(channels), tmp_path / "mesh.glb"
    notes = field.export(path, None)
    assert "KHR_materials_unlit" in notes[0]
    assert len(notes) == (2 if mode else 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # mip maps of what shines
        again = read_textured_surface(path)
    ours, theirs = field.unwrapped, again.unwrapped
    assert np.array_equal(theirs.corners, ours.corners)
    assert np.array_equal(theirs.uv, ours.uv.astype(np.float32))
    written = field.vertices.astype(np.float32)[ours.vertex]
    np.testing.assert_array_equal(again.vertices[theirs.vertex].astype(np.float32), written)
    assert again.shape == field.shape  # seams are closed again
    assert (again.edges.borders, again.edges.crowded) == (0, 0)
    assert again.has_opacity == field.has_opacity == (mode == "BLEND")
    assert np.array_equal(texture_bits(again), texture_bits(field))
    assert glb_json(path)["materials"][0].get("alphaMode") == mode
    # Another time it is the same file.
    again.export(tmp_path / "again.glb", None)
    assert (tmp_path / "again.glb").read_bytes() == path.read_bytes()


@pytest.mark.parametrize("channels", [3, 4])
def test_it_looks_the_same_after_it_was_read(tmp_path: Path, channels: int) -> None:
    field = field_of(channels)
    field.export(tmp_path / "mesh.glb", None)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        again = read_textured_surface(tmp_path / "mesh.glb")
    camera = spiral_cameras(field.box, 3, size=40)[1]
    pictures = [render_field(each, camera, 0.0)[0] for each in (field, again)]
    assert pictures[0].std() > 0.05
    error = float(np.square(pictures[0] - pictures[1]).mean())
    assert decibels(error) > 50  # of texels with 8 bits


@pytest.mark.parametrize("channels", [3, 4])
def test_nothing_is_lost_for_another_reader(tmp_path: Path, channels: int) -> None:
    trimesh = need_module("trimesh")
    field, path = field_of(channels), tmp_path / "mesh.glb"
    field.export(path, None)
    (mesh,) = trimesh.load(path, process=False).geometry.values()
    flat = field.unwrapped
    np.testing.assert_array_equal(
        np.asarray(mesh.vertices, np.float32), field.vertices.astype(np.float32)[flat.vertex]
    )
    assert np.array_equal(mesh.faces, flat.corners)
    upwards = np.asarray(mesh.visual.uv, np.float64)  # it turns v over
    np.testing.assert_allclose(upwards[:, 0], flat.uv[:, 0], atol=1e-7)
    np.testing.assert_allclose(1 - upwards[:, 1], flat.uv[:, 1], atol=1e-7)
    material = mesh.visual.material
    image = np.asarray(material.baseColorTexture)
    assert np.array_equal(image, texture_bits(field)[..., :channels])
    assert material.alphaMode == ("BLEND" if channels == 4 else None)
    assert material.doubleSided


def test_arrays_hold_everything(tmp_path: Path) -> None:
    field = field_of(4)
    field.export(tmp_path / "mesh.npz", None)
    with np.load(tmp_path / "mesh.npz") as arrays:
        assert {"vertices", "rgba", "uv", "corners", "vertex", "box"} == set(arrays.files)
        np.testing.assert_allclose(arrays["rgba"], field.rgba(), atol=1e-7)


def test_files_without_one_texture_are_refused(tmp_path: Path) -> None:
    plain = write_obj(tmp_path / "cube.obj", cube())
    with pytest.raises(SceneError, match="one shape with a texture of its color, got none"):
        read_textured_surface(plain)
    field = field_of(3)
    flat = field.unwrapped
    moved = TexturedSurface(
        *field.params.values(), Unwrapped(flat.uv, flat.corners, flat.vertex), field.policy
    )
    object.__setattr__(moved.unwrapped, "uv", 1.5 * flat.uv)
    moved.export(tmp_path / "outside.glb", None)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(RangeError, match=r"texture coordinates in \[0, 1\], got others"):
            read_textured_surface(tmp_path / "outside.glb")
