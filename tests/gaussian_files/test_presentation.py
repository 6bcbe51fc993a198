"""What is up and what stands behind travel with files of Gaussians."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError, RangeError
from photograd.splats.files import read_gaussians, write_gaussians
from photograd.splats.frames import (
    UNSTATED,
    UP_AXES,
    Presentation,
    dropped,
    file_from_upright,
    half_turn,
    with_usual_up,
)
from photograd.splats.splatting import render
from plyfile import PlyData

from tests.splat import oracle

TOLD = Presentation("-y", (0.1, 1 / 3, 0.0), False)


def test_comments_come_back_to_the_bit(tmp_path: Path) -> None:
    g = oracle.cloud(3, 1).astype(np.float32)
    write_gaussians(tmp_path / "a.ply", g, presentation=TOLD)
    found = read_gaussians(tmp_path / "a.ply")
    assert found.presentation == TOLD
    assert found.conversions == (
        "the file says: -y is up",
        "the file says: background 0.100 0.333 0.000",
    )
    assert PlyData.read(tmp_path / "a.ply").comments[0] == "photograd: up -y"
    write_gaussians(tmp_path / "b.ply", g)
    assert read_gaussians(tmp_path / "b.ply").presentation == UNSTATED
    assert (tmp_path / "b.ply").read_bytes().count(b"comment") == 0


@pytest.mark.parametrize(
    ("comment", "expected"),
    [
        ("up north", "'photograd: up' with one of"),
        ("background 0.1 0.2", "three numbers in 0..1"),
        ("background 0.1 0.2 nan", "three numbers in 0..1"),
        ("background 0.1 0.2 1.5", "three numbers in 0..1"),
        ("antialiased maybe", "yes or no"),
    ],
)
def test_comments_of_ours_that_mean_nothing_are_refused(
    tmp_path: Path, comment: str, expected: str
) -> None:
    write_gaussians(tmp_path / "a.ply", oracle.cloud(3, 1).astype(np.float32), presentation=TOLD)
    whole = (tmp_path / "a.ply").read_bytes()
    changed = whole.replace(b"photograd: up -y", f"photograd: {comment}".encode())
    (tmp_path / "a.ply").write_bytes(changed)
    with pytest.raises(IoError, match=expected):
        read_gaussians(tmp_path / "a.ply")
    other = whole.replace(b"photograd: up -y", b"photograd: lens 35")
    (tmp_path / "a.ply").write_bytes(other.replace(b"photograd: back", b"others: back"))
    assert read_gaussians(tmp_path / "a.ply").presentation == Presentation(antialiased=False)


def test_spz_files_have_one_axis_up_and_a_flag(tmp_path: Path) -> None:
    g = oracle.cloud(3, 1).astype(np.float32)
    for antialiased, expected in ((True, True), (False, None), (None, None)):
        told = replace(TOLD, antialiased=antialiased)
        write_gaussians(tmp_path / "a.spz", g, presentation=told)
        assert read_gaussians(tmp_path / "a.spz").presentation == Presentation("-y", None, expected)
    assert dropped(".ply", TOLD) == []
    assert [line.split(" is dropped")[0] for line in dropped(".spz", TOLD)] == [
        "the background 0.100 0.333 0.000 (display values)",
        "that they were fitted without antialiasing",
    ]
    assert len(dropped(".spz", replace(TOLD, antialiased=True))) == 1
    assert len(dropped(".splat", replace(TOLD, antialiased=True))) == 2


@pytest.mark.parametrize("up", UP_AXES)
def test_a_scene_rotated_to_the_usual_axis_looks_the_same(up: str) -> None:
    g, camera = oracle.cloud(20, 1), oracle.camera()
    turned = with_usual_up(g, up)
    R = np.linalg.lstsq(g.means, turned.means, rcond=None)[0].T
    np.testing.assert_allclose(R @ file_from_upright(up)[:, 1], [0, -1, 0], atol=1e-12)
    pose = camera.world_from_camera.copy()
    pose[:3] = R @ pose[:3]
    a, b = render(g, camera)[0], render(turned, replace(camera, world_from_camera=pose))[0]
    assert a.opacity.max() > 0.5
    np.testing.assert_allclose(b.color, a.color, atol=1e-10)  # measured 2e-14


def test_the_frames_of_files_and_of_the_world_are_half_a_turn_apart() -> None:
    assert np.array_equal(file_from_upright("+y"), np.eye(3))
    assert np.array_equal(file_from_upright("-y"), np.diag([1.0, -1.0, -1.0]))
    g = oracle.cloud(5, 1)
    for name, array in half_turn(g).arrays().items():
        assert np.array_equal(with_usual_up(g, "+y").arrays()[name], array), name
    with pytest.raises(RangeError, match=r"with_usual_up: up: expected one of \+x"):
        with_usual_up(g, "y")
