"""Media that are none are refused by name; cameras may stand anywhere."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, RangeError, SceneError, ShapeError
from photograd.transport import (
    BOUNDARY,
    VACUUM,
    DensityGrid,
    Environment,
    Material,
    Medium,
    PathTracer,
    Scene,
    SphereShape,
)
from photograd.transport.media_list import is_closed
from photograd.transport.shapes import box, rectangle

from tests.transport.media_scenes import FOG, INK, ball_of, pencil, smoke, with_interior
from tests.transport.scenes import FLOOR, GRAY, view


@pytest.mark.parametrize(
    ("make", "error", "text"),
    [
        (lambda: Medium([-1, 1, 1]), RangeError, "sigma_t: expected finite numbers of at least 0"),
        (
            lambda: Medium([np.nan, 1, 1]),
            RangeError,
            "sigma_t: expected finite numbers of at least 0",
        ),
        (lambda: Medium(np.inf), RangeError, "sigma_t: expected finite numbers of at least 0"),
        (lambda: Medium([1, 1]), ShapeError, "sigma_t: expected a number or shape .3,."),
        (lambda: Medium(1.0, 1.01), RangeError, "albedo: expected finite numbers in"),
        (lambda: Medium(1.0, -0.1), RangeError, "albedo: expected finite numbers in"),
        (lambda: Medium(1.0, 0.5, "fair"), RangeError, "phase function: name"),
        (lambda: Medium(1.0, 0.5, values={"h": 1.0}), RangeError, "values: expected g"),
        (lambda: Medium(1.0, 0.5, values={"g": 1.0}), RangeError, "g: expected a finite number in"),
        (lambda: Medium.of(-1.0, 1.0), RangeError, "Medium.of: sigma_a"),
        (lambda: DensityGrid(np.ones((1, 2, 2))), ShapeError, "with X, Y, Z >= 2"),
        (lambda: DensityGrid(-np.ones((2, 2, 2))), RangeError, "numbers of at least 0"),
        (lambda: DensityGrid(np.full((2, 2, 2), np.nan)), RangeError, "numbers of at least 0"),
        (lambda: DensityGrid(np.ones((2, 2, 2)), np.zeros((4, 4))), RangeError, "with a volume"),
        (lambda: DensityGrid(np.ones((2, 2, 2)), majorant=0.5), RangeError, "the majorant 0.5"),
    ],
)
def test_numbers_that_are_no_medium(make: Any, error: type[Error], text: str) -> None:
    with pytest.raises(error, match=text):
        make()


def scene_with(shape: Any, **more: Any) -> Scene:
    return Scene("s", (shape,), {"gray": GRAY}, view(2), media={"fog": FOG}, **more)


def test_interiors_that_no_light_could_enter() -> None:
    open_mesh = rectangle("sheet", *FLOOR, BOUNDARY)
    with pytest.raises(SceneError, match=r"sheet.interior: expected a closed mesh"):
        scene_with(with_interior(open_mesh, "fog"))
    inward = box("room", [0, 0, 0], [2, 2, 2], BOUNDARY, inward=True)
    with pytest.raises(SceneError, match=r"room.interior: expected a closed mesh"):
        scene_with(with_interior(inward, "fog"))
    ball = SphereShape("ball", np.zeros(3), 1.0, "gray", interior="fog")
    with pytest.raises(SceneError, match=r"ball.interior: expected a surface that lets light in"):
        scene_with(ball)
    with pytest.raises(SceneError, match=r"interior: expected one of the scene's media"):
        scene_with(replace(ball, material=BOUNDARY, interior="fgo"))
    with pytest.raises(SceneError, match=r"world: expected one of the scene's media"):
        scene_with(replace(ball, interior=None), world="mist")
    with pytest.raises(SceneError, match=r"ball.emission: expected none"):
        scene_with(replace(ball, material=BOUNDARY, emission=np.ones(3)))
    with pytest.raises(SceneError, match="a meaning of its own"):
        Scene("s", (ball,), {"gray": GRAY}, view(2), media={VACUUM: FOG})


def test_closed_is_every_edge_both_ways() -> None:
    cube = box("cube", [0, 0, 0], [1, 1, 1], "gray")
    assert is_closed(cube)
    assert not is_closed(replace(cube, faces=cube.faces[:-1]))
    turned = cube.faces.copy()
    turned[0] = turned[0, ::-1]
    assert not is_closed(replace(cube, faces=turned))
    # Corners of its own for each triangle, as flat shading needs: the same places.
    apart = replace(
        cube,
        vertices=cube.vertices[cube.faces].reshape(-1, 3),
        faces=np.arange(36, dtype=np.uint32).reshape(-1, 3),
    )
    assert is_closed(apart)


def test_params_that_are_no_medium_are_named() -> None:
    tracer = PathTracer(ball_of(smoke(), size=2))
    good = dict(tracer.params)
    for name, value, text in (
        ("sigma_t", [-1, 1, 1], "media.inside.sigma_t"),
        ("albedo", [1.5, 1, 1], "media.inside.albedo"),
        ("g", 1.0, "media.inside.g"),
        ("density", -good["media.inside.density"], "media.inside.density"),
    ):
        tracer.params = {**good, f"media.inside.{name}": np.array(value)}
        with pytest.raises(RangeError, match=text):
            tracer.render(spp=1, seed=0)
    tracer.params = {**good, "media.inside.sigma_t": np.ones(2)}
    with pytest.raises(ShapeError, match=r"media\.inside\.sigma_t"):
        tracer.render(spp=1, seed=0)


def test_a_camera_within_a_medium() -> None:
    # In the middle of a ball of ink, of 1 m across, and in a hole within it.
    sky = Environment.constant(1.0)
    ink = SphereShape("ink", np.zeros(3), 0.5, BOUNDARY, interior="ink")
    hole = box("hole", [0, 0, 0], [0.25, 0.25, 0.25], BOUNDARY)
    for shapes, length in (((ink,), 0.5), ((ink, with_interior(hole, VACUUM)), 0.375)):
        scene = Scene("c", shapes, {}, pencil((0, 0, 0), (0, 0, -1)), sky, media={"ink": INK})
        found = PathTracer(scene, dtype=np.float64).render(spp=2, seed=1)
        np.testing.assert_allclose(
            found.mean[0, 0], np.exp(-np.asarray(INK.sigma_t) * length), rtol=1e-9
        )


def test_an_opaque_shape_around_the_camera_is_none_of_it() -> None:
    room = box("room", [0, 0, 0], [2, 2, 2], "gray", [1, 1, 1], inward=True)
    camera = pencil((0, 0, 0), (0, 0, -1))
    dark = {"gray": Material("lambert", {"albedo": [0.0, 0.0, 0.0]})}
    scene = Scene("r", (room,), dark, camera, media={"ink": INK}, world="ink")
    found = PathTracer(scene, dtype=np.float64).render(spp=2, seed=1)
    np.testing.assert_allclose(found.mean[0, 0], np.exp(-np.asarray(INK.sigma_t)), rtol=1e-9)
