"""Lenses beyond the radial-tangential one: COLMAP's other models, and fisheye lenses."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture import Camera, ColmapLens, FisheyeDistortion, Lens, View, load_capture
from photograd.capture.assemble import undistortion_lines
from photograd.capture.colmap import pinhole_and_lens
from photograd.capture.colmap_model import MODELS, ColmapCamera
from photograd.errors import IoError, RangeError, ShapeError
from PIL import Image

from support import capture_files as files
from support.missing import need_module

WIDTH, HEIGHT = 120, 90
FOCAL, CENTER = (75.0, 72.0), (58.0, 47.0)
OURS = {
    "SIMPLE_FISHEYE": [],
    "FISHEYE": [],
    "SIMPLE_RADIAL_FISHEYE": [0.03],
    "RADIAL_FISHEYE": [0.03, -0.01],
    "OPENCV_FISHEYE": [0.03, -0.01, 0.004, -0.001],
}
THEIRS = {
    "FULL_OPENCV": [0.1, -0.02, 0.003, -0.002, 0.01, 0.12, 0.02, 0.003],
    "FOV": [0.7],
    "THIN_PRISM_FISHEYE": [0.02, -0.01, 0.001, -0.002, 0.003, 0.001, 0.002, -0.001],
    "RAD_TAN_THIN_PRISM_FISHEYE": [
        0.02,
        -0.01,
        1e-3,
        1e-3,
        0,
        0,
        1e-3,
        -2e-3,
        1e-3,
        1e-3,
        2e-3,
        2e-3,
    ],
    "SIMPLE_DIVISION": [-0.1],
    "DIVISION": [-0.1],
    "EUCM": [0.5, 1.1],
}


def pycolmap() -> Any:
    return need_module("pycolmap", by_choice=True)  # extra sfm


def stored(model: str, terms: list[float]) -> ColmapCamera:
    single = model.startswith("SIMPLE_") or model == "RADIAL_FISHEYE"
    focal = FOCAL[:1] if single else FOCAL
    return ColmapCamera(model, WIDTH, HEIGHT, (*focal, *CENTER, *terms))


def reference(camera: ColmapCamera) -> Any:
    """pycolmap's own camera."""
    return pycolmap().Camera(
        model=camera.model, width=WIDTH, height=HEIGHT, params=list(camera.parameters)
    )


def lens_of(model: str, terms: list[float]) -> tuple[Camera, Lens]:
    pinhole, lens = pinhole_and_lens(stored(model, terms), 1, np.eye(4))
    assert lens is not None
    return pinhole, lens


def pixel_centers() -> np.ndarray:
    u, v = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    return np.stack([u, v], axis=-1).reshape(-1, 2)


def pattern(points: np.ndarray) -> np.ndarray:
    """A smooth opaque picture of the ideal image plane, (N, 4)."""
    x, y = points[:, 0], points[:, 1]
    color = [0.5 + 0.4 * np.sin(4 * x), 0.5 + 0.4 * np.cos(3 * y), 0.5 + 0.3 * np.sin(2 * (x + y))]
    return np.stack([*color, np.ones_like(x)], axis=-1)


def test_the_models_are_those_of_colmap() -> None:
    module = pycolmap()
    numbers = {name: int(member.value) for name, member in module.CameraModelId.__members__.items()}
    for number, (name, parameters) in enumerate(MODELS):
        assert numbers[name] == number
        made = module.Camera.create_from_model_name(0, name, 50.0, WIDTH, HEIGHT)
        assert len(made.params) == parameters
    assert max(numbers.values()) == len(MODELS) - 1


@pytest.mark.parametrize("model", [*OURS, *THEIRS])
def test_a_photograph_becomes_the_pinhole_picture(model: str) -> None:
    """Pixels of the photograph by pycolmap's inverse; the view has to be the ideal picture."""
    camera = stored(model, (OURS | THEIRS)[model])
    theirs = reference(camera)
    pinhole, lens = lens_of(model, (OURS | THEIRS)[model])
    shown = np.asarray(theirs.cam_from_img(pixel_centers()))
    assert np.isfinite(shown).all()
    photograph = pattern(shown).reshape(HEIGHT, WIDTH, 4).astype(np.float32)
    ideal = (pixel_centers() - [pinhole.cx, pinhole.cy]) / [pinhole.fx, pinhole.fy]
    expected = pattern(ideal).reshape(HEIGHT, WIDTH, 4)
    assert np.abs(photograph - expected)[..., :3].max() > 0.05  # 25 times the error allowed below
    view = View("a", pinhole, photograph, distortion=lens)
    valid = view.valid_mask()
    assert valid.mean() > 0.7
    # Bilinear interpolation errs by h^2/8 |f''| <= (1/72)^2 / 8 * 16 * 0.4 = 2e-4 where the lens
    # keeps the scale, and by the square of the magnification more toward the border.
    np.testing.assert_allclose(view.rgba()[valid], expected[valid], atol=2e-3)
    # The same positions as theirs, forth and back.
    points = ideal[valid.ravel()]
    there = np.asarray(theirs.img_from_cam(np.column_stack([points, np.ones(len(points))])))
    found = lens.distort(points) * [pinhole.fx, pinhole.fy] + [pinhole.cx, pinhole.cy]
    np.testing.assert_allclose(found, there, atol=1e-9)
    np.testing.assert_allclose(theirs.cam_from_img(found), points, atol=1e-7)


