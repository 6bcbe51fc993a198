"""Textures: size, range, seams, and that patterns are where they should be."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from photograd.scenes import textures
from photograd.scenes.parts import BRIGHTEST, DARKEST, Color, paint, paint_names, paints
from photograd.scenes.textures import Size
from photograd_course.errors import RangeError, ShapeError

RED, WHITE, BLUE = paint("red"), paint("white"), paint("blue")
THREE = np.stack([RED, WHITE, BLUE])

MAKERS: dict[str, Callable[[Size, int], Color]] = {
    "checker": lambda size, _: textures.checker(size, (4, 6), THREE[:2]),
    "stripes": lambda size, _: textures.stripes(size, 6, THREE, lean=3),
    "bands": lambda size, _: textures.bands(size, [0.25, 0.5], THREE),
    "marble": lambda size, seed: textures.marble(size, THREE, seed=seed),
    "wood": lambda size, seed: textures.wood(size, paint("maple"), paint("walnut"), seed=seed),
    "painted_tiles": lambda size, seed: textures.painted_tiles(
        size, (3, 4), THREE, paint("cream"), seed=seed
    ),
}


@pytest.mark.parametrize("name", MAKERS)
def test_textures_are_albedos_and_repeat(name: str) -> None:
    texture = MAKERS[name]((48, 64), 3)
    assert texture.shape == (48, 64, 3)
    assert texture.dtype == np.float32
    assert DARKEST <= texture.min() < texture.max() <= BRIGHTEST
    np.testing.assert_array_equal(texture, MAKERS[name]((48, 64), 3))
    spread = texture.reshape(-1, 3).std(axis=0)
    assert spread.max() > 0.05, "a texture without contrast teaches nothing"


@pytest.mark.parametrize("name", ["marble", "wood", "painted_tiles"])
def test_seeds_draw_other_textures(name: str) -> None:
    assert np.abs(MAKERS[name]((48, 64), 3) - MAKERS[name]((48, 64), 4)).max() > 0.1


def test_marble_has_no_seam() -> None:
    """The step across the edge is no larger than steps inside, on both axes."""
    texture = textures.marble((128, 128), THREE, seed=1).astype(np.float64)
    for axis in (0, 1):
        inside = np.abs(np.diff(texture, axis=axis)).mean()
        across = np.abs(np.take(texture, 0, axis) - np.take(texture, -1, axis)).mean()
        assert 0.2 * inside < across < 2.0 * inside


def test_checker_by_hand() -> None:
    texture = textures.checker((2, 4), (2, 2), np.stack([RED, WHITE]))
    np.testing.assert_array_equal(texture, [[RED, RED, WHITE, WHITE], [WHITE, WHITE, RED, RED]])


def test_stripes_lean_and_close_after_a_turn() -> None:
    upright = textures.stripes((2, 6), 3, THREE)
    np.testing.assert_array_equal(upright[0], np.repeat(THREE, 2, axis=0))
    np.testing.assert_array_equal(upright[0], upright[1])
    leaning = textures.stripes((60, 60), 6, THREE, lean=3)
    # Half a turn down, the pattern has moved by 1.5 of 6 stripes: by a quarter of the width.
    np.testing.assert_array_equal(leaning[30], np.roll(leaning[0], -15, axis=0))
    np.testing.assert_array_equal(leaning, np.roll(leaning, -30, axis=1))


def test_bands_by_hand() -> None:
    texture = textures.bands((4, 1), [0.25, 0.5], THREE)
    np.testing.assert_array_equal(texture[:, 0], [RED, WHITE, BLUE, BLUE])


def test_tiles_have_grout_and_two_colors_each() -> None:
    grout = paint("ink")
    texture = textures.painted_tiles((96, 128), (3, 4), THREE, grout, seed=0)
    tiles = texture.reshape(3, 32, 4, 32, 3).transpose(0, 2, 1, 3, 4).reshape(12, 1024, 3)
    kinds = set()
    for tile in tiles:
        square = tile.reshape(32, 32, 3)
        np.testing.assert_array_equal(square[0], np.tile(grout, (32, 1)))
        inside = square[2:-2, 2:-2].reshape(-1, 3)
        assert len(np.unique(inside, axis=0)) == 2
        kinds.add(square.tobytes())
    assert len(kinds) > 6


def test_paints() -> None:
    np.testing.assert_allclose(paint("white")[0], 0.9301, atol=1e-4)  # 0xf7 decoded
    assert paints("red", "blue").shape == (2, 3)
    for name in paint_names():
        assert DARKEST <= paint(name).min() <= paint(name).max() <= BRIGHTEST
    with pytest.raises(RangeError, match="did you mean 'violet'"):
        paint("violett")


def test_bad_input_is_refused() -> None:
    with pytest.raises(RangeError, match="checker: size"):
        textures.checker((0, 4), (2, 2), THREE)
    with pytest.raises(ShapeError, match="stripes: colors"):
        textures.stripes((4, 4), 2, RED)
    with pytest.raises(ShapeError, match="marble: size"):
        textures.marble((4, 4, 3), THREE, seed=0)  # type: ignore[arg-type]
