"""Textured materials in traced pictures, and the derivative of pictures by texels."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, IoError, RangeError, SceneError, ShapeError
from photograd.transport import (
    Environment,
    Material,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    Texture,
    TextureUse,
    read_texture,
)
from photograd.transport.shapes import rectangle
from photograd_course.gradcheck import check_gradient
from PIL import Image

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport.scenes import BLACK, FLOOR, LAMP, picture_and_gradients, view
from tests.transport.test_adjoint import OPTIONS, proof

BARE = PathOptions("bsdf")
WALL = ([-1, -1, 0], [2, 0, 0], [0, 2, 0])


def noise(height: int, width: int, channels: int = 3, seed: int = 1) -> Texture:
    values = np.random.default_rng(seed).uniform(0.2, 0.9, (height, width, channels))
    return Texture(values)


def wall(material: Material, textures: dict[str, Texture], size: int = 8, **more: Any) -> Scene:
    """A square that fills the picture, in front of nothing but an even sky of 1."""
    camera = view(size, (0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    scale = 3.0 * np.tan(np.radians(20.0))  # the square is as large as what the camera sees
    corner, u, v = (scale * np.array(edge, float) for edge in WALL)
    shape = rectangle("wall", corner, u, v, "wall")
    sky = Environment.constant(1.0)
    return Scene("wall", (shape,), {"wall": material}, camera, sky, textures=textures, **more)


def stage(size: int = 6) -> Scene:
    """A textured floor and ball stand: two textures on three parameters, one of them twice."""
    floor = Material(
        "gltf",
        {"base_color": [0.9, 0.8, 0.7], "metalness": 0.8, "roughness": 0.9},
        {
            "base_color": TextureUse("paint"),
            "metalness": TextureUse("rough", 2),
            "roughness": TextureUse("rough", 1),
        },
    )
    box = Material("lambert", {"albedo": [0.8, 0.9, 0.7]}, {"albedo": TextureUse("paint")})
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        rectangle("back", [-1, 0, -0.8], [2, 0, 0], [0, 1.4, 0], "box"),
        SphereShape("ball", np.array([0.0, 0.4, 0.0]), 0.4, "mirror"),
        rectangle("lamp", *LAMP, "black", [4.0, 3.5, 3.0]),
    )
    mirror = Material("mirror", {"reflectance": [0.9, 0.8, 0.7]})
    materials = {"floor": floor, "box": box, "mirror": mirror, "black": BLACK}
    textures = {"paint": noise(5, 4), "rough": noise(3, 3, seed=2)}
    return Scene(
        "stage", shapes, materials, view(size), Environment.constant(0.3), textures=textures
    )


def test_a_texture_stands_upright_and_is_looked_up_bilinearly() -> None:
    # Under an even sky of 1 every sample of a Lambertian wall is exactly its albedo.
    texture = noise(2, 2)
    paint = Material("lambert", {"albedo": [1.0, 0.5, 0.25]}, {"albedo": TextureUse("t")})
    scene = wall(paint, {"t": texture}, 16)
    found = PathTracer(scene, dtype=np.float64).render(spp=64, seed=1, options=BARE).mean
    factor = np.array([1.0, 0.5, 0.25])
    # A quarter of the picture's edge is the center of a texel, and beyond it its value goes on.
    for row, column in ((0, 0), (0, 1), (1, 0), (1, 1)):
        corner = found[row * 13 : row * 13 + 3, column * 13 : column * 13 + 3]
        expected = np.broadcast_to(factor * texture.values[row, column], corner.shape)
        np.testing.assert_allclose(corner, expected, rtol=1e-6)
    middle = factor * texture.values.mean(axis=(0, 1))
    np.testing.assert_allclose(found[7:9, 7:9].mean(axis=(0, 1)), middle, rtol=0.01)


@pytest.mark.parametrize(
    ("wrap", "expected"),
    [("repeat", [0, 1, 0, 1]), ("mirror", [0, 1, 1, 0]), ("clamp", [0, 1, 1, 1])],
)
def test_coordinates_outside_of_the_texture(wrap: str, expected: list[int]) -> None:
    values = np.zeros((1, 2, 1)) + np.array([0.0, 1.0])[None, :, None]
    texture = Texture(np.repeat(values, 32, axis=1), (wrap, wrap))  # blocks, for a crisp edge
    paint = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("t", 0)})
    gray = Texture(np.repeat(texture.values, 3, axis=2), texture.wrap)
    scene = wall(paint, {"t": gray}, 8)
    old = scene.shapes[0]
    assert isinstance(old, MeshShape)
    for start in (0.0, -2.0):  # two periods further left, where that changes nothing
        if wrap == "clamp" and start:
            continue
        uv = np.asarray(old.uv) * [2.0, 1.0] + [start, 0.0]
        shape = MeshShape("wall", old.vertices, old.faces, "wall", uv=uv)
        moved = replace(scene, shapes=(shape,))
        row = PathTracer(moved).render(spp=16, seed=1, options=BARE).mean[4, :, 0]
        # Pixels 0, 2, 4 and 6 lie inside of one half of a period.
        np.testing.assert_allclose(row[[0, 3, 4, 7]], np.array(expected), atol=0.02)


def test_a_product_beyond_the_range_is_cut_off_and_has_no_derivative() -> None:
    from photograd.transport.material import MODELS

    parameters = {p.name: p for p in MODELS["gltf"].parameters}
    least = parameters["roughness"].lo
    values = {"base_color": [0.9] * 3, "metalness": 1.0, "roughness": 0.5}
    plain = wall(Material("gltf", values | {"roughness": least}), {}, 4)
    dark = Texture(np.full((2, 2, 1), 0.5 * least))  # times 0.5: below the range
    textured = wall(Material("gltf", values, {"roughness": TextureUse("t")}), {"t": dark}, 4)
    one, other = (PathTracer(s, dtype=np.float64) for s in (plain, textured))
    np.testing.assert_allclose(
        other.render(spp=8, seed=1).mean, one.render(spp=8, seed=1).mean, rtol=1e-12
    )
    gradient = other.render_backward(np.ones((4, 4, 3)), spp=8, seed=1)
    assert (gradient["textures.t"] == 0).all()
    assert gradient["materials.wall.roughness"] == 0
    assert (gradient["materials.wall.base_color"] > 0).all()


def test_texels_have_derivatives() -> None:
    function, backward, start = proof(stage())
    names = {"textures.paint", "textures.rough", "materials.floor.roughness"}
    assert names <= set(start)
    report = check_gradient(function, backward, start, seed=2, coordinates=6, directions=6)
    assert report, str(report)


def test_a_picture_of_direct_light_is_linear_in_the_texels() -> None:
    # Two segments, one albedo: <J v, w> = <v, J' w> with J v a difference, without remainder.
    paint = Material("lambert", {"albedo": [0.9, 0.8, 0.7]}, {"albedo": TextureUse("t")})
    shapes = (rectangle("floor", *FLOOR, "f"), rectangle("lamp", *LAMP, "b", [4.0, 3.0, 2.0]))
    scene = Scene("s", shapes, {"f": paint, "b": BLACK}, view(8), textures={"t": noise(6, 5)})
    tracer = PathTracer(scene, dtype=np.float64)
    options, g = PathOptions(max_depth=2), np.random.default_rng(3)
    v, w = 0.1 * g.uniform(-1, 1, (6, 5, 3)), g.uniform(-1, 1, (8, 8, 3))
    before = tracer.render(spp=8, seed=1, options=options).mean
    gradient = tracer.render_backward(w, spp=8, seed=1, options=options)["textures.t"]
    tracer.params["textures.t"] = tracer.params["textures.t"] + v
    after = tracer.render(spp=8, seed=1, options=options).mean
    left, right = float(((after - before) * w).sum()), float((v * gradient).sum())
    assert abs(right) > 1e-3
    assert left == pytest.approx(right, rel=1e-10)  # measured: 2e-15


def test_wrong_gradients_die() -> None:
    paint = Material("lambert", {"albedo": [0.9, 0.8, 0.7]}, {"albedo": TextureUse("t")})
    function, backward, start = proof(wall(paint, {"t": noise(3, 2)}, 3))
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_value_and_texture_share_the_derivative_of_their_product() -> None:
    # p = value t: value dL/dvalue = sum of t dL/dt, over all slabs of a backward pass.
    scene = stage(40)
    tracer = PathTracer(scene, dtype=np.float64)
    d = np.random.default_rng(7).uniform(-1, 1, (40, 40, 3))
    gradient = tracer.render_backward(d, spp=96, seed=3, options=OPTIONS)  # three slabs
    rough, d_rough = tracer.params["textures.rough"], gradient["textures.rough"]
    for channel, name in ((2, "metalness"), (1, "roughness")):
        by_value = gradient[f"materials.floor.{name}"] * tracer.params[f"materials.floor.{name}"]
        assert abs(float(by_value)) > 1e-3
        by_texels = (rough * d_rough)[..., channel].sum()
        assert float(by_texels) == pytest.approx(float(by_value), rel=1e-9)
    assert (d_rough[..., 0] == 0).all()
    paint = (tracer.params["textures.paint"] * gradient["textures.paint"]).sum(axis=(0, 1))
    values = sum(
        gradient[f"materials.{name}"] * tracer.params[f"materials.{name}"]
        for name in ("floor.base_color", "box.albedo")
    )
    np.testing.assert_allclose(paint, values, rtol=1e-9)


@same_bits("path tracing with textures")
def picture_and_gradients_of_textures() -> list[Any]:
    return picture_and_gradients(stage(24), 20)


def test_twice_the_cotangent_is_twice_the_gradient_and_float_agrees_with_double() -> None:
    d = np.random.default_rng(8).uniform(-1, 1, (24, 24, 3))
    tracer = PathTracer(stage(24))
    gradient, double = (tracer.render_backward(f * d, spp=20, seed=9) for f in (1, 2))
    for name, value in gradient.items():
        np.testing.assert_allclose(double[name], 2 * value, rtol=1e-6)
    wide = PathTracer(stage(24), dtype=np.float64).render_backward(d, spp=20, seed=9)
    for name in ("textures.paint", "textures.rough"):
        error = np.linalg.norm(gradient[name] - wide[name]) / np.linalg.norm(wide[name])
        assert error < 1e-3  # measured: 3e-6


def test_files_are_decoded_by_name(tmp_path: Path) -> None:
    pixels = np.array([[[0, 128, 255]]], np.uint8)
    Image.fromarray(pixels).save(tmp_path / "p.png")
    coded = read_texture(tmp_path / "p.png")
    np.testing.assert_allclose(coded.values[0, 0], [0, 0.2158605, 1], atol=1e-6)
    plain = read_texture(tmp_path / "p.png", "linear", ("clamp", "mirror"))
    np.testing.assert_allclose(plain.values[0, 0], [0, 128 / 255, 1], atol=1e-7)
    assert plain.wrap == ("clamp", "mirror")
    with pytest.raises(RangeError, match="encoding"):
        read_texture(tmp_path / "p.png", "gamma")
    with pytest.raises(IoError, match="expected a file, got none"):
        read_texture(tmp_path / "none.png")


def test_wrong_textures_are_refused() -> None:
    with pytest.raises(DtypeError, match="floating"):
        Texture(np.zeros((2, 2, 3), int))
    with pytest.raises(ShapeError, match="shape"):
        Texture(np.zeros((2, 2)))
    with pytest.raises(RangeError, match="finite"):
        Texture(np.full((1, 1, 1), np.nan))
    with pytest.raises(RangeError, match="wrap"):
        Texture(np.zeros((1, 1, 1)), ("repeat", "never"))
    with pytest.raises(RangeError, match=r"textures\.color"):
        Material("lambert", {"albedo": [1.0] * 3}, {"color": TextureUse("t")})
    paint = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("t", 1)})
    with pytest.raises(SceneError, match="one of the scene's textures, got t"):
        wall(paint, {})
    with pytest.raises(SceneError, match=r"at least 4 channels, got 3 in 't'"):
        wall(paint, {"t": noise(2, 2)})
    ball = SphereShape("ball", np.zeros(3), 1.0, "wall")
    good = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("t")})
    with pytest.raises(SceneError, match=r"ball\.uv: expected texture coordinates"):
        Scene("s", (ball,), {"wall": good}, view(4), textures={"t": noise(2, 2)})
    tracer = PathTracer(wall(good, {"t": noise(2, 2)}, 4))
    tracer.params["textures.t"] = np.zeros((3, 2, 3))
    with pytest.raises(ShapeError, match="textures"):
        tracer.render(spp=1, seed=1)
