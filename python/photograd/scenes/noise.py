"""Gradient noise: smooth random functions of 2D and 3D points, and sums of their octaves.

Every lattice point gets a random gradient; between lattice points the linear functions that these
gradients define are blended with weights whose first and second derivatives vanish at the ends
[Perlin1985; Perlin2002]. The noise is 0 at every lattice point, and its mean is 0.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np
from photograd_course import random
from photograd_course.checks import require_integer, require_number

from photograd._arrays import Arguments
from photograd.errors import RangeError, message
from photograd.types import FloatArray

_TABLE: Final = 256
"""Length of the table of hashes: without a `period` the noise repeats after 256 units."""

# The middles of a cube's edges, four of them twice to make 16 [Perlin2002, Sec. 3].
_EDGES: Final = np.array(
    [
        [1, 1, 0],
        [-1, 1, 0],
        [1, -1, 0],
        [-1, -1, 0],
        [1, 0, 1],
        [-1, 0, 1],
        [1, 0, -1],
        [-1, 0, -1],
        [0, 1, 1],
        [0, -1, 1],
        [0, 1, -1],
        [0, -1, -1],
        [1, 1, 0],
        [-1, 1, 0],
        [0, -1, 1],
        [0, -1, -1],
    ],
    dtype=np.float64,
)

# Eight directions in the plane, of length sqrt(2) as the edges have.
_COMPASS: Final = np.array(
    [
        [1, 1],
        [-1, 1],
        [1, -1],
        [-1, -1],
        [np.sqrt(2), 0],
        [-np.sqrt(2), 0],
        [0, np.sqrt(2)],
        [0, -np.sqrt(2)],
    ]
)

_GRADIENTS: Final = {2: _COMPASS, 3: _EDGES}
POINTS: Final = ((..., 2), (..., 3))


def gradient_noise(
    points: FloatArray, *, seed: int, octave: int = 0, period: int | None = None
) -> FloatArray:
    """Noise with features of about one unit, between -1.04 and 1.04, mean 0.

    Args:
        points: (..., 2) or (..., 3), in units of the lattice.
        seed: the table of hashes is a random order of 0..255 drawn from it.
        octave: another table of the same seed, independent of the first.
        period: 1..256; the noise then repeats after so many units along each axis.

    Returns:
        (...), float64.

    Raises:
        DtypeError, ShapeError: points are no float array, or neither 2D nor 3D.
        RangeError: non-finite points, a period outside 1..256.
    """
    points = Arguments("gradient_noise", np.float64).array("points", points, *POINTS, floating=True)
    if period is not None:
        require_integer("gradient_noise", "period", period, least=1, most=_TABLE)
    table = random.permutation(seed, _TABLE, step=octave)
    wrap = _TABLE if period is None else period
    gradients = _GRADIENTS[points.shape[-1]]
    # One array an axis instead of a last axis of two or three: several times faster.
    cells, inside, fades = [], [], []
    for x in np.moveaxis(points, -1, 0):
        floor = np.floor(x)
        t = x - floor
        cells.append(np.mod(floor, wrap).astype(np.int64))
        inside.append(t)
        fades.append(t * t * t * (t * (6.0 * t - 15.0) + 10.0))
    total = np.zeros(points.shape[:-1])
    for corner in product((0, 1), repeat=len(cells)):
        hashed, weight = np.int64(0), np.float64(1.0)
        for cell, fade, step in zip(cells, fades, corner, strict=True):
            hashed = table[(hashed + (cell + step) % wrap) % _TABLE]
            weight = weight * (fade if step else 1.0 - fade)
        chosen = hashed % len(gradients)
        for t, component, step in zip(inside, gradients.T, corner, strict=True):
            total += weight * component[chosen] * (t - step)
    return total


def fractal_noise(
    points: FloatArray,
    *,
    seed: int,
    octaves: int = 5,
    gain: float = 0.5,
    ridged: bool = False,
    period: int | None = None,
) -> FloatArray:
    """Sum of octaves, each twice as fine and `gain` times as strong as the one before.

        sum_k gain^k noise_k(2^k x) / sum_k gain^k

    With `ridged`, each noise n is replaced by 1 - 2 |n|, which makes sharp crests where n = 0.

    Args:
        points: (..., 2) or (..., 3), in units of the first octave.
        seed: each octave has a table of its own.
        octaves: 1..12.
        gain: 0..1, below 0.5 smooth, above rough.
        ridged: crests instead of hills.
        period: of the first octave; 2^(octaves - 1) period is at most 256.

    Returns:
        (...), within the range of one noise: -1.04..1.04, or -1.08..1 with `ridged`.

    Raises:
        DtypeError, ShapeError, RangeError: as `gradient_noise`, or numbers outside their range.
    """
    points = Arguments("fractal_noise", np.float64).array("points", points, *POINTS, floating=True)
    require_integer("fractal_noise", "octaves", octaves, least=1, most=12)
    require_number("fractal_noise", "gain", gain, least=0.0, most=1.0)
    if period is not None and (period << (octaves - 1)) > _TABLE:
        expected = f"at most {_TABLE >> (octaves - 1)} with {octaves} octaves"
        raise RangeError(message("fractal_noise", "period", expected, period))
    total = np.zeros(points.shape[:-1])
    weights = gain ** np.arange(octaves)
    for k in range(octaves):
        finer = None if period is None else period << k
        noise = gradient_noise(points * 2.0**k, seed=seed, octave=k, period=finer)
        total += weights[k] * (1.0 - 2.0 * np.abs(noise) if ridged else noise)
    return np.asarray(total / weights.sum())
