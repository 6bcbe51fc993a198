"""Cameras of a capture: all around, at one distance, each split in directions of its own."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from photograd.capture import Camera, sees_box
from photograd.scenes.capture import FILL, HIGHEST, LOWEST, capture_cameras
from photograd_course.errors import RangeError, ShapeError

Array = npt.NDArray[np.float64]

BOX = np.array([[-0.3, -0.2, 0.1], [0.5, 0.6, 0.5]])
CENTER = BOX.mean(axis=0)


def outward(cameras: list[Camera]) -> Array:
    rays = np.array([camera.position for camera in cameras]) - CENTER
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    return rays


def angles(first: Array, second: Array) -> Array:
    degrees: Array = np.degrees(np.arccos(np.clip(first @ second.T, -1.0, 1.0)))
    return degrees


def test_a_ball_around_the_box_is_nine_tenths_as_wide_as_the_picture() -> None:
    for radius in (None, 0.3):
        for camera in capture_cameras(BOX, 5, size=100, seed=0, radius=radius)["train"]:
            np.testing.assert_allclose(camera.project(CENTER[None])[0], [[50.0, 50.0]], atol=1e-9)
            reach = 0.5 * np.linalg.norm(BOX[1] - BOX[0]) if radius is None else radius
            distance = np.linalg.norm(camera.position - CENTER)
            # The outline of a ball: directions at the angle arcsin(radius / distance).
            half_width = camera.fx * np.tan(np.arcsin(reach / distance))
            assert half_width == pytest.approx(FILL * 50.0, rel=1e-12)
            corners = np.array([[x, y, z] for x in BOX[:, 0] for y in BOX[:, 1] for z in BOX[:, 2]])
            pixels = camera.project(corners)[0]
            if radius is None:
                assert np.linalg.norm(pixels - 50.0, axis=1).max() <= FILL * 50.0 + 1e-9


def test_intrinsics_are_what_the_blender_format_can_say() -> None:
    cameras = capture_cameras(BOX, 4, 2, size=64, seed=0)
    for camera in [*cameras["train"], *cameras["test"]]:
        assert sees_box(camera, BOX)
        assert (camera.width, camera.height, camera.cx, camera.cy) == (64, 64, 32.0, 32.0)
        assert camera.fx == camera.fy == pytest.approx(32.0 / np.tan(np.radians(20.0)))
        assert camera.world_from_camera[1, 0] == pytest.approx(0.0, abs=1e-15)  # level horizon
        assert camera.world_from_camera[1, 1] < 0.0  # +Y of the picture is down


def test_directions_cover_their_band_evenly() -> None:
    rays = outward(capture_cameras(BOX, 60, size=8, seed=0)["train"])
    heights = rays[:, 1]
    assert LOWEST < heights.min() < heights.max() < HIGHEST
    assert (heights > 0.0).mean() > 0.7
    between = angles(rays, rays) + 360.0 * np.eye(60)
    # 60 equal caps on this band (0.61 of the sphere) have a radius of 11.6 degrees; a hexagonal
    # packing would set neighbors 22 degrees apart, and no direction may be more than that away.
    assert between.min() > 18.0
    probe = outward(capture_cameras(BOX, 1000, size=8, seed=3)["train"])
    assert angles(probe, rays).min(axis=1).max() < 22.0


@pytest.mark.parametrize("numbers", [(60, 8), (100, 20), (24, 6), (12, 4), (7, 1), (3, 9)])
def test_test_cameras_are_everywhere_and_elsewhere(numbers: tuple[int, int]) -> None:
    splits = capture_cameras(BOX, *numbers, size=8, seed=0)
    assert (len(splits["train"]), len(splits["test"])) == numbers
    train, test = outward(splits["train"]), outward(splits["test"])
    everything = np.concatenate([train, test])
    spacing = (angles(everything, everything) + 360.0 * np.eye(len(everything))).min()
    assert angles(test, train).min() >= spacing - 1e-9
    assert spacing > 0.75 * np.degrees(np.sqrt(4.0 * np.pi * 0.61 / sum(numbers)))
    if numbers[1] >= 4:
        turns = np.sort(np.arctan2(test[:, 0], test[:, 2]))
        gaps = np.diff(np.append(turns, turns[0] + 2.0 * np.pi))
        assert gaps.max() < np.pi, "all test cameras on one side"


def test_seeds_turn_and_equal_seeds_agree() -> None:
    first, again, other = (
        outward(capture_cameras(BOX, 9, size=8, seed=seed)["train"]) for seed in (0, 0, 1)
    )
    np.testing.assert_array_equal(first, again)
    np.testing.assert_allclose(first[:, 1], other[:, 1], atol=1e-12)
    turned = np.arctan2(first[:, 0], first[:, 2]) - np.arctan2(other[:, 0], other[:, 2])
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * turned[0]), atol=1e-12)
    assert abs(np.exp(1j * turned[0]) - 1.0) > 0.01


def test_without_test_views_there_is_no_test_split() -> None:
    assert list(capture_cameras(BOX, 1, size=8, seed=0)) == ["train"]


def test_bad_input_is_refused() -> None:
    with pytest.raises(ShapeError, match="capture_cameras: bounds"):
        capture_cameras(BOX[0], 3, size=8, seed=0)
    with pytest.raises(RangeError, match="lower below upper"):
        capture_cameras(BOX[::-1], 3, size=8, seed=0)
    with pytest.raises(RangeError, match="views"):
        capture_cameras(BOX, 0, size=8, seed=0)
    with pytest.raises(RangeError, match="test_views"):
        capture_cameras(BOX, 1, -1, size=8, seed=0)
    with pytest.raises(RangeError, match="size"):
        capture_cameras(BOX, 1, size=0, seed=0)
    with pytest.raises(RangeError, match="radius"):
        capture_cameras(BOX, 1, size=8, seed=0, radius=0.0)
