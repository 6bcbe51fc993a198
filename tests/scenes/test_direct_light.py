"""Direct light in described scenes: closed forms, alpha, vertex colors, any number of samples."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.errors import RangeError, ShapeError
from photograd.scenes.description import SceneDescription, SceneMesh, SkyDescription, SunDescription
from photograd.scenes.direct_light import DirectLight, vertex_color_texture
from photograd.textures import sample

from geometry.shapes import bumpy_sphere
from support.bits import same_bits

BLACK, WHITE = np.zeros(3), np.ones(3)
BOX = np.array([[-2.0, -2.0, -2.0], [2.0, 2.0, 2.0]])
ALBEDO = np.array([0.25, 0.5, 0.75], np.float32)


def square(y: float, half: float, albedo: Any, *, uv: bool = False) -> SceneMesh:
    """A horizontal square that faces up."""
    corners = [[-half, y, half], [half, y, half], [half, y, -half], [-half, y, -half]]
    coordinates = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32) if uv else None
    return SceneMesh(
        np.array(corners, np.float32),
        np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        np.asarray(albedo, np.float32),
        coordinates,
    )


def lit(
    *meshes: SceneMesh,
    sun: Any = BLACK,
    sky: Any = BLACK,
    radius: float = 0.1,
    towards: Any = (0.0, 1.0, 0.0),
    box: Any = BOX,
) -> DirectLight:
    direction = np.asarray(towards) / np.linalg.norm(towards)
    light = SunDescription(direction, np.asarray(sun, float), radius)
    dome = SkyDescription(*(np.asarray(sky, float) for _ in range(3)))
    return DirectLight(SceneDescription("test", meshes, light, dome, box))


def camera(size: int = 8, eye: Any = (0.0, 1.6, 0.02)) -> Camera:
    pose = look_at(np.array(eye), np.zeros(3))
    return Camera(size, size, 2.0 * size, 2.0 * size, size / 2, size / 2, pose)


def lively() -> DirectLight:
    """A textured floor, a square with vertex colors above it that casts a shadow, sun and sky."""
    g = np.random.default_rng(3)
    floor = square(-0.2, 1.0, g.uniform(0.2, 0.8, (5, 4, 3)), uv=True)
    lid = square(0.2, 0.25, g.uniform(0.2, 0.8, (4, 3)))
    sky = SkyDescription(*(g.uniform(0.2, 1.0, 3) for _ in range(3)))
    sun = SunDescription(np.array([0.6, 0.8, 0.0]), np.array([9.0, 8.0, 6.0]), 0.2)
    return DirectLight(SceneDescription("t", (floor, lid), sun, sky, BOX))


def test_white_sky_gives_back_the_albedo() -> None:
    # An open plane under a dome of radiance 1 has irradiance pi: radiance = albedo.
    radiance, alpha = lit(square(0, 1.5, ALBEDO), sky=WHITE).render_view(camera(), 64, 1)
    np.testing.assert_array_equal(alpha, 1)
    np.testing.assert_allclose(radiance.mean(axis=(0, 1)), ALBEDO, rtol=5e-3)


@pytest.mark.parametrize("tilt", [0.0, 0.5, 1.0])
def test_sun_irradiance_follows_the_cosine(tilt: float) -> None:
    # A disc wholly above the horizon gives E = pi L sin^2(r) cos(tilt); radiance = albedo E / pi.
    radius = 0.2
    towards = [np.sin(tilt), np.cos(tilt), 0.0]
    light = lit(square(0, 1.5, [0.5] * 3), sun=10 * WHITE, radius=radius, towards=towards)
    radiance, _ = light.render_view(camera(), 256, 2)
    expected = 0.5 * 10 * np.sin(radius) ** 2 * np.cos(tilt)
    # Over 64 pixels of 256 samples the cosine varies by at most tan(tilt) r / sqrt(16384) = 0.25 %.
    assert radiance.mean() == pytest.approx(expected, rel=0.01)


def test_sun_and_sky_add_up() -> None:
    # Whichever of them light sampling turns to, and how often.
    plane, view = square(0, 1.5, ALBEDO), camera()
    for sun in (0.01, 10.0, 300.0):
        whole, _ = lit(plane, sun=sun * WHITE, sky=WHITE).render_view(view, 256, 3)
        expected = ALBEDO * (1 + sun * np.sin(0.1) ** 2)
        np.testing.assert_allclose(whole.mean(axis=(0, 1)), expected, rtol=5e-3)


def test_penumbra_is_between_light_and_shadow() -> None:
    # A lid of half size 0.25 m hangs 1 m above a floor under a sun of radius 0.2 rad, straight
    # above: full shadow in the middle (0.25 > tan 0.2), full light far outside, neither between.
    floor, lid = square(0, 1.5, [0.8] * 3), square(1.0, 0.25, [0.0] * 3)
    under = Camera(64, 1, 40.0, 40.0, 32.0, 0.5, look_at(np.array([0, 0.7, 1e-3]), np.zeros(3)))
    radiance, _ = lit(floor, lid, sun=10 * WHITE, radius=0.2).render_view(under, 256, 3)
    row, full = radiance[0, :, 0], 0.8 * 10 * np.sin(0.2) ** 2
    assert row[32] == 0
    assert row[0] == pytest.approx(full, rel=0.05)
    inside = row[(row > 0.1 * full) & (row < 0.9 * full)]
    assert len(inside) >= 8
    left = row[:32]
    assert np.corrcoef(left, np.sort(left)[::-1])[0, 1] > 0.98  # falls steadily into the shadow


def test_pixels_beside_the_object_are_empty() -> None:
    radiance, alpha = lit(square(0, 0.2, ALBEDO), sky=WHITE).render_view(camera(16), 16, 4)
    assert alpha[0, 0] == 0
    assert alpha[8, 8] == 1
    assert not radiance[alpha == 0].any()
    rim = (alpha > 0) & (alpha < 1)
    assert rim.any()
    np.testing.assert_array_equal(alpha * 16, np.round(alpha * 16))  # whole samples
    # Premultiplied: what is seen of the square has its color, whatever lies beside it.
    np.testing.assert_allclose(radiance[rim].mean(axis=0), alpha[rim].mean() * ALBEDO, rtol=0.05)


@pytest.mark.parametrize("scale", [1e-2, 1.0, 1e3])
def test_no_surface_shadows_itself(scale: float) -> None:
    # Above a facet of a convex mesh the whole sky is free, so it shows its albedo.
    vertices, faces = bumpy_sphere(12, 24)
    convex = vertices / np.linalg.norm(vertices, axis=1, keepdims=True) * scale
    mesh = SceneMesh(convex.astype(np.float32), faces, ALBEDO)
    box = np.array([[-1.1] * 3, [1.1] * 3]) * scale
    eye = look_at(np.array([0.0, 1.0, 3.0]) * scale, np.zeros(3))
    light = lit(mesh, sky=WHITE, box=box)
    radiance, alpha = light.render_view(Camera(24, 24, 31, 31, 12, 12, eye), 64, 6)
    assert alpha.max() == 1
    assert (alpha == 0).any()
    mean = (radiance.sum(axis=(0, 1)) / alpha.sum()) / ALBEDO
    np.testing.assert_allclose(mean, 1, rtol=3e-3)


def test_radiance_does_not_change_with_distance() -> None:
    # A02: radiance along an unoccluded ray, from three distances.
    light = lit(square(0, 1.5, ALBEDO), sun=10 * WHITE)
    seen: list[Any] = []
    for height in (0.2, 1.0, 1.9):
        eye = look_at(np.array([0.0, height, 1e-3]), np.zeros(3))
        seen.append(light.render_view(Camera(2, 2, 40, 40, 1, 1, eye), 4, 1)[0])
        np.testing.assert_allclose(seen[-1], seen[0], rtol=1e-5)


@pytest.mark.parametrize("spp", [1, 7, 12, 64])
def test_any_number_of_samples_has_the_same_mean(spp: int) -> None:
    # One pixel on a floor; a wall's edge stands before half of the sun.
    wall = np.array([[0, 1, 5], [5, 1, 5], [5, 1, -5], [0, 1, -5]], np.float32) * 0.3
    half = SceneMesh(wall, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), np.zeros(3, np.float32))
    light = lit(square(0, 1.5, [0.8] * 3), half, sun=10 * WHITE, radius=0.3)
    eye = look_at(np.array([-0.02, 0.2, 1e-3]), np.array([-0.02, 0.0, 0.0]))
    view = Camera(1, 1, 2000.0, 2000.0, 0.5, 0.5, eye)
    truth = float(light.render_view(view, 1 << 16, 1000)[0][0, 0, 0])
    assert 0.2 < truth / (0.8 * 10 * np.sin(0.3) ** 2) < 0.8
    count = 4096 // spp
    seen = [float(light.render_view(view, spp, s)[0][0, 0, 0]) for s in range(count)]
    # Four standard errors; a bias of 5 % would be seen even with one sample a pixel.
    error = max(float(np.std(seen)) / np.sqrt(count), 1e-3 * truth)
    assert abs(np.mean(seen) - truth) < 4 * error
    assert error < 0.02 * truth


def test_vertex_colors_are_interpolated_over_each_face() -> None:
    g = np.random.default_rng(5)
    _, faces = bumpy_sphere(40, 80)
    colors = g.uniform(0, 1, (int(faces.max()) + 1, 3)).astype(np.float32)
    uv, texels = vertex_color_texture(faces.astype(np.uint32), colors)
    weights = g.dirichlet([1, 1, 1], len(faces))
    at = (weights[..., None] * uv.reshape(-1, 3, 2).astype(np.float64)).sum(axis=1)
    found = sample(texels.astype(np.float64), at)
    expected = (weights[..., None] * colors[faces]).sum(axis=1)
    # 160 texels along u, of which float32 knows places to 160 * 2^-24 = 1e-5.
    np.testing.assert_allclose(found, expected, atol=3e-5)


def test_vertex_colors_look_like_a_texture() -> None:
    # Colors that are linear in x and z are the same as vertex colors and as a bilinear texture.
    a, b, c = np.array([[0.3, 0.3, 0.5], [0.6, 0.2, 0.4], [0.7, 0.6, 0.8]])
    corners = np.stack([a, b, c, a + c - b])
    texels = corners[[[3, 2], [0, 1]]]
    painted = square(0, 1, texels, uv=True)
    uv = np.array([[0.25, 0.75], [0.75, 0.75], [0.75, 0.25], [0.25, 0.25]], np.float32)
    painted = SceneMesh(painted.vertices, painted.faces, painted.albedo, uv)
    view = camera(6, eye=(0.3, 1.4, 0.9))
    one, other = (
        lit(mesh, sun=10 * WHITE, sky=WHITE).render_view(view, 16, 1)
        for mesh in (painted, square(0, 1, corners))
    )
    np.testing.assert_array_equal(one[1], other[1])
    np.testing.assert_allclose(one[0], other[0], rtol=1e-5)


@same_bits("direct light")
def direct_light() -> list[Any]:
    return list(lively().render_view(camera(24, eye=(0.3, 1.4, 0.9)), 20, 9))


def test_bad_arguments_are_named() -> None:
    with pytest.raises(RangeError, match="spp: expected a whole number of at least 1"):
        lively().render_view(camera(), 0, 0)
    with pytest.raises(ShapeError, match=r"colors: expected shape \(V, 3\)"):
        vertex_color_texture(np.zeros((1, 3), np.uint32), np.ones(3, np.float32))
