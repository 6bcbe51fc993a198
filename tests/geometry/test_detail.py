"""Coarser meshes lie where they promise to, and are chosen where nobody sees the difference."""

from __future__ import annotations

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import RangeError
from photograd.geometry import LevelsOfDetail, clustered, nearest_on_mesh
from photograd.geometry.mesh import Bvh, Mesh
from photograd.scenes.shapes import torus
from photograd_course.random import uniform

from .shapes import Array, bumpy_sphere

RING = torus(1.0, 0.35, rows=14, columns=28)
FIN = np.array([[0, 0, 0], [1, 0, 0], [1, 0.04, 0], [0, 0.04, 0], [2.0, 0, 0.5]], np.float32)
MESHES = {
    "bumpy": Mesh(*bumpy_sphere(12, 20)),
    "ring": Mesh(RING.vertices, RING.faces),
    # A thin fin that collapses to a line beside a triangle that stays.
    "fin": Mesh(FIN, np.array([[0, 1, 2], [0, 2, 3], [1, 4, 0]])),
}


def on_surface(mesh: Mesh, count: int, seed: int) -> Array:
    """Points (count, 3) spread over the triangles, corners among them."""
    u = uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(3))
    face = (u[:, 0] * len(mesh.faces)).astype(int)
    a, b = np.where(u[:, 1:2] + u[:, 2:] > 1, 1 - u[:, 1:], u[:, 1:]).T
    corner = mesh.vertices.astype(np.float64)[mesh.faces[face]]
    inside = corner[:, 0] + a[:, None] * (corner[:, 1] - corner[:, 0])
    inside += b[:, None] * (corner[:, 2] - corner[:, 0])
    return np.concatenate([inside, mesh.vertices[::3].astype(np.float64)])


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("cell", [0.08, 0.2, 0.4])
def test_every_point_has_another_within_the_error(name: str, cell: float) -> None:
    mesh = MESHES[name]
    level = clustered(mesh, cell)
    there, _ = nearest_on_mesh(on_surface(mesh, 250, 1), level.mesh)
    back, _ = nearest_on_mesh(on_surface(level.mesh, 250, 2), mesh)
    measured = max(there.max(), back.max())
    assert measured <= level.error + 1e-12  # rounding, where no vertex moved
    # Measured: the bound is 1.1 to 4 times the distance that was found.
    assert level.error <= 3 * cell
    assert level.error <= 6 * measured + 1e-12
    assert len(level.mesh.faces) <= len(mesh.faces)


def test_coarser_is_smaller_and_errs_more() -> None:
    levels = LevelsOfDetail(MESHES["ring"], [0.1, 0.2, 0.4]).levels
    faces = [len(level.mesh.faces) for level in levels]
    assert faces == sorted(faces, reverse=True)
    assert faces[-1] < 0.25 * faces[0]
    errors = [level.error for level in levels]
    assert errors[0] == 0
    assert errors == sorted(errors)


def test_a_promise_without_what_was_lost_would_be_broken() -> None:
    # The fin becomes a line that belongs to no triangle: moved corners alone (2 cm) do not tell.
    mesh = Mesh(
        np.concatenate([FIN, FIN + np.array([0, 3, 0])]),
        np.array([[0, 1, 2], [0, 2, 3], [5, 9, 6]]),
    )
    level = clustered(mesh, 0.2)
    there, _ = nearest_on_mesh(on_surface(mesh, 200, 3), level.mesh)
    assert there.max() > 1.0
    assert level.error >= there.max()


def view(k: int) -> Camera:
    u = uniform(4, pixel=k, dimension=np.arange(5))
    way = u[:3] - 0.5
    eye = way / np.linalg.norm(way) * (1.7 + 60.0 * u[3] ** 3)
    return Camera(96, 96, 90 + 60 * u[4], 100, 48, 48, look_at(eye, 0.4 * way))


def test_the_screen_error_is_honoured() -> None:
    # From 60 eyes: what is seen of the fine surface has a point of the chosen one within a pixel.
    mesh = MESHES["ring"]
    detail = LevelsOfDetail(mesh, [0.2, 0.3, 0.4, 0.5])
    fine = Bvh(mesh)
    used, worst = set(), 0.0
    for k in range(60):
        camera = view(k)
        level = detail.choose(camera, 1.0)
        used.add(level)
        pixels = np.arange(0, 96 * 96, 61)
        origins, directions = camera.rays(pixels)
        hits = fine.trace(origins, directions)
        seen = (origins + np.where(hits.hit, hits.t, 0)[:, None] * directions)[hits.hit]
        _, near = nearest_on_mesh(seen, detail.levels[level].mesh)
        gap = np.linalg.norm(camera.project(seen)[0] - camera.project(near)[0], axis=1)
        worst = max(worst, float(gap.max(initial=0.0)))
        assert gap.max(initial=0.0) <= detail.screen_error(level, camera, 1.0) + 1e-9
        coarser = level + 1
        if coarser < len(detail.levels):
            assert detail.screen_error(coarser, camera, 1.0) > 1.0
    assert worst <= 1.0
    assert used == {0, 1, 2, 3, 4}
    # Measured: 0.1 of a pixel. Vertices move along the surface more than away from it.
    assert worst > 0.05


def test_silhouettes_move_by_no_more_than_the_error() -> None:
    mesh = MESHES["ring"]
    detail = LevelsOfDetail(mesh, [0.1, 0.2, 0.4])
    camera = Camera(128, 128, 120, 120, 64, 64, look_at(np.array([0.0, 8.0, 14.0]), np.zeros(3)))
    level = detail.choose(camera, 4.0)
    assert level > 0
    masks = [
        Bvh(m).trace(*camera.rays()).hit.reshape(128, 128)
        for m in (mesh, detail.levels[level].mesh)
    ]
    assert (masks[0] != masks[1]).any()
    reach = 5  # pixels: the error, and half a pixel on either side
    for one, other in (masks, masks[::-1]):
        rows, columns = np.nonzero(one)
        grown = np.zeros_like(other)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                grown |= np.roll(other, (dy, dx), axis=(0, 1))
        assert grown[rows, columns].all()


def test_an_eye_inside_gets_the_finest_and_bad_cells_are_refused() -> None:
    detail = LevelsOfDetail(MESHES["ring"], [0.2, 0.4])
    inside = Camera(64, 64, 60, 60, 32, 32, look_at(np.zeros(3), np.array([1.0, 0, 0])))
    assert detail.choose(inside, 100.0) == 0
    with pytest.raises(RangeError, match="growing"):
        LevelsOfDetail(MESHES["ring"], [0.2, 0.1])
    with pytest.raises(RangeError, match="cell"):
        clustered(MESHES["ring"], 0.0)
    with pytest.raises(RangeError, match="leaves no triangle"):
        clustered(MESHES["ring"], 50.0)
    with pytest.raises(RangeError, match="pixels"):
        detail.choose(inside, 0.0)


def test_nearest_points_of_a_triangle_by_hand() -> None:
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    points = np.array([[1.0, 1, 1], [2, -1, -1], [0, -1, 1], [0.5, 0.5, -3]])
    expected = np.array([[1.0, 1, 1] / np.array(3.0), [1, 0, 0], [0, 0, 1], [0.5, 0.5, 0]])
    distance, place = nearest_on_mesh(points, triangle)
    np.testing.assert_allclose(place, expected, atol=1e-12)
    np.testing.assert_allclose(distance, np.linalg.norm(points - expected, axis=1), rtol=1e-12)
