"""Particles as they leave each kind of light: where, which way, how much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.transport import Emitted, MeshShape, PathTracer, emit_particles

from support.statistics import chi_square_p, sidak, sphere_cell_masses, sphere_counts
from tests.light.seen import FACES, OCTAHEDRON
from tests.transport.light_scenes import LIGHTS, TILT, lit_by
from tests.transport.scenes import GRAY, stage

COUNT = 60_000
CELLS = 6  # along each of four dimensions: 46 particles a cell
LEVEL = 1e-3  # all tests of this file together raise a false alarm this often
TESTS = 14
# The sphere around the box of floor and ball.
CENTER, RADIUS = np.array([0.0, 0.5, 0.0]), float(np.sqrt(4 + 0.25 + 4))


def emitted(name: str, count: int = COUNT) -> tuple[Any, Emitted]:
    """A light of `LIGHTS` and particles of it."""
    tracer = PathTracer(lit_by(*LIGHTS[name], gloss=GRAY), dtype=np.float64)
    return LIGHTS[name][0], emit_particles(tracer, count, seed=5)


def frames(normals: Any) -> tuple[Any, Any]:
    """Two unit vectors across each normal (N, 3)."""
    helper = np.where(np.abs(normals[:, :1]) < 0.6, [[1.0, 0, 0]], [[0, 1.0, 0]])
    first = np.cross(normals, helper)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(normals, first)


def turn(v: Any, axis: Any) -> Any:
    """The angle of vectors (N, 3) around axes (N, 3), as a part of the whole turn."""
    x, y = frames(axis)
    return np.arctan2((v * y).sum(axis=1), (v * x).sum(axis=1)) / (2 * np.pi) % 1.0


def in_cap(w: Any, axis: Any, height: float) -> list[Any]:
    """(N,) twice: uniform in [0, 1] for directions that are even over a cap."""
    axes = np.broadcast_to(axis, w.shape)
    return [(1 - (w * axes).sum(axis=1)) / height, turn(w, axes)]


def by_cosine(w: Any, normals: Any) -> list[Any]:
    """The same for directions with density cos / pi."""
    axes = np.broadcast_to(normals, w.shape)
    return [1 - (w * axes).sum(axis=1) ** 2, turn(w, axes)]


def on_disc(origins: Any, towards: Any) -> list[Any]:
    """The same for points that are even over the disc that faces `towards`, beside the scene."""
    apart = origins - CENTER
    along = (apart * towards).sum(axis=1)
    np.testing.assert_allclose(along, RADIUS, rtol=1e-5)
    across = apart - along[:, None] * towards
    return [(across**2).sum(axis=1) / RADIUS**2, turn(across, towards)]


def in_triangle(points: Any, corners: Any) -> list[Any]:
    """The same for points even over triangles (N, 3, 3)."""
    a, b, c = (corners[:, k] for k in range(3))
    normal = np.cross(b - a, c - a)
    whole = (normal**2).sum(axis=1)
    y = (np.cross(points - a, c - a) * normal).sum(axis=1) / whole
    z = (np.cross(b - a, points - a) * normal).sum(axis=1) / whole
    return [(y + z) ** 2, z / (y + z)]


def assert_even(parts: list[Any]) -> None:
    """Chi-square over cells of the unit cube of all dimensions, together."""
    places = np.stack(parts, axis=1)
    assert ((places > -1e-4) & (places < 1 + 1e-4)).all()
    counts, _ = np.histogramdd(
        places.clip(0, 1 - 1e-9), bins=[np.linspace(0, 1, CELLS + 1)] * len(parts)
    )
    masses = np.full(counts.shape, 1.0 / counts.size)
    assert chi_square_p(counts, masses) > sidak(LEVEL, TESTS)


def unit(v: Any) -> Any:
    return np.asarray(v, float) / np.linalg.norm(v)


def test_point_and_spot() -> None:
    light, found = emitted("point")
    np.testing.assert_allclose(found.origins, np.broadcast_to(light.position, (COUNT, 3)))
    assert_even(in_cap(found.directions, [0.0, 0, 1], 2.0))
    np.testing.assert_allclose(
        found.flux, np.broadcast_to(4 * np.pi * np.asarray(light.intensity), (COUNT, 3))
    )
    spot, found = emitted("spot")
    axis = unit(spot.axis)
    assert_even(in_cap(found.directions, axis, 1 - spot.cos_outer))
    t = (found.directions @ axis - spot.cos_outer) / (spot.softness * (1 - spot.cos_outer))
    t = t.clip(0, 1)
    shade = (t * t * (3 - 2 * t))[:, None] * np.asarray(spot.intensity)
    np.testing.assert_allclose(found.flux, 2 * np.pi * (1 - spot.cos_outer) * shade, rtol=1e-9)
    height = 1 - spot.cos_outer
    power = 2 * np.pi * height * (1 - spot.softness / 2) * np.asarray(spot.intensity)
    np.testing.assert_allclose(found.flux.mean(axis=0), power, rtol=0.01)


@pytest.mark.parametrize("name", ["directional", "ambient", "sky", "sun"])
def test_light_from_far_away(name: str) -> None:
    light, found = emitted(name)
    towards = -found.directions
    if name == "directional":
        ways: list[Any] = []
        np.testing.assert_allclose(towards, np.broadcast_to(unit(light.direction), (COUNT, 3)))
        arriving = np.asarray(light.irradiance)
    elif name == "sun":
        ways = in_cap(towards, unit(light.direction), light.height)
        arriving = 2 * np.pi * light.height * np.asarray(light.radiance)
    else:
        ways = in_cap(towards, [0.0, 1, 0], 2.0)
        parts = (
            [light.radiance] * 4
            if name == "ambient"
            else [light.zenith, light.horizon, light.horizon, light.ground]
        )
        arriving = np.pi * np.sum(parts, axis=0)
    assert_even([*ways, *on_disc(found.origins, towards)])
    flux = np.pi * RADIUS**2 * arriving
    np.testing.assert_allclose(found.flux.mean(axis=0), flux, rtol=0.01)


@pytest.mark.parametrize("name", ["map", "turned map"])
def test_environment_maps(name: str) -> None:
    light, found = emitted(name)
    towards = -found.directions
    assert_even(on_disc(found.origins, towards))
    # In the frame of the map, its cells' edges are edges of these: the density is smooth within.
    rotation = TILT if name == "turned map" else np.eye(3)
    height = len(light.texels)
    z = -np.cos(np.concatenate([[0], (np.arange(height) + 0.5) / height, [1]]) * np.pi)

    def density(w: Any) -> Any:
        """w as (Z, -X, Y) of the map."""
        of_map = np.stack([-w[:, 1], w[:, 2], w[:, 0]], axis=1)
        world = np.ascontiguousarray(of_map @ rotation.T)
        return light.pdf(np.zeros_like(world), world)

    of_map = towards @ rotation
    turned = np.stack([of_map[:, 2], -of_map[:, 0], of_map[:, 1]], axis=1)
    masses = sphere_cell_masses(density, z, 4 * height)
    assert masses.sum() == pytest.approx(1.0, rel=1e-5)
    counts = sphere_counts(turned, z, 4 * height)
    assert chi_square_p(counts, masses) > sidak(LEVEL, TESTS)
    radiance = light.L(np.zeros_like(towards), np.ascontiguousarray(towards))
    pdf = light.pdf(np.zeros_like(towards), np.ascontiguousarray(towards))
    expected = np.pi * RADIUS**2 * radiance / pdf[:, None]
    # A direction that is turned forth and back rounds to other texels' weights.
    np.testing.assert_allclose(found.flux, expected, rtol=1e-6)


def test_rectangle_and_ball() -> None:
    light, found = emitted("rectangle")
    normal = unit(np.cross(light.edge_x, light.edge_y))
    inside = found.origins - light.corner
    np.testing.assert_allclose(inside @ normal, 2e-5, rtol=1e-6)  # beside the surface
    place = [inside @ np.asarray(e) / (np.asarray(e) @ e) for e in (light.edge_x, light.edge_y)]
    assert_even([*place, *by_cosine(found.directions, normal)])
    area = np.linalg.norm(np.cross(light.edge_x, light.edge_y))
    expected = np.broadcast_to(np.pi * area * np.asarray(light.radiance), (COUNT, 3))
    np.testing.assert_allclose(found.flux, expected, rtol=1e-6)
    ball, found = emitted("sphere")
    out = (found.origins - ball.center) / np.linalg.norm(
        found.origins - ball.center, axis=1, keepdims=True
    )
    assert_even([*in_cap(out, [0.0, 0, 1], 2.0), *by_cosine(found.directions, out)])
    power = 4 * np.pi**2 * ball.radius**2 * np.asarray(ball.radiance)
    np.testing.assert_allclose(found.flux, np.broadcast_to(power, (COUNT, 3)), rtol=1e-6)


def triangle() -> tuple[Any, Any, Emitted]:
    """Corners (1, 3, 3), radiance, and particles of a light."""
    light, found = emitted("triangle")
    return np.array([[light.a, light.b, light.c]], float), light.radiance, found


def mesh() -> tuple[Any, Any, Emitted]:
    """The same of a shape with eight faces."""
    vertices, radiance = OCTAHEDRON + np.array([0.3, 0.0, 0.2]), np.array([4.0, 3.0, 2.0])
    scene = lit_by(gloss=GRAY)
    shape = MeshShape("octahedron", vertices, FACES, "floor", radiance)
    tracer = PathTracer(replace(scene, shapes=(*scene.shapes, shape)), dtype=np.float64)
    return vertices[FACES], radiance, emit_particles(tracer, COUNT, seed=5)


@pytest.mark.parametrize("light", [triangle, mesh])
def test_triangles(light: Callable[[], tuple[Any, Any, Emitted]]) -> None:
    corners, radiance, found = light()
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = 0.5 * np.linalg.norm(normals, axis=1)
    normals /= 2 * areas[:, None]
    counts = np.bincount(found.entries, minlength=len(areas))
    if len(areas) > 1:
        assert chi_square_p(counts, areas / areas.sum()) > sidak(LEVEL, TESTS)
    place = in_triangle(found.origins, corners[found.entries])
    assert_even([*place, *by_cosine(found.directions, normals[found.entries])])
    power = np.pi * areas.sum() * np.asarray(radiance)
    np.testing.assert_allclose(found.flux, np.broadcast_to(power, (COUNT, 3)), rtol=1e-5)


def test_lights_are_chosen_by_power() -> None:
    tracer = PathTracer(lit_by(*LIGHTS["all"], gloss=GRAY), dtype=np.float64)
    found = emit_particles(tracer, COUNT, seed=6)
    centers = (np.arange(1 << 16) + 0.5) / (1 << 16)
    entries, pmf = tracer._geometry.choose_lights(centers)
    kinds, first = np.unique(entries, return_index=True)
    masses = pmf[first] / pmf[first].sum()
    counts = np.bincount(found.entries, minlength=kinds.max() + 1)[kinds]
    assert chi_square_p(counts, masses) > sidak(LEVEL, TESTS)
    # What each light sends does not depend on the others.
    for kind, p in zip(kinds, pmf[first], strict=True):
        assert found.flux[found.entries == kind].sum() > 0, p


def test_particles_have_numbers_and_scenes_have_lights() -> None:
    tracer = PathTracer(stage(GRAY), dtype=np.float64)
    whole, part = emit_particles(tracer, 100, seed=1), emit_particles(tracer, 60, seed=1, first=40)
    np.testing.assert_array_equal(whole.origins[40:], part.origins)
    np.testing.assert_array_equal(whole.flux[40:], part.flux)
    other = emit_particles(tracer, 100, seed=2)
    assert (whole.directions != other.directions).any()
    with pytest.raises(RangeError, match="count: expected a whole number of at least 1"):
        emit_particles(tracer, 0, seed=1)
    with pytest.raises(RangeError, match="a scene with lights"):
        emit_particles(PathTracer(stage(GRAY, lamp=0.0)), 1, seed=1)
