"""The fused march has the bits of the staged one; skipping changes none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.fields.active_voxels import ActiveVoxels

from support.bits import same_bits
from tests.render.sparse import GROUPS, Scene, march, march_backward, scene

VARIANTS: dict[str, dict[str, Any]] = {
    "learning": {"density_scale": 5.0},
    "plenoxels": {"density_activation": 1, "color_activation": 1, "offset": 0.5, "degree": 3},
    "stop": {"density_scale": 20.0, "stop": 1e-2},
    "degree 1, riemann": {"degree": 1, "quadrature": "riemann", "density_activation": 1},
    "degree 0, exp": {"degree": 0, "density_activation": 3, "lattice": "entry"},
}


def big(variant: dict[str, Any], dtype: Any = np.float32) -> Scene:
    """21 x 18 x 35: several bricks along each axis, none of them full; a hole in the middle."""
    s = scene(1, shape=(21, 18, 35), count=2000, dtype=dtype, **{"dt": 0.03, **variant})
    mask = s.active.mask.copy()
    mask[4:16, :, 9:30] = False
    keep = s.active.rows[mask]
    active = ActiveVoxels(mask)
    i, j, k = active.voxels.T
    keep = s.active.rows[i, j, k]
    s.place.update(density=s.place["density"][keep], sh=s.place["sh"][keep])
    return Scene(active, s.place, s.rays, s.options, s.offset)


def run(variant: dict[str, Any], *, fused: bool = True, skip: bool = True) -> list[Any]:
    s = big(variant)
    g = np.random.default_rng(3)
    n = len(s.rays[0])
    d = (
        g.uniform(-1, 1, (n, 3)).astype(np.float32),
        g.uniform(-1, 1, n).astype(np.float32),
        g.uniform(-1, 1, n).astype(np.float32),
    )
    gradients = march_backward(s, s.place, d, fused=fused)
    return [*march(s, s.place, fused=fused, skip=skip)[:3], *(gradients[g] for g in GROUPS)]


@pytest.mark.parametrize("name", VARIANTS)
def test_fused_equals_staged_bit_for_bit(name: str) -> None:
    fused, staged = run(VARIANTS[name]), run(VARIANTS[name], fused=False)
    for a, b in zip(fused, staged, strict=True):
        assert np.abs(a).max() > 0
        assert np.array_equal(a, b)


@same_bits(
    "march_sparse_sh",
    each=VARIANTS,
    kernels=("march_sparse_sh_forward", "march_sparse_sh_backward", "march_sparse_sh_gather"),
)
def fused_results(name: str) -> list[Any]:
    return run(VARIANTS[name])


@same_bits("march_sparse_sh, staged")
def staged_results() -> list[Any]:
    return run(VARIANTS["plenoxels"], fused=False)


@same_bits("greatest weights of voxels", kernels=("march_sparse_sh_weights",))
def greatest_weights() -> list[Any]:
    s = big(VARIANTS["learning"])
    greatest = np.zeros(len(s.active), np.float32)
    parameters, rays = [s.place[g] for g in GROUPS], (*s.rays, *s.samples())
    _core.sparse_sh_weights(s.active.table, parameters, s.settings, rays, greatest)
    return [greatest]


def ball(seed: int, n: int = 96) -> Scene:
    """A bumpy ball of voxels that fills 5 % of the box, off center."""
    c = (np.arange(n) + 0.5) / n * 2 - 1
    x, y, z = np.meshgrid(c, c, c, indexing="ij")
    r = np.sqrt((x - 0.2) ** 2 + (y + 0.1) ** 2 + z**2)
    active = ActiveVoxels(r < 0.45 + 0.04 * np.sin(9 * x) * np.sin(8 * y))
    s = scene(seed, count=4000, dtype=np.float32, dt=1 / n, density_scale=6.0)
    g = np.random.default_rng(seed)
    place = {
        "density": g.uniform(-0.5, 2, len(active)).astype(np.float32),
        "sh": g.uniform(-0.5, 0.5, (len(active), 9, 3)).astype(np.float32),
        "background": s.place["background"],
    }
    return Scene(active, place, s.rays, s.options)


def test_skipping_changes_no_bit_and_most_samples_are_not_looked_up() -> None:
    s = ball(5)
    assert s.active.mask.mean() == pytest.approx(0.05, abs=0.01)
    every = march(s, s.place, skip=False)
    few = march(s, s.place)
    assert np.abs(every[0]).max() > 0.1
    for a, b in zip(every[:3], few[:3], strict=True):
        assert np.array_equal(a, b)
    assert every[3] == s.samples()[1].sum()
    assert few[3] * 5 <= every[3], (few[3], every[3])


@pytest.mark.parametrize("name", ["learning", "plenoxels"])
def test_float_agrees_with_double(name: str) -> None:
    # As for the dense grid: positions round differently, and a sample may fall into the next cell.
    narrow, wide = big(VARIANTS[name]), big(VARIANTS[name], np.float64)
    same = narrow.samples()[1] == wide.samples()[1]
    assert same.mean() > 0.95
    for a, b in zip(march(narrow, narrow.place)[:2], march(wide, wide.place)[:2], strict=True):
        np.testing.assert_allclose(a[same], b[same], atol=5e-5)
