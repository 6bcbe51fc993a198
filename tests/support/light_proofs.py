"""Proofs of lights as functions of anything that samples and has a density."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd_course.random import uniform

from support.light_charts import Chart
from support.statistics import chi_square_p

Array = npt.NDArray[Any]
SAMPLES = 200_000


@dataclass(frozen=True)
class Seen:
    """A light as one point sees it, and the irradiance that is known to arrive there.

    Attributes:
        light: has `sample(points, u2)` and `pdf(points, w)`.
        point, normal: (3,) of the surface that is lit.
        chart: where the light is.
        irradiance: (3,), W/m^2, by another way.
    """

    light: Any
    point: Array
    normal: Array
    chart: Chart
    irradiance: Array

    def points(self, count: int) -> Array:
        return np.tile(self.point, (count, 1))


def square(count: int, *, seed: int) -> Array:
    return uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(2))


def cell_masses(seen: Seen, *, order: int = 6) -> Array:
    """Integral of the density over the cells of all patches (patches, S, T), by Gauss-Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    lines = []
    for edges in seen.chart.edges():
        width = np.diff(edges)[:, None]
        lines.append((edges[:-1, None] + 0.5 * width * (nodes + 1.0), 0.5 * width * weights))
    (s, s_weight), (t, t_weight) = lines
    masses = []
    for patch in range(seen.chart.patches):
        at_s, at_t = np.meshgrid(s.ravel(), t.ravel(), indexing="ij")
        w, solid_angle = seen.chart.directions(patch, at_s.ravel(), at_t.ravel())
        density = seen.light.pdf(seen.points(len(w)), w) * solid_angle
        density = density.reshape(*s.shape, *t.shape)
        masses.append(np.einsum("iajb,ia,jb->ij", density, s_weight, t_weight))
    return np.stack(masses)


def cell_counts(seen: Seen, *, seed: int) -> Array:
    """How many of SAMPLES samples fell into each of those cells."""
    samples = seen.light.sample(seen.points(SAMPLES), square(SAMPLES, seed=seed))
    drawn = samples.pdf > 0
    norm = np.linalg.norm(samples.direction[drawn], axis=1)
    np.testing.assert_allclose(norm, 1.0, atol=1e-12)
    patch, s, t = seen.chart.places(samples)
    edges = (np.arange(-0.5, seen.chart.patches), *seen.chart.edges())
    inside = [
        part[drawn].clip(line[0] + 1e-12, line[-1] - 1e-12)
        for part, line in zip((s, t), edges[1:], strict=True)
    ]
    counts, _ = np.histogramdd((patch[drawn], *inside), bins=edges)
    assert counts.sum() == drawn.sum(), "every sample lies on the light"
    return counts


def prove_density(seen: Seen) -> None:
    """T4: the density integrates to one, and samples follow it.

    A right sampler has p < 1e-3 for one seed in a thousand; it then gets another, so that one
    in a million fails.
    """
    masses = cell_masses(seen)
    # Gauss-Legendre of order 6 on cells where the density is smooth.
    np.testing.assert_allclose(masses.sum(), 1.0, rtol=1e-7)
    for seed in (21, 22):
        counts = cell_counts(seen, seed=seed)
        assert counts.sum() == SAMPLES, "samples are lost"
        p = chi_square_p(counts, masses / masses.sum())
        if p > 1e-3:
            return
    raise AssertionError(f"samples do not follow the density: p = {p:.1e}")


def prove_irradiance(seen: Seen) -> None:
    """T7: the mean of radiance cos / pdf is the irradiance, within five standard errors (6e-7)."""
    samples = seen.light.sample(seen.points(SAMPLES), square(SAMPLES, seed=23))
    cosine = np.maximum(samples.direction @ seen.normal, 0.0)
    drawn = samples.pdf > 0
    weight = np.where(drawn, cosine / np.where(drawn, samples.pdf, 1.0), 0.0)
    estimates = samples.radiance * weight[:, None]
    error = estimates.std(axis=0) / np.sqrt(SAMPLES)
    assert (seen.irradiance > 0).all()
    # Rounding for lights whose samples all weigh the same.
    gap = np.abs(estimates.mean(axis=0) - seen.irradiance)
    assert (gap <= 5.0 * error + 1e-9 * seen.irradiance).all(), f"{gap} beyond 5 x {error}"


def polygon_irradiance(corners: Array, point: Array, normal: Array) -> float:
    """Irradiance by a polygon (K, 3) of radiance 1 above the horizon: Lambert's sum over its edges.

    Each edge's angle, times the cosine between the normal and that of the edge's plane through the
    point, halved. Counterclockwise seen from the point's side.
    """
    to = corners - point
    to = to / np.linalg.norm(to, axis=1, keepdims=True)
    total = 0.0
    for a, b in zip(to, np.roll(to, -1, axis=0), strict=True):
        n = np.cross(b, a)
        angle = np.arctan2(np.linalg.norm(n), a @ b)
        total += angle * float(n @ normal) / float(np.linalg.norm(n))
    return 0.5 * total
