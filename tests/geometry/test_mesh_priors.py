"""Priors on the shape of a mesh: closed forms, finite differences, mutants, bad input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.geometry.icosphere import icosphere
from photograd.geometry.mesh_priors import LaplacianEnergy, NormalConsistency
from photograd.raster import MeshEdges
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants

SPHERE = icosphere(3)
EDGES = MeshEdges.of(SPHERE.faces)
# Bent along the edge (0, 1) by the angle `bend`.
HINGE = np.array([[0, 1, 2], [1, 0, 3]])


def hinge(bend: float) -> Any:
    far = [0.5, np.cos(bend), np.sin(bend)]
    return np.array([[0.0, 0, 0], [1, 0, 0], [0.5, -1, 0], far])


def energies() -> dict[str, Any]:
    count = len(SPHERE.vertices)
    return {
        "laplacian": LaplacianEnergy(EDGES.ends, count, 2.0),
        "normals": NormalConsistency(EDGES.ends, EDGES.opposite),
    }


def place() -> Any:
    g = np.random.default_rng(2)
    return {"x": SPHERE.vertices + 0.1 * g.normal(size=SPHERE.vertices.shape)}


@pytest.mark.parametrize("name", ["laplacian", "normals"])
def test_gradients_agree_with_central_differences_and_mutants_die(name: str) -> None:
    energy = energies()[name]
    forward = lambda p: energy.value(p["x"])  # noqa: E731
    backward = lambda p, d: {"x": energy.gradient(p["x"], d)}  # noqa: E731
    assert forward(place()) > 1e-4
    report = check_gradient(forward, backward, place(), seed=3)
    assert report, str(report)
    mutants = check_gradient_mutants(forward, backward, place(), 1.0, seed=3)
    assert mutants, str(mutants)
    assert len(mutants.killed) >= 3


@pytest.mark.parametrize("share", [0.0, 0.5])
def test_a_gradient_without_one_of_its_terms_is_noticed(share: float) -> None:
    energy = energies()["laplacian"]
    factor = 2 / (len(SPHERE.vertices) * 4.0)

    def wrong(p: Any, d: float) -> Any:
        whole = energy.gradient(p["x"], d)
        own = factor * d * energy._delta(p["x"])  # without what neighbors take back
        return {"x": share * whole + (1 - share) * own}

    assert not check_gradient(lambda p: energy.value(p["x"]), wrong, place(), seed=3)


def test_the_laplacian_of_a_regular_fan_in_closed_form() -> None:
    angles = np.arange(6) * np.pi / 3
    rim = np.stack([np.cos(angles), np.sin(angles), np.zeros(6)], axis=1)
    vertices = np.concatenate([[[0.0, 0, 0.3]], rim])
    ends = [[0, k] for k in range(1, 7)] + [[k, k % 6 + 1] for k in range(1, 7)]
    energy = LaplacianEnergy(np.array(ends), 7, 2.0)
    # The middle is 0.3 above its neighbors; a vertex of the rim has the middle and two others.
    around = rim - (vertices[0] + np.roll(rim, 1, axis=0) + np.roll(rim, -1, axis=0)) / 3
    expected = (0.3**2 + np.square(around).sum()) / (7 * 4)
    np.testing.assert_allclose(energy.value(vertices), expected, rtol=1e-12)
    assert LaplacianEnergy(np.zeros((0, 2), int), 3, 1.0).value(np.eye(3)) == 0


@pytest.mark.parametrize("bend", [0.0, 0.4, 1.5, 3.0])
@pytest.mark.parametrize("turned", [False, True])
def test_the_normals_of_a_hinge_in_closed_form(bend: float, turned: bool) -> None:
    faces = HINGE.copy()
    if turned:  # one face runs the other way; the surface is the same
        faces[1] = faces[1, ::-1]
    edges = MeshEdges.of(faces)
    energy = NormalConsistency(edges.ends, edges.opposite)
    np.testing.assert_allclose(energy.value(hinge(bend)), 1 - np.cos(bend), atol=1e-12)


def test_faces_without_area_and_meshes_without_edges_have_no_gradient() -> None:
    edges = MeshEdges.of(HINGE)
    energy = NormalConsistency(edges.ends, edges.opposite)
    flat = hinge(0.5)
    flat[3] = [2.0, 0, 0]  # on the line of the edge
    assert energy.value(flat) == 0
    assert not energy.gradient(flat).any()
    alone = MeshEdges.of(HINGE[:1])
    lone = NormalConsistency(alone.ends, alone.opposite)
    assert lone.value(flat) == 0
    assert lone.gradient(flat).shape == (4, 3)


def test_bad_input_is_named() -> None:
    for energy in energies().values():
        with pytest.raises(ShapeError, match="vertices"):
            energy.value(np.zeros((4, 2)))
        with pytest.raises(RangeError, match=r"vertices: .*finite"):
            energy.gradient(np.full(SPHERE.vertices.shape, np.nan))
    with pytest.raises(RangeError, match="scale"):
        LaplacianEnergy(EDGES.ends, 92, 0.0)
    with pytest.raises(RangeError, match="ends"):
        LaplacianEnergy(EDGES.ends, 5, 1.0)
    with pytest.raises(ShapeError, match="opposite"):
        NormalConsistency(EDGES.ends, EDGES.opposite[:3])
