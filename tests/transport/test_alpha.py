"""Surfaces that cover only in part: what they show, what they let through, and derivatives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import SceneError
from photograd.transport import (
    Environment,
    Material,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    Texture,
    TextureUse,
)
from photograd.transport.shapes import rectangle
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants
from tests.transport.scenes import FLOOR, GRAY, LAMP, picture_and_gradients, view
from tests.transport.test_adjoint import proof
from tests.transport.test_textures import wall

BARE = PathOptions("bsdf")
OPTIONS = PathOptions(max_depth=6, roulette_from=3, sampler="independent")
CARD = ([-1.0, 0.8, -1.0], [2.0, 0, 0], [0, 0, 2.0])  # between the light and the floor, faces down


def gray(alpha: float, **more: Any) -> Material:
    return Material("lambert", {"albedo": [0.3, 0.4, 0.5], "alpha": alpha}, **more)


def shade(card: Material | None, *, size: int = 6, sky: float | None = 0.3, **more: Any) -> Scene:
    """A floor under a light, a card of a material between them."""
    shapes = [rectangle("floor", *FLOOR, "floor"), rectangle("lamp", *LAMP, "floor", [4, 3.5, 3])]
    materials = {"floor": GRAY}
    if card is not None:
        shapes.append(rectangle("card", *CARD, "card"))
        materials["card"] = card
    environment = None if sky is None else Environment.constant(sky)
    return Scene("shade", tuple(shapes), materials, view(size), environment, **more)


def checker() -> Texture:
    """Alpha that takes all values, on cards that have little detail."""
    return Texture(np.random.default_rng(1).uniform(0.1, 0.9, (3, 2, 1)))


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.0])
def test_a_card_shows_its_part_of_what_lies_behind(alpha: float) -> None:
    # Under an even sky of 1 a Lambertian card shows its albedo, and the sky behind it 1.
    found = PathTracer(wall(gray(alpha), {}), dtype=np.float64).render(
        spp=512, seed=1, options=replace(BARE, sampler="independent")
    )
    expected = alpha * np.array([0.3, 0.4, 0.5]) + 1 - alpha
    error = found.standard_error.mean(axis=(0, 1)) / 8
    assert (error < 0.004).all()
    assert (np.abs(found.mean.mean(axis=(0, 1)) - expected) < 4 * error + 1e-12).all()


@pytest.mark.parametrize("alpha", [0.0, 1.0])
def test_alphas_of_none_and_all_have_their_whole_derivative(alpha: float) -> None:
    # dL/dalpha = albedo - 1, though one of the two ways is looked along in one sample of forty.
    tracer = PathTracer(wall(gray(alpha), {}), dtype=np.float64)
    d_image = np.full((8, 8, 3), 1 / 64)
    found = [
        float(
            tracer.render_backward(d_image, spp=64, seed=seed, options=BARE)["materials.wall.alpha"]
        )
        for seed in range(40)
    ]
    expected = (0.3 + 0.4 + 0.5) - 3
    error = np.std(found) / np.sqrt(len(found))
    assert error < 0.1
    assert abs(np.mean(found) - expected) < 4 * error


def test_a_shadow_keeps_what_passes() -> None:
    # Light alone is asked, directly: the card takes its part of every sample, and of no other.
    options = PathOptions("light", max_depth=2)
    # Row 4 sees the floor at z = 0.3 to 1.2, where all of the light is behind the card.
    second = rectangle("second", [-1.5, 0.9, -1.5], [3, 0, 0], [0, 0, 3], "second")
    covered = shade(gray(0.3), sky=None)
    twice = replace(
        covered,
        shapes=(*covered.shapes, second),
        materials={**covered.materials, "second": gray(0.4)},
    )
    bare, once, both = (
        PathTracer(scene, dtype=np.float64)
        .render(spp=64, seed=2, options=options, camera=view(8, (0, 0.5, 3.0), (0, 0, 0.3)))
        .mean[4, 3:5]
        for scene in (shade(None, sky=None), covered, twice)
    )
    assert bare.min() > 0.05
    np.testing.assert_allclose(once / bare, 0.7, rtol=1e-9)
    np.testing.assert_allclose(both / bare, 0.7 * 0.6, rtol=1e-9)


def test_strategies_agree_behind_a_veil() -> None:
    material = gray(0.4, textures={"alpha": TextureUse("t")})
    scene = shade(material, sky=0.2, textures={"t": checker()})
    means, errors = [], []
    for strategy in ("light", "bsdf", "mis"):
        options = PathOptions(strategy, max_depth=6, sampler="independent")
        found = PathTracer(scene).render(spp=1500, seed=3, options=options)
        means.append(found.mean[..., 0].mean())  # channels share their paths
        errors.append(np.sqrt((found.standard_error[..., 0] ** 2).sum()) / 36)
    assert max(errors) < 0.01 * means[2]
    for k in (0, 1):
        # False alarm: 6e-5 each.
        assert abs(means[k] - means[2]) < 4 * np.hypot(errors[k], errors[2])


def test_derivatives() -> None:
    # The card is seen, and stands before light and sky; a second one has an alpha without texture.
    material = gray(0.8, textures={"alpha": TextureUse("t")})
    scene = shade(material, textures={"t": checker()})
    second = rectangle("second", [-1.0, 0.4, -1.0], [2.0, 0, 0], [0, 0, 2.0], "sheet")
    sheet = Material(
        "gltf_transmission",
        {
            "base_color": [0.8, 0.6, 0.4],
            "metalness": 0.1,
            "roughness": 0.6,
            "transmission": 0.5,
            "eta": 1.4,
            "alpha": 0.6,
        },
    )
    scene = replace(
        scene, shapes=(*scene.shapes, second), materials={**scene.materials, "sheet": sheet}
    )
    function, backward, start = proof(scene, OPTIONS)
    gradient = backward(start, np.ones((6, 6, 3)))
    for name in ("materials.card.alpha", "materials.sheet.alpha", "textures.t"):
        assert np.abs(gradient[name]).max() > 1e-3
    report = check_gradient(function, backward, start, seed=2, coordinates=6, directions=4)
    assert report, str(report)


def test_wrong_gradients_die() -> None:
    scene = shade(gray(0.8, textures={"alpha": TextureUse("t")}), size=3, textures={"t": checker()})
    function, backward, start = proof(scene, OPTIONS)
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)


def test_a_mask_cuts_a_shape_out() -> None:
    # Alpha is 1 in the left half and 0 in the right one: the picture is that of half a card.
    mask = Texture(np.repeat(np.array([1.0, 0.0]), 64)[None, :, None])
    cut = gray(1.0, textures={"alpha": TextureUse("t")}, alpha_cutoff=0.5)
    options = PathOptions(sampler="independent")
    camera = view(16, (0.3, 1.2, 3.0), (0, 0.5, 0))

    def picture(scene: Scene) -> Any:
        return PathTracer(scene).render(spp=96, seed=4, options=options, camera=camera)

    whole = picture(shade(cut, textures={"t": mask}))
    corner, u, v = CARD
    plain = Material("lambert", {"albedo": [0.3, 0.4, 0.5]})
    half = shade(None)
    half = replace(
        half,
        shapes=(*half.shapes, rectangle("card", corner, np.multiply(u, 0.5), v, "card")),
        materials={**half.materials, "card": plain},
    )
    other, full = picture(half), picture(shade(plain))
    for side in (slice(0, 8), slice(8, 16)):
        # Most paths are the same ones: the two differ by less than either's error. Measured: 0.1.
        parts = [found.mean[:, side, 0].mean() for found in (whole, other, full)]
        error = np.sqrt((other.standard_error[:, side, 0] ** 2).sum()) / (16 * 8)
        assert error < 0.02 * parts[1]
        assert abs(parts[0] - parts[1]) < error
    assert abs(parts[2] - parts[1]) > 8 * error  # the right half, where a whole card would be
    d = PathTracer(shade(cut, textures={"t": mask})).render_backward(
        np.ones((6, 6, 3)), spp=16, seed=4
    )
    assert not {"textures.t", "materials.card.alpha"} & d.keys()  # edges would move
    assert np.abs(d["materials.card.albedo"]).max() > 0


@same_bits("path tracing with opacity")
def checkered_picture_and_gradients() -> list[Any]:
    material = gray(0.8, textures={"alpha": TextureUse("t")})
    return picture_and_gradients(shade(material, size=24, textures={"t": checker()}), 16)


def test_what_cannot_be_is_refused() -> None:
    lit = rectangle("lit", *LAMP, "card", [1, 1, 1])
    with pytest.raises(SceneError, match=r"lit\.material: .* a material with alpha, got both"):
        Scene("s", (lit,), {"card": gray(0.5)}, view(4))
    with pytest.raises(SceneError, match="alpha_cutoff"):
        Material("lambert", {"albedo": [0.3] * 3}, alpha_cutoff=0.5)
    with pytest.raises(SceneError, match="alpha_cutoff"):
        gray(0.5, alpha_cutoff=-0.1)
    bare = MeshShape("m", np.eye(3), np.array([[0, 1, 2]]), "card")
    painted = gray(0.5, textures={"alpha": TextureUse("t")})
    with pytest.raises(SceneError, match=r"m\.uv: expected texture coordinates"):
        Scene("s", (bare,), {"card": painted}, view(4), textures={"t": checker()})
