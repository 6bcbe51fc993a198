"""Gaussians seen from a circle, and turned as a whole."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd import sh
from photograd.commands import register
from photograd.data.frames import rotation_from_axis_angle
from photograd.data.gaussian_ply import write_gaussian_ply
from photograd.errors import RangeError
from photograd.splat import Gaussians, render
from photograd.splat_orbit import UP_AXES, file_from_upright, orbit_splats, scene_box
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
        g.means @ R.T, g.log_scales, q, g.opacity_logits,
        np.einsum("kj,njc->nkc", sh.rotation(R, 3), g.sh),
    )  # fmt: skip
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
    g.sh[:] = 0.0  # grey, but for a black one on top
    g.means[0] = 0.38 * turn[:, 1]
    g.sh[0], g.log_scales[0], g.opacity_logits[0] = -2.0, -2.3, 5.0
    picture = next(orbit_splats(g, 1, size=48, elevation=0.0, up=up))
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


def test_the_command_renders_a_ply_file(tmp_path: Path) -> None:
    write_gaussian_ply(tmp_path / "a.ply", oracle.cloud(40, 1))
    app = Typer()
    register(app)
    words = ["render", f"{tmp_path / 'a.ply'}", "--orbit", "3", "--size", "24"]
    done = CliRunner().invoke(app, [*words, "--out", f"{tmp_path / 'a.gif'}", "--up", "+z"])
    assert done.exit_code == 0, done.output
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.size == (24, 24)
        assert np.asarray(picture.convert("RGB")).min() < 200
