"""Image-based light in real time: maps that are averaged beforehand, and the split sum.

Light that a surface sends back is an integral over all directions [Debevec1998]. Three tables make
a product of lookups of it [Karis2013]:

    irradiance E(n) = integral of L(wi) <n,wi>+ dwi, W/m^2: the cosine is in it, 1 / pi is not
    specular   S(r) = mean of L(wi) with the weight D(h) <n,wi>+, for n = wo = r
    dfg        A, B = the lobe's albedo for an even sky (`dfg`), the cosine in it

    L(wo) = (1 - metalness) base_color E(n) / pi + S(r) (f0 A + B)
    f0 = (1 - metalness) 0.16 reflectance^2 + metalness base_color       the model `standard`

E is exact. The rest is not: the lobe is taken for that of a view from above, round, however
obliquely it is seen, and the mean of a product for the product of means. Both are right for an even
sky. Nothing here knows of shadows or of light from one surface to another.

As published, r is the mirrored view. Rough lobes lean from there towards the normal, until for
roughness 1 they hardly know of the view. A weight of alpha^2 = roughness^4 for the normal is near
the best for metals; for dielectrics, which mirror most at the rim, it may lean too far (errors with
and without are in docs/results.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.lights.base import Light
from photograd.lights.dfg import DfgTable, dfg_table
from photograd.lights.environment import DirectionMap, EnvironmentMap, cell_directions
from photograd.lights.registered import ConstantLight, SkyLight
from photograd.types import Array

Kernel = Callable[[Array], Array]
"""Weights of 1 - cos(angle), an array of numbers from 0 to 2."""
OnRow = Callable[[int, int], None]
"""Called with the number of rows that are done, and of all."""
AROUND = (EnvironmentMap, ConstantLight, SkyLight)
"""Lights that come from everywhere and have no edges; a sun is painted on a map."""
LEAST_ROWS = 128
"""Fewer cells than this are too few for any light."""
MOST_ROWS = 1 << 13


def zonal_mean(
    light: Light, kernel: Kernel, width: float, rows: int, on_row: OnRow | None = None
) -> DirectionMap:
    """Means (rows, 2 rows, 3) of the radiance around every direction.

    Args:
        light: from all around, one of `AROUND`. Cells follow the texels of an `EnvironmentMap`.
        kernel: the weight.
        width: radians within which it changes by no more than a small factor; cells are no wider.
        rows: of the result.
        on_row: progress.

    Raises:
        RangeError: another light, no rows or too many, or a width that asks for more than
            `MOST_ROWS` rows of cells.
    """
    if not isinstance(light, AROUND):
        expected, got = f"one of {', '.join(c.__name__ for c in AROUND)}", type(light).__name__
        raise RangeError(message("zonal_mean", "light", expected, got))
    Arguments("zonal_mean").integer("rows", rows, low=2, high=MOST_ROWS)
    turn = light.world_from_map if isinstance(light, EnvironmentMap) else np.eye(3)
    texels = light.texels.shape[0] if isinstance(light, EnvironmentMap) else LEAST_ROWS
    count = _source_rows(texels, width, rows)
    if count > MOST_ROWS:
        expected, remedy = f"at most {MOST_ROWS} rows of cells", "take a wider lobe"
        raise RangeError(message("zonal_mean", "width", expected, count, remedy))
    w = cell_directions(count).reshape(-1, 3) @ turn.T
    radiance = light.L(np.zeros_like(w), w).reshape(count, 2 * count, 3)
    spectrum = np.fft.rfft(radiance, axis=1)
    found = np.empty((rows, 2 * rows, 3))
    for row in range(rows):
        found[row] = _row(spectrum, kernel, (row + 0.5) / rows * np.pi, 2 * rows)
        if on_row is not None:
            on_row(row + 1, rows)
    return DirectionMap(found, turn)


def _source_rows(texels: int, width: float, rows: int) -> int:
    """Rows of cells: a multiple of the result's and, unless there are twice as many, of the texels.

    Between texels radiance is a tent; cells that are wider than half of one must stand in the
    middles, or the sum over a bright texel would depend on where it is.
    """
    least = max(texels, LEAST_ROWS, int(np.ceil(np.pi / width)))
    if texels % rows == 0:
        return texels * -(-least // texels)
    return rows * -(-max(least, 2 * texels) // rows)


def _row(spectrum: Array, kernel: Kernel, theta: float, columns: int) -> Array:
    """(columns, 3): the means in the row at the height theta."""
    count = len(spectrum)
    step = 2 * count // columns
    heights = (np.arange(count) + 0.5) / count * np.pi
    # From the middle of a column of the result to the middles of the columns of cells.
    shift = 0.5 if step % 2 == 0 else 0.0
    turns = (np.arange(2 * count) + shift) * np.pi / count
    drop = 2 * np.sin(0.5 * (theta - heights))[:, None] ** 2
    drop = drop + 2 * np.sin(theta) * np.sin(heights)[:, None] * np.sin(0.5 * turns) ** 2
    weights = kernel(drop) * np.sin(heights)[:, None]  # solid angles but for a factor
    transformed = np.conj(np.fft.rfft(weights, axis=1))
    sums = np.fft.irfft(np.einsum("jf,jfc->fc", transformed, spectrum), 2 * count, axis=0)
    picked = sums[step // 2 :: step]
    return np.asarray(np.maximum(picked, 0) / weights.sum())


# Image-based light in real time: maps that are averaged beforehand, and the split sum.


ROUGHNESSES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
LEAST_ROUGHNESS = 0.045
"""Of the models in `photograd.bsdf`."""


def irradiance_map(light: Light, rows: int = 64, on_row: OnRow | None = None) -> DirectionMap:
    """Irradiance E (rows, 2 rows, 3), W/m^2, of surfaces that face each direction.

    Args:
        light: from all around (`zonal.AROUND`), such as an `EnvironmentMap`.
        rows: of the result; E is smooth, and 64 are enough for a thousandth between cells.
        on_row: progress.

    Raises:
        RangeError: as for `zonal_mean`.
    """
    mean = zonal_mean(light, lambda drop: np.maximum(1 - drop, 0), np.pi / 128, rows, on_row)
    return DirectionMap(np.pi * mean.values, mean.world_from_map)


def specular_kernel(roughness: float) -> Kernel:
    """D(h) <n,wi>+ without its constant, for n = wo: <n,h>^2 = (1 + <n,wi>) / 2."""
    a2 = roughness**4

    def weight(drop: Array) -> Array:
        # <n,h>^2 (a^2 - 1) + 1, without the difference of two numbers that are almost 1
        denominator = 0.5 * drop + a2 * (1 - 0.5 * drop)
        return np.asarray(np.maximum(1 - drop, 0) * (a2 / denominator) ** 2)

    return weight


@dataclass(frozen=True, eq=False)
class SpecularMap:
    """Radiance S, averaged for some roughnesses, W/(m^2 sr).

    Attributes:
        roughnesses: ascending.
        levels: one map for each.
    """

    roughnesses: tuple[float, ...]
    levels: tuple[DirectionMap, ...]

    def at(self, w: Array, roughness: ArrayLike) -> Array:
        """S (..., 3) in directions w (..., 3), linear between the two nearest roughnesses.

        Beyond the first and the last, those.
        """
        at = np.interp(np.asarray(roughness), self.roughnesses, np.arange(len(self.levels)))
        at = np.broadcast_to(at, np.shape(w)[:-1])
        found = np.zeros((*at.shape, 3))
        for number, level in enumerate(self.levels):
            share = np.maximum(1 - np.abs(at - number), 0)
            used = share > 0
            found[used] += share[used][:, None] * level.at(np.asarray(w)[used])
        return found


def specular_map(
    light: Light,
    roughnesses: Sequence[float] = ROUGHNESSES,
    most_rows: int = 256,
    on_row: OnRow | None = None,
) -> SpecularMap:
    """The radiance that lobes of these roughnesses see around each direction.

    Args:
        light: from all around (`zonal.AROUND`), such as an `EnvironmentMap`.
        roughnesses: ascending, from 0.045 to 1. Smooth ones take long: their cells are small.
        most_rows: of a level, (rows, 2 rows, 3). Rows double from 64 on until cells are no wider
            than roughness^2 radians; what needs more than this is blurred by the cells.
        on_row: progress, over all levels.

    Raises:
        RangeError: roughnesses that are none or not ascending, or as for `zonal_mean`.
    """
    wanted = tuple(float(r) for r in roughnesses)
    ascending = all(a < b for a, b in pairwise(wanted))
    if not wanted or not ascending or not LEAST_ROUGHNESS <= wanted[0] <= wanted[-1] <= 1:
        expected = f"ascending numbers from {LEAST_ROUGHNESS} to 1"
        raise RangeError(message("specular_map", "roughnesses", expected, roughnesses))
    sizes = [_rows_of(r, most_rows) for r in wanted]
    levels: list[DirectionMap] = []
    for r, rows in zip(wanted, sizes, strict=True):

        def report(done: int, _: int, before: int = sum(sizes[: len(levels)])) -> None:
            if on_row is not None:
                on_row(before + done, sum(sizes))

        levels.append(zonal_mean(light, specular_kernel(r), r * r, rows, report))
    return SpecularMap(wanted, tuple(levels))


def _rows_of(roughness: float, most: int) -> int:
    rows = 64
    while rows < most and np.pi / rows > roughness**2:
        rows *= 2
    return min(rows, most)


@dataclass(frozen=True, eq=False)
class PrefilteredLight:
    """The three tables of a light.

    Attributes:
        irradiance: of `irradiance_map`.
        specular: of `specular_map`.
        dfg: of `dfg_table`.
    """

    irradiance: DirectionMap
    specular: SpecularMap
    dfg: DfgTable

    @classmethod
    def of(cls, light: Light, on_row: OnRow | None = None) -> PrefilteredLight:
        """Of a light from all around, with default sizes; progress is of the specular map."""
        return cls(irradiance_map(light), specular_map(light, on_row=on_row), dfg_table())


def shade(
    light: PrefilteredLight,
    normals: Array,
    wo: Array,
    *,
    base_color: ArrayLike,
    metalness: ArrayLike,
    roughness: ArrayLike,
    reflectance: ArrayLike = 0.5,
    occlusion: ArrayLike = 1.0,
    leaning: bool = True,
) -> Array:
    """Radiance (..., 3) that surfaces of the model `standard` send towards wo, by the split sum.

    Args:
        light: its tables.
        normals, wo: (..., 3) unit vectors in the world; wo points to the viewer, on the outside.
        base_color: (..., 3) or (3,).
        metalness, roughness, reflectance: (...) or numbers, 0 to 1.
        occlusion: (...) or a number: the part of this light that reaches the surface, 1 for all, as
            `OcclusionMap.at` looks it up. All light here is ambient, so all of it is scaled.
        leaning: whether rough lobes lean towards the normal; False is the sum as published.

    Raises:
        ShapeError: normals and wo of different shapes.
    """
    call = Arguments("shade", np.float64)
    n = call.array("normals", normals, (..., 3))
    v = call.array("wo", wo, n.shape)
    color = np.asarray(base_color, np.float64)
    metal, gloss = np.asarray(metalness)[..., None], np.asarray(reflectance)[..., None]
    cosine = (n * v).sum(axis=-1)
    mirrored = 2 * cosine[..., None] * n - v
    if leaning:  # of any length: only the direction is looked at
        mirrored = mirrored + (n - mirrored) * np.asarray(roughness, np.float64)[..., None] ** 4
    table = light.dfg.at(roughness, np.clip(cosine, 0, 1))
    f0 = (1 - metal) * 0.16 * gloss**2 + metal * color
    diffuse = (1 - metal) * color * light.irradiance.at(n) / np.pi
    specular = light.specular.at(mirrored, roughness) * (f0 * table[..., :1] + table[..., 1:])
    return np.asarray((diffuse + specular) * np.asarray(occlusion)[..., None])
