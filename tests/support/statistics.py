"""Is a sampler drawn from the density it states? Chi-square over cells of the sphere."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def sphere_cell_masses(
    pdf: Callable[[Array], Array], z: Array, columns: int, *, order: int = 5
) -> Array:
    """Integral of pdf over each cell (Z - 1, columns) of height and azimuth, by Gauss-Legendre.

    `z` (Z,) are the edges of the rows; area on the sphere is dz dphi. A cell has order^2 nodes.
    """
    nodes, weights = np.polynomial.legendre.leggauss(order)
    phi = np.linspace(0.0, 2.0 * np.pi, columns + 1)
    high = 0.5 * (z[:-1, None] + z[1:, None]) + 0.5 * np.diff(z)[:, None] * nodes
    turn = 0.5 * (phi[:-1, None] + phi[1:, None]) + 0.5 * np.diff(phi)[:, None] * nodes
    h, t = np.meshgrid(high.ravel(), turn.ravel(), indexing="ij")
    s = np.sqrt(np.clip(1.0 - h * h, 0.0, 1.0))
    w = np.stack([s * np.cos(t), s * np.sin(t), h], axis=-1).reshape(-1, 3)
    values = pdf(np.ascontiguousarray(w)).reshape(len(z) - 1, order, columns, order)
    sums = np.einsum("iajb,a,b->ij", values, weights, weights)
    masses: Array = sums * (0.25 * np.diff(z)[:, None] * np.diff(phi)[None, :])
    return masses


def sphere_counts(directions: Array, z: Array, columns: int) -> Array:
    """How many directions (N, 3) fall into each cell (Z - 1, columns)."""
    phi = np.mod(np.arctan2(directions[:, 1], directions[:, 0]), 2.0 * np.pi)
    counts, _, _ = np.histogram2d(
        directions[:, 2].clip(z[0], z[-1]), phi, bins=(z, np.linspace(0, 2 * np.pi, columns + 1))
    )
    return counts


def chi_square_p(counts: Array, masses: Array, *, least: float = 5.0) -> float:
    """p-value of counts against expected masses times the number of samples.

    Cells that expect fewer than `least` samples are pooled; samples where nothing at all is
    expected give 0. The tail is Wilson and Hilferty's, good to 1e-3 for hundreds of cells.
    """
    total = counts.sum()
    expected = masses.ravel() * total
    found = counts.ravel()
    if found[expected < 1e-9 * total].sum() > 1e-6 * total:
        return 0.0
    small = expected < least
    e = np.append(expected[~small], expected[small].sum())
    n = np.append(found[~small], found[small].sum())
    if e[-1] < least:  # too small on its own: join the last large cell
        e, n = np.append(e[:-2], e[-2:].sum()), np.append(n[:-2], n[-2:].sum())
    freedom = len(e) - 1
    chi = float(((n - e) ** 2 / e).sum())
    normal = ((chi / freedom) ** (1 / 3) - (1 - 2 / (9 * freedom))) / math.sqrt(2 / (9 * freedom))
    return 0.5 * math.erfc(normal / math.sqrt(2.0))


def sidak(level: float, tests: int) -> float:
    """Level of each of `tests` independent tests so that all together fail falsely with `level`."""
    return 1.0 - (1.0 - level) ** (1.0 / tests)
