"""Signed distance functions in the path tracer: no ray passes them, none leaks, none is lost."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError
from photograd.geometry.sdf import (
    box,
    difference,
    intersection,
    placed,
    plane,
    smooth_union,
    sphere,
    torus,
    union,
)
from photograd.transport import (
    BOUNDARY,
    Accumulation,
    Environment,
    Material,
    Medium,
    PathOptions,
    PathTracer,
    Scene,
    SdfShape,
    SphereShape,
    Texture,
    TextureUse,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box as box_mesh
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.transport.scenes import (
    BLACK,
    GRAY,
    any_material,
    picture_and_gradients,
    rough_dielectric_stage,
    stage,
    view,
)
from tests.transport.test_adjoint import proof
from tests.transport.test_mip_textures import in_a_ball, swing

Array = Any
WHITE = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_white_body_cannot_be_seen(dtype: Any) -> None:
    # Every path off a convex white body ends in the sky of 1; one that met it again, or got in,
    # would end otherwise.
    options = PathOptions("bsdf", max_depth=2)
    for body in (sphere(1.0), box([0.7, 0.5, 0.6])):
        shape = SdfShape("body", placed(body, [0.3, -0.2, 0.1], [0.9, 0.3, 0.2, -0.1]), "white")
        camera = camera_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0, 24, 24)
        scene = Scene("w", (shape,), {"white": WHITE}, camera, Environment.constant(1.0))
        found = PathTracer(scene, dtype=dtype).render(spp=64, seed=2, options=options)
        np.testing.assert_allclose(found.mean, 1.0, rtol=2e-6 if dtype == np.float32 else 1e-12)


def as_sdf(scene: Scene) -> Scene:
    """The same scene with signed distance functions for its balls."""
    shapes = [
        SdfShape(s.name, placed(sphere(s.radius), s.center), s.material, interior=s.interior)
        if isinstance(s, SphereShape) and not s.emission.any()
        else s
        for s in scene.shapes
    ]
    assert any(isinstance(shape, SdfShape) for shape in shapes)
    return replace(scene, shapes=tuple(shapes))


def within_glass() -> Scene:
    glass = Material("glass", {"eta": 1.5, "tint": [0.9, 0.8, 1.0]})
    ball = SphereShape("ball", np.zeros(3), 1.0, "glass")
    sky = Environment(np.full(3, 1.0), np.full(3, 0.6), np.full(3, 0.2))
    return Scene("g", (ball,), {"glass": glass}, view(8, (0.1, 0, 0.2), (0, 0, -1)), sky)


def hollow_room() -> Scene:
    """A light and a camera in a hollow ball, whose inside reflects many times."""
    room = SphereShape("room", np.zeros(3), 1.0, "gray")
    lamp = SphereShape("lamp", np.array([0.3, 0.2, -0.5]), 0.15, "black", np.array([3.0, 2.0, 1.0]))
    camera = view(8, (0.2, 0.1, 0.6), (0, 0, -1))
    return Scene("r", (room, lamp), {"gray": GRAY, "black": BLACK}, camera)


def milk() -> Scene:
    scene = stage(GRAY, sky=0.4)
    white = Medium([3.0, 4.0, 5.0], [0.9, 0.95, 0.8], values={"g": 0.3})
    balls = [
        replace(s, material=BOUNDARY, interior="milk") if s.name == "ball" else s
        for s in scene.shapes
    ]
    return replace(scene, shapes=tuple(balls), media={"milk": white})


@pytest.mark.parametrize(
    "make",
    [
        lambda: stage(any_material("gltf"), sky=0.4),
        rough_dielectric_stage,
        lambda: stage(Material("glass", {"eta": 1.5, "tint": [0.9, 1.0, 0.95]}), sky=0.4),
        within_glass,
        hollow_room,
        milk,
    ],
)
def test_a_ball_looks_like_a_sphere(make: Any) -> None:
    scene, options = make(), PathOptions(max_depth=24, sampler="independent")
    a = PathTracer(scene).render(spp=1024, seed=1, options=options)
    b = PathTracer(as_sdf(scene)).render(spp=1024, seed=2, options=options)
    assert a.mean.mean() > 0.05
    error = np.sqrt(a.standard_error**2 + b.standard_error**2)
    gap = b.mean - a.mean
    # False alarm: 6e-5 for the whole, and 1e-4 for the worst of 192 numbers at 5 errors.
    assert abs(gap.sum()) < 4 * np.sqrt((error**2).sum())
    assert np.abs(gap[error > 0] / error[error > 0]).max() < 5


def test_no_light_leaks_through_a_shell() -> None:
    # A thin shell with creases in the dark: outside it is bright, inside nothing shines.
    inside = union(sphere(0.9), placed(box([0.5] * 3), [0.6, 0.4, 0.0], [0.9, 0.2, 0.3, 0.1]))
    outside = union(sphere(0.92), placed(box([0.52] * 3), [0.6, 0.4, 0.0], [0.9, 0.2, 0.3, 0.1]))
    shell = SdfShape("shell", difference(outside, inside), "gray")
    for target in ([1, 1, 1], [-1, -1, 1], [1, 0.3, -0.2]):
        camera = camera_at([0, 0.1, 0], target, 80.0, 16, 16)
        scene = Scene("s", (shell,), {"gray": GRAY}, camera, Environment.constant(1e6))
        assert not PathTracer(scene).render(spp=32, seed=8).radiance.any()


def busy() -> Scene:
    """Bodies, a mesh and a sphere that overlap, a light among them."""
    grown = placed(smooth_union(sphere(0.3), box([0.5, 0.1, 0.2]), 0.2), [-0.5, 0.3, 0.3])
    ring = placed(torus(0.35, 0.1), [0.5, 0.5, 0.2], [0.8, 0.5, 0.1, 0.2])
    scene = stage(any_material("gltf"), size=6, sky=0.3)
    shapes = (SdfShape("grown", grown, "shiny"), *scene.shapes, SdfShape("ring", ring, "glass"))
    materials = {
        **scene.materials,
        "shiny": any_material("ggx_metal"),
        "glass": Material("rough_dielectric", {"eta": 1.5, "roughness": 0.4}),
    }
    return replace(scene, shapes=shapes, materials=materials)


def test_derivatives_by_materials_of_bodies() -> None:
    function, backward, start = proof(busy())
    report = check_gradient(function, backward, start, seed=2, coordinates=2, directions=3)
    assert report, str(report)


@same_bits("path tracing of SDFs")
def picture_and_gradients_of_bodies() -> list[Any]:
    return picture_and_gradients(replace(busy(), camera=view(24)), 4)


def test_boxes_are_derived() -> None:
    ring = SdfShape(
        "r", placed(torus(0.5, 0.1), [1, 2, 3], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)]), "m"
    )
    np.testing.assert_allclose(ring.box, [[0.9, 1.4, 2.4], [1.1, 2.6, 3.6]], atol=1e-5)
    cut = SdfShape("c", intersection(sphere(1.0), plane([0, 2, 0], 0.2)), "m")
    np.testing.assert_allclose(cut.box, [[-1, -1, -1], [1, 0.2, 1]], atol=1e-5)


def test_what_is_no_solid_is_refused() -> None:
    cases: list[tuple[type[Exception], str, Any]] = [
        (SceneError, "an end on all sides", lambda: SdfShape("s", plane([0, 1, 0], 0.0), "m")),
        (
            SceneError,
            "nothing is left of it",
            lambda: SdfShape("s", intersection(sphere(1), placed(sphere(1), [3, 0, 0])), "m"),
        ),
        (
            SceneError,
            r"s\.body: expected a shape of photograd\.geometry",
            lambda: SdfShape("s", SphereShape("t", np.zeros(3), 1.0, "m"), "m"),
        ),  # type: ignore[arg-type]
        (
            SceneError,
            r"s\.emission: expected 0, got .*let a mesh or a sphere shine",
            lambda: SdfShape("s", sphere(1), "m", np.ones(3)),
        ),
        (RangeError, r"s\.emission", lambda: SdfShape("s", sphere(1), "m", -np.ones(3))),
    ]
    for error, words, call in cases:
        with pytest.raises(error, match=words):
            call()
    painted = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("paint")})
    with pytest.raises(SceneError, match=r"s\.uv: expected texture coordinates"):
        Scene(
            "s",
            (SdfShape("s", sphere(1), "m"),),
            {"m": painted},
            view(4),
            textures={"paint": Texture(np.ones((2, 2, 3)))},
        )


def test_other_views_of_a_scene_see_bodies() -> None:
    # Ambient occlusion in a corner of a box of triangles and one of distances.
    near = (
        box_mesh("a", [0, -1, 0], [4, 2, 4], "gray"),
        box_mesh("b", [0.0, 0.5, -1], [1, 1, 1], "gray"),
    )
    far = tuple(
        SdfShape(s.name, placed(box((s.box[1] - s.box[0]) / 2), s.box.mean(axis=0)), "gray")
        for s in near
    )
    pictures = []
    for seed, shapes in enumerate((near, far)):
        tracer = PathTracer(Scene("c", shapes, {"gray": GRAY}, view(8)))
        sums = Accumulation.empty(8, 8)
        tracer.add_occlusion(sums, 1024, seed=seed, radius=1.0)
        pictures.append(sums)
    a, b = pictures
    error = np.sqrt(a.standard_error**2 + b.standard_error**2)
    assert 0.6 < a.mean.mean() < 0.98
    assert (np.abs(a.mean - b.mean) <= 5 * error + 1e-12).all()


def test_a_cone_goes_on_behind_a_mirror_that_is_a_body() -> None:
    scene = in_a_ball(0.0)  # seen in a flat mirror
    body = placed(box([1.0, 1.0, 0.5]), [0.0, 0.0, 0.5])
    shapes = (scene.shapes[0], SdfShape("mirror", body, "mirror"))
    found = swing(replace(scene, shapes=shapes), PathOptions("light", max_depth=3))
    assert found == pytest.approx(1 - np.log2(1.5), abs=0.06)
