"""Wrong adjoints of the emission-absorption ray that have been seen in the wild: all must die.

Each variant is the right formula, in NumPy, with one thing wrong. The unchanged formula must pass
the same check, and must agree with the core's backward; the error of each wrong one must exceed the
tolerance by at least a factor of 1000, so that none dies by luck.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.gradcheck import check_gradient

from tests.registry.test_ops import Proof, draw, flat, split

DT = 0.13
OP = _core.ops["composite"]

WRONG = {
    "no occlusion": "later samples are not dimmed: the sum over them is left out",
    "sign": "the sum over later samples is added",
    "missing dt": "d_sigma without the factor dt",
    "off by one": "the sum over later samples includes the sample itself",
    "riemann weight": "w = T sigma dt in the adjoint of an alpha-form image",
    "inclusive transmittance": "T attenuates a sample by its own extinction",
    "background forgotten": "the light from behind does not count as dimmed",
    "background twice": "the light from behind counts twice",
    "opacity forgotten": "the cotangent of opacity is dropped",
    "depth forgotten": "the cotangent of depth is dropped in the density",
    "tail dropped": "the backward walk stops three samples early, the forward does not",
}


def backward(wrong: str | None) -> Any:
    def formula(groups: dict[str, Any], d_y: Any) -> dict[str, Any]:
        s = groups["sigma_t"] * DT
        rgb = groups["rgb"].reshape(-1, 3)
        background = groups["background"]
        d_color, d_opacity, d_depth = d_y[:3], d_y[3], d_y[4]
        t = (np.arange(len(s)) + 0.5) * DT
        front = np.exp(-(np.cumsum(s) - s))
        if wrong == "inclusive transmittance":
            front = np.exp(-np.cumsum(s))
        alpha = s if wrong == "riemann weight" else -np.expm1(-s)
        w = front * alpha
        v = rgb @ d_color + (0 if wrong == "depth forgotten" else d_depth * t)
        wv = w * v
        later = wv[::-1].cumsum()[::-1] - wv
        if wrong == "off by one":
            later = later + wv
        later = {"no occlusion": 0 * later, "sign": -later}.get(wrong or "", later)
        end = np.exp(-s.sum())
        behind = {"background forgotten": 0.0, "background twice": 2.0}.get(wrong or "", 1.0)
        end_term = (
            (0.0 if wrong == "opacity forgotten" else d_opacity) - behind * (d_color @ background)
        ) * end
        d_s = front * np.exp(-s) * v - later + end_term
        if wrong == "tail dropped":
            d_s[-3:] = 0
        return {
            "sigma_t": d_s * (1 if wrong == "missing dt" else DT),
            "rgb": (w[:, None] * d_color).ravel(),
            "background": end * d_color,
        }

    return formula


def test_the_right_formula_passes_and_equals_the_core() -> None:
    proof, place = Proof("composite"), draw(OP, 11)
    assert check_gradient(proof.forward, backward(None), place, seed=11)
    d_y = np.array([0.7, -0.4, 0.9, 0.3, -0.8])
    mine = flat(OP, backward(None)(place, d_y))
    core = flat(OP, proof.backward(place, d_y))
    np.testing.assert_allclose(mine, core, rtol=1e-11, atol=1e-14)
    assert set(split(OP, core)) == {"sigma_t", "rgb", "background"}


@pytest.mark.parametrize("wrong", WRONG)
def test_wrong_adjoint_dies(wrong: str) -> None:
    proof = Proof("composite")
    place = draw(OP, 11)
    place["sigma_t"] *= 0.4  # so thin that the background shows: T_end = 0.2
    tolerance = 1e-6
    report = check_gradient(proof.forward, backward(wrong), place, seed=11, tolerance=tolerance)
    assert not report, WRONG[wrong]
    assert max(group.error for group in report.groups) >= 1000 * tolerance, str(report)
