"""Descriptions: what they hold, and that each mistake gets one typed sentence."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.scenes import SceneDescription, SceneMesh, SkyDescription, SunDescription, bounds_of
from photograd_course.errors import DtypeError, Error, RangeError, SceneError, ShapeError

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], dtype=np.float32)
FACES = np.array([[0, 1, 2], [1, 3, 2]], dtype=np.uint32)
GRAY = np.full(3, 0.5, dtype=np.float32)
UV = VERTICES[:, :2].copy()
TEXTURE = np.full((2, 3, 3), 0.25, dtype=np.float32)
UP = np.array([0.0, 1.0, 0.0])


def mesh(**members: Any) -> SceneMesh:
    return SceneMesh(**{"vertices": VERTICES, "faces": FACES, "albedo": GRAY} | members)


def sky() -> SkyDescription:
    return SkyDescription(UP, UP, UP)


def scene(**members: Any) -> SceneDescription:
    given = {
        "name": "test",
        "meshes": (mesh(),),
        "sun": SunDescription(UP, UP, 0.05),
        "sky": sky(),
        "bounds": np.array([[-1.0] * 3, [2.0] * 3]),
    }
    return SceneDescription(**given | members)


def test_three_kinds_of_albedo() -> None:
    assert mesh().albedo_kind == "constant"
    colors = np.full((4, 3), 0.1, dtype=np.float32)
    assert mesh(albedo=colors).albedo_kind == "vertices"
    assert mesh(albedo=TEXTURE, uv=UV).albedo_kind == "texture"


def test_descriptions_own_their_arrays() -> None:
    vertices = VERTICES.copy()
    described = mesh(vertices=vertices)
    vertices[0] = 9.0
    np.testing.assert_array_equal(described.vertices, VERTICES)
    with pytest.raises(ValueError, match="read-only"):
        described.vertices[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        scene().bounds[0] = 1.0


@pytest.mark.parametrize(
    ("members", "error", "text"),
    [
        ({"vertices": VERTICES.astype(np.float64)}, DtypeError, "vertices: expected float32, got"),
        (
            {"vertices": VERTICES[:, :2]},
            ShapeError,
            r"vertices: expected shape \(V, 3\) with V >= 1",
        ),
        ({"vertices": VERTICES[:0]}, ShapeError, "vertices"),
        ({"vertices": VERTICES * np.float32(np.nan)}, RangeError, "in row 0"),
        ({"faces": FACES.astype(np.float32)}, DtypeError, "faces: expected integers"),
        ({"faces": FACES[:0]}, ShapeError, "faces"),
        ({"faces": FACES + np.uint32(2)}, RangeError, "indices below V = 4, got 5"),
        ({"faces": FACES[:, [0, 1, 1]]}, SceneError, r"2 without, first faces\[0\]"),
        ({"vertices": VERTICES * np.float32([1, 0, 0])}, SceneError, "triangles with an area"),
        ({"albedo": GRAY * 3}, RangeError, r"albedo: expected finite numbers in \[0, 1\], got 1.5"),
        ({"albedo": -GRAY}, RangeError, "albedo"),
        ({"albedo": GRAY * np.float32(np.inf)}, RangeError, "finite"),
        ({"albedo": GRAY[:2]}, ShapeError, r"\(V, 3\) or \(H, W, 3\) with V = 4 as in"),
        ({"albedo": TEXTURE[:0], "uv": UV}, ShapeError, "albedo"),
        ({"albedo": np.ones(3)}, DtypeError, "albedo"),
        ({"albedo": TEXTURE}, SceneError, "a texture needs coordinates"),
        ({"albedo": TEXTURE, "uv": UV[:3]}, ShapeError, r"uv: expected shape \(V, 2\) with V = 4"),
        ({"uv": UV.astype(np.float64)}, DtypeError, "uv"),
    ],
)
def test_bad_meshes_are_refused(members: dict[str, Any], error: type[Error], text: str) -> None:
    with pytest.raises(error, match=f"SceneMesh: .*{text}"):
        mesh(**members)


def test_the_sun_by_its_irradiance() -> None:
    """Integrate the disc's radiance times the cosine on a fine net of directions."""
    given = np.array([3.0, 2.0, 1.0])
    sun = SunDescription.from_irradiance(np.array([0.0, 3.0, 4.0]), given, 0.3)
    np.testing.assert_allclose(sun.direction, [0.0, 0.6, 0.8], atol=1e-15)
    theta = 0.3 * (np.arange(2000) + 0.5) / 2000
    integral = (2.0 * np.pi * np.sin(theta) * np.cos(theta)).sum() * 0.3 / 2000
    np.testing.assert_allclose(sun.radiance * integral, given, rtol=1e-6)


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (lambda: SunDescription(2 * UP, UP, 0.1), RangeError, "direction: expected length 1"),
        (lambda: SunDescription(UP, -UP, 0.1), RangeError, "radiance"),
        (lambda: SunDescription(UP, UP, 0.0), RangeError, "angular_radius"),
        (lambda: SunDescription(UP, UP, 1.6), RangeError, "angular_radius"),
        (lambda: SunDescription(UP[:2], UP, 0.1), ShapeError, "direction"),
        (lambda: SunDescription.from_irradiance(0 * UP, UP, 0.1), RangeError, "a zero vector"),
        (lambda: SunDescription.from_irradiance(UP, UP, 0.0), RangeError, "angular_radius"),
        (lambda: replace(sky(), ground=np.full(3, np.nan)), RangeError, "SkyDescription: ground"),
        (lambda: replace(sky(), zenith=np.ones((1, 3))), ShapeError, "SkyDescription: zenith"),
        (lambda: scene(meshes=()), SceneError, "meshes: expected at least one"),
        (lambda: scene(bounds=np.array([[0.1] * 3, [2.0] * 3])), SceneError, r"meshes\[0\]"),
        (lambda: scene(bounds=np.array([[2.0] * 3, [0.0] * 3])), RangeError, "lower below upper"),
        (lambda: scene(bounds=np.zeros(6)), ShapeError, "bounds"),
    ],
)
def test_bad_scenes_are_refused(call: Any, error: type[Error], text: str) -> None:
    with pytest.raises(error, match=text):
        call()


def test_bounds_of_several_meshes() -> None:
    other = mesh(vertices=VERTICES - np.float32(1.0))
    np.testing.assert_allclose(
        bounds_of((mesh(), other), margin=0.5), [[-1.5] * 3, [1.5] * 3], atol=1e-15
    )
