"""Gaussians seen from a circle, and turned as a whole."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd import sh
from photograd.capture.frames import rotation_from_axis_angle
from photograd.commands import register
from photograd.errors import RangeError
from photograd.splats.frames import UP_AXES, Presentation, file_from_upright
from photograd.splats.orbit import orbit_splats, scene_box
from photograd.splats.ply_files import write_gaussian_ply
from photograd.splats.splatting import Gaussians, render
from PIL import Image
from typer import Typer
from typer.testing import CliRunner

from tests.splat import oracle


def test_a_scene_and_its_camera_turned_together_give_the_same_picture() -> None:
    g, camera = oracle.cloud(20, 1), oracle.camera()
    half = np.array([0.3, -0.2, 0.5])
    angle = 2 * np.linalg.norm(half)
    R = rotation_from_axis_angle(2 * half)
    w = np.cos(angle / 2)
    x, y, z = np.sin(angle / 2) * 2 * half / angle
    q = g.quats @ np.array([[w, x, y, z], [-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
    turned = Gaussians(
        g.means @ R.T,
        g.log_scales,
        q,
        g.opacity_logits,
        np.einsum("kj,njc->nkc", sh.rotation(R, 3), g.sh),
    )
    pose = camera.world_from_camera.copy()
    pose[:3] = R @ pose[:3]
    a, b = render(g, camera)[0], render(turned, replace(camera, world_from_camera=pose))[0]
    assert a.opacity.max() > 0.5
    np.testing.assert_allclose(b.color, a.color, atol=1e-10)  # measured 1e-14


@pytest.mark.parametrize("up", UP_AXES)
def test_up_is_up(up: str) -> None:
    turn = file_from_upright(up)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3))
    assert np.linalg.det(turn) == pytest.approx(1)
    g = oracle.cloud(40, 1, degree=0, size=-3.0)
    g.means[:] *= 0.25
    g.sh[:] = 0.0  # gray, but for a black one on top
    g.means[0] = 0.38 * turn[:, 1]
    g.sh[0], g.log_scales[0], g.opacity_logits[0] = -2.0, -2.3, 5.0
    picture = next(orbit_splats(g, 1, size=48, elevation=0.0, presentation=Presentation(up)))
    rows, _ = np.nonzero(picture.sum(-1) < 0.7)
    assert len(rows) > 3
    assert rows.max() < 20
    assert picture.max() > 0.9


def test_stragglers_do_not_shrink_the_scene() -> None:
    g = oracle.cloud(200, 1, degree=0)
    g.means[7] = [1e4, 0, 0]
    assert np.abs(scene_box(g)).max() < 1.1
    none = Gaussians(**{name: array[:0] for name, array in g.arrays().items()})
    with pytest.raises(RangeError, match="at least one"):
        scene_box(none)
    with pytest.raises(RangeError, match="one of"):
        file_from_upright("up")


def dots(g: Gaussians) -> int:
    """Pixels in which something is drawn, of a picture of 48 x 48."""
    return int(((1 - next(orbit_splats(g, 1, size=48))) > 0.2).any(-1).sum())


@pytest.mark.parametrize("log_scale", [-np.inf, -12.0, -3.0, 2.0])
@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (1e3, -2e3, 5.0)])
@pytest.mark.parametrize("count", [1, 5])
def test_gaussians_in_one_place_are_drawn(
    log_scale: float, place: tuple[float, float, float], count: int
) -> None:
    g = oracle.cloud(count, 1, degree=0).astype(np.float32)
    g.means[:], g.log_scales[:], g.opacity_logits[:], g.sh[:] = place, log_scale, 9.0, -1.0
    lower, upper = scene_box(g)
    np.testing.assert_allclose((lower + upper) / 2, place, rtol=1e-6)
    # A point is a dot of a pixel or four, a ball of three sigmas fills most of the picture.
    drawn = dots(g)
    assert drawn >= 1
    if log_scale == 2.0 or (log_scale > -9.0 and place[0] == 0.0):
        assert drawn > 300


def test_points_without_extent_are_dots() -> None:
    g = oracle.cloud(30, 1, degree=0).astype(np.float32)
    g.log_scales[:], g.sh[:], g.opacity_logits[:] = -np.inf, -1.0, 9.0
    assert 30 <= dots(g) <= 30 * 9


def test_a_scene_of_millimeters_is_not_cut_off_by_the_near_plane() -> None:
    g = oracle.cloud(60, 1, degree=0, size=-3.0).astype(np.float32)
    g.sh[:] = -1.0
    small = replace(
        g, means=np.float32(1e-3) * g.means, log_scales=g.log_scales + np.float32(np.log(1e-3))
    )
    assert dots(g) > 100
    assert dots(small) == pytest.approx(dots(g), rel=0.01)


def test_a_file_of_one_gaussian_is_drawn(tmp_path: Path) -> None:
    record = struct.pack("<6f8B", 1, 2, 3, 0.5, 0.5, 0.5, 255, 0, 0, 255, 255, 128, 128, 128)
    (tmp_path / "one.splat").write_bytes(record)
    one = {"means3d": np.ones((1, 3), np.float32), "colors": np.zeros((1, 3), np.uint8)}
    np.savez(tmp_path / "one.npz", **one)
    for name in ("one.splat", "one.npz"):
        out = tmp_path / f"{name}.png"
        app = Typer()
        register(app)
        words = ["render", f"{tmp_path / name}", "--frames", "1", "--size", "24", "--out", f"{out}"]
        done = CliRunner().invoke(app, words)
        assert done.exit_code == 0, done.output
        assert np.asarray(Image.open(out))[12, 12, 1] < 100


def test_the_command_renders_a_ply_file(tmp_path: Path) -> None:
    write_gaussian_ply(tmp_path / "a.ply", oracle.cloud(40, 1))
    app = Typer()
    register(app)
    words = ["render", f"{tmp_path / 'a.ply'}", "--frames", "3", "--size", "24"]
    done = CliRunner().invoke(app, [*words, "--out", f"{tmp_path / 'a.gif'}", "--up", "+z"])
    assert done.exit_code == 0, done.output
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.size == (24, 24)
        assert np.asarray(picture.convert("RGB")).min() < 200
