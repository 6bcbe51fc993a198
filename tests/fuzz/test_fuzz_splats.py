"""Damaged files of Gaussians: a reader may refuse with IoError or take them; nothing else."""

from __future__ import annotations

import gzip
import os
import time
from pathlib import Path

import numpy as np
import pytest
from photograd.capture.nerfstudio import read_point_ply
from photograd.errors import IoError
from photograd.splats.files import read_gaussians, write_gaussians
from photograd.splats.ply_files import read_gaussian_ply, write_gaussian_ply
from tests.gaussian_files.words import ROW, write_words
from tests.splat import oracle

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
MEMORY = 1 << 26


def damaged(whole: bytes, g: np.random.Generator) -> bytes:
    """Cut, overwrite, insert or repeat a few bytes, mostly in the header."""
    data = bytearray(whole)
    for _ in range(int(g.integers(1, 4))):
        header = data.find(b"end_header") + 11
        header = header if header > 11 else 48
        at = int(g.integers(0, header if g.random() < 0.8 else len(data) + 1))
        length = int(g.integers(1, 9))
        noise = g.integers(0, 256, length, np.uint8).tobytes()
        digits = str(int(g.integers(-9, 10**12))).encode()
        choice = int(g.integers(0, 6))
        if choice == 0:
            data[at : at + length] = noise
        elif choice == 1:
            data[at:at] = digits
        elif choice == 2:
            del data[at : at + length]
        elif choice == 3:
            data[at:at] = data[at : at + 30]
        elif choice == 4 and at < len(data):
            data[at] ^= 1 << int(g.integers(0, 8))
        else:
            del data[at:]
    return bytes(data)


def test_damaged_gaussians(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    write_gaussian_ply(path, oracle.cloud(3, 1, degree=1))
    whole, g = path.read_bytes(), np.random.default_rng(1)
    taken = refused = 0
    deadline = time.monotonic() + SECONDS
    while time.monotonic() < deadline:
        path.write_bytes(damaged(whole, g))
        try:
            gaussians = read_gaussian_ply(path)
            taken += 1
            assert np.isfinite(gaussians.means).all()
        except IoError:
            refused += 1
    assert taken > 0
    assert refused > 0


def make(path: Path, kind: str) -> bytes:
    """A whole file of four Gaussians."""
    cloud = oracle.cloud(4, 1, degree=1).astype(np.float32)
    if kind == "compressed":
        write_words(path, [ROW] * 4, colors=True, rest=9)
    elif kind == "npz":
        np.savez(path, means3d=cloud.means, colors=np.zeros((4, 3), np.uint8))
    else:
        version = int(kind[-1]) if kind[:3] == "spz" else 3
        write_gaussians(path, cloud, spz_version=version)
    return path.read_bytes()


@pytest.mark.parametrize("kind", ["compressed", "npz", "splat", "spz2", "spz3", "spz4"])
def test_damaged_files_of_every_format(tmp_path: Path, kind: str) -> None:
    end = {"compressed": "ply", "npz": "npz", "splat": "splat"}.get(kind, "spz")
    path = tmp_path / f"a.{end}"
    whole, g = make(path, kind), np.random.default_rng(1)
    inside = kind in ("spz2", "spz3")  # damage what the checksum of gzip would hide
    answers = {"taken": 0, "refused": 0}
    deadline = time.monotonic() + SECONDS / 3
    while time.monotonic() < deadline or not all(answers.values()):
        if inside and g.random() < 0.8:
            path.write_bytes(gzip.compress(damaged(gzip.decompress(whole), g), 1))
        else:
            path.write_bytes(damaged(whole, g))
        try:
            gaussians = read_gaussians(path, memory_limit=MEMORY).gaussians
            answers["taken"] += 1
            assert np.isfinite(gaussians.means).all()
            assert not np.isnan(gaussians.log_scales).any()
            assert np.isfinite(gaussians.quats).all()
            assert sum(array.nbytes for array in gaussians.arrays().values()) < MEMORY
        except IoError:
            answers["refused"] += 1
        assert sum(answers.values()) < 2000 or all(answers.values())


def test_damaged_points(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    rows = "".join(f"{i} 0.5 {-i} 1 2 {i}\n" for i in range(4))
    colors = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    positions = "".join(f"property float {axis}\n" for axis in "xyz")
    head = f"ply\nformat ascii 1.0\nelement vertex 4\n{positions}{colors}end_header\n"
    whole, g = (head + rows).encode(), np.random.default_rng(1)
    taken = refused = 0
    deadline = time.monotonic() + SECONDS / 3
    while time.monotonic() < deadline or not (taken and refused):
        path.write_bytes(damaged(whole, g))
        try:
            points, _ = read_point_ply(path)
            taken += 1
            assert np.isfinite(points).all()
        except IoError:
            refused += 1
