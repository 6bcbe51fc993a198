"""Compressed .ply files, .splat files and archives of points: written by hand, and damaged."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError
from photograd.sh import Y_0
from photograd.splats.files import holds_gaussians, read_gaussians
from photograd.splats.splat_files import neighbor_spacing

from tests.gaussian_files.words import ROW, write_words


def test_words_mean_what_the_format_says(tmp_path: Path) -> None:
    write_words(tmp_path / "a.ply", [ROW])
    found = read_gaussians(tmp_path / "a.ply")
    g = found.gaussians
    assert found.format == "compressed ply"
    np.testing.assert_allclose(g.means, [[2.0, 0.0, -2 + 4 * 1024 / 2047]], atol=1e-6)
    np.testing.assert_allclose(g.log_scales, [[-6.0, -1.0, -1.0]])
    near = (511 / 1023 - 0.5) * np.sqrt(2)
    np.testing.assert_allclose(g.quats, [[np.sqrt(0.5), near, np.sqrt(0.5), near]], atol=2e-6)
    np.testing.assert_allclose(g.opacity_logits, [np.log(4.0)], rtol=1e-6)
    np.testing.assert_allclose(0.5 + Y_0 * g.sh, [[[1.0, 0.2, 0.0]]], atol=1e-6)


def test_limits_of_colors_and_harmonics_are_used(tmp_path: Path) -> None:
    write_words(tmp_path / "a.ply", [ROW] * 3, colors=True, rest=9)
    g = read_gaussians(tmp_path / "a.ply").gaussians
    assert g.degree == 1
    np.testing.assert_allclose(0.5 + Y_0 * g.sh[2, 0], [3.0, -0.2, -1.0], atol=1e-6)
    # Red first: bytes 0, 255, 128; then green: 30, 0, 255.
    np.testing.assert_allclose(g.sh[1, 1:, 0], [-4.0, 4.0, 8 * 128.5 / 256 - 4], atol=1e-6)
    np.testing.assert_allclose(g.sh[1, 1:, 1], [8 * 30.5 / 256 - 4, -4.0, 4.0], atol=1e-6)


def test_damaged_words_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    write_words(path, [ROW], chunks=2)
    with pytest.raises(IoError, match="1 chunks for 1 Gaussians, got 2"):
        read_gaussians(path)
    write_words(path, [ROW] * 257)
    with pytest.raises(IoError, match="2 chunks for 257"):
        read_gaussians(path)
    write_words(path, [ROW], rest=5)
    with pytest.raises(IoError, match="9, 24 or 45"):
        read_gaussians(path)
    write_words(path, [ROW], lowest=np.nan)
    with pytest.raises(IoError, match=r"finite limits, got \[\[nan, .* in chunk 0"):
        read_gaussians(path)
    write_words(path, [ROW] * 40)
    whole = path.read_bytes()
    path.write_bytes(whole[:-1])
    with pytest.raises(IoError, match=r"a readable \.ply file"):
        read_gaussians(path)
    path.write_bytes(whole.replace(b"vertex 40", b"vertex 99"))
    with pytest.raises(IoError, match=r"a readable \.ply file"):
        read_gaussians(path)
    path.write_bytes(whole)
    with pytest.raises(IoError, match="40 Gaussians stated, which take"):
        read_gaussians(path, memory_limit=1000)


def record(mean: float = 1.0, scale: float = 0.5) -> bytes:
    return struct.pack("<6f8B", mean, 2, 3, scale, 1, 0, 255, 0, 51, 204, 128, 0, 128, 255)


def test_splat_records_mean_what_the_format_says(tmp_path: Path) -> None:
    (tmp_path / "a.splat").write_bytes(record())
    g = read_gaussians(tmp_path / "a.splat").gaussians
    assert g.means.tolist() == [[1, 2, 3]]
    np.testing.assert_allclose(g.log_scales, [[np.log(0.5), 0, -np.inf]])
    expected = np.array([0, -1, 0, 127 / 128])
    np.testing.assert_allclose(g.quats[0], expected / np.linalg.norm(expected), rtol=1e-6)
    np.testing.assert_allclose(g.opacity_logits, [np.log(4.0)], rtol=1e-6)
    np.testing.assert_allclose(0.5 + Y_0 * g.sh, [[[1.0, 0.0, 0.2]]], atol=1e-6)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "at least one, got 0 bytes"),
        (record()[:-1], "whole records of 32 bytes"),
        (record() + record(mean=np.nan), r"in row 1"),
        (record(scale=-1.0), "scales from 0"),
        (record(scale=np.inf), "scales from 0"),
    ],
)
def test_damaged_splats_are_refused(tmp_path: Path, content: bytes, words: str) -> None:
    (tmp_path / "a.splat").write_bytes(content)
    with pytest.raises(IoError, match=words):
        read_gaussians(tmp_path / "a.splat")


def test_alien_files_are_refused_by_what_they_are(tmp_path: Path, shared_data: Path) -> None:
    with pytest.raises(IoError, match=r"a file of Gaussians: \.ply, \.splat, \.spz, \.npz"):
        read_gaussians(shared_data / "splats/format_fixtures/minimal.ksplat")
    with pytest.raises(IoError, match="a file, got none"):
        read_gaussians(tmp_path / "none.spz")
    (tmp_path / "a.splat").write_bytes(b"ply\nand so on")
    with pytest.raises(IoError, match=r"a readable \.ply file"):
        read_gaussians(tmp_path / "a.splat")
    copy = tmp_path / "a.splat"
    copy.write_bytes((shared_data / "splats/format_fixtures/minimal-v3.spz").read_bytes())
    found = read_gaussians(copy)
    assert "read as .spz, as its content says, in spite of its name" in found.conversions


def test_the_garden_is_points_that_can_be_seen(shared_data: Path) -> None:
    path = shared_data / "splats/test_garden.npz"
    found = read_gaussians(path)
    g, raw = found.gaussians, np.load(path)
    assert holds_gaussians(path)
    assert np.array_equal(g.means, raw["means3d"])
    np.testing.assert_allclose(0.5 + Y_0 * g.sh[:, 0], raw["colors"] / 255.0, atol=1e-6)
    assert "points without sizes" in found.conversions[0]
    # Some points against their exact nearest three.
    size, points = np.exp(g.log_scales[:, 0]), raw["means3d"]
    shares = []
    for row in range(0, len(points), 3001):
        gaps = np.linalg.norm(points - points[row], axis=1)
        shares.append(size[row] / (0.5 * np.sort(gaps)[1:4].mean()))
    capped = size[::3001] > 0.99 * size.max()
    share = np.array(shares)[~capped]
    assert len(share) > 35
    assert share.min() > 0.999  # windows miss neighbors; they invent none
    assert np.median(share) < 1.5


def test_points_in_odd_numbers_have_sizes() -> None:
    assert neighbor_spacing(np.zeros((1, 3))).tolist() == [1e-3]
    assert neighbor_spacing(np.zeros((5, 3))).tolist() == [1e-3] * 5
    line = np.arange(20.0)[:, None] * [1.0, 0.0, 0.0]
    size = neighbor_spacing(line)
    np.testing.assert_allclose(size[1:-1], 0.5 * (1 + 1 + 2) / 3)
    np.testing.assert_allclose(neighbor_spacing(line[:2]), 0.5)


def test_other_archives_are_refused(tmp_path: Path) -> None:
    path, points = tmp_path / "a.npz", np.zeros((5, 3), np.float32)
    colors = np.zeros((5, 3), np.uint8)
    for arrays, words in [
        ({"means3d": points}, "no colors"),
        ({"means3d": points, "colors": points}, "colors: uint8"),
        ({"means3d": points[:, :2], "colors": colors}, "means3d: floats of shape"),
        ({"means3d": points.astype(object), "colors": colors}, "readable .npz"),
        ({"means3d": points + np.inf, "colors": colors}, "finite means3d"),
    ]:
        np.savez(path, **arrays)
        with pytest.raises(IoError, match=words):
            read_gaussians(path)
    np.savez(path, values=points)
    assert not holds_gaussians(path)
    whole = bytearray(path.read_bytes())
    path.write_bytes(bytes(whole[:60]))
    assert not holds_gaussians(path)
    assert not holds_gaussians(tmp_path / "none.npz")
