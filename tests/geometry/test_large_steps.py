"""The parameterization of a mesh's vertices against a dense matrix, and the icosphere."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.geometry.icosphere import icosphere
from photograd.geometry.large_steps import LargeSteps
from photograd.raster import MeshEdges

from support.bits import same_bits


def matrix(ends: Any, count: int, smoothness: float) -> Any:
    laplacian = np.zeros((count, count))
    for a, b in ends:
        laplacian[[a, b], [a, b]] += 1
        laplacian[[a, b], [b, a]] -= 1
    return np.eye(count) + smoothness * laplacian


@pytest.mark.parametrize("smoothness", [0.0, 1.0, 19.0, 1e4])
def test_products_and_solves_are_those_of_the_dense_matrix(smoothness: float) -> None:
    mesh = icosphere(3)
    ends, count = MeshEdges.of(mesh.faces).ends, len(mesh.vertices)
    steps, dense = LargeSteps(ends, count, smoothness), matrix(ends, count, smoothness)
    x = np.random.default_rng(1).normal(size=(count, 3))
    u = steps.times(x)
    np.testing.assert_allclose(u, dense @ x, rtol=1e-12, atol=1e-12 * np.abs(u).max())
    np.testing.assert_allclose(steps.solve(x), np.linalg.solve(dense, x), rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(steps.solve(u), x, rtol=1e-8, atol=1e-9)


def test_the_solve_is_its_own_adjoint_and_keeps_constants_and_vertices_without_edges() -> None:
    steps = LargeSteps(np.array([[0, 1], [1, 2]]), 4, 5.0)
    a, b = np.random.default_rng(2).normal(size=(2, 4, 2))
    assert (steps.solve(a) * b).sum() == pytest.approx((a * steps.solve(b)).sum(), rel=1e-12)
    np.testing.assert_allclose(steps.solve(np.ones((4, 1))), 1.0, rtol=1e-12)
    assert np.array_equal(steps.solve(a)[3], a[3])
    assert np.array_equal(steps.solve(np.zeros((4, 3))), np.zeros((4, 3)))


def test_a_gradient_at_one_vertex_moves_its_neighbors_along() -> None:
    mesh = icosphere(4)
    ends = MeshEdges.of(mesh.faces).ends
    impulse = np.zeros((len(mesh.vertices), 1))
    impulse[0] = 1
    moved = LargeSteps(ends, len(mesh.vertices), 10.0).solve(impulse)[:, 0]
    neighbors = ends[(ends == 0).any(axis=1)].sum(axis=1)
    assert moved.argmax() == 0
    assert moved[neighbors].min() > np.median(moved)
    assert moved.sum() == pytest.approx(1)


def test_bad_arguments_are_named() -> None:
    ends = np.array([[0, 1]])
    with pytest.raises(RangeError, match="LargeSteps: ends"):
        LargeSteps(ends, 1, 1.0)
    with pytest.raises(RangeError, match="LargeSteps: smoothness"):
        LargeSteps(ends, 2, -1.0)
    steps = LargeSteps(ends, 2, 1.0)
    with pytest.raises(ShapeError, match=r"LargeSteps.solve: u: expected shape \(2, K\)"):
        steps.solve(np.zeros((3, 3)))
    with pytest.raises(RangeError, match=r"LargeSteps.solve: u: .*finite"):
        steps.solve(np.array([[1.0], [np.nan]]))


@pytest.mark.parametrize("divisions", [1, 2, 3, 8])
def test_the_icosphere_is_closed_round_and_turned_outwards(divisions: int) -> None:
    mesh = icosphere(divisions)
    vertices = mesh.vertices.astype(np.float64)
    assert len(vertices) == 10 * divisions**2 + 2
    assert len(mesh.faces) == 20 * divisions**2
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1, atol=1e-6)
    edges = MeshEdges.of(mesh.faces)
    assert (edges.borders, edges.crowded) == (0, 0)
    a, b, c = vertices[mesh.faces].swapaxes(0, 1)
    assert (np.einsum("fd,fd->f", np.cross(b - a, c - a), a + b + c) > 0).all()


@same_bits("large steps")
def solved() -> list[Any]:
    mesh = icosphere(4)
    steps = LargeSteps(MeshEdges.of(mesh.faces).ends, len(mesh.vertices), 10.0)
    return [mesh.vertices, mesh.faces, steps.solve(mesh.vertices)]
