"""Our bounded reader of NIfTI files against nibabel, on random headers."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from photograd.grids.volumes import read_volume

from support.missing import need_module
from tests.volumes.files import nifti

nibabel = need_module("nibabel")

OURS_FROM_THEIRS = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
METERS = {"meter": 1.0, "mm": 1e-3, "micron": 1e-6, "unknown": 1.0}
CODES = {"u1": 2, "i2": 4, "i4": 8, "f4": 16, "f8": 64, "i1": 256, "u2": 512, "u4": 768}
NUMBERS = st.floats(-100, 100, width=32)
SIZES = st.floats(0.125, 8, width=32)


@st.composite
def files(draw: st.DrawFn) -> tuple[bytes, bool]:
    """A file, and whether its header says where it lies."""
    kind = draw(st.sampled_from(sorted(CODES)))
    array = np.random.default_rng(draw(st.integers(0, 99))).integers(0, 120, (4, 3, 2))
    more: dict[str, Any] = {}
    if draw(st.booleans()):
        more["sform"] = (
            np.diag([1.0, 2, 3, 0])[:3] + np.reshape(draw(st.tuples(*[NUMBERS] * 12)), (3, 4)) / 300
        )
    if draw(st.booleans()):
        axis = np.array(draw(st.tuples(*[st.floats(-1, 1, width=32)] * 3))) / 1.8
        more["qform"] = (*axis, *draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)))
    handed = draw(st.sampled_from([-1, 1]))
    data = nifti(
        array,
        draw(st.sampled_from("<>")) + kind,
        CODES[kind],
        slope=draw(st.just(0.0) | SIZES),
        shift=draw(NUMBERS),
        pixdim=(handed, *draw(st.tuples(SIZES, SIZES, SIZES))),
        units=draw(st.integers(0, 3)),
        **more,
    )
    return data, bool(more)


@pytest.mark.usefixtures("core")
@pytest.mark.parametrize("name", ["a.nii", "a.nii.gz"])
def test_values_and_places_are_those_of_nibabel(
    tmp_path_factory: pytest.TempPathFactory, name: str
) -> None:
    path: Path = tmp_path_factory.mktemp("nifti") / name

    @seed(1)
    @settings(max_examples=60, deadline=None, database=None)
    @given(files())
    def compare(file: tuple[bytes, bool]) -> None:
        data, placed = file
        path.write_bytes(gzip.compress(data) if name.endswith("gz") else data)
        ours, theirs = read_volume(path), nibabel.load(path)
        # float32 of sums below 1100: half a unit in the last place is 6e-5.
        np.testing.assert_allclose(ours.values[..., 0], np.asarray(theirs.dataobj), atol=7e-5)
        if placed:  # without a transform nibabel mirrors x and puts the origin in the middle
            meters = METERS[theirs.header.get_xyzt_units()[0]]
            expected = OURS_FROM_THEIRS @ np.diag([meters] * 3 + [1]) @ theirs.affine
            np.testing.assert_allclose(
                ours.world_from_index, expected, rtol=1e-6, atol=1e-5 * meters
            )

    compare()
