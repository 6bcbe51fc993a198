"""Frames: rotations from quaternions and axis-angle vectors, and which way is up."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.capture.frames import (
    OPENGL_FROM_OPENCV,
    Y_UP_FROM_Z_UP,
    check_pose,
    invert_rigid,
    mean_camera_up,
    rotation_between,
    rotation_from_axis_angle,
    rotation_from_quaternion,
    world_from_estimated_up,
)

from support.capture_files import orbit, quaternion_of


def test_quarter_turns() -> None:
    about_z = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    s = np.sqrt(0.5)
    turned = rotation_from_quaternion(np.array([s, 0, 0, s]))
    np.testing.assert_allclose(turned, about_z, atol=1e-15)
    vector = np.array([0.0, 0, np.pi / 2])
    np.testing.assert_allclose(rotation_from_axis_angle(vector), about_z, atol=1e-15)
    np.testing.assert_array_equal(rotation_from_axis_angle(np.zeros(3)), np.eye(3))


def test_quaternions_there_and_back() -> None:
    for camera in orbit(5):
        rotation = camera.world_from_camera[:3, :3]
        again = rotation_from_quaternion(3.0 * quaternion_of(rotation))
        np.testing.assert_allclose(again, rotation, atol=1e-14)


def test_z_up_becomes_y_up() -> None:
    np.testing.assert_array_equal(Y_UP_FROM_Z_UP[:3, :3] @ [1.0, 2.0, 3.0], [1.0, 3.0, -2.0])
    for matrix in (Y_UP_FROM_Z_UP, OPENGL_FROM_OPENCV):
        check_pose("test", "matrix", matrix)
        np.testing.assert_array_equal(invert_rigid(matrix) @ matrix, np.eye(4))


def test_smallest_rotation_between_directions() -> None:
    rng = np.random.default_rng(1)
    pairs = rng.normal(size=(20, 2, 3))
    pairs /= np.linalg.norm(pairs, axis=2, keepdims=True)
    pairs[0, 1] = pairs[0, 0]
    pairs[1, 1] = -pairs[1, 0]
    for source, target in pairs:
        rotation = rotation_between(source, target)
        np.testing.assert_allclose(rotation @ source, target, atol=1e-12)
        np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-12)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        # The angle of a rotation by theta: trace = 1 + 2 cos(theta).
        assert np.trace(rotation) == pytest.approx(1.0 + 2.0 * source @ target, abs=1e-12)


def test_estimated_up_stands_the_cameras_upright() -> None:
    tilt = np.eye(4)
    tilt[:3, :3] = rotation_from_axis_angle(np.array([0.7, -0.4, 1.9]))
    poses = [tilt @ camera.world_from_camera for camera in orbit(9)]
    transform, line = world_from_estimated_up(poses, declared_z_up=False)
    up = mean_camera_up([transform @ pose for pose in poses])
    np.testing.assert_allclose(up / np.linalg.norm(up), [0.0, 1.0, 0.0], atol=1e-12)
    assert "estimated" in line


def test_declared_z_up_is_kept_if_the_cameras_agree() -> None:
    poses = [invert_rigid(Y_UP_FROM_Z_UP) @ camera.world_from_camera for camera in orbit(9)]
    transform, line = world_from_estimated_up(poses, declared_z_up=True)
    np.testing.assert_array_equal(transform, Y_UP_FROM_Z_UP)
    assert line == "+Z up -> +Y up"
    lying = [Y_UP_FROM_Z_UP @ pose for pose in poses]
    assert "estimated" in world_from_estimated_up(lying, declared_z_up=True)[1]


def test_no_common_up_is_said() -> None:
    pose = np.eye(4)
    poses = [pose, pose @ np.diag([-1.0, -1.0, 1.0, 1.0])]
    transform, line = world_from_estimated_up(poses, declared_z_up=False)
    np.testing.assert_array_equal(transform, np.eye(4))
    assert "no common up" in line
    assert "no common up" in world_from_estimated_up(poses, declared_z_up=True)[1]
