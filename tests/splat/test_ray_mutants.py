"""Wrong adjoints of ray casting: all must die.

As in test_mutants: the right formula of an op, in NumPy, with one thing wrong. The unchanged one
must pass the same check and agree with the core's backward.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd_course.gradcheck import check_gradient

from tests.registry.test_ops import Proof, draw, flat
from tests.splat.test_mutants import TOLERANCE, Formula, Groups, matrix


def peak(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    direction = groups["direction"] + np.array([0, 0, 1.3])
    quat, s = groups["quat"], np.exp(groups["log_scale"])
    n = quat / np.linalg.norm(quat)
    R = matrix(n)
    W = np.diag(1 / s) @ R.T
    a, b = W @ (groups["origin"] - groups["mean"] - np.array([0, 0, 3])), W @ direction
    length = np.linalg.norm(b)
    u, t = b / length, -(a @ b) / (b @ b)
    p = a + t * b
    d_q, d_t = d_out
    d_a = 2 * d_q * p - d_t * u / length
    d_b = 2 * d_q * t * p - d_t * (p / length + t * u) / length
    if wrong == "the peak stays where it was":  # the direction's part of q is lost
        d_b = d_b - 2 * d_q * t * p
    if wrong == "depth ignores the direction's length":
        d_b = d_b + d_t * t * u / length
    if wrong == "depth moves along only":
        d_b = d_b + d_t * p / length**2
    if wrong == "square forgotten":
        d_a, d_b = d_a - d_q * p, d_b - d_q * t * p
    strain = np.outer(d_a, a) + np.outer(d_b, b)
    if wrong == "the origin's strain alone":
        strain = np.outer(d_a, a)
    d_R = (R * s) @ strain / s
    if wrong == "strain not turned back":
        d_R = R @ strain
    d_n = np.array([(d_R * (matrix(n + e) - matrix(n - e)) / 2).sum() for e in np.eye(4)])
    d_origin, d_log_scale = W.T @ d_a, -np.diag(strain)
    return {
        "origin": d_origin,
        "direction": W.T @ d_b,
        "mean": d_origin if wrong == "mean with the origin's sign" else -d_origin,
        "quat": (d_n if wrong == "length kept" else d_n - n * (n @ d_n)) / np.linalg.norm(quat),
        "log_scale": -d_log_scale if wrong == "scales inverted" else d_log_scale,
    }


def color(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    d, c = groups["direction"], groups["sh"].reshape(16, 3)
    n = d / np.linalg.norm(d)
    _, d_n = sh.evaluate_backward(c[None], n[None], d_out[None])
    d_n = d_n[0]
    if wrong != "normalization forgotten":
        d_n = d_n - n * (n @ d_n)
    if wrong != "length forgotten":
        d_n = d_n / np.linalg.norm(d)
    Y = sh.basis(n[None], 3)[0]
    return {"direction": d_n, "sh": np.outer(Y, d_out).ravel()}


def blend(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    alpha, t, c = groups["raw"], groups["t"], groups["color"].reshape(3, 3)
    through = np.cumprod(1 - alpha)
    T = np.concatenate([[1.0], through[:-1]])
    if wrong == "inclusive transmittance":
        T = through
    w = T * alpha
    v = c @ d_out[:3] + d_out[4] * t
    if wrong == "depth forgotten":
        v = c @ d_out[:3]
    d_end = d_out[:3] @ groups["background"] - d_out[3]
    if wrong == "background forgotten":
        d_end = -d_out[3]
    if wrong == "opacity's sign":
        d_end += 2 * d_out[3]
    behind = (w * v).sum() - np.cumsum(w * v)
    if wrong == "off by one":
        behind = behind + w * v
    d_raw = T * v - (behind + d_end * through[-1]) / (1 - alpha)
    if wrong == "division forgotten":
        d_raw = T * v - behind - d_end * through[-1]
    return {
        "raw": d_raw,
        "color": np.outer(w, d_out[:3]).ravel(),
        "t": w * d_out[4],
        "background": through[-1] * d_out[:3],
    }


FORMULAS: dict[str, tuple[Formula, list[str]]] = {
    "ray_gaussian": (
        peak,
        [
            "the peak stays where it was",
            "depth ignores the direction's length",
            "depth moves along only",
            "square forgotten",
            "the origin's strain alone",
            "strain not turned back",
            "mean with the origin's sign",
            "length kept",
            "scales inverted",
        ],
    ),
    "ray_color": (color, ["normalization forgotten", "length forgotten"]),
    "ray_blend": (
        blend,
        [
            "inclusive transmittance",
            "depth forgotten",
            "background forgotten",
            "opacity's sign",
            "off by one",
            "division forgotten",
        ],
    ),
}
WRONG = [(op, wrong) for op, (_, list_of) in FORMULAS.items() for wrong in list_of]


@pytest.mark.parametrize("name", FORMULAS)
def test_the_right_formula_passes_and_equals_the_core(name: str) -> None:
    proof, (formula, _) = Proof(name), FORMULAS[name]
    place = draw(proof.op, 11)
    assert check_gradient(proof.forward, lambda p, d: formula(None, p, d), place, seed=11)
    d_y = np.random.default_rng(1).standard_normal(proof.op.outputs)
    mine, core = (
        flat(proof.op, formula(None, place, d_y)),
        flat(proof.op, proof.backward(place, d_y)),
    )
    np.testing.assert_allclose(mine, core, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize(("name", "wrong"), WRONG)
def test_wrong_adjoint_dies(name: str, wrong: str) -> None:
    proof, (formula, _) = Proof(name), FORMULAS[name]
    place = draw(proof.op, 11)
    report = check_gradient(
        proof.forward, lambda p, d: formula(wrong, p, d), place, seed=11, tolerance=TOLERANCE
    )
    assert not report, wrong
    assert max(group.error for group in report.groups) >= 1000 * TOLERANCE, str(report)
