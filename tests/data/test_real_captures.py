"""Real captures: conventions hold on data that others made."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.capture import Capture, View, estimate_bounds, load_capture
from photograd.capture.colmap import reproject
from photograd.capture.colmap_model import read_text_model
from photograd.capture.frames import invert_rigid
from photograd.images import read_image


def mean_reprojection_error(capture: Capture, model_folder: Path) -> tuple[float, int]:
    """Mean distance in pixels between observations and projected points, and how many there are."""
    model = read_text_model(model_folder)
    assert model.points is not None
    assert capture.points is not None
    row_of = {int(point): row for row, point in enumerate(model.points.ids)}
    views: dict[str, View] = {view.name: view for view in capture.views}
    errors = []
    for image in model.images:
        rows = [row_of[int(point)] for point in image.point_ids]
        pixels = reproject(views[image.name], capture.points[rows])
        errors.append(np.linalg.norm(pixels - image.pixels, axis=1))
    joined = np.concatenate(errors)
    return float(joined.mean()), len(joined)


def test_chair(posed: Path) -> None:
    capture = load_capture(posed / "nerf_synthetic_chair")
    assert (len(capture.train), len(capture.test)) == (100, 40)
    assert capture.has_alpha
    view = capture.train[0]
    assert view.camera.fx == pytest.approx(277.78, abs=0.005)
    for each in capture.views:
        # The data set's cameras stand on a sphere; its poses are printed float32.
        assert np.linalg.norm(each.camera.position) == pytest.approx(4.031, abs=1e-3)
        towards = -each.camera.position / np.linalg.norm(each.camera.position)
        assert each.camera.forward @ towards == pytest.approx(1.0, abs=1e-6)
    # Position (-1.057, 2.574, 2.917) with +Z up.
    np.testing.assert_allclose(view.camera.position, [-1.05724, 2.91661, -2.57403], atol=1e-5)
    rgba = view.rgba()
    assert rgba.shape == (200, 200, 4)
    assert 0.1 < rgba[..., 3].mean() < 0.9


def test_chair_bounds(posed: Path) -> None:
    found = estimate_bounds(load_capture(posed / "nerf_synthetic_chair"))
    # A 128^3 hull of all 100 masks spans (-0.69, -0.69, -1.00) to (0.64, 0.69, 1.04) with +Z up.
    truth = np.array([[-0.69, -1.00, -0.69], [0.64, 1.04, 0.69]])
    assert (found.box[0] < truth[0] + 0.01).all()
    assert (found.box[1] > truth[1] - 0.01).all()
    assert np.abs(found.box - truth).max() < 0.17  # padding is 0.1, a voxel and a pixel the rest
    assert found.blind == ()


def test_banana_reprojects_its_points(posed: Path) -> None:
    """The distorted photographs: pose, lens, turned world and points together."""
    capture = load_capture(posed / "banana")
    assert capture.format == "colmap"
    error, count = mean_reprojection_error(capture, posed / "banana/sparse")
    assert count > 10000
    # The reconstruction itself reports 0.146 px.
    assert error == pytest.approx(0.146, abs=0.002)  # found: 0.1464


def test_banana_undistorted_forms_agree(posed: Path) -> None:
    """COLMAP text and transforms.json hold the same cameras in different conventions."""
    folder = posed / "banana/undistorted"
    model = load_capture(folder / "sparse")
    poses = load_capture(folder)
    assert (model.format, poses.format) == ("colmap", "nerfstudio")
    error, count = mean_reprojection_error(model, folder / "sparse")
    assert count > 10000
    assert error < 1.0
    ours = {view.name: view.camera for view in model.views}
    theirs = {view.name.removeprefix("images/"): view.camera for view in poses.views}
    assert set(ours) == set(theirs)
    assert len(ours) == 14
    first = min(ours)
    for name, camera in ours.items():
        relative = [
            invert_rigid(cameras[first].world_from_camera) @ cameras[name].world_from_camera
            for cameras in (ours, theirs)
        ]
        np.testing.assert_allclose(relative[0], relative[1], atol=1e-6)
        assert camera.fx == pytest.approx(theirs[name].fx, rel=1e-12)
        assert (camera.cx, camera.cy) == (theirs[name].cx, theirs[name].cy)


def test_banana_stands_upright(posed: Path) -> None:
    """After the turn the carpet lies below the cameras."""
    capture = load_capture(posed / "banana")
    assert capture.points is not None
    heights = [view.camera.position[1] for view in capture.views]
    assert min(heights) > np.median(capture.points[:, 1])


def test_undistorted_banana_matches_our_undistortion(posed: Path) -> None:
    """COLMAP's own undistorted photograph against ours; it cut one blank pixel off each border."""
    ours = {view.name: view for view in load_capture(posed / "banana").views}
    theirs = {view.name: view for view in load_capture(posed / "banana/undistorted/sparse").views}
    name = "dsc_0430.jpg"
    assert ours[name].camera.fx == theirs[name].camera.fx
    assert ours[name].camera.cx - 1.0 == theirs[name].camera.cx
    valid = ours[name].valid_mask()[1:-1, 1:-1]
    difference = np.abs(ours[name].rgba()[1:-1, 1:-1, :3] - theirs[name].rgba()[..., :3])[valid]
    assert valid.mean() > 0.98
    # Both are resampled once, theirs was saved as JPEG again, the carpet is noise at pixel size.
    shifted = np.abs(ours[name].rgba()[1:-1, 2:, :3] - theirs[name].rgba()[..., :3])[valid].mean()
    assert difference.mean() < 0.02
    assert shifted > 2.0 * difference.mean()


def test_berlin_points_land_on_their_colors(posed: Path) -> None:
    """The file holds no observations, but it says which color each point had."""
    capture = load_capture(posed / "opensfm_berlin")
    assert capture.format == "opensfm"
    assert len(capture.views) == 3
    assert capture.points is not None
    assert capture.point_colors is not None
    assert len(capture.points) == 1430
    seen = np.zeros(1430, dtype=int)
    for view in capture.views:
        assert view.camera.fx == pytest.approx(0.8696658 * 816, rel=1e-6)
        assert -view.camera.world_from_camera[1, 1] > 0.8  # upright: camera up is mostly +Y
        pixels = reproject(view, capture.points)
        inside = ((pixels >= 0.0) & (pixels < [812, 612])).all(axis=1)
        seen += inside
        columns, rows = np.floor(pixels[inside]).astype(int).T
        assert isinstance(view.image, Path)
        photograph = read_image(view.image)[..., :3] * 255.0
        colors = capture.point_colors[inside]
        there = np.abs(photograph[rows, columns] - colors).mean(axis=1)
        aside = np.abs(photograph[rows, columns + 3] - colors).mean(axis=1)
        # Measured: 7 to 9 of 255 levels where the points land, 37 to 39 three pixels beside.
        assert np.median(there) < 12.0
        assert np.median(aside) > 30.0
    assert (seen >= 2).all()  # a point is made from at least two photographs
    assert estimate_bounds(capture).blind == ()


@pytest.mark.parametrize(
    ("name", "train", "test"),
    [("banana", 12, 2), ("opensfm_berlin", 2, 1), ("nerf_synthetic_chair", 100, 40)],
)
def test_splits_are_reproducible(posed: Path, name: str, train: int, test: int) -> None:
    first, second = load_capture(posed / name), load_capture(posed / name)
    assert (len(first.train), len(first.test)) == (train, test)
    assert not {view.name for view in first.train} & {view.name for view in first.test}
    assert first.split_hash() == second.split_hash()
