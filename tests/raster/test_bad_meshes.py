"""Strange meshes: without area, not manifold, of NaN, huge, and behind the camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    antialias,
    antialias_backward,
    find_crossings,
    footprints,
    interpolate,
    interpolate_backward,
    project,
    project_backward,
    rasterize,
    rasterize_backward,
)
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.raster import oracle

SIZE = (20, 24)
CAMERA = oracle.camera()


class Picture:
    """Colors and depths of a mesh, edges blended, as a function of its vertices."""

    def __init__(self, vertices: Any, faces: Any) -> None:
        self.faces, self.edges = np.asarray(faces), MeshEdges.of(np.asarray(faces))
        g = np.random.default_rng(3)
        self.colors = g.uniform(0.1, 1, (len(vertices), 2))
        self.place = {"vertices": np.asarray(vertices, np.float64)}
        self.cotangent = g.uniform(0.5, 1.5, (*SIZE, 2))

    def steps(self, p: Any) -> Any:
        positions = project(p["vertices"], CAMERA)
        visibility = rasterize(positions, self.faces, SIZE)
        shaded = interpolate(self.colors, self.faces, visibility)
        crossings = find_crossings(positions, self.faces, visibility, self.edges)
        return positions, visibility, shaded, crossings

    def forward(self, p: Any) -> Any:
        _, _, shaded, crossings = self.steps(p)
        return antialias(shaded, crossings)

    def backward(self, p: Any, d: Any) -> Any:
        positions, visibility, shaded, crossings = self.steps(p)
        d_shaded, silhouettes = antialias_backward(shaded, crossings, d, positions, self.edges)
        _, d_b = interpolate_backward(self.colors, self.faces, visibility, d_shaded)
        interior = rasterize_backward(positions, self.faces, visibility, d_b)
        found = project_backward(p["vertices"], CAMERA, silhouettes + interior)
        return {"vertices": found.vertices}


def world(points: Any) -> Any:
    """Points (N, 3) of the camera's frame in the world."""
    pose = CAMERA.world_from_camera
    return np.asarray(points, np.float64) @ pose[:3, :3].T + pose[:3, 3]


TRIANGLE = world([[-0.61, -0.52, 2.0], [0.73, -0.31, 2.2], [0.02, 0.64, 1.9]])


@pytest.mark.parametrize(
    "extra",
    [[1, 1, 2], [0, 0, 0], [0, 1, 3], [4, 5, 6], [7, 8, 9]],
    ids=["one vertex twice", "one vertex", "on an edge", "a line", "a point"],
)
def test_triangles_without_area_show_nothing_and_ask_for_nothing(extra: list[int]) -> None:
    middle = (TRIANGLE[0] + TRIANGLE[1]) / 2
    line = world([[-0.3, 0.1, 1.5], [0.1, 0.1, 1.5], [0.5, 0.1, 1.5]])
    point = world([[0.1, 0.1, 1.4]] * 3)
    vertices = np.concatenate([TRIANGLE, [middle], line, point])
    alone, both = Picture(vertices, [[0, 1, 2]]), Picture(vertices, [[0, 1, 2], extra])
    assert both.steps(both.place)[1].covered.sum() > 50
    np.testing.assert_array_equal(alone.forward(alone.place), both.forward(both.place))
    d = alone.cotangent
    ours, theirs = both.backward(both.place, d), alone.backward(alone.place, d)
    np.testing.assert_allclose(ours["vertices"], theirs["vertices"], atol=1e-12)


def test_a_sliver_has_finite_derivatives() -> None:
    vertices = world([[-0.6, 0.1, 2.0], [0.6, 0.1, 2.0], [0.0, 0.1 + 1e-12, 2.0]])
    picture = Picture(vertices, [[0, 1, 2]])
    assert np.isfinite(picture.forward(picture.place)).all()
    assert np.isfinite(picture.backward(picture.place, picture.cotangent)["vertices"]).all()


