"""What a surface of GGX facets reflects of an even sky, split by Schlick's two terms [Karis2013].

With F = f0 + (1 - f0) ramp, ramp = (1 - <wo,h>)^5, the directional albedo is linear in f0:

    A(roughness, mu) = integral of D G2 / (4 <n,wi> mu) (1 - ramp) <n,wi> dwi
    B(roughness, mu) = integral of D G2 / (4 <n,wi> mu)      ramp  <n,wi> dwi
    albedo = f0 A + B,    mu = <n,wo>,    alpha = roughness^2

The cosine of wi is in it, no 1 / pi is. G2 is Smith's masking, correlated by height, as in the
models of `photograd.bsdf` [Heitz2014]. Over half vectors h drawn in proportion to D <n,h> it
becomes a mean of G2 <wo,h> / (mu <n,h>), which is smooth: Gauss's points in their distribution
function, equal steps around the normal.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from photograd._arrays import Arguments
from photograd.types import Array

HEIGHTS, TURNS = 64, 48
"""As many points are right to 2e-4, and more only at the horizon."""


def directional_albedo(roughness: ArrayLike, cosine: ArrayLike) -> Array:
    """A and B (..., 2) of roughness and the view's cosine, which broadcast against each other.

    Raises:
        RangeError: a roughness or a cosine outside of (0, 1].
    """
    call = Arguments("directional_albedo", np.float64)
    given = {"roughness": roughness, "cosine": cosine}
    numbers = np.broadcast_arrays(
        *(call.array(name, values, above=0, high=1) for name, values in given.items())
    )
    rows = [_of_one_roughness(r, c) for r, c in zip(*(n.ravel() for n in numbers), strict=True)]
    return np.array(rows).reshape(*numbers[0].shape, 2)


def _of_one_roughness(roughness: float, mu: float) -> Array:
    """(2,)."""
    u, du = _heights()
    phi = np.pi * (np.arange(TURNS) + 0.5) / TURNS  # half a turn: the other half is alike
    a2 = roughness**4
    cos2 = (1 - u) / (1 - u + a2 * u)
    n_dot_h = np.sqrt(cos2)[:, None]
    sin_h = np.sqrt(a2 * u / (1 - u + a2 * u))[:, None]
    o_dot_h = np.sqrt(1 - mu * mu) * sin_h * np.cos(phi) + mu * n_dot_h
    n_dot_i = 2 * o_dot_h * n_dot_h - mu
    visible = (o_dot_h > 0) & (n_dot_i > 0)
    n_dot_i = np.where(visible, n_dot_i, 1.0)
    G2 = 1 / (1 + _hidden(a2, mu) + _hidden(a2, n_dot_i))
    part = np.where(visible, G2 * o_dot_h / (mu * n_dot_h), 0.0) * du[:, None] / TURNS
    ramp = np.where(visible, 1 - o_dot_h, 0.0) ** 5
    return np.array([(part * (1 - ramp)).sum(), (part * ramp).sum()])


@functools.cache
def _heights() -> tuple[Array, Array]:
    """Points of the distribution function and their weights.

    u = s^2 (3 - 2 s): many at both ends, where flat facets and steep ones are.
    """
    x, weight = np.polynomial.legendre.leggauss(HEIGHTS)
    s = 0.5 * (x + 1)
    return s * s * (3 - 2 * s), 3 * s * (1 - s) * weight


def _hidden(a2: float, cosine: Array | float) -> Array:
    """Smith's Lambda: facets that are hidden for one that is seen."""
    return np.asarray((np.sqrt(1 + a2 * (1 / np.square(cosine) - 1)) - 1) / 2)


@dataclass(frozen=True, eq=False)
class DfgTable:
    """A and B at the middles of equal cells of roughness and cosine, both from 0 to 1.

    Attributes:
        values: (S, S, 2) float64; row i has the roughness (i + 1/2) / S, column j that cosine.

    Raises:
        ShapeError: values of another shape.
    """

    values: Array

    def __post_init__(self) -> None:
        call = Arguments("DfgTable", np.float64)
        values = call.array("values", self.values, ("S", "S", 2), finite=False)
        object.__setattr__(self, "values", values)

    def at(self, roughness: ArrayLike, cosine: ArrayLike) -> Array:
        """A and B (..., 2), bilinear between cells; outermost cells continue to the edges."""
        size = len(self.values)
        (i, f), (j, g) = (_cells(number, size) for number in (roughness, cosine))
        near, far = (
            self.values[k, j] + (self.values[k, j + 1] - self.values[k, j]) * g for k in (i, i + 1)
        )
        return np.asarray(near + (far - near) * f)


def _cells(number: ArrayLike, size: int) -> tuple[Array, Array]:
    """Number of the first of two cells, and the part (..., 1) of the second."""
    at = np.clip(np.asarray(number, np.float64) * size - 0.5, 0, size - 1)
    first = np.minimum(at.astype(np.intp), size - 2)
    return first, (at - first)[..., None]


def dfg_table(size: int = 64) -> DfgTable:
    """The table of `size` roughnesses and as many cosines.

    Raises:
        RangeError: a size below 2.
    """
    Arguments("dfg_table").integer("size", size, low=2)
    middles = (np.arange(size) + 0.5) / size
    return DfgTable(directional_albedo(middles[:, None], middles))
