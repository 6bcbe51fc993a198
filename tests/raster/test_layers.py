"""Layers of transparent faces: how many hide a point, and which silhouettes belong to a layer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.raster import (
    FaceLookup,
    MeshEdges,
    find_crossings,
    layered_crossings,
    project,
    rasterize,
)

from support.bits import same_bits
from tests.raster import oracle

SIZE = (20, 24)
CAMERA = oracle.camera()


def scene(seed: int = 3) -> tuple[Any, Any]:
    vertices, faces = oracle.soup(60, seed, size=2.0)
    return project(vertices, CAMERA), faces


def peeled(positions: Any, faces: Any, most: int) -> list[Any]:
    layers = [rasterize(positions, faces, SIZE)]
    while len(layers) < most:
        layers.append(rasterize(positions, faces, SIZE, behind=layers[-1].depth))
    return layers


def test_faces_at_a_point_are_counted() -> None:
    positions, faces = scene()
    lookup, g = FaceLookup(positions, faces, SIZE), np.random.default_rng(1)
    points = g.uniform([-2, -2], [26, 22], (400, 2))
    depth = g.uniform(0.5, 8.0, 400)
    expected = np.zeros(400, int)
    for face in range(len(faces)):  # one triangle alone: is it there, and how far?
        alone = FaceLookup(positions, faces[face : face + 1], SIZE)
        expected += alone.nearest(points)[1] <= depth
    assert expected.max() >= 3
    assert np.array_equal(lookup.count(points, depth), expected)
    with pytest.raises(ShapeError, match=r"FaceLookup.count: depth"):
        lookup.count(points, depth[:3])
    with pytest.raises(RangeError, match=r"FaceLookup.count: depth: .*finite"):
        lookup.count(points, np.full(400, np.nan))


@pytest.mark.parametrize("seed", [1, 3, 5])
def test_each_silhouette_belongs_to_the_layer_that_so_many_faces_hide(seed: int) -> None:
    positions, faces = scene(seed)
    edges = MeshEdges.of(faces)
    layers = peeled(positions, faces, 4)
    found = layered_crossings(positions, faces, layers, edges)
    first = find_crossings(positions, faces, layers[0], edges)
    for ours, theirs in zip(vars(found[0]).values(), vars(first).values(), strict=True):
        assert np.array_equal(ours, theirs)
    assert len(found[1].taker) > 10
    for k, layer in enumerate(layers):
        face = layer.face.reshape(-1)
        assert (face[found[k].taker] != face[found[k].giver]).all()
    # No silhouette is blended in two layers between the same pixels.
    pairs = [set(zip(c.edge.tolist(), c.taker.tolist(), strict=True)) for c in found]
    assert not pairs[0] & pairs[1]


def test_a_layer_is_blended_as_if_what_hides_it_were_not_there() -> None:
    square = 4 * np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    vertices = [[*xy, 2.0] for xy in 4 * square] + [[*(0.11 * xy + 0.05), 3.0] for xy in square]
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    positions = project(np.array(vertices), CAMERA)
    layers = peeled(positions, faces, 2)
    hidden = layered_crossings(positions, faces, layers, MeshEdges.of(faces))
    alone = rasterize(positions, faces[2:], SIZE)
    open_one = find_crossings(positions, faces[2:], alone, MeshEdges.of(faces[2:]))
    assert not len(hidden[0].taker)
    assert len(hidden[1].taker) > 10
    assert np.array_equal(hidden[1].taker, open_one.taker)
    np.testing.assert_allclose(hidden[1].weight, open_one.weight)


@same_bits("layers of crossings")
def crossings() -> list[Any]:
    positions, faces = scene()
    layers = peeled(positions, faces, 3)
    found = layered_crossings(positions, faces, layers, MeshEdges.of(faces))
    return [part for each in found for part in (each.taker, each.weight, each.d_line)]
