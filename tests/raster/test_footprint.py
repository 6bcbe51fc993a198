"""How attributes change between pixels: differences, adjoints, and a textured picture whole."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.raster import (
    footprints,
    footprints_backward,
    interpolate,
    interpolate_backward,
    project,
    rasterize,
    rasterize_backward,
)
from photograd.textures import (
    build_mips,
    build_mips_backward,
    mip_level,
    mip_level_backward,
    sample_mips,
    sample_mips_backward,
)
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.raster import oracle

SIZE = (10, 12)
CAMERA = oracle.camera(12, 10, 13.0)
FACES = np.array([[0, 1, 2], [0, 2, 3]])
VERTICES = np.array([[-1.2, -1.1, 0.4], [1.3, -1.0, -0.5], [1.1, 1.2, 0.9], [-1.0, 0.9, -0.3]])
UV = np.array([[0.05, 0.9], [0.95, 0.93], [0.9, 0.08], [0.1, 0.12]])


def test_they_are_what_a_step_of_a_pixel_changes() -> None:
    positions = project(VERTICES, CAMERA)
    visibility = rasterize(positions, FACES, SIZE)
    found = footprints(UV, positions, FACES, visibility)
    assert 20 < visibility.covered.sum() < visibility.covered.size
    assert not found[~visibility.covered].any()
    for axis in range(2):
        moved = positions.copy()
        moved[:, axis] -= 1e-6 * moved[:, 2]  # what a pixel then shows lies a step further
        after = rasterize(moved, FACES, SIZE)
        assert np.array_equal(after.face, visibility.face)
        step = interpolate(UV, FACES, after) - interpolate(UV, FACES, visibility)
        np.testing.assert_allclose(found[:, :, axis], step / 1e-6, atol=1e-8)


class Picture:
    """A texture, looked up at the level of its footprint, as a function of all groups."""

    def __init__(self) -> None:
        rng = np.random.default_rng(1)
        positions = project(VERTICES, CAMERA)
        self.place = {"positions": positions, "uv": UV, "texture": rng.uniform(0, 1, (64, 48, 2))}
        self.visibility = rasterize(positions, FACES, SIZE)

    def parts(self, p: dict[str, Any]) -> Any:
        visibility = rasterize(p["positions"], FACES, SIZE)
        covered = visibility.covered
        uv = interpolate(p["uv"], FACES, visibility)[covered]
        sides = footprints(p["uv"], p["positions"], FACES, visibility)[covered]
        return visibility, uv, sides, mip_level(p["texture"].shape, sides)

    def forward(self, p: dict[str, Any]) -> Any:
        visibility, uv, _, level = self.parts(p)
        picture = np.zeros((*SIZE, 2))
        picture[visibility.covered] = sample_mips(build_mips(p["texture"]), uv, level)
        return picture

    def backward(self, p: dict[str, Any], d: Any) -> dict[str, Any]:
        visibility, uv, sides, level = self.parts(p)
        covered, mips = visibility.covered, build_mips(p["texture"])
        d_mips, d_looked_up, d_level = sample_mips_backward(mips, uv, level, d[covered])
        d_coordinates, d_sides = np.zeros((*SIZE, 2)), np.zeros((*SIZE, 2, 2))
        d_coordinates[covered] = d_looked_up
        d_sides[covered] = mip_level_backward(p["texture"].shape, sides, d_level)
        d_uv, d_b = interpolate_backward(p["uv"], FACES, visibility, d_coordinates)
        d_positions = rasterize_backward(p["positions"], FACES, visibility, d_b)
        more = footprints_backward(p["uv"], p["positions"], FACES, visibility, d_sides)
        return {
            "positions": d_positions + more[1],
            "uv": d_uv + more[0],
            "texture": build_mips_backward(d_mips),
        }


def test_a_textured_picture_agrees_with_central_differences() -> None:
    picture = Picture()
    level = picture.parts(picture.place)[3]
    assert level.min() > 0.5
    assert np.unique(np.floor(level)).size > 1
    report = check_gradient(picture.forward, picture.backward, picture.place, seed=1)
    assert report, str(report)


def test_a_picture_without_the_derivative_of_the_level_is_noticed() -> None:
    picture = Picture()

    def without(p: dict[str, Any], d: Any) -> dict[str, Any]:
        visibility, uv, _, level = picture.parts(p)
        covered, mips = visibility.covered, build_mips(p["texture"])
        d_mips, d_looked_up, _ = sample_mips_backward(mips, uv, level, d[covered])
        d_coordinates = np.zeros((*SIZE, 2))
        d_coordinates[covered] = d_looked_up
        d_uv, d_b = interpolate_backward(p["uv"], FACES, visibility, d_coordinates)
        d_positions = rasterize_backward(p["positions"], FACES, visibility, d_b)
        return {"positions": d_positions, "uv": d_uv, "texture": build_mips_backward(d_mips)}

    assert not check_gradient(picture.forward, without, picture.place, seed=1)


def test_wrong_gradients_are_noticed() -> None:
    picture = Picture()
    cotangent = np.random.default_rng(2).uniform(-1, 1, (*SIZE, 2))
    report = check_gradient_mutants(
        picture.forward, picture.backward, picture.place, cotangent, seed=1, coordinates=8
    )
    assert report, str(report)
