"""Silhouettes that are blended: continuity, bounds, derivatives, topology."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import ShapeError
from photograd.raster import (
    MeshEdges,
    antialias,
    antialias_backward,
    find_crossings,
    project,
    rasterize,
)
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.raster import oracle

SIZE = (20, 24)
BEHIND = np.array([0.1, 0.7])


def painted(visibility: Any, faces: Any) -> Any:
    """(H, W, 2) a color of its own for each face, and a background."""
    colors = np.random.default_rng(1).uniform(0, 1, (len(faces), 2))
    return np.where(visibility.covered[..., None], colors[visibility.face], BEHIND)


class Picture:
    """An antialiased picture of the positions and of its colors before it."""

    def __init__(self, positions: Any, faces: Any, size: tuple[int, int] = SIZE) -> None:
        self.faces, self.edges, self.size = faces, MeshEdges.of(faces), size
        self.visibility = rasterize(positions, faces, size)
        self.place = {"positions": positions, "color": painted(self.visibility, faces)}

    def crossings(self, p: dict[str, Any]) -> Any:
        visibility = rasterize(p["positions"], self.faces, self.size)
        return find_crossings(p["positions"], self.faces, visibility, self.edges)

    def forward(self, p: dict[str, Any]) -> Any:
        return antialias(p["color"], self.crossings(p))

    def backward(self, p: dict[str, Any], d: Any) -> dict[str, Any]:
        crossings = self.crossings(p)
        d_color, d_positions = antialias_backward(
            p["color"], crossings, d, p["positions"], self.edges
        )
        return {"positions": d_positions, "color": d_color}


def scene(name: str) -> tuple[Any, Any]:
    made = {
        "sphere": lambda: oracle.sphere(6, 4),
        "small faces": lambda: oracle.sphere(60, 30),
        "soup": lambda: oracle.soup(8, 4),
        "behind the camera": lambda: oracle.soup(5, 2, size=6.0),
    }
    vertices, faces = made[name]()
    return project(vertices, oracle.camera()), faces


@pytest.mark.parametrize("name", ["sphere", "small faces", "soup", "behind the camera"])
def test_backward_agrees_with_central_differences(name: str) -> None:
    picture = Picture(*scene(name))
    assert len(picture.crossings(picture.place).taker) > 3
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=1)
    assert report, str(report)


def test_wrong_gradients_are_noticed() -> None:
    picture = Picture(*scene("sphere"))
    cotangent = np.random.default_rng(2).uniform(-1, 1, (*SIZE, 2))
    report = check_gradient_mutants(
        picture.forward, picture.backward, picture.place, cotangent, seed=1, coordinates=8
    )
    assert report, str(report)


def half_plane(x: float, slope: float = 0.0) -> tuple[Any, Any]:
    """Everything left of an edge through (x, 4) that moves by `slope` pixels a row."""
    points = [[-9, -9, 1], [x - 13 * slope, -9, 1], [x + 13 * slope, 17, 1], [-9, 17, 1]]
    return np.array(points, float), np.array([[0, 1, 2], [0, 2, 3]])


def test_an_upright_edge_gives_the_exact_coverage_and_its_derivative() -> None:
    for x in np.linspace(2.02, 4.98, 12):
        picture = Picture(*half_plane(x), (8, 8))
        picture.place["color"] = picture.visibility.covered[..., None].astype(float)
        blended = picture.forward(picture.place)
        np.testing.assert_allclose(blended.sum(axis=(1, 2)), x, rtol=1e-12)
        d = picture.backward(picture.place, np.ones_like(blended))["positions"]
        assert d[[1, 2], 0].sum() == pytest.approx(8, rel=1e-12)  # of 8 rows


def test_a_slanted_edge_covers_what_lies_on_its_side() -> None:
    picture = Picture(*half_plane(4.03, 0.4), (8, 8))
    picture.place["color"] = picture.visibility.covered[..., None].astype(float)
    blended = picture.forward(picture.place)
    # At the middle of each row, in sum over it.
    np.testing.assert_allclose(blended[..., 0].sum(axis=1), 4.03 + 0.4 * (np.arange(8) - 3.5))


def test_the_picture_is_continuous_where_the_samples_jump() -> None:
    before, after = (Picture(*half_plane(x), (8, 8)) for x in (3.5 - 1e-9, 3.5 + 1e-9))
    assert not np.array_equal(before.visibility.face, after.visibility.face)
    pictures = []
    for picture in (before, after):
        picture.place["color"] = picture.visibility.covered[..., None].astype(float)
        pictures.append(picture.forward(picture.place))
    np.testing.assert_allclose(*pictures, atol=1e-8)


@pytest.mark.parametrize("name", ["sphere", "small faces", "soup"])
def test_no_color_leaves_the_range_of_its_neighbors(name: str) -> None:
    picture = Picture(*scene(name))
    color = picture.place["color"]
    padded = np.pad(color, ((1, 1), (1, 1), (0, 0)), mode="edge")
    shifts = [(1, 1), (0, 1), (2, 1), (1, 0), (1, 2)]
    around = np.stack([padded[y : y + SIZE[0], x : x + SIZE[1]] for y, x in shifts])
    blended = picture.forward(picture.place)
    assert not np.array_equal(blended, color)
    assert (blended <= around.max(axis=0) + 1e-12).all()
    assert (blended >= around.min(axis=0) - 1e-12).all()


def test_a_pixel_that_every_neighbor_covers_keeps_to_their_range() -> None:
    """Four corners of a hole of less than a pixel: the sum of what it takes is above 1."""
    square = np.array([[3.4, 3.4], [3.6, 3.4], [3.6, 3.6], [3.4, 3.6]])
    outer = np.array([[-9, -9], [17, -9], [17, 17], [-9, 17.0]])
    positions = np.insert(np.concatenate([square, outer]), 2, 1.0, axis=1)
    faces = np.array(
        [[[k, (k + 1) % 4, 4 + k], [4 + k, (k + 1) % 4, 4 + (k + 1) % 4]] for k in range(4)]
    )
    picture = Picture(positions, faces.reshape(-1, 3), (8, 8))
    assert not picture.visibility.covered[3, 3]
    crossings = picture.crossings(picture.place)
    assert crossings.weight[crossings.taker == 27].sum() > 1
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=3)
    assert report, str(report)


def test_a_hidden_silhouette_blends_nothing() -> None:
    vertices, faces = oracle.sphere(6, 4)
    wall = np.array([[-9.0, -9, -1], [9, -9, -1], [0, 18, -1]])
    both = np.concatenate([vertices, wall])
    positions = project(both, oracle.camera())
    all_faces = np.concatenate([faces, [[len(vertices), len(vertices) + 1, len(vertices) + 2]]])
    visibility = rasterize(positions, all_faces, SIZE)
    assert (visibility.face == len(faces)).all()
    edges = MeshEdges.of(all_faces)
    assert edges.silhouettes(positions).sum() > 5
    assert not len(find_crossings(positions, all_faces, visibility, edges).taker)


def test_a_closed_mesh_has_no_border_and_a_seam_none_either() -> None:
    vertices, faces = oracle.sphere()
    whole = MeshEdges.of(faces)
    assert (whole.borders, whole.crowded, len(whole.ends)) == (0, 0, 3 * len(faces) // 2)
    apart = vertices[faces].reshape(-1, 3)  # each corner a vertex of its own
    numbers = np.arange(len(apart)).reshape(-1, 3)
    assert MeshEdges.of(numbers).borders == 3 * len(faces)
    welded = MeshEdges.of(numbers, apart)
    assert (welded.borders, len(welded.ends)) == (0, len(whole.ends))
    camera = oracle.camera()
    assert (
        welded.silhouettes(project(apart, camera)).sum()
        == whole.silhouettes(project(vertices, camera)).sum()
    )


def test_an_edge_with_three_faces_has_no_inside() -> None:
    edges = MeshEdges.of([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    assert edges.crowded == 1
    assert edges.borders == 6
    (k,) = np.flatnonzero((edges.ends == [0, 1]).all(axis=1))
    assert edges.inner[k] == -1
    assert (edges.opposite[k] == -1).all()


def test_bad_input_is_named() -> None:
    positions, faces = scene("sphere")
    picture = Picture(positions, faces)
    crossings = picture.crossings(picture.place)
    with pytest.raises(ShapeError, match=r"antialias: color: expected shape \(H, W, C\)"):
        antialias(np.zeros((4, 4)), crossings)
    with pytest.raises(ShapeError, match=r"find_crossings: positions"):
        find_crossings(positions[:, :2], faces, picture.visibility, picture.edges)
