"""Files of .ply elements against plyfile, whose own reader believes what a header states."""

from __future__ import annotations

import io
import tracemalloc
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from photograd._ply import ply_bytes, read_ply
from photograd.errors import IoError
from plyfile import PlyData, PlyElement

KINDS = ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")


def column(g: np.random.Generator, kind: str, rows: int) -> Any:
    if kind[0] == "f":
        return g.normal(size=rows).astype(kind)
    limits = np.iinfo(kind)
    return g.integers(limits.min, limits.max, rows, kind, endpoint=True)


@given(st.integers(0, 2**32), st.sampled_from([("<", False), (">", False), ("=", True)]))
def test_elements_are_those_that_the_library_wrote(seed: int, form: tuple[str, bool]) -> None:
    g = np.random.default_rng(seed)
    elements = []
    for name in ("vertex", "face", "rest"):
        rows = int(g.integers(0, 6))
        kinds = [(f"c{k}", str(kind)) for k, kind in enumerate(g.choice(KINDS, g.integers(1, 5)))]
        # Beside lists, the library's numbers are in the machine's order whatever the header says.
        lists = [("many", object)] if form[0] != ">" and g.random() < 0.6 else []
        table = np.empty(rows, [*kinds[:2], *lists, *kinds[2:]])
        for title, kind in kinds:
            table[title] = column(g, kind, rows)
        same = g.random() < 0.5  # as all triangles are
        for row in range(rows if lists else 0):
            table["many"][row] = column(g, "i4", 3 if same else int(g.integers(0, 4)))
        told = {"many": "i4"} if lists else {}
        elements.append(PlyElement.describe(table, name, val_types=told))
    stream = io.BytesIO()
    order, text = form
    PlyData(elements, text=text, byte_order=order).write(stream)
    check(stream.getvalue(), elements)


def check(data: bytes, elements: list[PlyElement]) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.ply"
        path.write_bytes(data)
        found = read_ply("f", path)
    assert list(found) == [element.name for element in elements]
    for element in elements:
        table = found[element.name]
        assert table.dtype.names == tuple(p.name for p in element.properties)
        for title in table.dtype.names or ():
            ours, theirs = table[title], element[title]
            assert ours.dtype == theirs.dtype.newbyteorder("=")
            assert [np.asarray(row).tolist() for row in ours] == [
                np.asarray(row).tolist() for row in theirs
            ]


def test_what_is_written_is_what_the_library_writes() -> None:
    table = np.zeros(3, [("x", "<f4"), ("opacity", "<f4")])
    table["x"] = 1, 2, 3
    stream = io.BytesIO()
    element = PlyElement.describe(table, "vertex")
    PlyData([element], byte_order="<", comments=["photograd: up -y"]).write(stream)
    assert ply_bytes("vertex", table, ["photograd: up -y"]) == stream.getvalue()


def binary(header: str, rows: bytes = b"") -> bytes:
    return f"ply\nformat binary_little_endian 1.0\n{header}end_header\n".encode() + rows


WIDE = "".join(f"property double p{k}\n" for k in range(2500))
LIST = "property list uint double p\n"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (binary(f"element vertex 60000\n{WIDE}", bytes(60000)), "60000 rows of b'vertex'"),
        (binary(f"element face 1\n{LIST}", b"\xff" * 64), "does not fit"),
        (binary(f"element face 2\n{LIST}", bytes(4) + b"\xff" * 60), "4294967295 numbers promised"),
        (binary("element face 900\n", bytes(100)), "900 rows of b'face' promised in 100 bytes"),
        (binary("element a 1\nelement a 1\n", b"0000"), "element 'a' twice"),
        (binary("element a 1\nproperty long x\n", bytes(8)), "the line 'property long x'"),
        (binary("element a 1\nproperty list float int x\n", bytes(8)), "the line 'property list"),
        (b"ply\nformat ascii 1.0\nelement a 2\nproperty int x\n", "without end_header"),
        (b"ply\nformat ascii 2.0\nend_header\n", "the line 'format ascii 2.0'"),
        (b"ply\nend_header\n", "no format among ascii"),
        (b"ply\nformat ascii 1.0\nelement a 1\nproperty uchar x\nend_header\n256\n", "for uint8"),
        (b"ply\nformat ascii 1.0\nelement a 1\nproperty int x\nend_header\n1 2\n", "more numbers"),
        (b"ply\nformat ascii 1.0\nelement a 1\nproperty int x\nend_header\nx\n", "invalid literal"),
    ],
)
def test_damaged_files_are_refused_in_little_memory(
    tmp_path: Path, data: bytes, words: str
) -> None:
    path = tmp_path / "a.ply"
    path.write_bytes(data)
    tracemalloc.start()
    with pytest.raises(IoError, match=rf"f: .*a\.ply: expected a readable \.ply file.*({words})"):
        read_ply("f", path)
    assert tracemalloc.get_traced_memory()[1] < 8 * len(data) + (2 << 20)
    tracemalloc.stop()


def test_lists_of_big_endian_files(tmp_path: Path) -> None:
    head = "ply\nformat binary_big_endian 1.0\nelement face 2\nproperty short a\n"
    head += "property list uchar uint many\nproperty ushort b\nend_header\n"
    row = b"\xff\xfe\x02\x00\x00\x00\x07\x80\x00\x00\x00\x01\x02"
    for second, last in ((row, [7, 1 << 31]), (b"\xff\xfe\x00\x01\x02", [])):
        (tmp_path / "a.ply").write_bytes(head.encode() + row + second)
        table = read_ply("f", tmp_path / "a.ply")["face"]
        assert table["a"].tolist() == [-2, -2]
        assert [many.tolist() for many in table["many"]] == [[7, 1 << 31], last]
        assert table["b"].tolist() == [0x0102, 0x0102]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_may_end_as_on_any_system(tmp_path: Path, end: str) -> None:
    lines = ["ply", "comment by hand", "format binary_big_endian 1.0", "element a 1"]
    head = end.join([*lines, "property short x", "end_header", ""])
    (tmp_path / "a.ply").write_bytes(head.encode() + b"\x01\x02")
    assert read_ply("f", tmp_path / "a.ply")["a"]["x"].tolist() == [0x0102]
