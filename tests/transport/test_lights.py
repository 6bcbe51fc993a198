"""Lights of a list in a path tracer: closed forms, strategies, turning, choice, what may change."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import SceneError, ShapeError
from photograd.lights import (
    ConstantLight,
    DirectionalLight,
    EnvironmentMap,
    PointLight,
    QuadLight,
    SkyLight,
    SpotLight,
)
from photograd.transport import (
    Accumulation,
    Environment,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle

from support.statistics import chi_square_p
from tests.transport.light_scenes import LIGHTS, TILT, environment_map, lit_by, texels
from tests.transport.scenes import FLOOR, GRAY, any_material, view
from tests.transport.test_strategies import assert_same_mean

POINT = np.array([0.5, 0.0, 0.3])


def pixel_of_floor(light: Any, *blockers: Any, spp: int = 4, strategy: str = "mis") -> Accumulation:
    """What a pixel of 0.01 degrees sees of a floor of albedo 0.5 in POINT, by direct light."""
    shapes = (rectangle("floor", *FLOOR, "gray"), *blockers)
    camera = camera_at([0.5, 1.0, 2.5], POINT, 0.01, 1, 1)
    scene = Scene("pixel", shapes, {"gray": GRAY}, camera, lights=(light,))
    options = PathOptions(strategy, max_depth=2)
    return PathTracer(scene, dtype=np.float64).render(spp=spp, seed=1, options=options)


def smooth(t: float) -> float:
    return t * t * (3 - 2 * t)


@pytest.mark.parametrize("strategy", ["light", "bsdf", "mis"])
def test_delta_lights_in_closed_form(strategy: str) -> None:
    # Radiance 0.5 / pi times irradiance; no strategy may give a delta light a weight below 1.
    place, color = np.array([0.9, 1.5, 0.8]), np.array([5.0, 4.0, 3.0])
    to = place - POINT
    r = float(np.linalg.norm(to))
    from_point = color * to[1] / r**3
    axis = np.array([-0.4, -1.0, -0.1])
    c = float(-to @ axis / r / np.linalg.norm(axis))
    t = (c - 0.85) / (0.9 * (1 - 0.85))
    assert 0.1 < t < 0.9
    sun = np.array([0.3, 0.8, 0.2])
    for light, irradiance in (
        (PointLight(place, color), from_point),
        (SpotLight(place, axis, color, 0.85, 0.9), from_point * smooth(t)),
        (DirectionalLight(sun, color), color * sun[1] / np.linalg.norm(sun)),
    ):
        found = pixel_of_floor(light, strategy=strategy)
        # The pixel is 0.4 mm wide: 1e-3 of the distance of the light at most.
        np.testing.assert_allclose(found.mean[0, 0], 0.5 / np.pi * irradiance, rtol=2e-3)


def test_delta_lights_cast_shadows() -> None:
    far = DirectionalLight([0.0, 1.0, 0.0], [1.0, 1.0, 1.0])
    near = PointLight([0.5, 1.0, 0.3], [1.0, 1.0, 1.0])
    for height, dark_far, dark_near in ((0.6, True, True), (1.4, True, False)):
        roof = rectangle("roof", [0.3, height, 0.5], [0.4, 0, 0], [0, 0, -0.4], "gray")
        assert pixel_of_floor(far, roof).mean.any() != dark_far
        assert pixel_of_floor(near, roof).mean.any() != dark_near


@pytest.mark.parametrize("name", LIGHTS)
def test_light_bsdf_and_both_agree(name: str) -> None:
    tracer = PathTracer(lit_by(*LIGHTS[name]))
    found = [
        tracer.render(
            spp=1024 if strategy == "bsdf" else 384,
            seed=seed,
            options=PathOptions(strategy, max_depth=4, roulette_from=None),
        )
        for seed, strategy in enumerate(("light", "bsdf", "mis"))
    ]
    assert found[2].mean.mean() > 0.01
    # Few paths meet the sun by chance, or the bright spot of a map.
    power = 0.4 if name in ("sun", "all") else 0.15
    for other in found[:2]:
        assert_same_mean(found[2], other, 2 * len(LIGHTS), power)


def turned(scene: Scene, world_from_old: Any) -> Scene:
    """Everything turned about the origin: shapes, camera, maps."""
    shapes: list[Any] = []
    for shape in scene.shapes:
        if isinstance(shape, MeshShape):
            shapes.append(replace(shape, vertices=shape.vertices @ world_from_old.T))
        else:
            assert isinstance(shape, SphereShape)
            shapes.append(replace(shape, center=world_from_old @ shape.center))
    pose = scene.camera.world_from_camera.copy()
    pose[:3] = world_from_old @ pose[:3]
    lights: list[Any] = []
    for light in scene.lights:
        assert isinstance(light, EnvironmentMap)
        lights.append(
            EnvironmentMap(light.texels, world_from_old @ light.world_from_map, light.uniform_share)
        )
    camera = replace(scene.camera, world_from_camera=pose)
    return replace(scene, shapes=tuple(shapes), camera=camera, lights=tuple(lights))


def test_turning_map_and_scene_together_changes_nothing() -> None:
    scene = lit_by(environment_map())
    options = PathOptions(max_depth=4)
    straight = PathTracer(scene).render(spp=1024, seed=1, options=options)
    together = PathTracer(turned(scene, TILT)).render(spp=1024, seed=2, options=options)
    assert_same_mean(straight, together, 2, 0.1)
    alone = PathTracer(lit_by(environment_map(turn=TILT))).render(spp=1024, seed=3, options=options)
    with pytest.raises(AssertionError):
        assert_same_mean(straight, alone, 2, 0.1)


def test_a_map_of_one_color_is_an_even_sky() -> None:
    plain = EnvironmentMap(np.full((4, 8, 3), 0.8))
    a = PathTracer(lit_by(plain)).render(spp=512, seed=1)
    sky = Environment.constant(0.8)
    b = PathTracer(lit_by(environment=sky)).render(spp=512, seed=2)
    assert_same_mean(a, b, 1, 0.1)


def test_lights_at_infinity_add_up() -> None:
    # Each alone and all together: light is linear, and their densities are mixed rightly.
    parts = [LIGHTS[name][0] for name in ("sky", "sun", "map")]
    options = PathOptions(max_depth=3, roulette_from=None)
    whole = PathTracer(lit_by(*parts)).render(spp=1536, seed=1, options=options)
    alone = [
        PathTracer(lit_by(part)).render(spp=512, seed=2 + i, options=options)
        for i, part in enumerate(parts)
    ]
    total = Accumulation.empty(8, 8)
    total.count = 512
    total.radiance = sum((found.radiance for found in alone), np.zeros((8, 8, 3)))
    variance = sum((found.standard_error**2 for found in alone), np.zeros((8, 8, 3)))
    total.squares = 512 * (total.mean**2 + variance * 511)
    assert_same_mean(whole, total, 1, 0.15)


def test_a_lamp_of_the_list_is_a_lamp_of_the_scene() -> None:
    corner, u, v, color = [-0.5, 1.5, -0.5], [1.0, 0, 0], [0, 0, 1.0], [4.0, 3.0, 2.0]
    listed = lit_by(QuadLight(corner, u, v, color))
    black = any_material("lambert", 0.0)
    lamp = rectangle("lamp", corner, u, v, "black", color)
    shape = replace(
        lit_by(), shapes=(*lit_by().shapes, lamp), materials={**lit_by().materials, "black": black}
    )
    a, b = (PathTracer(scene).render(spp=16, seed=3) for scene in (listed, shape))
    np.testing.assert_array_equal(a.radiance, b.radiance)
    assert a.radiance.any()


def test_rectangles_are_sampled_by_solid_angle() -> None:
    # Close under a light 1 / d^2 varies: points even over the area are noisier than directions.
    lamp = np.array([[-0.6, 0.25, -0.6], [0.6, 0.25, -0.6], [0.6, 0.25, 0.6], [-0.6, 0.25, 0.6]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    noise = []
    for bend in (0.0, 1e-4):  # a bent one is two triangles
        corners = lamp + np.array([0, bend, 0]) * np.array([[0.0], [0], [0], [1]])
        light = MeshShape("lamp", corners, faces, "gray", np.ones(3))
        found = pixel_of_floor(ConstantLight([0.0, 0.0, 0.0]), light, spp=4096, strategy="light")
        noise.append(found.standard_error.max())
        assert found.mean.min() > 0.05
    assert noise[0] < 0.7 * noise[1]


def powers(scene: Scene) -> Any:
    """Of the lights of `LIGHTS["all"]`, by formulas of their own; then of what emits as a shape."""
    lo, hi = np.full(3, np.inf), np.full(3, -np.inf)
    tracer = PathTracer(scene)
    for shape in tracer.core_shapes:
        if isinstance(shape, MeshShape):
            low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
        else:
            low, high = shape.center - shape.radius, shape.center + shape.radius
        lo, hi = np.minimum(lo, low), np.maximum(hi, high)
    x, y, z = hi - lo
    shadow = np.array([y * z, z * x, x * y])

    def bright(color: Any) -> float:
        return float(np.asarray(color) @ [0.2126, 0.7152, 0.0722])

    def at_infinity(light: Any) -> float:
        h, a = np.meshgrid(
            (np.arange(200) + 0.5) / 100 - 1, 2 * np.pi * (np.arange(100) + 0.5) / 100
        )
        side = np.sqrt(1 - h * h)
        w = np.stack([np.cos(a) * side, h, np.sin(a) * side], axis=-1).reshape(-1, 3)
        mean = light.L(np.zeros_like(w), w).mean(axis=0)
        return 4 * math.pi * bright(mean) * shadow.sum() / 2

    point, spot, sun = (LIGHTS[name][0] for name in ("point", "spot", "directional"))
    c = np.linspace(-1, 1, 200001)
    t = np.clip((c - 0.75) / (0.6 * 0.25), 0, 1)
    cone = 2 * math.pi * float(np.trapezoid(t * t * (3 - 2 * t), c))
    assert isinstance(point, PointLight)
    assert isinstance(spot, SpotLight)
    assert isinstance(sun, DirectionalLight)
    found = [
        4 * math.pi * bright(point.intensity),
        cone * bright(spot.intensity),
        bright(sun.irradiance) * float(shadow @ np.abs(sun.direction)),
        *(at_infinity(LIGHTS[n][0]) for n in ("ambient", "sky")),
        2 * math.pi * 0.03 * bright([25.0, 20.0, 15.0]) * shadow.sum() / 2,  # cap of height 0.03
        *(at_infinity(LIGHTS[n][0]) for n in ("map", "turned map")),
        math.pi * 1.0 * bright([3.0, 2.5, 2.0]),
    ]
    a, b, corner = (np.array(x) for x in ([-0.7, 1.5, -0.4], [0.8, 1.4, -0.5], [0.1, 1.6, 0.9]))
    area = 0.5 * np.linalg.norm(np.cross(b - a, corner - a))
    found.append(math.pi * area * bright([5, 4, 3]))
    found.append(math.pi * 4 * math.pi * 0.3**2 * bright([6.0, 5.0, 4.0]))
    return np.array(found)


def test_lights_are_chosen_by_power() -> None:
    scene = lit_by(*LIGHTS["all"])
    tracer = PathTracer(scene)
    expected = powers(scene)
    entries, pmf = tracer._geometry.choose_lights(np.random.default_rng(5).random(200_000))
    listed = 8
    least = 0.01 * expected.sum() / listed
    expected[:listed] = np.maximum(expected[:listed], least)
    share = expected / expected.sum()
    counts = np.bincount(entries, minlength=len(expected))
    assert len(counts) == len(expected) == 8 + 1 + 1 + 1
    # Sums over a grid stand for integrals.
    np.testing.assert_allclose(pmf, share[entries], rtol=0.02)
    exact = np.zeros(len(expected))
    exact[entries] = pmf
    assert exact.sum() == pytest.approx(1.0, abs=1e-9)  # all have been drawn
    assert chi_square_p(counts, exact) > 1e-3
    assert chi_square_p(counts, np.roll(exact, 1)) < 1e-9


def test_what_was_dark_may_shine_later() -> None:
    # Built dark and lit later: lights are chosen badly, and the picture is right all the same.
    point, sky = PointLight([0.8, 1.6, 0.9], [0, 0, 0]), SkyLight(*np.zeros((3, 3)))
    lights = point, sky, EnvironmentMap(np.zeros((6, 12, 3)))
    late = PathTracer(lit_by(*lights, LIGHTS["rectangle"][0]))
    bright: Any = (LIGHTS["point"][0], LIGHTS["sky"][0], LIGHTS["map"][0], LIGHTS["rectangle"][0])
    soon = PathTracer(lit_by(*bright))
    assert list(late.params) == list(soon.params)
    late.params = {name: value.copy() for name, value in soon.params.items()}
    for strategy in ("mis", "bsdf"):  # asking alone finds the bright spot too rarely for a test
        options = PathOptions(strategy, max_depth=3)
        a = soon.render(spp=512, seed=1, options=options)
        b = late.render(spp=4096, seed=2, options=options)
        assert_same_mean(a, b, 2, 0.3)


def test_what_is_no_light_is_named() -> None:
    with pytest.raises(SceneError, match=r"lights\[1\]: expected a light"):
        lit_by(LIGHTS["point"][0], "sun")  # type: ignore[arg-type]
    tracer = PathTracer(lit_by(environment_map()))
    tracer.params["lights.0.texels"] = texels(4)
    with pytest.raises(ShapeError, match="texels"):
        tracer.render(spp=1, seed=1)
    with pytest.raises(SceneError, match="a light without a surface, got quad"):
        _core.PathGeometry(
            [],
            np.zeros(0, np.int32),
            np.zeros((0, 3, 4)),
            np.ones((1, 4), np.float32),
            np.zeros(1, np.int32),
            np.zeros((1, 3)),
            [("quad", np.ones(3), np.ones(9))],
        )


def test_a_view_of_the_sky_alone_is_the_map() -> None:
    # No shape in sight: a ray sees the map itself, whatever the strategy.
    light = environment_map(turn=TILT)
    scene = replace(lit_by(light), camera=view(8, (0, 3, 0), (0.3, 9, -1)))
    for strategy in ("light", "bsdf", "mis"):
        tracer = PathTracer(scene, dtype=np.float64)
        found = tracer.path(5, 0, seed=1, options=PathOptions(strategy))
        w = np.array([found[0]["direction"]])
        np.testing.assert_allclose(found[0]["Le"], light.L(np.zeros((1, 3)), w)[0], rtol=1e-12)
        assert found[0]["emission_weight"] == 1.0
