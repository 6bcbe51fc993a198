"""Shapes that move while the shutter is open: a picture is the mean of still ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError, ShapeError
from photograd.geometry.sdf import sphere
from photograd.transport import (
    Accumulation,
    Environment,
    IrradianceSensor,
    Material,
    MeshShape,
    NormalMap,
    PathOptions,
    PathTracer,
    PhotonMap,
    Scene,
    SdfShape,
    Shutter,
    SphereShape,
    Texture,
    TextureUse,
    bake_ambient_occlusion,
    emit_particles,
    read_scene,
    trace_light,
)
from photograd.transport.builtin import camera_at
from photograd.transport.mesh_files import save_gltf
from photograd.transport.motion import moved_on
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.transport.scenes import BLACK, GRAY, any_material, stage, view
from tests.transport.test_adjoint import OPTIONS, proof
from tests.transport.test_derivative import check
from tests.transport.test_instances import dome, place

Array = Any
START, END = place(-0.7, 0.2, 0.3, [1, 1, 1]), place(-0.2, -0.3, 1.1, [1.2, 0.9, 1.0])
BALL_END = np.array([0.5, 0.7, -0.2])


def moving(size: int = 8, *, alpha: bool = False) -> Scene:
    """A dome with normals and a texture that moves, turns and stretches, and a ball that flies."""
    values = np.random.default_rng(1).uniform(0.1, 0.9, (16, 24, 3))
    paint = Texture(values, filter="mip")
    given = {"base_color": [1.0] * 3, "metalness": 0.3, "roughness": 0.4}
    tilt = NormalMap(np.broadcast_to([0.2, 0.1, 1.0], (2, 2, 3)).copy())
    gloss = Material("gltf", given, {"base_color": TextureUse("paint")}, tilt)
    veil = Material("lambert", {"albedo": [0.8, 0.6, 0.4], "alpha": 0.6})
    vertices, faces, normals, uv = dome()
    mesh = MeshShape(
        "dome",
        vertices,
        faces,
        "gloss",
        normals=normals,
        uv=uv,
        instances=(START,),
        closing_instances=(END,),
    )
    scene = stage(any_material("ggx_metal"), size=size, sky=0.3)
    ball = SphereShape(
        "flying", np.array([0.5, 0.25, 0.5]), 0.25, "veil" if alpha else "ball", closing=BALL_END
    )
    still = SphereShape("still", np.array([0.8, 0.2, 0.8]), 0.2, "floor")
    shapes = (mesh, ball, still, *(s for s in scene.shapes if s.name != "ball"))
    materials = {**scene.materials, "gloss": gloss, "veil": veil}
    del materials["ball" if alpha else "veil"]
    return replace(scene, shapes=shapes, materials=materials, textures={"paint": paint})


def at(scene: Scene, s: float) -> Scene:
    """The scene at a moment, standing still."""
    shapes = []
    for shape in scene.shapes:
        if isinstance(shape, MeshShape) and shape.closing_instances:
            here = (1 - s) * shape.instances[0] + s * shape.closing_instances[0]
            shapes.append(replace(shape, instances=(here,), closing_instances=()))
        elif isinstance(shape, SphereShape) and shape.closing is not None:
            here = (1 - s) * shape.center + s * shape.closing
            shapes.append(replace(shape, center=here, closing=None))
        else:
            shapes.append(shape)
    return replace(scene, shapes=tuple(shapes))


@pytest.mark.parametrize("alpha", [False, True])
def test_a_picture_is_the_mean_of_still_ones(alpha: bool) -> None:
    scene, options = moving(alpha=alpha), PathOptions(max_depth=4, sampler="independent")
    blurred = PathTracer(scene).render(spp=1536, seed=1, options=options)
    mean, variance, count = np.zeros((8, 8, 3)), np.zeros((8, 8, 3)), 48
    for number in range(count):
        tracer = PathTracer(at(scene, (number + 0.5) / count))
        one = tracer.render(spp=32, seed=100 + number, options=options)
        mean += one.mean / count
        variance += (one.standard_error / count) ** 2
    error = np.sqrt(variance + blurred.standard_error**2)
    gap = blurred.mean - mean
    # False alarm: 6e-5 for the whole, and 1e-4 for the worst of 192 numbers at 5 errors.
    assert abs(gap.sum()) < 4 * np.sqrt((error**2).sum())
    assert np.abs(gap / error).max() < 5
    still = PathTracer(at(scene, 0.0)).render(spp=512, seed=2, options=options)
    assert np.abs((still.mean - mean) / error).max() > 10


def test_a_camera_that_flies_along_sees_no_blur() -> None:
    # Ball and camera move alike, at the same moments or the picture would be blurred.
    way = np.array([0.7, 0.2, -0.3])
    camera = camera_at([0, 0, 4], [0, 0, 0], 40.0, 24, 24)
    end = camera.world_from_camera.copy()
    end[:3, 3] += way
    ball = SphereShape("ball", np.zeros(3), 1.0, "black", closing=way)
    sky = Environment.constant(1.0)
    scene = Scene("f", (ball,), {"black": BLACK}, camera, sky, shutter=Shutter(end))
    still = replace(scene, shapes=(replace(ball, closing=None),), shutter=None)
    a, b = (PathTracer(s).render(spp=64, seed=1).mean for s in (scene, still))
    assert 0.2 < b.mean() < 0.9
    assert np.abs(a - b).max() <= 1 / 64 + 1e-6  # at the rim, a sample may round the other way
    assert np.mean(a != b) < 0.02
    unlike = replace(scene, shutter=None)
    assert np.abs(PathTracer(unlike).render(spp=64, seed=1).mean - b).max() > 0.3


def test_what_moves_nowhere_takes_the_same_picture() -> None:
    scene = at(moving(), 0.3)
    told = [
        replace(s, closing_instances=s.instances)
        if isinstance(s, MeshShape) and s.instances
        else replace(s, closing=s.center)
        if isinstance(s, SphereShape)
        else s
        for s in scene.shapes
    ]
    a, b = (
        PathTracer(s).render(spp=4, seed=3).radiance
        for s in (scene, replace(scene, shapes=tuple(told)))
    )
    assert a.any()
    np.testing.assert_array_equal(a, b)


def test_derivatives_see_the_same_moments() -> None:
    function, backward, start = proof(moving(6, alpha=True), OPTIONS)
    report = check_gradient(function, backward, start, seed=2, coordinates=2, directions=3)
    assert report, str(report)


@same_bits("shapes that move")
def picture_of_moving_shapes() -> list[Any]:
    return [PathTracer(moving(24)).render(spp=4, seed=3).radiance]


def test_boxes_hold_the_whole_way() -> None:
    dome_shape, ball = moving().shapes[:2]
    for s in np.linspace(0, 1, 5):
        for shape, now in zip((dome_shape, ball), at(moving(), s).shapes[:2], strict=True):
            assert (shape.box[0] <= now.box[0] + 1e-9).all()
            assert (shape.box[1] >= now.box[1] - 1e-9).all()


def test_what_cannot_move_is_refused() -> None:
    vertices, faces, *_ = dome()
    about = np.diag([-1.0, 1, -1, 1])  # half a turn about Y: flat in the middle

    def mesh(**more: Any) -> MeshShape:
        return MeshShape("d", vertices, faces, "gray", **more)

    with pytest.raises(
        RangeError, match=r"d\.closing_instances: expected a positive determinant at"
    ):
        mesh(closing_instances=(about,))
    with pytest.raises(RangeError, match="a positive determinant"):
        mesh(closing_instances=(np.diag([1.0, 1, -1, 1]),))
    with pytest.raises(ShapeError, match="2, one for each instance"):
        mesh(instances=(START, END), closing_instances=(END,))
    with pytest.raises(ShapeError, match=r"b\.closing: expected shape \(3,\)"):
        SphereShape("b", np.zeros(3), 1.0, "gray", closing=np.zeros(2))
    scene = moving()
    ball = next(s for s in scene.shapes if s.name == "flying")
    lit = [replace(s, emission=np.ones(3)) if s is ball else s for s in scene.shapes]
    with pytest.raises(SceneError, match=r"flying\.emission: expected lights that stand still"):
        replace(scene, shapes=tuple(lit))
    body = SdfShape("s", sphere(1.0), "gray")
    with pytest.raises(SceneError, match=r"s\.closing: expected a mesh or a sphere"):
        moved_on(body, END)


def test_who_wants_shapes_that_stand_still_says_so(tmp_path: Path) -> None:
    scene = moving()
    tracer = PathTracer(scene)
    wall = IrradianceSensor([0, 0, 0], [1, 0, 0], [0, 0, 1], 2, 2)
    calls: dict[str, Callable[[], Any]] = {
        "add_occlusion": lambda: tracer.add_occlusion(Accumulation.empty(8, 8), 1, seed=1),
        "bake_ambient_occlusion": lambda: bake_ambient_occlusion(scene, "dome", 4, seed=1),
        "emit_particles": lambda: emit_particles(tracer, 4, seed=1),
        "trace_light": lambda: trace_light(tracer, wall, 4, seed=1),
        "PhotonMap": lambda: PhotonMap(tracer, 4, radius=0.1, seed=1),
    }
    for name, call in calls.items():
        words = rf"^{name}: scene\.shapes: expected shapes that stand still, got 'dome', which"
        with pytest.raises(SceneError, match=words):
            call()
    with pytest.raises(SceneError, match="shape 'dome' moves while the shutter is open"):
        save_gltf(replace(scene, shapes=scene.shapes[:1]), tmp_path / "s.glb")


def test_derivative_pictures_see_the_same_moments() -> None:
    check(moving(6, alpha=True), without=("materials.black.albedo",))


TEXT = """
[camera]
position = [0, 1, 4]
look_at = [0, 0, 0]
field_of_view = 40
size = [4, 4]
[environment]
radiance = 1
[materials.gray]
model = "lambert"
albedo = [0.5, 0.5, 0.5]
[[shapes]]
kind = "sphere"
center = [0, 0, 0]
radius = 1
material = "gray"
closing = { translate = [1, 2, 3] }
[[shapes]]
kind = "box"
center = [2, 0, 0]
size = [1, 1, 1]
material = "gray"
closing = { rotate = [0, 30, 0], translate = [0, 1, 0] }
"""


def test_scene_files_say_how_shapes_move(tmp_path: Path) -> None:
    path = tmp_path / "s.toml"
    path.write_text(TEXT)
    ball, box = read_scene(path).shapes
    assert isinstance(ball, SphereShape)
    assert isinstance(box, MeshShape)
    np.testing.assert_array_equal(ball.closing, [1, 2, 3])
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    expected = [[c, 0, s, 0], [0, 1, 0, 1], [-s, 0, c, 0], [0, 0, 0, 1]]
    np.testing.assert_allclose(box.closing_instances[0], expected, atol=1e-15)
    for old, new, line, words in (
        ("translate = [1, 2, 3]", "translate = [1, 2]", 17, "shapes.0.closing.translate"),
        ("translate = [1, 2, 3]", "shift = [1, 2, 3]", 17, "shapes.0.closing.shift"),
        ("translate = [1, 2, 3]", "rotate = [0, 9, 0]", 17, "by translate alone"),
        ("rotate = [0, 30, 0]", "rotate = [0, 180, 0]", 23, "at every moment"),
        ("closing = { rotate", "emission = 1\nclosing = { rotate", 12, "lights that stand still"),
    ):
        path.write_text(TEXT.replace(old, new))
        with pytest.raises(SceneError) as caught:
            read_scene(path)
        assert words in str(caught.value)
        if line != 12:
            assert f"line {line}:" in str(caught.value), str(caught.value)


def test_gray_stays_gray() -> None:
    # A white ball in flight under an even sky cannot be seen.
    ball = SphereShape("b", np.zeros(3), 0.5, "white", closing=np.array([0.4, 0.2, 0.1]))
    white = Material("lambert", {"albedo": [1.0, 1.0, 1.0]})
    scene = Scene("w", (ball,), {"white": white, "gray": GRAY}, view(8), Environment.constant(1.0))
    found = PathTracer(scene).render(spp=32, seed=2, options=PathOptions("bsdf"))
    np.testing.assert_allclose(found.mean, 1.0, rtol=2e-6)