def test_an_edge_with_three_faces_is_drawn_and_has_the_derivative_of_its_picture() -> None:
    ends = [[-0.7, 0.07, 2.0], [0.7, 0.11, 2.1]]
    fins = world([*ends, [0.1, 0.8, 1.8], [0.2, -0.7, 1.9], [0.05, 0.3, 3.0]])
    picture = Picture(fins, [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    assert picture.edges.crowded == 1
    assert picture.steps(picture.place)[1].covered.sum() > 80
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=2)
    assert report, str(report)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_vertices_that_are_no_numbers_are_refused_everywhere(bad: float) -> None:
    picture = Picture(TRIANGLE, [[0, 1, 2]])
    positions, visibility, _, _ = picture.steps(picture.place)
    broken = positions.copy()
    broken[1, 2] = bad
    faces, edges = picture.faces, picture.edges
    calls = {
        "project": lambda: project(np.where(TRIANGLE[1, 1] == TRIANGLE, bad, TRIANGLE), CAMERA),
        "rasterize": lambda: rasterize(broken, faces, SIZE),
        "find_crossings": lambda: find_crossings(broken, faces, visibility, edges),
        "FaceLookup": lambda: FaceLookup(broken, faces, SIZE),
        "footprints": lambda: footprints(np.eye(3)[:, :2], broken, faces, visibility),
        "rasterize_backward": lambda: rasterize_backward(broken, faces, visibility),
    }
    for name, call in calls.items():
        with pytest.raises(RangeError, match=rf"{name}: \w+: .*finite"):
            call()


HUGE = {"1 km": 1e3, "1000 km": 1e6}


@pytest.mark.parametrize("size", HUGE.values(), ids=HUGE.keys())
def test_a_huge_triangle_covers_its_side_of_the_horizon(size: float) -> None:
    ground = world([[-2 * size, 0.5, -size], [2 * size, 0.5, -size], [0.3, 0.5, 2 * size]])
    picture = Picture(ground, [[0, 1, 2]])
    visibility = picture.steps(picture.place)[1]
    below = np.arange(SIZE[0]) + 0.5 > CAMERA.cy + CAMERA.fy * 0.5 / size * 8
    assert visibility.covered[below].all()
    assert not visibility.covered[np.arange(SIZE[0]) + 0.5 < CAMERA.cy].any()
    depth = visibility.depth[below][:, 12]
    rows = np.arange(SIZE[0])[below] + 0.5
    np.testing.assert_allclose(depth, CAMERA.fy * 0.5 / (rows - CAMERA.cy), rtol=1e-9)
    found = picture.backward(picture.place, picture.cotangent)["vertices"]
    assert np.isfinite(found).all()
    assert found.any()
    if size == HUGE["1 km"]:  # beyond that, differences of float64 drown in rounding
        report = check_gradient(picture.forward, picture.backward, picture.place, seed=2)
        assert report, str(report)


BEHIND = {
    "one corner": [[-0.9, 0.5, 3.0], [0.8, 0.4, 2.5], [0.1, 0.3, -1.0]],
    "two corners": [[-0.9, 0.35, -0.5], [0.8, 0.4, -1.5], [0.07, -0.3, 4.0]],
}


@pytest.mark.parametrize("name", BEHIND)
def test_a_triangle_that_reaches_behind_the_camera_has_derivatives(name: str) -> None:
    vertices = np.concatenate(
        [world(BEHIND[name]), TRIANGLE + world([[0, 0, 3]]) - world([[0] * 3])]
    )
    picture = Picture(vertices, [[0, 1, 2], [3, 4, 5]])
    positions, visibility, _, crossings = picture.steps(picture.place)
    assert (positions[:3, 2] < 0).any()
    assert (visibility.face == 0).sum() > 20
    assert len(crossings.taker) > 10
    found = picture.backward(picture.place, picture.cotangent)["vertices"]
    assert (np.abs(found[:3]).max(axis=1) > 1e-3).all()  # the corners behind it, too
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=2)
    assert report, str(report)
    mutants = check_gradient_mutants(
        picture.forward, picture.backward, picture.place, picture.cotangent, seed=2
    )
    assert mutants, str(mutants)


def test_a_mesh_behind_the_camera_shows_nothing() -> None:
    vertices = world([[-0.61, -0.52, -2.0], [0.73, -0.31, -2.2], [0.02, 0.64, -1.9]])
    picture = Picture(vertices, [[0, 1, 2]])
    assert not picture.forward(picture.place).any()
    assert not picture.backward(picture.place, picture.cotangent)["vertices"].any()
