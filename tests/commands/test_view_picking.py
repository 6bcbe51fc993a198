"""What a click in `photograd view` hits, against what the renderers blend."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.commands.view_hits import Pick, box_edges, numbers, only_at, ray_through
from photograd.commands.view_picking import densities, pick, splat_weights, weights_along
from photograd.fields import DenseGrid, HashGrid, MeshSurface, OctreeSh, SparseSh, TexturedMesh
from photograd.fitting.photograph_gradient import PhotographGradient
from photograd.geometry.icosphere import icosphere
from photograd.representation import ImageBatch, RayBatch, RenderOptions
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import SplatOptions

from tests.fit import scene
from tests.splat import oracle

pytestmark = pytest.mark.usefixtures("core")
BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])


def hit(field: Any, camera: Camera, at: tuple[float, float], gradient: Any = None) -> Pick:
    found = pick(field, camera, at, None, gradient)
    assert found is not None
    return found


def opacity_of(field: Any, camera: Camera, at: tuple[float, float]) -> float:
    origin, direction = ray_through(camera, at)
    batch = RayBatch(origin[None], direction[None], np.zeros(1, np.uint32))
    outputs, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
    return float(outputs.opacity[0])


@pytest.mark.parametrize(
    ("make", "tolerance"), [(DenseGrid, 0.005), (SparseSh, 0.005), (OctreeSh, 0.05)]
)
def test_weights_along_a_ray_add_up_to_its_opacity(make: Any, tolerance: float) -> None:
    field = make.example(seed=2)
    field = field if field.dt is None else field.with_dt(0.01)
    (camera,) = orbit_cameras(field.box, 1, size=32)
    told = []
    for at in ((16.0, 16.0), (12.3, 18.8), (20.1, 13.4)):
        weights, points = weights_along(field, *ray_through(camera, at))
        opacity = opacity_of(field, camera, at)
        assert weights.sum() == pytest.approx(opacity, abs=tolerance)
        assert (points >= field.box[0]).all()
        assert (points <= field.box[1]).all()
        told.append(opacity)
    assert max(told) > 0.3


def test_the_voxel_is_where_a_ball_begins() -> None:
    field = scene.truth()
    (camera,) = orbit_cameras(scene.BOX, 1, size=48)
    center, radius, _ = scene.BALLS[0]
    (at,), _ = camera.project(np.array([center]))
    found = hit(field, camera, tuple(at.tolist()))
    way = np.array(center) - camera.position
    begins = camera.position + way * (1 - radius / np.linalg.norm(way))
    assert np.linalg.norm(found.position - begins) < 0.1  # two voxels: the edge fades
    index = eval(found.title.removeprefix("Voxel "))
    low, high = found.lines.min(axis=(0, 1)), found.lines.max(axis=(0, 1))
    assert (low <= found.position).all()
    assert (found.position <= high).all()
    np.testing.assert_allclose(low, scene.BOX[0] + 0.05 * np.array(index), atol=1e-12)
    values = field.params["values"][index]
    assert found.facts["values"] == numbers(values)
    assert float(found.facts["sigma_t"].split()[0]) == pytest.approx(values[3], rel=1e-3)
    gradient = PhotographGradient(
        "voxels", np.arange(32 * 24 * 28.0).reshape(32, 24, 28), 0, camera
    )
    told = hit(field, camera, tuple(at.tolist()), gradient).facts["dL/dsigma_t"]
    assert told == f"{gradient.values[index]:.4g} m"
    assert pick(field, camera, (0.5, 0.5), None, None) is None


def test_densities_of_inactive_voxels_are_the_background() -> None:
    field = SparseSh.example(seed=0)
    cell = np.argwhere(~field.active_voxels)[7]
    policy = replace(field.policy, density_activation="identity")
    raw = SparseSh(field.active, *field.params.values(), policy, background_density=-2.0)
    (found,) = densities(raw, cell[None] + 0.5)
    assert found == pytest.approx(-2.0 * policy.density_scale)


def splats(*, antialiased: bool) -> GaussianScene:
    policy = SplatOptions(antialiased=antialiased, frustum_margin=10.0)
    return GaussianScene(oracle.cloud(60, 3), extent=1.0, policy=policy)


@pytest.mark.parametrize("antialiased", [False, True])
def test_weights_of_gaussians_add_up_to_the_opacity_of_the_pixel(antialiased: bool) -> None:
    field = splats(antialiased=antialiased)
    (camera,) = orbit_cameras(field.box, 1, size=33)
    outputs, _ = field.render(ImageBatch(camera), seed=0, step=0, options=RenderOptions())
    assert outputs.opacity is not None
    opacity = outputs.opacity.reshape(33, 33)
    for row, column in ((16, 16), (10, 20), (20, 14)):
        weights, rows = splat_weights(field, camera, (column + 0.5, row + 0.5))
        assert weights.sum() == pytest.approx(opacity[row, column], abs=1e-9)
        depth = camera.project(field.params["means"][rows])[1]
        assert (np.diff(depth) >= 0).all()
    assert opacity.max() > 0.3


def test_the_first_noticeable_gaussian_is_hit() -> None:
    field = splats(antialiased=False)
    (camera,) = orbit_cameras(field.box, 1, size=33)
    weights, rows = splat_weights(field, camera, (16.5, 16.5))
    first = rows[np.flatnonzero(weights >= 0.05)[0]]
    groups = {name: np.full(p.shape, 7.0) for name, p in field.params.items()}
    values = groups["opacity_logits"]
    gradient = PhotographGradient("gaussians", values, 0.0, camera, groups=groups)
    found = hit(field, camera, (16.5, 16.5), gradient)
    assert found.title == f"Gaussian {first}"
    np.testing.assert_array_equal(found.position, field.params["means"][first])
    assert found.facts["dL/d means"] == "7, 7, 7"
    assert found.facts["quats"] == numbers(field.params["quats"][first])
    length = np.linalg.norm(found.lines[:, 1] - found.lines[:, 0], axis=1)
    np.testing.assert_allclose(length, 4 * np.exp(field.params["log_scales"][first]))
    assert pick(field, camera, (-500.0, 0.0), None, None) is None


def test_the_nearest_triangle_is_hit() -> None:
    sphere = icosphere(3)
    field = MeshSurface.of_mesh(0.5 * sphere.vertices, sphere.faces)
    (camera,) = orbit_cameras(BOX, 1, size=33)
    d_vertices = np.arange(3.0 * len(sphere.vertices)).reshape(-1, 3)
    gradient = PhotographGradient(
        "surface", d_vertices[:, 0], 0.0, camera, groups={"vertices": d_vertices}
    )
    found = hit(field, camera, (16.5, 16.5), gradient)
    face = int(found.title.removeprefix("Triangle "))
    corners = field.vertices[field.faces[face]]
    np.testing.assert_allclose(found.lines[:, 0], corners, atol=1e-6)
    assert np.linalg.norm(found.position) == pytest.approx(0.5, abs=0.02)
    assert found.position @ camera.position > 0  # in front
    number = int(field.faces[face][1])
    assert found.facts[f"dL/dx of vertex {number}"] == f"{numbers(d_vertices[number])} 1/m"
    assert pick(field, camera, (0.5, 0.5), None, None) is None


def test_a_textured_mesh_names_the_texel() -> None:
    field = TexturedMesh.example(seed=0)
    batch = field.example_batch(seed=0)
    outputs, _ = field.render(batch, seed=0, step=0, options=RenderOptions())
    assert outputs.opacity is not None
    row = int(np.flatnonzero(outputs.opacity > 0)[0])
    origin, direction = batch.origins[row], batch.directions[row]
    from photograd.commands.view_picking import pick_triangle

    found = pick_triangle(field, origin, direction, None)
    assert found is not None
    assert outputs.depth is not None
    distance = np.linalg.norm(found.position - origin)
    assert distance == pytest.approx(float(outputs.depth[row]), rel=1e-5)
    assert any(name.startswith("texel (") for name in found.facts)


def test_a_network_tells_the_place() -> None:
    field = HashGrid.example(seed=0)
    (camera,) = orbit_cameras(field.box, 1, size=33)
    found = hit(field, camera, (16.5, 16.5))
    assert (np.abs(found.position - field.box.mean(axis=0)) < np.ptp(field.box, axis=0)).all()
    assert "hash_grid" in found.markdown()
    assert "table" in found.facts["parameters"]


def test_a_single_pixel_sees_what_the_picture_sees_there() -> None:
    (camera,) = orbit_cameras(BOX, 1, size=(40, 30))
    origins, directions = camera.rays()
    origin, direction = ray_through(camera, (7.5, 11.5))
    np.testing.assert_allclose(direction, directions[11 * 40 + 7], atol=1e-15)
    np.testing.assert_array_equal(origin, origins[0])
    assert (only_at(camera, (3, 4)).width, only_at(camera, (3, 4)).height) == (1, 1)
    edges = box_edges(np.zeros(3), np.array([1.0, 2, 3]))
    assert sorted(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)) == [1] * 4 + [2] * 4 + [3] * 4
    assert len(np.unique(edges.reshape(-1, 3), axis=0)) == 8
