"""The conventions of CONTRIBUTING.md as checks: axes, handedness, pixels, rows, quaternions."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.frames import OPENGL_FROM_OPENCV, Y_UP_FROM_Z_UP, rotation_from_quaternion

RIGHT, DOWN, FORWARD = np.eye(3)


@pytest.fixture
def camera() -> Camera:
    """Three pixels wide, two high, focal length two pixels, in the world's frame turned by nothing.

    Its axes then are the world's: +X right, +Y down on the picture, +Z into it.
    """
    return Camera(3, 2, 2.0, 2.0, 1.5, 1.0, np.eye(4))


def test_camera_axes_are_right_down_forward(camera: Camera) -> None:
    np.testing.assert_array_equal(camera.forward, FORWARD)
    _, directions = camera.rays()
    first, last = directions[0], directions[-1]  # top left, bottom right
    assert first @ RIGHT < 0 < last @ RIGHT
    assert first @ DOWN < 0 < last @ DOWN
    assert (directions @ FORWARD > 0).all()


def test_frames_are_right_handed(camera: Camera) -> None:
    np.testing.assert_array_equal(np.cross(RIGHT, DOWN), FORWARD)
    assert np.linalg.det(camera.world_from_camera[:3, :3]) == pytest.approx(1.0)


def test_pixel_centers_lie_at_one_half_and_row_zero_is_on_top(camera: Camera) -> None:
    _, directions = camera.rays()
    picture = directions.reshape(2, 3, 3)  # (H, W, 3): the row is the first index
    on_image = picture[..., :2] / picture[..., 2:] * 2.0 + [1.5, 1.0]
    columns, rows = np.meshgrid(np.arange(3) + 0.5, np.arange(2) + 0.5)
    np.testing.assert_allclose(on_image, np.stack([columns, rows], axis=-1), atol=1e-12)


def test_matrices_take_columns_and_are_named_result_from_source(camera: Camera) -> None:
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([FORWARD, DOWN, -RIGHT])  # a quarter turn about +Y
    pose[:3, 3] = [1.0, 2.0, 3.0]
    turned = Camera(3, 2, 2.0, 2.0, 1.5, 1.0, pose)
    np.testing.assert_array_equal(turned.position, [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(turned.forward, -RIGHT)
    origins, directions = turned.rays()
    np.testing.assert_array_equal(origins, np.tile([1.0, 2.0, 3.0], (6, 1)))
    _, local = camera.rays()
    np.testing.assert_allclose(directions, local @ pose[:3, :3].T, atol=1e-12)


def test_directions_are_unit_length(camera: Camera) -> None:
    _, directions = camera.rays()
    # Six float64 divisions and a root: a few units in the last place.
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, rtol=1e-15, atol=0)


def test_the_world_has_y_up() -> None:
    up_in_a_z_up_file = np.array([0.0, 0.0, 1.0])
    np.testing.assert_array_equal(Y_UP_FROM_Z_UP[:3, :3] @ up_in_a_z_up_file, [0.0, 1.0, 0.0])
    assert np.linalg.det(Y_UP_FROM_Z_UP) == 1.0  # turned, not mirrored


def test_an_opengl_camera_looks_along_minus_z() -> None:
    np.testing.assert_array_equal(OPENGL_FROM_OPENCV[:3, :3] @ FORWARD, [0.0, 0.0, -1.0])
    np.testing.assert_array_equal(OPENGL_FROM_OPENCV[:3, :3] @ DOWN, [0.0, -1.0, 0.0])


def test_quaternions_are_w_x_y_z_and_turn_counterclockwise() -> None:
    half = np.sqrt(0.5)
    quarter_about_z = rotation_from_quaternion(np.array([half, 0.0, 0.0, half]))
    x, y = np.eye(3)[:2]
    np.testing.assert_allclose(quarter_about_z @ x, y, atol=1e-15)
