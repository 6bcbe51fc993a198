"""Pictures of glass and mirrors: the path tracer's, with derivatives that move the paths."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.caustics import discontinuities, specular_picture, specular_picture_backward
from photograd.caustics.lens import grid_faces
from photograd.caustics.picture import sky, sky_backward
from photograd.errors import RangeError, SceneError
from photograd.lights import PointLight
from photograd.transport import Material, MeshShape, PathOptions, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.caustics.all_lobes import SKY, Ball
from tests.caustics.test_lens import wavy

SIZE = 12
WEIGHTS = np.random.default_rng(0).uniform(0, 1, (SIZE, SIZE, 3)) / (3 * SIZE * SIZE)


def ball(eta: float = 1.5, y: float = 0.0, radius: float = 1.0) -> Scene:
    shape = SphereShape("ball", np.array([0, y, 0]), radius, "glass")
    glass = Material("glass", {"eta": eta, "tint": [1, 0.9, 0.8]})
    camera = camera_at([0, 0.2, 4], [0, 0, 0], 40, SIZE, SIZE)
    return Scene("ball", (shape,), {"glass": glass}, camera, SKY)


def loss(scene: Scene, spp: int, seed: int = 7) -> float:
    return float((specular_picture(scene, spp=spp, seed=seed) * WEIGHTS).sum())


def test_the_picture_is_the_path_tracers() -> None:
    options = PathOptions(max_depth=17)
    traced = PathTracer(ball(), dtype=np.float64).render(spp=256, seed=1, options=options)
    found = specular_picture(ball(), spp=256, seed=0)
    error = np.sqrt(np.square(traced.standard_error).sum()) * np.sqrt(2) / found.size
    assert abs((found - traced.mean).mean()) < 4 * error
    assert abs((found - traced.mean).mean()) < 2e-3
    assert found.std() > 0.1


def test_a_ball_has_whole_derivatives() -> None:
    """All lobes, free differences: the index, and inside of the rim the place and the size."""
    assert discontinuities(ball(), spp=32, seed=0) == []
    place = np.array([1.5, 0.0, 0.0, 0.0, 1.0])
    inside = Ball(40, 18.0)
    total, gradient = inside.mean(place)
    assert total > 0.3
    np.testing.assert_allclose(gradient, inside.differences(place, 1e-4), rtol=1e-5)
    whole = Ball(120, 40.0)
    h = 0.01 * np.eye(5)[0]
    difference = (whole.mean(place + h)[0] - whole.mean(place - h)[0]) / 0.02
    assert whole.mean(place)[1][0] == pytest.approx(difference, rel=0.01)


def test_held_paths_lack_a_part() -> None:
    """The derivative with respect to eta by the path tracer, which refuses it unless asked."""
    moved = specular_picture_backward(ball(), WEIGHTS, spp=512, seed=2)["materials.glass.eta"]
    tracer = PathTracer(ball(), dtype=np.float64, allow_incomplete=True)
    held = tracer.render_backward(WEIGHTS, spp=512, seed=1)["materials.glass.eta"]
    assert abs(float(held) - float(moved)) > 0.3 * abs(float(moved))


def mirror(t: float = 0.0) -> Scene:
    """A wavy mirror that fills the view; `t` raises one wave and bends its normals."""
    y, x = np.meshgrid(*[np.linspace(-2, 2, 41)] * 2, indexing="ij")
    heights = t * 0.1 * np.sin(2 * x + y)
    steep = t * 0.1 * np.cos(2 * x + y)
    vertices = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
    normals = np.stack([-2 * steep, -steep, np.ones_like(x)], axis=-1).reshape(-1, 3)
    shape = MeshShape("wall", vertices, grid_faces(41, 41), "mirror", normals=normals)
    materials = {"mirror": Material("mirror", {"reflectance": [0.9, 0.8, 0.7]})}
    camera = camera_at([0.1, 0.4, 1.5], [0, 0, 0], 40, SIZE, SIZE)
    return Scene("wall", (shape,), materials, camera, SKY)


def test_heights_and_normals_of_a_mirror_that_fills_the_view() -> None:
    assert discontinuities(mirror(0.5), spp=4, seed=0) == []
    found = specular_picture_backward(mirror(0.5), WEIGHTS, spp=16, seed=7)
    h = 0.01
    one, two = (mirror(0.5 + sign * h).shapes[0] for sign in (1, -1))
    assert isinstance(one, MeshShape)
    assert isinstance(two, MeshShape)
    along = {"vertices": one.vertices - two.vertices, "normals": one.normals - two.normals}  # type: ignore[operator]
    parts = {key: float((found[f"shapes.wall.{key}"] * d).sum()) for key, d in along.items()}
    difference = loss(mirror(0.5 + h), 16) - loss(mirror(0.5 - h), 16)
    assert sum(parts.values()) == pytest.approx(difference, rel=2e-3)  # rays that change triangles
    assert min(abs(part) for part in parts.values()) > 1e-7
    assert parts["normals"] != pytest.approx(difference, rel=0.001)


def test_the_sky_agrees_with_differences() -> None:
    rng = np.random.default_rng(1)
    report = check_gradient(
        lambda p: sky(SKY, p["d"]),
        lambda p, d: {"d": sky_backward(SKY, p["d"], d)},
        {"d": rng.normal(size=(20, 3))},
        seed=2,
    )
    assert report, str(report)


def slab() -> Scene:
    camera = camera_at([0.02, 0.16, 0.2], [0, 0.1, 0], 40, SIZE, SIZE)
    glass = Material("glass", {"eta": 1.5, "tint": [1, 1, 1]})
    return Scene("slab", (wavy().shape("lens", "glass"),), {"glass": glass}, camera, SKY)


def test_edges_that_are_seen_make_derivatives_incomplete() -> None:
    reasons = discontinuities(slab(), spp=8, seed=0)
    assert "an edge of 'lens' is seen" in reasons
    d_image = np.ones((SIZE, SIZE, 3))
    found = specular_picture_backward(slab(), d_image, spp=8, seed=0)
    assert len(found) == 0
    with pytest.raises(RangeError, match="an edge of 'lens' is seen"):
        found["materials.glass.eta"]
    labeled = specular_picture_backward(slab(), d_image, spp=8, seed=0, allow_incomplete=True)
    assert float(labeled["materials.glass.eta"]) != 0
    lens = slab().shapes[0]
    assert isinstance(lens, MeshShape)
    flat = replace(slab(), shapes=(replace(lens, normals=None),))
    assert "faces of 'lens' are flat" in discontinuities(flat, spp=4, seed=0)
    dull = Material("mirror", {"reflectance": [0.9] * 3})
    rim = replace(ball(), materials={"glass": dull})
    assert discontinuities(rim, spp=4, seed=0) == ["the rim of 'ball', which absorbs, is seen"]


def with_material(material: Material) -> Scene:
    return replace(ball(), materials={"glass": material})


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (with_material(Material("lambert", {"albedo": [0.5] * 3})), "glass or mirror"),
        (replace(ball(), environment=None), "an environment"),
        (replace(ball(), lights=(PointLight([0, 3, 0], [1.0] * 3),)), "no lights"),
    ],
)
def test_other_scenes_are_refused(scene: Scene, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        specular_picture(scene, spp=1, seed=0)
    with pytest.raises(SceneError, match=said):
        specular_picture_backward(scene, WEIGHTS, spp=1, seed=0)


@same_bits("pictures of glass")
def picture_and_gradients() -> list[Any]:
    found = specular_picture_backward(ball(), WEIGHTS, spp=4, seed=1)
    return [specular_picture(ball(), spp=4, seed=1), *found.values()]
