"""Where the scene is: each rule in turn, and which cameras see the box."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import (
    Camera,
    Capture,
    View,
    blind_cameras,
    estimate_bounds,
    require_views_of,
    sees_box,
)
from photograd.capture.bounds import silhouettes_of, visual_hull_box
from photograd_course.errors import SceneError

from support.capture_files import SPHERE_CENTER, SPHERE_RADIUS, look_at, orbit, picture

UNIT_BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])


def sphere_views(count: int = 24, size: int = 64) -> tuple[View, ...]:
    """Views of the sphere, in memory."""
    cameras = orbit(count, size, size, 1.1 * size)
    return tuple(
        View(f"v{index}", camera, picture(camera) / np.float32(255.0))
        for index, camera in enumerate(cameras)
    )


def capture_of(views: tuple[View, ...], **members: object) -> Capture:
    values = {"train": views, "test": (), "format": "test", "source": Path("here")}
    rest = {"color_space": "display", "has_alpha": False}
    return Capture(**(values | rest | members))  # type: ignore[arg-type]


def test_declared_bounds_win() -> None:
    box = np.array([[-1.0, 0, 0], [1, 2, 3]])
    found = estimate_bounds(capture_of(sphere_views(4, 8), bounds=box, has_alpha=True))
    np.testing.assert_array_equal(found.box, box)
    assert "declared" in found.rule


def test_visual_hull_of_a_sphere() -> None:
    found = estimate_bounds(capture_of(sphere_views(), has_alpha=True))
    lower, upper = SPHERE_CENTER - SPHERE_RADIUS, SPHERE_CENTER + SPHERE_RADIUS
    assert (found.box[0] < lower).all()
    assert (found.box[1] > upper).all()
    # 5 % of padding, a voxel of the last pass (2 %), a pixel (2.5 / 70 = 4 % of a diameter) on each
    # side, and above and below the cone that cameras at 30 degrees leave (1 / cos 30 - 1 = 15 %).
    assert (found.box[0] > lower - 0.15).all()
    assert (found.box[1] < upper + 0.15).all()
    assert "hull" in found.rule
    assert found.blind == ()


def test_the_hull_never_loses_a_thin_object() -> None:
    """A rod thinner than a voxel of the first pass still casts its shadow."""
    cameras = orbit(12, 64, 64, 70.0)
    rod = SPHERE_CENTER + np.linspace(-0.6, 0.6, 2000)[:, None] * np.array([1.0, 0.0, 0.0])
    views = []
    for index, camera in enumerate(cameras):
        image = np.zeros((64, 64, 4), dtype=np.float32)
        pixels = np.floor(camera.project(rod)[0]).astype(int)
        image[pixels[:, 1], pixels[:, 0]] = 1.0
        views.append(View(f"v{index}", camera, image))
    box = visual_hull_box(silhouettes_of(views), 2.0 * UNIT_BOX)
    assert box is not None
    assert (box[0] <= rod.min(axis=0)).all()
    assert (box[1] >= rod.max(axis=0)).all()
    assert (box[1] - box[0] < [1.45, 0.25, 0.25]).all()


def test_opaque_alpha_falls_through_to_points() -> None:
    views = tuple(
        replace(view, image=np.ones((8, 8, 4), dtype=np.float32)) for view in sphere_views(6, 8)
    )
    points = np.random.default_rng(0).uniform(-1.0, 1.0, (5000, 3))
    points[0] = 1e6  # an outlier must not stretch the box
    found = estimate_bounds(capture_of(views, has_alpha=True, points=points))
    # 2nd to 98th percentile of a uniform cube is +-0.96, padding makes it 1.056; the standard
    # error of a percentile is 2 sqrt(0.02 * 0.98 / 5000) = 0.004.
    np.testing.assert_allclose(found.box, 1.056 * UNIT_BOX, atol=0.02)
    assert "percentile of 5000 sparse points" in found.rule


def test_depth_range() -> None:
    camera = Camera(10, 20, 10.0, 10.0, 5.0, 10.0, np.eye(4))
    view = View("v", camera, np.zeros((20, 10, 4), dtype=np.float32))
    found = estimate_bounds(capture_of((view,), depth_range=(2.0, 6.0)))
    np.testing.assert_allclose(found.box, [[-3.0, -6.0, 2.0], [3.0, 6.0, 6.0]])


def test_focus_of_the_cameras() -> None:
    found = estimate_bounds(capture_of(sphere_views(9, 8)))
    np.testing.assert_allclose(found.box.mean(axis=0), [0.1, 0.0, 0.05], atol=1e-9)
    assert "focus" in found.rule
    single = sphere_views(1, 8)
    with pytest.raises(SceneError, match="parallel axes"):
        estimate_bounds(capture_of(single))


def test_no_camera_sees_the_box() -> None:
    far = UNIT_BOX + 100.0
    with pytest.raises(SceneError, match=r"cameras that see the box .* v0, v1, v2"):
        estimate_bounds(capture_of(sphere_views(3, 8), bounds=far))


def test_blind_cameras_are_named() -> None:
    views = sphere_views(3, 8)
    pose = views[1].camera.world_from_camera @ np.diag([-1.0, 1.0, -1.0, 1.0])
    turned = replace(views[1], camera=replace(views[1].camera, world_from_camera=pose))
    views = (views[0], turned, views[2])
    assert blind_cameras(views, UNIT_BOX) == ("v1",)
    assert estimate_bounds(capture_of(views, bounds=UNIT_BOX)).blind == ("v1",)
    require_views_of((views[0], views[2]), UNIT_BOX)
    with pytest.raises(SceneError, match=r"1 of 3 that do not: v1"):
        require_views_of(views, UNIT_BOX)


def test_seeing_agrees_with_a_dense_sample() -> None:
    """Random cameras and boxes against a dense sample of the box; both answers must occur.

    A sample point in the image proves that the box is seen. The other way, points just miss thin
    overlaps, so that "not seen" is held against a box that is 8 % smaller than the sampled one.
    """
    rng = np.random.default_rng(11)
    steps = np.linspace(0.0, 1.0, 26)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    answers = []
    for _ in range(80):
        target = rng.normal(size=3)
        pose = look_at(target + rng.normal(size=3) + [0.3, 0.0, 0.0], target)
        camera = Camera(16, 10, rng.uniform(6, 30), rng.uniform(6, 30), 7.0, 6.0, pose)
        lower = rng.normal(size=3) * 1.5
        box = np.stack([lower, lower + rng.uniform(0.2, 1.5, 3)])
        margin = 0.04 * (box[1] - box[0])
        smaller = np.stack([box[0] + margin, box[1] - margin])
        pixels, depth = camera.project(box[0] + grid * (box[1] - box[0]))
        inside = (pixels >= 0.0).all(axis=1) & (pixels <= [16.0, 10.0]).all(axis=1) & (depth > 0)
        sampled = bool(inside.any())
        if sampled:
            assert sees_box(camera, box)
        else:
            assert not sees_box(camera, smaller)
        answers.append(sampled)
    assert 15 < sum(answers) < 65


def test_a_camera_inside_sees_its_box() -> None:
    assert sees_box(Camera(4, 4, 4.0, 4.0, 2.0, 2.0, np.eye(4)), UNIT_BOX)
    assert not sees_box(Camera(4, 4, 4.0, 4.0, 2.0, 2.0, np.eye(4)), UNIT_BOX - [0.0, 0.0, 1.001])


def test_edges_that_cross_at_a_distance() -> None:
    """A box that no face of either body separates from the pyramid, only a pair of edges."""
    pose = look_at(np.array([1.0, -4.0, 4.0]), np.array([3.0, -2.0, 3.0]))
    camera = Camera(10, 10, 5.0, 5.0, 5.0, 5.0, pose)
    box = np.array([[-2.0, 0.0, -2.0], [-1.0, 3.0, 1.0]])
    assert not sees_box(camera, box)
    assert sees_box(camera, box + np.array([0.5, 0.0, 0.0]))
