"""Damaged volume files: taken or refused with a typed error, nothing else."""

from __future__ import annotations

import gzip
import os
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.errors import IoError
from photograd.grids.volumes import read_volume
from tests.volumes.files import mitsuba, nifti, values, vtk

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 50
FILES = {
    "a.vtk": vtk(values()),
    "text.vtk": vtk(values(), text=True),
    "a.nii": nifti(values(), slope=1.0, qform=(0.1, 0.2, 0.3, 1, 2, 3)),
    "a.nii.gz": gzip.compress(nifti(values()), mtime=0),
    "a.vol": mitsuba(values()[..., None]),
}


@st.composite
def damage(draw: st.DrawFn, data: bytes) -> bytes:
    """One to three places overwritten, a piece perhaps removed, and perhaps the end."""
    result = bytearray(data)
    place = st.integers(0, len(data) - 1)
    for _ in range(draw(st.integers(1, 3))):
        at = draw(place)
        if draw(st.booleans()):
            result[at] ^= 1 << draw(st.integers(0, 7))
        else:
            patch = draw(st.sampled_from([b"\xff" * 4, b"\0" * 8, b"9" * 8, b"-1 "]) | st.binary())
            result[at : at + len(patch)] = patch
    if draw(st.integers(0, 3)) == 0:
        at = draw(place)
        del result[at : at + draw(st.integers(1, 64))]
    if draw(st.integers(0, 7)) == 0:
        del result[draw(place) :]
    return bytes(result)


@pytest.mark.parametrize("name", FILES)
def test_damaged_files(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    answers: list[str] = []
    end = time.monotonic() + SECONDS / len(FILES)
    rounds = 0
    while time.monotonic() < end or rounds == 0:

        @seed(rounds)
        @settings(
            max_examples=EXAMPLES_A_ROUND,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(damage(FILES[name]))
        def survive(bad: bytes) -> None:
            path.write_bytes(bad)
            try:
                volume = read_volume(path, memory_limit=1 << 26)
            except IoError:
                answers.append("refused")
                return
            answers.append("taken")
            assert np.isfinite(volume.values).all()
            assert volume.values.nbytes <= 1 << 26

        survive()
        rounds += 1
    assert "refused" in answers
