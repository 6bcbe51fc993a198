"""Damaged files of Gaussians: the reader may refuse with IoError or take them; nothing else."""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np
import pytest
from photograd.data.gaussian_ply import read_gaussian_ply, write_gaussian_ply
from photograd.errors import IoError
from tests.splat import oracle

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))


def damaged(whole: bytes, g: np.random.Generator) -> bytes:
    """Cut, overwrite, insert or repeat a few bytes, mostly in the header."""
    data = bytearray(whole)
    for _ in range(int(g.integers(1, 4))):
        header = data.find(b"end_header") + 11
        at = int(g.integers(0, header if g.random() < 0.8 and header > 11 else len(data) + 1))
        length = int(g.integers(1, 9))
        noise = g.integers(0, 256, length, np.uint8).tobytes()
        digits = str(int(g.integers(-9, 10**12))).encode()
        choice = int(g.integers(0, 5))
        if choice == 0:
            data[at : at + length] = noise
        elif choice == 1:
            data[at:at] = digits
        elif choice == 2:
            del data[at : at + length]
        elif choice == 3:
            data[at:at] = data[at : at + 30]
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
