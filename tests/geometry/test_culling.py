"""Nothing that a camera sees is culled; most of what it does not see is; and order by distance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import RangeError, ShapeError
from photograd.geometry import CullingTree, Frustum, order_by_distance
from photograd.geometry.mesh import Bvh, Mesh
from photograd_course.random import uniform

from .shapes import Array

NEAR, FAR = 0.05, 12.0
CAMERAS = 10_000
OCTAHEDRON = np.concatenate([np.eye(3), -np.eye(3)])
FACES = np.array(
    [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
)


def objects(count: int = 120) -> Array:
    """Corners (N, 6, 3) of octahedra, mostly small, in a flat world of 20 m."""
    u = uniform(1, pixel=np.arange(count)[:, None], dimension=np.arange(6))
    center = (u[:, :3] - 0.5) * [20.0, 4.0, 20.0]
    size = 0.05 + 1.5 * u[:, 3:] ** 4
    return center[:, None] + size[:, None] * OCTAHEDRON


U = uniform(2, pixel=np.arange(CAMERAS)[:, None], dimension=np.arange(10))


def random_camera(k: int) -> Camera:
    u = U[k]
    eye = (u[:3] - 0.5) * [24.0, 6.0, 24.0]
    target = (u[3:6] - 0.5) * [20.0, 4.0, 20.0]
    focal = 40.0 + 150.0 * u[6]
    cx, cy = 64 * (0.2 + 0.6 * u[7]), 48 * (0.2 + 0.6 * u[8])
    return Camera(64, 48, focal, focal * (0.8 + 0.4 * u[9]), cx, cy, look_at(eye, target))


CORNERS = objects()
BOXES = np.stack([CORNERS.min(axis=1), CORNERS.max(axis=1)], axis=1)


def seen_by(camera: Camera) -> Array:
    """(N,) whether a corner of the object lies in the picture."""
    pixels, depth = camera.project(CORNERS.reshape(-1, 3))
    inside = (depth >= NEAR) & (depth <= FAR)
    with np.errstate(invalid="ignore"):
        inside &= (pixels >= 0).all(axis=1) & (pixels <= [camera.width, camera.height]).all(axis=1)
    return inside.reshape(len(CORNERS), -1).any(axis=1)


def test_ten_thousand_cameras_miss_nothing() -> None:
    tree = CullingTree(BOXES)
    seen = kept = missed = 0
    for k in range(CAMERAS):
        camera = random_camera(k)
        frustum = Frustum.of_camera(camera, NEAR, FAR)
        culled = tree.cull(frustum)
        visible = seen_by(camera)
        missed += int((visible & ~culled.visible).sum())
        if k % 20 == 0:  # the tree decides as a test of every box would
            np.testing.assert_array_equal(culled.visible, ~frustum.misses(BOXES))
        seen += int(visible.sum())
        kept += int(culled.visible.sum())
    assert missed == 0
    assert seen > 8 * CAMERAS
    # The boxes of what is kept and not seen mostly lie beside an edge of the view.
    assert kept < 1.3 * seen
    assert kept < 0.15 * CAMERAS * len(BOXES)


def test_groups_spare_tests() -> None:
    corners = objects(4000)
    boxes = np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1)
    tree = CullingTree(boxes)
    frusta = [Frustum.of_camera(random_camera(k), NEAR, FAR) for k in range(60)]
    culled = [tree.cull(frustum) for frustum in frusta]
    tested = float(np.mean([found.tested for found in culled]))
    kept = float(np.mean([found.visible.sum() for found in culled]))
    assert 0.02 < kept / len(boxes) < 0.2
    # Of 4000 objects 9 % are kept, for 1100 comparisons.
    assert tested < 0.33 * len(boxes)


def test_what_rays_hit_is_kept() -> None:
    # Also faces whose corners all lie beside the picture.
    bvh = Bvh([Mesh(c, FACES) for c in CORNERS.astype(np.float32)])
    tree = CullingTree(BOXES)
    found = 0
    for k in range(150):
        camera = random_camera(k)
        origins, directions = camera.rays()
        along = directions @ camera.forward
        hits = bvh.trace(origins, directions, NEAR / along, FAR / along)
        met = np.unique(hits.instance[hits.hit])
        found += len(met)
        assert tree.cull(Frustum.of_camera(camera, NEAR, FAR)).visible[met].all()
    assert found > 300


@pytest.mark.parametrize("plane", range(6))
def test_a_wrong_plane_is_seen(plane: int) -> None:
    tree, missed = CullingTree(BOXES), 0
    for k in range(200):
        camera = random_camera(k)
        frustum = Frustum.of_camera(camera, NEAR, FAR)
        wrong = frustum.planes.copy()
        # The sides lean inwards; what is near or far begins or ends 4 m off.
        wrong[plane] -= 0.2 * frustum.planes[4] if plane < 4 else np.array([0, 0, 0, 4.0])
        missed += int((seen_by(camera) & ~tree.cull(Frustum(wrong)).visible).sum())
    assert missed > 0


def test_the_shape_of_the_tree() -> None:
    tree = CullingTree(BOXES, max_depth=4)
    assert tree.parent[0] == -1
    assert (tree.parent[1:] < np.arange(1, len(tree.parent))).all()
    assert (tree.level[1:] == tree.level[tree.parent[1:]] + 1).all()
    assert 2 <= tree.level.max() <= 4
    for inner, outer in (
        (tree.node_boxes[1:], tree.node_boxes[tree.parent[1:]]),
        (BOXES, tree.node_boxes[tree.node]),
    ):
        assert (inner[:, 0] >= outer[:, 0]).all()
        assert (inner[:, 1] <= outer[:, 1]).all()
    np.testing.assert_array_equal(tree.node_boxes[0], [BOXES[:, 0].min(0), BOXES[:, 1].max(0)])
    assert len(CullingTree(BOXES, max_depth=0).parent) == 1
    assert CullingTree(np.zeros((1, 2, 3))).cull(Frustum(np.zeros((6, 4)))).visible.tolist() == [
        True
    ]


def test_bad_boxes_and_cameras_are_named() -> None:
    broken = BOXES.copy()
    broken[5, 0, 1] = np.nan
    cases: list[tuple[type[Exception], str, Any, dict[str, Any]]] = [
        (ShapeError, r"shape \(N, 2, 3\)", BOXES[:, 0], {}),
        (RangeError, "at least one object", BOXES[:0], {}),
        (RangeError, "in row 5", broken, {}),
        (RangeError, "lower <= upper.*row 0", BOXES[:, ::-1], {}),
        (RangeError, "max_depth", BOXES, {"max_depth": 17}),
    ]
    for error, words, boxes, options in cases:
        with pytest.raises(error, match=words):
            CullingTree(boxes, **options)
    with pytest.raises(RangeError, match="far"):
        Frustum.of_camera(random_camera(0), 1.0, 1.0)
    with pytest.raises(RangeError, match="near"):
        Frustum.of_camera(random_camera(0), 0.0, 1.0)


def test_order_by_distance_is_stable_from_both_ends() -> None:
    # Points of a lattice: most distances occur many times.
    grid = np.stack(np.meshgrid(*[np.arange(-6.0, 7.0)] * 3, indexing="ij"), -1).reshape(-1, 3)
    points = grid[np.argsort(uniform(4, pixel=np.arange(len(grid))), kind="stable")]
    squared = (points**2).sum(axis=1)
    assert len(np.unique(squared)) < len(points) / 10
    near = order_by_distance(points, [0, 0, 0])
    np.testing.assert_array_equal(near, np.argsort(squared, kind="stable"))
    far = order_by_distance(points, [0, 0, 0], far_first=True)
    np.testing.assert_array_equal(far, np.argsort(-squared, kind="stable"))
    assert not np.array_equal(far, near[::-1])
    assert order_by_distance(points[:0], [0, 0, 0]).shape == (0,)


def test_order_by_distance_from_anywhere() -> None:
    points = np.random.default_rng(5).normal(size=(5000, 3)) * 10.0 ** np.arange(-1, 2)
    eye = np.array([0.3, -2.0, 40.0])
    distance = np.linalg.norm(points - eye, axis=1)
    assert (np.diff(distance[order_by_distance(points, eye)]) >= 0).all()
    with pytest.raises(ShapeError, match="points"):
        order_by_distance(eye, eye)
    with pytest.raises(ShapeError, match="eye"):
        order_by_distance(points, points)
    with pytest.raises(RangeError, match="row 3"):
        order_by_distance(np.where(np.arange(5)[:, None] == 3, np.nan, points[:5]), eye)
