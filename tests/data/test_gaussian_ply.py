"""Files of Gaussians: what is written comes back, other programs' files are read, bad ones
refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.errors import IoError
from photograd.splats.ply_files import read_gaussian_ply, write_gaussian_ply
from photograd.splats.splatting import Gaussians
from plyfile import PlyData
from tests.splat import oracle


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_a_round_trip_is_bit_exact(tmp_path: Path, degree: int) -> None:
    g = oracle.cloud(7, 1, degree=degree).astype(np.float32)
    g.opacity_logits[2] = np.inf
    write_gaussian_ply(tmp_path / "a.ply", g)
    back = read_gaussian_ply(tmp_path / "a.ply")
    for name, array in g.arrays().items():
        assert np.array_equal(back.arrays()[name], array), name


def test_no_gaussians_are_a_file_too(tmp_path: Path) -> None:
    g = oracle.cloud(1, 1)
    none = Gaussians(**{name: array[:0] for name, array in g.arrays().items()})
    write_gaussian_ply(tmp_path / "a.ply", none)
    assert len(read_gaussian_ply(tmp_path / "a.ply")) == 0


def test_the_layout_is_the_one_that_others_read(tmp_path: Path) -> None:
    g = oracle.cloud(3, 1, degree=1)
    write_gaussian_ply(tmp_path / "a.ply", g)
    vertex = PlyData.read(tmp_path / "a.ply")["vertex"]
    # f_rest: the three coefficients of red first, then those of green.
    np.testing.assert_allclose(vertex["f_rest_0"], g.sh[:, 1, 0], rtol=1e-6)
    np.testing.assert_allclose(vertex["f_rest_2"], g.sh[:, 3, 0], rtol=1e-6)
    np.testing.assert_allclose(vertex["f_rest_3"], g.sh[:, 1, 1], rtol=1e-6)
    np.testing.assert_allclose(vertex["f_rest_8"], g.sh[:, 3, 2], rtol=1e-6)
    np.testing.assert_allclose(vertex["rot_0"], g.quats[:, 0], rtol=1e-6)
    np.testing.assert_allclose(vertex["scale_2"], g.log_scales[:, 2], rtol=1e-6)


def text_file(tmp_path: Path, header: str, rows: str) -> Path:
    path = tmp_path / "text.ply"
    path.write_text(f"ply\nformat ascii 1.0\n{header}end_header\n{rows}", encoding="ascii")
    return path


NAMES = [
    "x",
    "y",
    "z",
    "scale_0",
    "scale_1",
    "scale_2",
    "rot_0",
    "rot_1",
    "rot_2",
    "rot_3",
    "opacity",
    "f_dc_0",
    "f_dc_1",
    "f_dc_2",
]


def header(names: list[str], count: int = 1, kind: str = "float") -> str:
    return f"element vertex {count}\n" + "".join(f"property {kind} {name}\n" for name in names)


def test_text_and_doubles_and_any_order_of_properties_are_read(tmp_path: Path) -> None:
    names = [*reversed(NAMES), "nx"]
    rows = " ".join(str(i) for i in range(len(names)))
    g = read_gaussian_ply(text_file(tmp_path, header(names, kind="double"), rows + "\n"))
    assert g.means.tolist() == [[13.0, 12.0, 11.0]]
    assert g.sh.tolist() == [[[2.0, 1.0, 0.0]]]


@pytest.mark.parametrize(
    ("names", "rows", "words"),
    [
        (NAMES[:3], "0 0 0\n", "no scale_0, scale_1, scale_2"),
        ([*NAMES, "f_rest_0"], "0 " * 15 + "\n", "f_rest_0"),
        (NAMES, "0 0 nan" + " 0" * 11 + "\n", "finite numbers in z, got nan in row 0"),
        (NAMES, "0 0 0 inf" + " 0" * 10 + "\n", "finite numbers in scale_0"),
        (NAMES, "0 0\n", "readable .ply"),
    ],
)
def test_other_files_are_refused_by_name(
    tmp_path: Path, names: list[str], rows: str, words: str
) -> None:
    with pytest.raises(IoError, match=words):
        read_gaussian_ply(text_file(tmp_path, header(names), rows))


def test_what_is_no_ply_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="expected a file, got none"):
        read_gaussian_ply(tmp_path / "none.ply")
    (tmp_path / "a.ply").write_bytes(b"\x89PNG\r\n")
    with pytest.raises(IoError, match=r"readable \.ply"):
        read_gaussian_ply(tmp_path / "a.ply")
    with pytest.raises(IoError, match="vertex"):
        read_gaussian_ply(text_file(tmp_path, "element face 0\nproperty int a\n", ""))
    lists = "element vertex 1\nproperty list uchar float x\n" + header(NAMES[1:])[17:]
    with pytest.raises(IoError, match="numbers in x, got lists"):
        read_gaussian_ply(text_file(tmp_path, lists, "1 0 " + "0 " * 13 + "\n"))


def test_a_header_that_promises_more_than_the_file_holds_is_refused(tmp_path: Path) -> None:
    g = oracle.cloud(2, 1, degree=0)
    write_gaussian_ply(tmp_path / "a.ply", g)
    whole = (tmp_path / "a.ply").read_bytes()
    promised = whole.replace(b"vertex 2", b"vertex 2000000000000")
    (tmp_path / "a.ply").write_bytes(promised)
    with pytest.raises(IoError, match=r"readable \.ply"):
        read_gaussian_ply(tmp_path / "a.ply")


def test_a_shipped_scene_is_read(shared_data: Path) -> None:
    g = read_gaussian_ply(shared_data / "splats" / "biker.ply")
    assert len(g) == 152746
    assert g.degree == 0
    assert np.isinf(g.opacity_logits).sum() == 198
    np.testing.assert_allclose(np.linalg.norm(g.quats, axis=1), 1, atol=1e-6)
    with pytest.raises(IoError, match="no x, y, z"):
        read_gaussian_ply(shared_data / "splats" / "biker.compressed.ply")
