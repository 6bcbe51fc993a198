"""Mipmaps in paths: the level of a path, its effect, and the derivative of texels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.errors import RangeError, SceneError
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    Environment,
    Material,
    Medium,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    Texture,
    TextureUse,
    read_scene,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle
from photograd.transport.texture import FILTERS
from photograd_course.gradcheck import check_gradient
from PIL import Image

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport import test_textures as textures
from tests.transport.scenes import picture_and_gradients
from tests.transport.test_adjoint import proof
from tests.transport.test_derivative import check

Array = Any
BARE = PathOptions("bsdf")
ONE = PathOptions("bsdf", max_depth=2)
SIZE = 64
PAINT = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("t")})


def checker(rows: int, columns: int, filter: str = "mip") -> Texture:
    """0 and 1 in turns from texel to texel: every coarser level of an even number is 1/2."""
    value = np.indices((rows, columns)).sum(axis=0) % 2
    return Texture(np.repeat(value[..., None], 3, axis=2).astype(float), filter=filter)


def far_away(distance: float, half: float, size: int = SIZE) -> Camera:
    """A camera on +Z that sees a square of this half edge at the origin."""
    angle = 2 * np.degrees(np.arctan(half / distance))
    return camera_at([0.0, 0.0, distance], [0.0, 0.0, 0.0], angle, size, size)


def tilted_wall(texture: Texture, tilt: float) -> Scene:
    """A square that fills the picture, leaning back by `tilt` degrees, under an even sky of 1."""
    c, s = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    up = np.array([0.0, 2.0, -2.0 * s / c])
    wall = rectangle("wall", [-1.0, *(-0.5 * up[1:])], [2, 0, 0], up, "paint")
    camera = far_away(2000.0, 0.999)
    sky = Environment.constant(1.0)
    return Scene("w", (wall,), {"paint": PAINT}, camera, sky, textures={"t": texture})


def swing(scene: Scene, options: PathOptions = ONE) -> float:
    """How far samples lie from 1/2 at most, as a part of 1/2; scaled by what a white wall shows."""
    found = PathTracer(scene, dtype=np.float64).render(spp=1, seed=1, options=options).mean
    (shape,) = scene.textures.values()
    white = replace(shape, values=np.ones_like(shape.values))
    bright = PathTracer(replace(scene, textures={"t": white}), dtype=np.float64).render(
        spp=1, seed=1, options=options
    )
    return float(2 * np.abs(found / bright.mean - 0.5).max())


@pytest.mark.parametrize(
    ("tilt", "rows", "columns", "rho"),
    [
        (0.0, 96, 96, 1.5),
        (0.0, 32, 96, 1.5),  # the longer side, whichever coordinate it goes along
        # Leaning back: twice as much of the wall in a pixel, and in a texel.
        (60.0, 96, 32, 1.5),
        (60.0, 32, 96, 1.5),
        (0.0, 80, 80, 1.25),
        (0.0, 112, 112, 1.75),
    ],
)
def test_the_level_is_that_of_the_longer_side(
    tilt: float, rows: int, columns: int, rho: float
) -> None:
    # Level log2(rho) lies between the checker, and a coarser one that is 1/2 everywhere.
    found = swing(tilted_wall(checker(rows, columns), tilt))
    expected = 1 - np.log2(rho)
    assert expected - 0.05 < found < expected + 0.003  # samples meet centers of texels nearly


@pytest.mark.parametrize(("texels", "rho"), [(48, 0.75), (64, 1.0), (128, 2.0), (512, 8.0)])
def test_near_it_is_bilinear_to_the_bit_and_far_the_mean(texels: int, rho: float) -> None:
    scene = tilted_wall(checker(texels, texels), 0.0)
    mip = PathTracer(scene).render(spp=4, seed=1, options=ONE)
    plain = {"t": checker(texels, texels, "bilinear")}
    points = PathTracer(replace(scene, textures=plain)).render(spp=4, seed=1, options=ONE)
    assert np.ptp(points.mean) > 0.3
    if rho < 1:
        np.testing.assert_array_equal(mip.radiance, points.radiance)
        np.testing.assert_array_equal(mip.squares, points.squares)
    elif rho > 1:
        np.testing.assert_allclose(mip.mean, 0.5, atol=0.01)
    else:
        np.testing.assert_allclose(mip.mean, points.mean, atol=0.01)


def in_a_ball(k: float) -> Scene:
    """A checker behind the camera, seen in a mirror: a ball of the curvature k at 4 m, or flat."""
    spacing = (4 + 9 * (1 + 8 * k)) / 1e4  # of pixels on the wall; 1e4 is the focal length
    half = 0.5 * SIZE * spacing
    wall = rectangle("wall", [half, -half, 10], [-2 * half, 0, 0], [0, 2 * half, 0], "paint")
    mirror: Any = rectangle("mirror", [-1, -1, 1], [2, 0, 0], [0, 2, 0], "mirror")
    if k:
        mirror = SphereShape("mirror", np.array([0.0, 0.0, 1 - 1 / k]), 1 / k, "mirror")
    camera = far_away(5.0, 5.0 * 0.5 * 0.99 * SIZE / 1e4)
    sun = DirectionalLight([1.0, 0.0, -1.0], [1.0, 1.0, 1.0])
    materials = {"paint": PAINT, "mirror": Material("mirror", {"reflectance": [1.0] * 3})}
    texture = checker(96, 96)
    shapes = (wall, mirror)
    return Scene("b", shapes, materials, camera, lights=(sun,), textures={"t": texture})


@pytest.mark.parametrize("k", [0.0, 0.5, 1.0])
def test_a_cone_goes_on_behind_mirrors(k: float) -> None:
    # At right angles a ray that leaves the axis by w meets a normal turned by k w.
    found = swing(in_a_ball(k), PathOptions("light", max_depth=3))
    assert found == pytest.approx(1 - np.log2(1.5), abs=0.06)


def test_a_mesh_with_normals_has_the_curvature_of_its_ball() -> None:
    scene = in_a_ball(0.5)
    n = 24
    x, y = np.meshgrid(np.linspace(-0.02, 0.02, n), np.linspace(-0.02, 0.02, n), indexing="ij")
    r = np.stack([x, y, np.sqrt(4 - x**2 - y**2)], axis=-1).reshape(-1, 3)
    corner = np.arange(n * n).reshape(n, n)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.concatenate([np.stack(half, -1).reshape(-1, 3) for half in ((a, b, c), (a, c, d))])
    # Placed by a matrix, wound the wrong way, and with normals of any length.
    place = np.eye(4)
    place[2, 3] = -1.0
    cap = MeshShape("mirror", r, faces[:, ::-1], "mirror", normals=3 * r, instances=(place,))
    found = swing(replace(scene, shapes=(scene.shapes[0], cap)), PathOptions("light", max_depth=3))
    assert found == pytest.approx(1 - np.log2(1.5), abs=0.06)
    flat = replace(cap, normals=None)
    sharp = swing(replace(scene, shapes=(scene.shapes[0], flat)), PathOptions("light", max_depth=3))
    assert sharp > 0.9  # facets have no curvature, and the cone stays as narrow as it was


def test_a_cone_goes_through_media() -> None:
    scene = tilted_wall(checker(96, 96), 0.0)
    lamp = PointLight([0.0, 0.0, 1990.0], [1e6] * 3)
    thin = {"air": Medium(np.full(3, 1e-9))}
    lit = replace(scene, environment=None, lights=(lamp,), media=thin, world="air")
    found = swing(lit, PathOptions("light", max_depth=2))
    assert found == pytest.approx(1 - np.log2(1.5), abs=0.06)


def floor_to_the_horizon(filter: str, size: int = 32) -> Scene:
    """A checkerboard of 64 x 64 squares, 8 x 8 texels each, that reaches far."""
    squares = np.kron(np.indices((64, 64)).sum(axis=0) % 2, np.ones((8, 8)))
    values = 0.1 + 0.8 * np.repeat(squares[..., None], 3, axis=2)
    floor = rectangle("floor", [-32, 0, 4], [64, 0, 0], [0, 0, -64], "paint")
    camera = camera_at([0.0, 1.5, 3.0], [0.0, 0.0, -6.0], 40.0, size, size)
    sky = Environment.constant(1.0)
    picture = {"t": Texture(values, ("clamp", "clamp"), filter)}
    return Scene("f", (floor,), {"paint": PAINT}, camera, sky, textures=picture)


def test_a_far_checkerboard_converges_at_one_sample() -> None:
    def render(filter: str, spp: int) -> Array:
        tracer = PathTracer(floor_to_the_horizon(filter))
        return tracer.render(spp=spp, seed=3, options=BARE).mean[..., 0]

    truth = render("bilinear", 1024)
    far = slice(10, 15)  # squares are smaller than pixels there
    np.testing.assert_allclose(truth[far].mean(axis=1), 0.5, atol=0.01)
    error = {name: float(np.std(render(name, 1)[far] - truth[far])) for name in FILTERS}
    assert error["bilinear"] > 0.3  # measured: 0.36
    assert error["mip"] < 0.05  # measured: 0.031: the variance of 130 samples
    # The price is a blur that no number of samples takes away: where squares are as long as pixels
    # but wider, their longer side blurs both; much nearer there is none.
    blurred = render("mip", 256) - truth
    middle, near = blurred[16:19], blurred[28:]
    assert 0.1 < float(np.std(middle)) < 0.3  # measured: 0.20
    assert float(np.std(near)) < 0.04  # measured: 0.027


def filtered(scene: Scene, texels: int = 24) -> Scene:
    """The same with textures of many texels and mip maps."""
    g = np.random.default_rng(5)
    fine = {
        name: Texture(g.uniform(0.2, 0.9, (texels, texels - 3, t.channels)), t.wrap, "mip")
        for name, t in scene.textures.items()
    }
    return replace(scene, textures=fine)


def test_texels_have_derivatives_through_all_levels() -> None:
    scene = filtered(textures.stage())
    points = {name: replace(t, filter="bilinear") for name, t in scene.textures.items()}
    one, other = (
        PathTracer(s, dtype=np.float64).render(spp=3, seed=1).mean
        for s in (scene, replace(scene, textures=points))
    )
    assert np.abs(one - other).max() > 0.01  # levels do count here
    function, backward, start = proof(scene)
    report = check_gradient(function, backward, start, seed=2, coordinates=6, directions=6)
    assert report, str(report)


def test_dual_numbers_agree_with_the_adjoint() -> None:
    check(filtered(textures.stage()), without=("materials.black.albedo",))


def test_wrong_gradients_die() -> None:
    wall = textures.wall(PAINT, {"t": textures.noise(2, 2)}, 3)
    function, backward, start = proof(filtered(wall, 8))
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_the_derivative_of_a_far_texture_is_spread_over_what_was_seen() -> None:
    # Every level keeps the mean, so dL/dtexels adds up to the same; but no texel is missed.
    d = np.ones((SIZE, SIZE, 3)) / (3 * SIZE**2)
    found = {}
    for name in FILTERS:
        scene = tilted_wall(checker(512, 512, name), 0.0)
        tracer = PathTracer(scene, dtype=np.float64)
        found[name] = tracer.render_backward(d, spp=1, seed=1, options=ONE)["textures.t"]
    assert [g.sum() for g in found.values()] == pytest.approx([1.0, 1.0], rel=1e-9)
    assert (found["bilinear"] == 0).mean() > 0.9
    assert (found["mip"] > 0).mean() > 0.98


@same_bits("path tracing with mip maps")
def picture_and_gradients_of_mips() -> list[Any]:
    return picture_and_gradients(filtered(textures.stage(24), 96), 8)


def test_float_agrees_with_double() -> None:
    d = np.random.default_rng(8).uniform(-1, 1, (24, 24, 3))
    gradient, exact = (
        PathTracer(filtered(textures.stage(24), 96), dtype=dtype).render_backward(d, spp=8, seed=9)
        for dtype in (np.float32, np.float64)
    )
    for name in ("textures.paint", "textures.rough"):
        error = np.linalg.norm(gradient[name] - exact[name]) / np.linalg.norm(exact[name])
        assert error < 1e-3  # measured: 3e-6


def test_scene_files_choose_a_filter(tmp_path: Path) -> None:
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(tmp_path / "p.png")
    text = """
[camera]
position = [0, 1, 4]
look_at = [0, 0, 0]
size = [2, 2]
field_of_view = 40
[textures.t]
file = "p.png"
FILTER
[materials.m]
model = "lambert"
albedo = [1, 1, 1]
textures = { albedo = "t" }
[[shapes]]
kind = "rectangle"
corner = [0, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 0, -1]
material = "m"
"""
    file = tmp_path / "s.toml"
    for line, expected in (("", "bilinear"), ('filter = "mip"', "mip")):
        file.write_text(text.replace("FILTER", line), encoding="utf-8")
        assert read_scene(file).textures["t"].filter == expected
    file.write_text(text.replace("FILTER", 'filter = "cubic"'), encoding="utf-8")
    with pytest.raises(SceneError, match="filter"):
        read_scene(file)
    with pytest.raises(RangeError, match="filter"):
        Texture(np.zeros((1, 1, 1)), filter="trilinear")
