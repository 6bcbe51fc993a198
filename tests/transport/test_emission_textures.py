"""Shapes whose light is painted by a texture: what is seen, what is asked, and derivatives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.transport import (
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    Texture,
    TextureUse,
)
from photograd.transport.shapes import rectangle
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP, view
from tests.transport.test_adjoint import proof

OPTIONS = PathOptions(max_depth=4, roulette_from=3, sampler="independent")


def sign(height: int = 3, width: int = 4) -> Texture:
    return Texture(np.random.default_rng(1).uniform(0.1, 2.0, (height, width, 3)))


def room(*, size: int = 6, triangles: bool = False) -> Scene:
    """A floor under a textured light: one rectangle, or six triangles of a strip."""
    floor = rectangle("floor", *FLOOR, "floor")
    lamp = rectangle("lamp", *LAMP, "black", [4.0, 3.0, 2.0])
    if triangles:
        corner, u, v = (np.array(edge, float) for edge in LAMP)
        s = np.linspace(0, 1, 4)
        vertices = np.concatenate([corner + s[:, None] * u, corner + s[:, None] * u + v])
        uv = np.concatenate([np.stack([s, np.ones(4)], 1), np.stack([s, np.zeros(4)], 1)])
        faces = [[k, k + 1, k + 5] for k in range(3)] + [[k, k + 5, k + 4] for k in range(3)]
        lamp = MeshShape("lamp", vertices, np.array(faces), "black", lamp.emission, uv=uv)
    shapes = (floor, replace(lamp, emission_texture=TextureUse("sign")))
    materials = {"floor": GRAY, "black": BLACK}
    return Scene("room", shapes, materials, view(size), textures={"sign": sign()})


def test_a_sign_shows_its_picture() -> None:
    blocks = np.repeat(np.repeat(sign(2, 2).values, 32, axis=0), 32, axis=1)
    shape = rectangle("sign", [-1, -1, 0], [2, 0, 0], [0, 2, 0], "black", [4.0, 2.0, 1.0])
    scene = Scene(
        "sign",
        (replace(shape, emission_texture=TextureUse("t")),),
        {"black": BLACK},
        view(8, (0, 0, 4.0), (0, 0, 0)),
        textures={"t": Texture(blocks)},
    )
    found = PathTracer(scene).render(spp=8, seed=1).mean
    for row, column in np.ndindex(2, 2):
        expected = blocks[16 + 32 * row, 16 + 32 * column] * [4, 2, 1]
        np.testing.assert_allclose(found[2 + 3 * row, 2 + 3 * column], expected, rtol=1e-5)


@pytest.mark.parametrize("triangles", [False, True])
def test_strategies_agree(triangles: bool) -> None:
    means, errors = [], []
    for strategy in ("light", "bsdf", "mis"):
        options = PathOptions(strategy, max_depth=3, sampler="independent")
        found = PathTracer(room(triangles=triangles)).render(spp=1500, seed=2, options=options)
        means.append(found.mean.mean(axis=(0, 1)))
        errors.append(np.sqrt((found.standard_error**2).sum(axis=(0, 1))) / 36)
    assert (errors[2] < 0.01 * means[2]).all()
    for k in (0, 1):
        # False alarm: 6e-5 for each of the channels.
        assert (np.abs(means[k] - means[2]) < 4 * np.hypot(errors[k], errors[2])).all()


def test_lights_are_asked_by_their_mean() -> None:
    # The texture of a second light has twice the power: it is sampled twice as often.
    scene = room()
    other = rectangle("other", [-0.6, 1.2, 0.8], [1.2, 0, 0], [0, 0, 1.2], "black", [4, 3, 2])
    textures = {**scene.textures, "bright": Texture(2 * scene.textures["sign"].values)}
    shapes = (*scene.shapes, replace(other, emission_texture=TextureUse("bright")))
    tracer = PathTracer(replace(scene, shapes=shapes, textures=textures))
    entries, pmf = tracer._geometry.choose_lights(np.array([0.1, 0.9]))
    assert entries.tolist() == [0, 1]
    np.testing.assert_allclose(pmf, [1 / 3, 2 / 3], rtol=1e-6)


@pytest.mark.parametrize("triangles", [False, True])
def test_derivatives(triangles: bool) -> None:
    scene = replace(room(triangles=triangles), camera=view(6, (0, 1.0, 3.0), (0, 0.9, 0)))
    function, backward, start = proof(scene, OPTIONS)
    gradient: Any = backward(start, np.ones((6, 6, 3)))
    assert np.abs(gradient["textures.sign"]).min() > 0
    assert np.abs(gradient["emission.lamp"]).min() > 0
    # E t: E dL/dE = sum of t dL/dt, whatever is seen and whatever is asked.
    by_texels = (start["textures.sign"] * gradient["textures.sign"]).sum(axis=(0, 1))
    by_value = start["emission.lamp"] * gradient["emission.lamp"]
    np.testing.assert_allclose(by_texels, by_value, rtol=1e-9)
    report = check_gradient(function, backward, start, seed=2, coordinates=4, directions=3)
    assert report, str(report)


def test_wrong_gradients_die() -> None:
    function, backward, start = proof(room(size=3), OPTIONS)
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_what_cannot_be_is_refused() -> None:
    scene = room()
    ball = SphereShape("ball", np.zeros(3), 1.0, "black")
    with pytest.raises(
        SceneError, match=r"lamp\.emission_texture: expected one of the scene's textures"
    ):
        replace(scene, textures={})
    lamp = replace(scene.shapes[1], emission_texture=TextureUse("sign", 1))
    with pytest.raises(SceneError, match="at least 4 channels"):
        replace(scene, shapes=(scene.shapes[0], lamp, ball))
    with pytest.raises(SceneError, match=r"lamp\.uv: expected texture coordinates"):
        replace(scene, shapes=(scene.shapes[0], replace(scene.shapes[1], uv=None)))
