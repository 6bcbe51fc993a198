"""Painted patterns as textures T[row, column]: linear albedo (H, W, 3) float32 in 0.02..0.95.

Every pattern joins itself at its left and right edge, and all but `wood` at top and bottom too, so
that it can go around a ball or a ring without a seam. Edges between colors are one texel sharp; a
renderer softens them by taking many samples in a pixel.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from photograd_course import random

from photograd._arrays import Arguments
from photograd.scenes.noise import fractal_noise, gradient_noise
from photograd.scenes.parts import Color, within_range
from photograd.types import FloatArray

Size: TypeAlias = tuple[int, int]
"""Height and width in texels."""


def checker(size: Size, counts: Size, colors: Color) -> Color:
    """Rectangles in turn: `counts` of them (down, across), `colors` (P, 3) by diagonals."""
    v, u = _coordinates("checker", size)
    index = np.floor(v * counts[0]) + np.floor(u * counts[1])
    return _picked("checker", colors, index)


def stripes(size: Size, count: int, colors: Color, *, lean: int = 0) -> Color:
    """`count` stripes along v, or leaning: `lean` stripes to the right from top to bottom.

    For a spiral around a lathe shape let `lean` be a multiple of the number of colors.
    """
    v, u = _coordinates("stripes", size)
    return _picked("stripes", colors, np.floor(u * count + v * lean))


def bands(size: Size, edges: list[float], colors: Color) -> Color:
    """Bands along u: colors change where v passes each of the rising `edges` in 0..1."""
    v, u = _coordinates("bands", size)
    return _picked("bands", colors, np.searchsorted(np.asarray(edges), v + 0.0 * u, side="right"))


def marble(size: Size, colors: Color, *, seed: int, veins: int = 3) -> Color:
    """Bands bent by fractal noise [Perlin1985], blended through all `colors` (P, 3) in turn."""
    v, u = _coordinates("marble", size)
    points = np.stack(np.broadcast_arrays(4.0 * u, 4.0 * v), axis=-1)
    bent = fractal_noise(points, seed=seed, octaves=6, gain=0.55, period=4)
    phase = (veins * (u + v) + 1.6 * bent) % 1.0
    return _blended(colors, phase * len(colors))


def wood(size: Size, light: Color, dark: Color, *, seed: int, planks: int = 5) -> Color:
    """Planks along v with rings, fibers and a tone of their own; u joins at the edges."""
    v, u = _coordinates("wood", size)
    plank = np.floor(u * planks)
    tone = random.uniform(seed, pixel=np.arange(planks), dimension=0)[plank.astype(int)]
    shift = 64.0 * random.uniform(seed, pixel=np.arange(planks), dimension=1)[plank.astype(int)]
    across = u * planks - plank - 0.5
    along = np.stack(np.broadcast_arrays(2.0 * across + shift, 1.3 * v), axis=-1)
    rings = 9.0 * gradient_noise(along, seed=seed) + 7.0 * across**2
    fibers = np.stack(np.broadcast_arrays(40.0 * across + shift, 3.0 * v), axis=-1)
    grain = 0.5 + 0.5 * np.sin(2.0 * np.pi * rings)
    mixed = 0.5 * grain**2 + 0.3 * tone + 0.25 * fractal_noise(fibers, seed=seed + 1, octaves=3)
    mixed = np.clip(mixed + 0.08, 0.0, 1.0)[..., None]
    gap = np.abs(across) > 0.485
    color = (1.0 - mixed) * light + mixed * dark
    return within_range(np.where(gap[..., None], 0.35 * dark, color))


def painted_tiles(size: Size, counts: Size, colors: Color, grout: Color, *, seed: int) -> Color:
    """Glazed tiles, `counts` (down, across): each has a motif, two colors and a turn by chance.

    Motifs: rings, a rhomb, two quarter circles, and a flower of four petals.

    Args:
        size, counts: texels and tiles; whole texels a tile look best.
        colors: (P, 3), P >= 2.
        grout: (3,) between the tiles.
        seed: of motifs, colors and turns.
    """
    v, u = _coordinates("painted_tiles", size)
    row, column = np.floor(v * counts[0]).astype(int), np.floor(u * counts[1]).astype(int)
    tile = row * counts[1] + column
    every = np.arange(counts[0] * counts[1])
    motif = random.uniform_int(seed, 4, pixel=every, dimension=0)[tile]
    first = random.uniform_int(seed, len(colors), pixel=every, dimension=1)
    other = 1 + random.uniform_int(seed, len(colors) - 1, pixel=every, dimension=2)
    turned = random.uniform_int(seed, 2, pixel=every, dimension=3)[tile]
    y = 2.0 * (v * counts[0] - row) - 1.0 + 0.0 * u
    x = (2.0 * (u * counts[1] - column) - 1.0) * np.where(turned == 1, 1.0, -1.0)
    masks = [_rings(x, y), _rhomb(x, y), _quarters(x, y), _petals(x, y)]
    inside = np.choose(motif, masks)
    second = (first + other) % len(colors)
    painted = np.where(inside[..., None], colors[first[tile]], colors[second[tile]])
    joint = np.maximum(np.abs(x), np.abs(y)) > 0.93
    return within_range(np.where(joint[..., None], grout, painted))


def _rings(x: FloatArray, y: FloatArray) -> npt.NDArray[np.bool_]:
    radius = np.hypot(x, y)
    return np.asarray((radius < 0.28) | ((radius > 0.5) & (radius < 0.78)))


def _rhomb(x: FloatArray, y: FloatArray) -> npt.NDArray[np.bool_]:
    distance = np.abs(x) + np.abs(y)
    return np.asarray((distance < 0.9) & (distance > 0.32))


def _quarters(x: FloatArray, y: FloatArray) -> npt.NDArray[np.bool_]:
    first, second = np.hypot(x + 1.0, y + 1.0), np.hypot(x - 1.0, y - 1.0)
    return np.asarray((np.abs(first - 1.0) < 0.24) | (np.abs(second - 1.0) < 0.24))


def _petals(x: FloatArray, y: FloatArray) -> npt.NDArray[np.bool_]:
    angle = np.arctan2(y, x)
    return np.asarray(np.hypot(x, y) < 0.85 * np.sqrt(np.abs(np.sin(2.0 * angle))))


def _coordinates(function: str, size: Size) -> tuple[FloatArray, FloatArray]:
    """Texels' centers: v (H, 1) and u (1, W)."""
    Arguments(function).array("size", size, (2,), dtype=np.int64, low=1, high=8192)
    v = (np.arange(size[0]) + 0.5) / size[0]
    u = (np.arange(size[1]) + 0.5) / size[1]
    return v[:, None], u[None, :]


def _picked(function: str, colors: Color, index: npt.NDArray[np.number]) -> Color:
    """Colors by whole index, around and around."""
    _require_colors(function, colors)
    return within_range(colors[index.astype(np.int64) % len(colors)])


def _blended(colors: Color, position: FloatArray) -> Color:
    """Colors by position, mixed linearly between neighbors, the last with the first."""
    _require_colors("marble", colors)
    before = np.floor(position).astype(np.int64)
    part = (position - before)[..., None]
    first, second = colors[before % len(colors)], colors[(before + 1) % len(colors)]
    return within_range((1.0 - part) * first + part * second)


def _require_colors(function: str, colors: Color) -> None:
    Arguments(function).array("colors", colors, ("P", 3), finite=False, min_length=1)
