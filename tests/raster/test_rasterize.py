"""What is seen: against an oracle, the ray tracer, and in closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.geometry.mesh import Bvh, Mesh
from photograd.raster import FaceLookup, RasterOptions, Visibility, project, rasterize

from tests.raster import oracle

SIZE = (20, 24)


def scene(kind: str) -> tuple[Any, Any]:
    """Positions in homogeneous pixels, faces."""
    if kind == "sphere":
        vertices, faces = oracle.sphere()
    elif kind == "soup":
        vertices, faces = oracle.soup(40, 1)
    else:  # large triangles, half of their corners behind the camera
        vertices, faces = oracle.soup(12, 2, size=6.0)
    return project(vertices, oracle.camera()), faces


@pytest.mark.parametrize("kind", ["sphere", "soup", "behind the camera"])
def test_every_pixel_agrees_with_the_oracle(kind: str) -> None:
    positions, faces = scene(kind)
    assert (kind == "behind the camera") == bool((positions[:, 2] < 0).any())
    visibility = rasterize(positions, faces, SIZE)
    face, weights, depth = oracle.rasterized(positions, faces, SIZE)
    assert 0.2 < visibility.covered.mean() < 1 or kind == "behind the camera"
    np.testing.assert_array_equal(visibility.face, face)
    np.testing.assert_allclose(visibility.barycentrics, weights[..., 1:], atol=1e-9)
    np.testing.assert_allclose(visibility.depth, depth, rtol=1e-9)


def test_the_near_plane_cuts_triangles() -> None:
    positions, faces = scene("sphere")
    visibility = rasterize(positions, faces, SIZE, RasterOptions(near=2.7, far=3.2))
    face, _, depth = oracle.rasterized(positions, faces, SIZE, near=2.7)
    kept = depth <= 3.2
    assert 10 < kept.sum() < (depth < np.inf).sum()
    np.testing.assert_array_equal(visibility.face, np.where(kept, face, -1))


def test_a_point_of_the_image_sees_what_the_rasterizer_sees_there() -> None:
    positions, faces = scene("soup")
    visibility = rasterize(positions, faces, SIZE)
    rows, columns = np.indices(SIZE).reshape(2, -1) + 0.5
    face, depth = FaceLookup(positions, faces, SIZE).nearest(np.stack([columns, rows], axis=-1))
    np.testing.assert_array_equal(face.reshape(SIZE), visibility.face)
    np.testing.assert_array_equal(depth.reshape(SIZE), visibility.depth)
    outside = FaceLookup(positions, faces, SIZE).nearest([[-1.0, 3.0], [3.0, 20.0]])
    assert (outside[0] == -1).all()
    assert np.isinf(outside[1]).all()


@pytest.mark.parametrize("name", ["sphere", "soup"])
def test_the_ray_tracer_sees_the_same_but_at_edges(name: str) -> None:
    vertices, faces = oracle.sphere(60, 30) if name == "sphere" else oracle.soup(200, 3)
    camera = oracle.camera(400, 300, 420.0)
    mesh = Mesh(vertices.astype(np.float32), faces)
    hits = Bvh(mesh).trace(*camera.rays())
    positions = project(mesh.vertices, camera)
    visibility = rasterize(positions, faces, (300, 400))
    other = hits.primitive.reshape(300, 400)
    differ = other != visibility.face
    assert differ.mean() < 1e-3
    # Where they differ, a neighbor's center sees what the ray saw: an edge is nearer than a pixel.
    padded = np.pad(visibility.face, 1, mode="edge")
    near = np.zeros(differ.shape, bool)
    for y, x in np.ndindex(3, 3):
        near |= padded[y : y + 300, x : x + 400] == other
    assert near[differ].all()


def grid(count: int, jitter: float) -> tuple[Any, Any]:
    """A square of 2 count^2 triangles over 1024 x 1024 pixels and half a pixel more, z = 1."""
    at = np.linspace(-0.5, 1024.5, count + 1)
    x, y = np.meshgrid(at, at)
    corners = np.stack([x, y], axis=-1)
    inside = np.s_[1:-1, 1:-1]
    corners[inside] += jitter * np.random.default_rng(1).uniform(-1, 1, corners[inside].shape)
    i = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    a, b, c, d = (each.reshape(-1) for each in (i[:-1, :-1], i[:-1, 1:], i[1:, :-1], i[1:, 1:]))
    flat = corners.reshape(-1, 2)
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)])
    return np.insert(flat, 2, 1.0, axis=1), faces


@pytest.mark.parametrize("jitter", [0.0, 0.3])
def test_no_gap_and_no_double_hit(jitter: float) -> None:
    # 1025 cells: all corners are centers of pixels, and diagonals run through centers, too.
    positions, faces = grid(1025 if jitter == 0 else 700, jitter)
    visibility = rasterize(positions, faces, (1024, 1024))
    assert visibility.overdraw.min() == visibility.overdraw.max() == 1


def test_a_shared_edge_at_any_depth_covers_a_pixel_once() -> None:
    rng = np.random.default_rng(5)
    x = np.arange(64) + 0.5
    top, bottom = rng.uniform(1, 4, 64), rng.uniform(1, 4, 64)
    upper = np.stack([x * top, 0.5 * top, top], axis=-1)
    lower = np.stack([x * bottom, 63.5 * bottom, bottom], axis=-1)
    i = np.arange(63)
    first = np.stack([i, i + 1, 64 + i], axis=1)
    second = np.stack([i + 1, 65 + i, 64 + i], axis=1)
    faces = np.concatenate([first, second])
    visibility = rasterize(np.concatenate([upper, lower]), faces, (64, 64))
    inside = visibility.overdraw[1:-1, 1:-1]
    assert inside.min() == inside.max() == 1


def test_of_equal_depths_the_first_is_seen() -> None:
    positions = np.array([[0.0, 0, 1], [8, 0, 1], [0, 8, 1]])
    visibility = rasterize(positions, [[0, 1, 2], [0, 1, 2], [2, 0, 1]], (4, 4))
    assert set(visibility.face.ravel()) <= {0, -1}
    assert visibility.overdraw.max() == 3


def test_a_second_mesh_goes_on_in_the_same_buffers() -> None:
    vertices, faces = oracle.soup(40, 1)
    positions = project(vertices, oracle.camera())
    whole = rasterize(positions, faces, SIZE)
    first = rasterize(positions, faces[:15], SIZE)
    both = rasterize(positions, faces[15:], SIZE, onto=first, first_face=15)
    for name, array in vars(whole).items():
        np.testing.assert_array_equal(getattr(both, name), array)
    assert (first.face < 15).all()
    assert not np.array_equal(first.face, both.face)


def test_degenerate_triangles_are_not_drawn_and_leave_no_nan() -> None:
    rng = np.random.default_rng(7)
    corners = rng.integers(-1, 3, (100_000, 3, 3)) * rng.choice([1e-12, 1.0, 1e9], (100_000, 1, 1))
    positions = corners.reshape(-1, 3).astype(float)
    visibility = rasterize(positions, np.arange(300_000).reshape(-1, 3), (4, 4))
    assert np.isfinite(visibility.barycentrics).all()
    assert not np.isnan(visibility.depth).any()
    flat = np.array([[0.0, 0, 1], [4, 4, 1], [2, 2, 1], [1, 1, 1]])
    nothing = rasterize(flat, [[0, 1, 2], [0, 3, 3]], (4, 4))
    assert not nothing.covered.any()


def test_bad_input_is_named() -> None:
    positions, faces = scene("sphere")
    with pytest.raises(RangeError, match=r"rasterize: faces: expected numbers of vertices below"):
        rasterize(positions, faces + len(positions), SIZE)
    with pytest.raises(RangeError, match=r"rasterize: positions"):
        rasterize(np.where(positions > 10, np.nan, positions), faces, SIZE)
    with pytest.raises(ShapeError, match=r"rasterize: positions: expected shape \(V, 3\)"):
        rasterize(positions[:, :2], faces, SIZE)
    with pytest.raises(ShapeError, match=r"rasterize: onto: expected buffers"):
        rasterize(positions, faces, SIZE, onto=Visibility.cleared(3, 3))
    with pytest.raises(RangeError, match=r"RasterOptions: near"):
        RasterOptions(near=0.0)
    with pytest.raises(RangeError, match=r"RasterOptions: far"):
        RasterOptions(near=2.0, far=1.0)
    with pytest.raises(RangeError, match=r"RasterOptions: cull"):
        RasterOptions(cull="both")  # type: ignore[arg-type]
    with pytest.raises(RangeError, match=r"Visibility.cleared: width"):
        Visibility.cleared(2**20, 2**20)
    with pytest.raises(DtypeError, match=r"Visibility.cleared: height"):
        Visibility.cleared(1.5, 4)  # type: ignore[arg-type]


def test_a_camera_projects_as_it_does_elsewhere() -> None:
    vertices, _ = oracle.sphere()
    camera: Camera = oracle.camera()
    positions = project(vertices, camera)
    pixels, depths = camera.project(vertices)
    np.testing.assert_allclose(positions[:, :2] / positions[:, 2:], pixels, rtol=1e-12)
    np.testing.assert_allclose(positions[:, 2], depths, rtol=1e-12)


def test_only_faces_that_are_drawn_hide_others() -> None:
    positions, faces = scene("soup")
    drawn = np.random.default_rng(3).uniform(size=len(faces)) < 0.6
    some = rasterize(positions, faces, SIZE, face_mask=drawn)
    alone = rasterize(positions, faces[drawn], SIZE)
    assert alone.covered.sum() > 10
    assert (some.face != rasterize(positions, faces, SIZE).face).any()
    np.testing.assert_array_equal(
        some.face, np.where(alone.covered, np.flatnonzero(drawn)[alone.face], -1)
    )
    np.testing.assert_array_equal(some.depth, alone.depth)
    np.testing.assert_array_equal(some.barycentrics, alone.barycentrics)
    np.testing.assert_array_equal(some.overdraw, alone.overdraw)
    with pytest.raises(ShapeError, match="rasterize: face_mask"):
        rasterize(positions, faces, SIZE, face_mask=drawn[1:])