def test_fisheye_by_hand() -> None:
    assert FisheyeDistortion().distort(np.zeros((1, 2))).tolist() == [[0.0, 0.0]]
    # 45 degrees from the axis: pi / 4 from the center, instead of 1.
    np.testing.assert_allclose(FisheyeDistortion().distort([[0.0, 1.0]]), [[0.0, np.pi / 4]])
    t = np.arctan(0.5)
    scale = 1 + 0.1 * t**2 + 0.2 * t**4 + 0.3 * t**6 + 0.4 * t**8
    points = np.array([[0.3, 0.4]])
    shown = FisheyeDistortion(0.1, 0.2, 0.3, 0.4).distort(points)
    np.testing.assert_allclose(shown, points / 0.5 * t * scale, rtol=1e-14)
    with pytest.raises(ShapeError, match=r"FisheyeDistortion\.distort: points"):
        FisheyeDistortion().distort(np.zeros((2, 3)))
    with pytest.raises(RangeError, match="FisheyeDistortion: k3"):
        FisheyeDistortion(k3=float("nan"))


def test_beyond_the_fold_nothing_is_seen() -> None:
    lens = FisheyeDistortion(k1=-0.3)  # theta - 0.3 theta^3 is largest at 1 / sqrt(0.9) = 1.054
    angles = np.tan([0.5, 1.05, 1.06, 1.4])
    points = np.stack([angles, np.zeros(4)], axis=-1)
    assert lens.inside_fold(points).tolist() == [True, True, False, False]
    pycolmap()
    folded = ColmapLens("FULL_OPENCV", (1.0, 1.0, 0.0, 0.0, -0.3, 0, 0, 0, 0, 0, 0, 0))
    points[:, 0] = [0.5, 1.05, 1.06, 3.0]  # r - 0.3 r^3, again
    assert folded.inside_fold(points).tolist() == [True, True, False, False]


def wide_capture(folder: Path, model: str, terms: list[float]) -> None:
    """Nine photographs by a camera of this model; they show nothing in particular."""
    cameras = files.orbit(9, WIDTH, HEIGHT, FOCAL[0])
    names = [f"{index:04d}.png" for index in range(9)]
    (folder / "images").mkdir(parents=True)
    for name in names:
        Image.new("RGB", (WIDTH, HEIGHT), (90, 80, 70)).save(folder / "images" / name)
    files.write_colmap_text(folder / "sparse", cameras, names, files.sphere_points())
    numbers = " ".join(map(str, stored(model, terms).parameters))
    (folder / "sparse/cameras.txt").write_text(f"7 {model} {WIDTH} {HEIGHT} {numbers}\n")
    (folder / "sparse/points3D.txt").unlink()


@pytest.mark.parametrize("model", ["OPENCV_FISHEYE", "FOV"])
def test_captures_say_what_a_pinhole_view_holds(tmp_path: Path, model: str) -> None:
    if model in THEIRS:
        pycolmap()
    wide_capture(tmp_path, model, (OURS | THEIRS)[model])
    capture = load_capture(tmp_path)
    (line,) = [line for line in capture.conversions if "lens distortion" in line]
    assert line.startswith("lens distortion removed on reading from 9 of 9 images; a pinhole view")
    assert "the middle" in line
    view = capture.train[0]
    _, lens = lens_of(model, (OURS | THEIRS)[model])
    assert view.distortion == lens
    # The border of the view, found again in the photograph.
    ends = np.array([[-CENTER[0], 0.0], [WIDTH - CENTER[0], 0.0]]) / FOCAL[0]
    left, right = lens.distort(ends)[:, 0]
    assert f"{100 * (right - left) * FOCAL[0] / WIDTH:.0f} x" in line


def test_without_pycolmap_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    wide_capture(tmp_path / "a", "OPENCV_FISHEYE", OURS["OPENCV_FISHEYE"])
    assert len(load_capture(tmp_path / "a").views) == 9
    wide_capture(tmp_path / "b", "FULL_OPENCV", THEIRS["FULL_OPENCV"])
    with pytest.raises(IoError, match=r"model FULL_OPENCV: pycolmap: .*'photograd\[sfm\]'"):
        load_capture(tmp_path / "b")


def test_numbers_that_are_none_are_refused() -> None:
    with pytest.raises(RangeError, match="ColmapLens: parameters: expected finite numbers"):
        ColmapLens("FOV", (1.0, 1.0, 0.0, 0.0, float("nan")))
    assert undistortion_lines([]) == []


def test_a_fisheye_capture_of_nerfstudio(tmp_path: Path) -> None:
    terms = dict(zip(("k1", "k2", "k3", "k4"), OURS["OPENCV_FISHEYE"], strict=True))
    cameras = files.orbit()
    files.write_nerfstudio(tmp_path, cameras, camera_model="OPENCV_FISHEYE", **terms)
    view = load_capture(tmp_path).train[0]
    assert view.distortion == FisheyeDistortion(**terms)
    files.write_nerfstudio(tmp_path, cameras, camera_model="OPENCV_FISHEYE")
    assert load_capture(tmp_path).train[0].distortion == FisheyeDistortion()
