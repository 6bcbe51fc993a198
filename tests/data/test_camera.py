"""Cameras: rays and projection are inverse, sizes and poses are checked."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.capture import Camera
from photograd_course.errors import DtypeError, Error, RangeError, SceneError, ShapeError

from support.capture_files import orbit


def test_central_ray_of_the_identity_looks_forward() -> None:
    camera = Camera(3, 5, 4.0, 4.0, 1.5, 2.5, np.eye(4))
    origins, directions = camera.rays()
    assert origins.shape == directions.shape == (15, 3)
    np.testing.assert_array_equal(directions[2 * 3 + 1], [0.0, 0.0, 1.0])
    # Right of the center is +X, below it is +Y.
    np.testing.assert_allclose(directions[2 * 3 + 2], np.array([0.25, 0, 1]) / np.hypot(0.25, 1))
    np.testing.assert_allclose(directions[3 * 3 + 1], np.array([0, 0.25, 1]) / np.hypot(0.25, 1))


def test_projection_undoes_rays() -> None:
    for camera in orbit(3):
        origins, directions = camera.rays()
        np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, atol=1e-15)
        t = np.random.default_rng(0).uniform(0.1, 9.0, len(directions))
        pixels, depth = camera.project(origins + t[:, None] * directions)
        ids = np.arange(camera.width * camera.height)
        expected = np.stack([ids % camera.width + 0.5, ids // camera.width + 0.5], axis=1)
        # Positions of a few units, focal length 26: 1e-12 is some hundred rounding errors.
        np.testing.assert_allclose(pixels, expected, atol=1e-12)
        np.testing.assert_allclose(depth, t * (directions @ camera.forward), rtol=1e-12)


def test_points_behind_have_no_pixel() -> None:
    pixels, depth = Camera(4, 4, 2.0, 2.0, 2.0, 2.0, np.eye(4)).project(np.array([[0.0, 0, -1]]))
    assert np.isnan(pixels).all()
    assert depth[0] == -1.0


def test_chosen_pixels_are_rows_of_all_rays() -> None:
    camera = orbit(1)[0]
    ids = np.array([7, 0, 479, 7])
    np.testing.assert_array_equal(camera.rays(ids)[1], camera.rays()[1][ids])


@pytest.mark.parametrize(
    ("ids", "error"),
    [
        (np.array([[1]]), ShapeError),
        (np.array([1.0]), DtypeError),
        (np.array([480]), RangeError),
        (np.array([-1]), RangeError),
    ],
)
def test_pixel_ids_are_checked(ids: np.ndarray, error: type[Error]) -> None:
    with pytest.raises(error, match="rays: pixel_ids: expected"):
        orbit(1)[0].rays(ids)


def test_downscaled_camera_sees_the_same_directions() -> None:
    camera = orbit(1, width=24, height=21)[0]
    small = camera.downscaled(4)
    assert (small.width, small.height) == (6, 5)
    point = camera.rays()[0][:1] + 2.0 * camera.rays()[1][100:101]
    np.testing.assert_allclose(small.project(point)[0] * 4.0, camera.project(point)[0], rtol=1e-14)
    with pytest.raises(RangeError, match="factor"):
        camera.downscaled(22)


def changed(**members: object) -> Camera:
    values = {"width": 4, "height": 3, "fx": 2.0, "fy": 2.0, "cx": 2.0, "cy": 1.5}
    pose = {"world_from_camera": np.eye(4)}
    return Camera(**(values | pose | members))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("members", "error", "text"),
    [
        ({"width": 0}, RangeError, "Camera: width"),
        ({"height": 2.5}, DtypeError, "Camera: height"),
        ({"fx": 0.0}, RangeError, "Camera: fx"),
        ({"fy": float("nan")}, RangeError, "Camera: fy"),
        ({"cx": float("inf")}, RangeError, "Camera: cx"),
        ({"world_from_camera": np.eye(3)}, ShapeError, "world_from_camera"),
        ({"world_from_camera": np.diag([2.0, 2, 2, 1])}, SceneError, "orthonormal"),
        ({"world_from_camera": np.diag([-1.0, 1, 1, 1])}, SceneError, "reflection"),
        ({"world_from_camera": np.full((4, 4), np.nan)}, RangeError, "finite"),
        (
            {"world_from_camera": np.eye(4) + 1e10 * np.eye(4, k=3)},
            RangeError,
            r"numbers in \[-1e\+09, 1e\+09\]",
        ),
        ({"world_from_camera": np.eye(4) + np.eye(4, k=-3)}, SceneError, "last row"),
    ],
)
def test_impossible_cameras_are_refused(
    members: dict[str, object], error: type[Error], text: str
) -> None:
    assert changed().width == 4
    with pytest.raises(error, match=text):
        changed(**members)


def test_poses_cannot_be_changed_behind_the_cameras_back() -> None:
    pose = np.eye(4)
    camera = changed(world_from_camera=pose)
    pose[0, 3] = 5.0
    assert camera.position[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        camera.world_from_camera[0, 3] = 1.0
