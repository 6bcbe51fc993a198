"""Archives of arrays: read whole, and refused by their headers where they claim too much."""

from __future__ import annotations

import io
import resource
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd._checkpoint import load_checkpoint
from photograd._files import read_npz
from photograd.errors import IoError
from photograd.splats.splat_files import read_point_npz


def claimed(path: Path, shape: tuple[int, ...], **others: Any) -> Path:
    """An archive whose `values` are zeros of that shape, written without making them."""
    header = io.BytesIO()
    layout = {"descr": "<f4", "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(header, layout)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        with archive.open("values.npy", "w", force_zip64=True) as stream:
            stream.write(header.getvalue())
            left = 4 * int(np.prod(shape))
            while left:
                left -= stream.write(bytes(min(left, 1 << 24)))
        for name, array in others.items():
            with archive.open(f"{name}.npy", "w") as stream:
                np.lib.format.write_array(stream, np.asarray(array))
    return path


def test_arrays_come_back(tmp_path: Path) -> None:
    arrays = {
        "a": np.arange(12.0).reshape(3, 4),
        "b": np.asfortranarray(np.arange(6, dtype=np.int32).reshape(2, 3)),
        "text": np.array("äöü"),
        "empty": np.zeros((0, 3), np.float32),
    }
    for write in (np.savez, np.savez_compressed):
        write(tmp_path / "a.npz", **arrays)
        found = read_npz("f", tmp_path / "a.npz")
        assert set(found) == set(arrays)
        for name, array in arrays.items():
            assert found[name].dtype == array.dtype
            assert np.array_equal(found[name], array)
        assert list(read_npz("f", tmp_path / "a.npz", ["b"])) == ["b"]


def test_what_unpacks_to_more_than_the_limit_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = claimed(tmp_path / "model.npz", (68_000_000,), means3d=1, colors=1)
    assert path.stat().st_size < 2_000_000
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for read in (lambda p: read_npz("load_checkpoint", p), load_checkpoint):
        with pytest.raises(IoError, match=r"at most 268,435,456 bytes more than .* got 27\d,"):
            read(path)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 50_000  # kB
    monkeypatch.setenv("PHOTOGRAD_MAX_EXPANSION", "1000")
    path = claimed(tmp_path / "model.npz", (2000,))
    with pytest.raises(IoError, match="set PHOTOGRAD_MAX_EXPANSION to a larger number"):
        read_npz("f", path)
    monkeypatch.setenv("PHOTOGRAD_MAX_EXPANSION", "10000")
    assert not read_npz("f", path)["values"].any()
    with pytest.raises(IoError, match=r"arrays that fit into 1,000 bytes, got 8,128 bytes"):
        read_npz("f", path, memory_limit=1000)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"shape": (3, 5)}, "float32 of shape (3, 5) in 176 bytes"),
        ({"shape": (1 << 60, 1 << 60)}, "in 176 bytes"),
        ({"descr": "|O"}, "object of shape (3, 4)"),
        ({"descr": "nonsense"}, "nonsense"),
    ],
)
def test_headers_that_lie_are_refused(tmp_path: Path, change: dict[str, Any], words: str) -> None:
    stream = io.BytesIO()
    layout = {"descr": "<f4", "fortran_order": False, "shape": (3, 4), **change}
    np.lib.format.write_array_header_1_0(stream, layout)
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("a.npy", stream.getvalue() + bytes(48))
    with pytest.raises(IoError) as caught:
        read_npz("f", tmp_path / "a.npz")
    assert words in str(caught.value)
    assert "expected a readable .npz file" in str(caught.value)


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.npz").write_bytes(b"PK\x03\x04 and no more")
    for path in (tmp_path, tmp_path / "none.npz", tmp_path / "a.npz"):
        with pytest.raises(IoError, match="f: "):
            read_npz("f", path)
    np.savez(tmp_path / "a.npz", a=np.zeros(3))
    with pytest.raises(IoError, match="no b, c"):
        read_npz("f", tmp_path / "a.npz", ("a", "b", "c"))
    with pytest.raises(IoError, match="no colors, means3d"):
        read_point_npz(tmp_path / "a.npz")
