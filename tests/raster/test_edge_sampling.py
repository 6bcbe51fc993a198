"""Edge sampling against exact coverage: no bias, and nothing where nothing moves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    edge_gradient,
    edge_motion_backward,
    polygon_coverage_backward,
    project,
    sample_edges,
)
from photograd_course.gradcheck import check_gradient

from tests.raster import oracle

SIZE = (7, 9)
FACES = np.array([[0, 1, 2]])
EDGES = MeshEdges.of(FACES)
DEPTHS = np.array([1.0, 2.5, 0.7])
CORNERS = np.array([[1.3, 0.8], [7.6, 2.1], [3.2, 6.4]])


def positions(corners: Any = CORNERS) -> Any:
    return DEPTHS[:, None] * np.insert(corners, 2, 1.0, axis=1)


def coverage(lookup: FaceLookup) -> Any:
    return lambda points: (lookup.nearest(points)[0] >= 0)[:, None].astype(float)


def gradient(place: Any, d: Any, seed: int, per_pixel: float) -> Any:
    samples = sample_edges(place, EDGES, SIZE, per_pixel=per_pixel, seed=seed)
    lookup = FaceLookup(place, FACES, SIZE)
    return edge_gradient(place, EDGES, samples, coverage(lookup), d[..., None])


@pytest.mark.parametrize("corners", [CORNERS, CORNERS * 2 - 3], ids=["inside", "cut by the border"])
def test_the_mean_over_seeds_is_the_exact_derivative(corners: Any) -> None:
    d = np.random.default_rng(1).uniform(-1, 1, SIZE)
    exact = polygon_coverage_backward(corners, d)  # in pixels
    place = positions(corners)
    # d/d(x, y) at a fixed depth: positions are z x, z y.
    found = np.array([gradient(place, d, seed, 0.5)[:, :2] for seed in range(400)])
    found *= DEPTHS[:, None]
    error = found.std(axis=0, ddof=1) / np.sqrt(len(found))
    z = (found.mean(axis=0) - exact) / error
    assert np.abs(exact).max() > 0.1
    assert np.abs(z).max() < 4.5


def test_more_points_come_closer() -> None:
    d = np.random.default_rng(2).uniform(-1, 1, SIZE)
    exact = polygon_coverage_backward(CORNERS, d)
    errors = []
    for per_pixel in (1, 16, 256):
        found = DEPTHS[:, None] * gradient(positions(), d, 3, per_pixel)[:, :2]
        errors.append(np.linalg.norm(found - exact) / np.linalg.norm(exact))
    assert errors[2] < 2e-2 < errors[0]
    assert errors[2] < errors[1] / 4


def test_a_constant_cotangent_gives_the_length_of_the_silhouette() -> None:
    """All of a picture brighter by what an outline that grows by a pixel adds."""
    vertices, faces = oracle.sphere(40, 20)
    camera = oracle.camera(120, 100, 80.0)
    place, edges, size = project(vertices, camera), MeshEdges.of(faces), (100, 120)
    samples = sample_edges(place, edges, size, seed=1)
    lookup = FaceLookup(place, faces, size)
    d = np.ones((*size, 1))
    found = edge_gradient(place, edges, samples, coverage(lookup), d)
    # Area = fx fy times something: x dA/dx + y dA/dy = 2 A about the principal point.
    centered = place[:, :2] - np.array([camera.cx, camera.cy]) * place[:, 2:]
    rows, columns = np.indices((400, 480)) / 4 + 0.125
    points = np.stack([columns, rows], axis=-1).reshape(-1, 2)
    area = (lookup.nearest(points)[0] >= 0).mean() * 100 * 120
    assert (found[:, :2] * centered).sum() == pytest.approx(2 * area, rel=2e-3)


def test_a_hidden_edge_adds_nothing() -> None:
    wall = np.array([[-99.0, -99, 0.5], [99, -99, 0.5], [0, 99, 0.5]])
    place = np.concatenate([positions(), wall])
    faces = np.array([[0, 1, 2], [3, 4, 5]])
    edges = MeshEdges.of(faces)
    samples = sample_edges(place, edges, SIZE)
    assert len(samples.points) > 20
    lookup = FaceLookup(place, faces, SIZE)
    shade = coverage(lookup)
    assert not edge_gradient(place, edges, samples, shade, np.ones((*SIZE, 1))).any()


def test_points_lie_on_their_edges_within_the_picture() -> None:
    vertices, faces = oracle.soup(8, 2, size=6.0)
    place = project(vertices, oracle.camera())
    edges = MeshEdges.of(faces)
    samples = sample_edges(place, edges, (20, 24), seed=5)
    assert len(samples.points) > 100
    assert (place[:, 2] < 0).any()
    a, b = (place[edges.ends[samples.edges, k]] for k in range(2))
    line = np.cross(a, b)
    value = (line * np.insert(samples.points, 2, 1.0, axis=1)).sum(axis=1)
    assert np.abs(value / np.linalg.norm(line[:, :2], axis=1)).max() < 1e-9
    assert (samples.points >= 0).all()
    assert (samples.points <= [24, 20]).all()
    np.testing.assert_allclose(np.linalg.norm(samples.normals, axis=1), 1)


def test_the_motion_of_an_edge_agrees_with_central_differences() -> None:
    samples = sample_edges(positions(), EDGES, SIZE, per_pixel=1)

    def forward(p: dict[str, Any]) -> Any:
        """Where the line of each point's edge crosses its normal through the point."""
        a, b = (p["positions"][EDGES.ends[samples.edges, k]] for k in range(2))
        line, homogeneous = np.cross(a, b), np.insert(samples.points, 2, 1.0, axis=1)
        along = (line[:, :2] * samples.normals).sum(axis=1)
        return 1 - (line * homogeneous).sum(axis=1) / along

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        return {"positions": edge_motion_backward(p["positions"], EDGES, samples, d)}

    report = check_gradient(forward, backward, {"positions": positions()}, seed=1)
    assert report, str(report)


def test_bad_input_is_named() -> None:
    with pytest.raises(RangeError, match=r"sample_edges: per_pixel"):
        sample_edges(positions(), EDGES, SIZE, per_pixel=0.0)
    samples = sample_edges(positions(), EDGES, SIZE)
    with pytest.raises(ShapeError, match=r"edge_gradient: shade"):
        edge_gradient(positions(), EDGES, samples, lambda _: np.zeros((3, 1)), np.ones((*SIZE, 1)))
