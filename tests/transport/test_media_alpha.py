"""Surfaces with opacity in media: an occluder transmits light through both sides."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    BOUNDARY,
    Accumulation,
    Environment,
    Material,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    TextureUse,
)
from photograd.transport.shapes import box, rectangle
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.transport.media_scenes import FOG, INK, fog_box, pencil, smoke, with_interior
from tests.transport.scenes import GRAY, picture_and_gradients
from tests.transport.test_adjoint import proof
from tests.transport.test_alpha import checker, gray
from tests.transport.test_strategies import assert_same_mean

SIGMA = np.array(INK.sigma_t)
OPTIONS = PathOptions(max_depth=6, roulette_from=3, sampler="independent")
LIGHT = PointLight([0.8, 1.6, 0.9], [3.0, 2.5, 2.0])
COLOR = {"albedo": [0.3, 0.4, 0.5]}


def veiled(card: Material | None, medium: Any = FOG, *, size: int = 4, **more: Any) -> Scene:
    """A card through the middle of the fog, before the light and all that the camera sees of it."""
    scene = fog_box(medium, size=size)
    if card is None:
        return replace(scene, lights=(LIGHT,), **more)
    shape = rectangle("card", [-3, 0.02, 0.1], [6, 0, 0], [0, 1.4, 0.6], "card")
    return replace(
        scene,
        shapes=(*scene.shapes, shape),
        materials={**scene.materials, "card": card},
        lights=(LIGHT,),
        **more,
    )


def opaque() -> Material:
    return Material("lambert", COLOR)


@cache
def picture(alpha: float | None, grid: bool, seed: int = 1) -> Accumulation:
    """With an occluder of this alpha; -1: an opaque card, None: no card."""
    card = None if alpha is None else opaque() if alpha < 0 else gray(alpha)
    scene = veiled(card, smoke() if grid else FOG)
    options = replace(OPTIONS, max_depth=8, roulette_from=None)
    return PathTracer(scene).render(spp=2048, seed=seed, options=options)


@pytest.mark.parametrize("grid", [False, True])
def test_alphas_of_all_and_none(grid: bool) -> None:
    assert_same_mean(picture(1.0, grid), picture(-1, grid, seed=2), 4, 0.15)
    assert_same_mean(picture(0.0, grid), picture(None, grid, seed=2), 4, 0.15)
    with pytest.raises(AssertionError):
        assert_same_mean(picture(None, grid, seed=2), picture(-1, grid, seed=2), 4, 0.15)


def test_a_veil_before_everything_mixes_both_pictures() -> None:
    deep = replace(OPTIONS, max_depth=32)  # passing takes a segment
    tracer = [PathTracer(veil_scene(alpha), dtype=np.float64) for alpha in (-1.0, None, 0.3)]
    one, zero, part = (t.render(spp=6000, seed=k, options=deep) for k, t in enumerate(tracer))
    expected = 0.3 * one.mean + 0.7 * zero.mean
    error = np.sqrt(
        0.3**2 * one.standard_error**2 + 0.7**2 * zero.standard_error**2 + part.standard_error**2
    )
    gap = part.mean - expected
    assert np.abs(gap / error).max() < 5  # of 48 numbers: 3e-5
    assert abs(gap.sum()) < 4 * np.sqrt((error**2).sum())
    # 32 and 16 errors were measured.
    assert np.abs((part.mean - one.mean) / error).max() > 10
    assert np.abs((part.mean - zero.mean) / error).max() > 10


def veil_scene(alpha: float | None) -> Scene:
    """Black and before everything: what it hides, it hides; it lights nothing and shades nothing.

    The ball of fog is lit from its own side of the occluder.
    """
    ball = SphereShape("ball", np.array([0.0, 0.0, 0.0]), 0.5, BOUNDARY, interior="fog")
    shapes: tuple[Any, ...] = (ball,)
    materials: dict[str, Material] = {}
    if alpha is not None:
        shapes = (*shapes, rectangle("veil", [-0.2, -0.2, 1.4], [0.4, 0, 0], [0, 0.4, 0], "veil"))
        dark = {"albedo": [0.0, 0.0, 0.0]}
        materials["veil"] = Material("lambert", dark if alpha < 0 else {**dark, "alpha": alpha})
    camera = replace(pencil((0, 0, 1.5), (0, 0, 0)), width=4, height=4, fx=8.0, fy=8.0, cx=2, cy=2)
    light = PointLight([1.5, 0.2, 0.1], [2.0, 3.0, 4.0])
    return Scene("veil", shapes, materials, camera, None, (light,), media={"fog": FOG})


def test_a_veil_in_ink_in_closed_form() -> None:
    # Seen: (1 - a) exp(-sigma d). Lit: a floor behind two occluders, in ink, by the sun above.
    ink = with_interior(box("ink", [0, 0, 0], [2, 2, 2], BOUNDARY), "ink")
    veil = rectangle("veil", [-0.5, -0.5, 0.25], [1, 0, 0], [0, 1, 0], "veil")
    black = Material("lambert", {"albedo": [0.0] * 3, "alpha": 0.3})
    camera = pencil((0, 0, 3), (0, 0, -3))
    scene = Scene(
        "ink", (ink, veil), {"veil": black}, camera, Environment.constant(1.0), media={"ink": INK}
    )
    found = PathTracer(scene, dtype=np.float64).render(
        spp=8192, seed=1, options=PathOptions(sampler="independent")
    )
    expected = 0.7 * np.exp(-2 * SIGMA)
    assert (found.standard_error[0, 0] < 0.01 * expected).all()
    assert (np.abs(found.mean[0, 0] - expected) < 4 * found.standard_error[0, 0]).all()

    floor = rectangle("floor", [-3, -0.5, 3], [6, 0, 0], [0, 0, -6], "floor")
    sheets = tuple(
        rectangle(f"sheet {k}", [-3, h, 3], [6, 0, 0], [0, 0, -6], "sheet")
        for k, h in enumerate((0.25, 0.5))
    )
    sheet = Material("lambert", {"albedo": [0.0] * 3, "alpha": 0.4})
    lit = Scene(
        "lit",
        (ink, floor, *sheets),
        {"floor": GRAY, "sheet": sheet},
        pencil((0, 0, 0.9), (0, -0.5, 0)),
        None,
        (DirectionalLight([0, 1, 0], [2.0] * 3),),
        media={"ink": INK},
    )
    found = PathTracer(lit, dtype=np.float64).render(
        spp=2, seed=1, options=PathOptions(max_depth=2)
    )
    seen = np.hypot(0.9, 0.5)
    expected = 0.5 / np.pi * 2.0 * 0.6**2 * np.exp(-SIGMA * (1.5 + seen))
    np.testing.assert_allclose(found.mean[0, 0], expected, rtol=1e-7)


def test_the_hole_of_a_surface_leads_into_its_interior() -> None:
    # A ball of ink whose surface is painted, in part: through its holes the ink is seen.
    for alpha in (0.0, 0.25):
        shell = Material("lambert", {"albedo": [0.0] * 3, "alpha": alpha})
        ball = SphereShape("ball", np.zeros(3), 0.5, "shell", interior="ink")
        scene = Scene(
            "ball",
            (ball,),
            {"shell": shell},
            pencil((0, 0, 3), (0, 0, 0)),
            Environment.constant(1.0),
            media={"ink": INK},
        )
        found = PathTracer(scene, dtype=np.float64).render(
            spp=8192, seed=1, options=PathOptions(sampler="independent")
        )
        expected = (1 - alpha) ** 2 * np.exp(-SIGMA)
        error = found.standard_error[0, 0]
        assert (error < 0.02 * expected).all()
        assert (np.abs(found.mean[0, 0] - expected) < 4 * error + 1e-9).all()


@pytest.mark.parametrize("grid", [False, True])
def test_strategies_agree_behind_a_veil(grid: bool) -> None:
    card = gray(0.4, textures={"alpha": TextureUse("t")})
    scene = veiled(card, smoke() if grid else FOG, textures={"t": checker()})
    scene = replace(scene, lights=())  # paths can hit light and sky
    found = {
        strategy: PathTracer(scene).render(
            spp=3000 if strategy == "bsdf" else 1000,
            seed=seed,
            options=PathOptions(strategy, max_depth=6, roulette_from=None, sampler="independent"),
        )
        for seed, strategy in enumerate(("light", "bsdf", "mis"))
    }
    assert_same_mean(found["light"], found["mis"], 4, 0.15)
    assert_same_mean(found["bsdf"], found["mis"], 4, 0.15)


@pytest.mark.parametrize("grid", [False, True])
def test_derivatives(grid: bool) -> None:
    card = gray(0.8, textures={"alpha": TextureUse("t")})
    scene = veiled(card, smoke() if grid else FOG, size=4, textures={"t": checker()})
    sheet = rectangle("sheet", [-1.0, 0.9, -1.0], [2.0, 0, 0], [0, 0, 2.0], "sheet")
    half = Material(
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
        scene, shapes=(*scene.shapes, sheet), materials={**scene.materials, "sheet": half}
    )
    function, backward, start = proof(scene, OPTIONS)
    gradient = backward(start, np.ones((4, 4, 3)))
    for name in ("materials.card.alpha", "materials.sheet.alpha", "textures.t", "media.fog.g"):
        assert np.abs(gradient[name]).max() > 1e-3
    black = ("materials.black.albedo",)
    report = check_gradient(
        function, backward, start, seed=2, coordinates=2, directions=1, may_be_zero=black
    )
    assert report, str(report)


def test_a_mask_cuts_a_hole_into_a_shell_of_ink() -> None:
    mask = Material("lambert", {**COLOR, "alpha": 0.2}, alpha_cutoff=0.5)
    ball = SphereShape("ball", np.zeros(3), 0.5, "shell", interior="ink")
    scene = Scene(
        "ball",
        (ball,),
        {"shell": mask},
        pencil((0, 0, 3), (0, 0, 0)),
        Environment.constant(1.0),
        media={"ink": INK},
    )
    found = PathTracer(scene, dtype=np.float64).render(spp=2, seed=1)
    np.testing.assert_allclose(found.mean[0, 0], np.exp(-SIGMA), rtol=1e-8)


@same_bits("media behind partial opacity")
def picture_and_gradients_behind_opacity() -> list[Any]:
    return picture_and_gradients(veiled(gray(0.6), smoke(), size=16), 8)
