"""Wrong adjoints of splatting that have been seen in the wild: all must die.

Each variant is the right formula of one op, in NumPy, with one thing wrong. The unchanged formula
must pass the same check and agree with the core's backward; the error of each wrong one must exceed
the tolerance by at least a factor of 1000, so that none dies by luck.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd_course.gradcheck import check_gradient

from tests.registry.test_ops import Proof, draw, flat

Groups = dict[str, Any]
TOLERANCE = 1e-6
PAIRS = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]


def matrix(n: Any) -> Any:
    w, x, y, z = n
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def symmetric(d: Any, off: float = 0.5) -> Any:
    """Matrix of derivatives from one number for each pair of entries."""
    G = np.zeros((3, 3) if len(d) == 6 else (2, 2))
    for (i, j), value in zip(PAIRS if len(d) == 6 else [(0, 0), (0, 1), (1, 1)], d, strict=True):
        G[i, j] = G[j, i] = value * (1.0 if i == j else off)
    return G


def once(G: Any, off: float = 2.0) -> Any:
    """The inverse of `symmetric`: an off-diagonal number stands for two entries."""
    pairs = PAIRS if len(G) == 3 else [(0, 0), (0, 1), (1, 1)]
    return np.array([G[i, j] * (1.0 if i == j else off) for i, j in pairs])


def covariance(wrong: str | None, groups: Groups, d_cov: Any) -> Groups:
    q, s = groups["quat"], np.exp(groups["log_scale"])
    length = np.linalg.norm(q)
    n = q / length
    M = matrix(n) * s
    G = symmetric(d_cov, 1.0 if wrong == "off-diagonal twice" else 0.5)
    d_M = (1 if wrong == "one side of M M^T" else 2) * G @ M
    d_R = d_M * s
    # R is quadratic in n: the central difference with step 1 is its exact derivative.
    d_n = np.array([(d_R * (matrix(n + e) - matrix(n - e)) / 2).sum() for e in np.eye(4)])
    d_q = (d_n - n * (n @ d_n)) / length
    if wrong == "normalization forgotten":
        d_q = d_n
    if wrong == "length forgotten":
        d_q = d_q * length
    d_s = (d_M * M).sum(0)
    return {"quat": d_q, "log_scale": d_s / s if wrong == "log forgotten" else d_s}


def conic(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    (xx, yy), (xy,) = groups["diagonal"], groups["off_diagonal"]
    S = np.array([[xx, xy], [xy, yy]])
    blurred = S + 0.3 * np.eye(2)
    Q = np.linalg.inv(blurred)
    H = symmetric(d_out[:3], {"halved conic fixed": 1.0}.get(wrong or "", 0.5))
    d_S = -Q @ H @ Q * (-1 if wrong == "inverted" else 1)
    compensation = np.sqrt(np.linalg.det(S) / np.linalg.det(blurred))
    slope = np.linalg.inv(S) - (0 if wrong == "low-pass forgotten" else Q)
    if wrong != "compensation forgotten":
        d_S = d_S + 0.5 * compensation * d_out[3] * slope
    d = once(d_S, 1.0 if wrong == "off-diagonal once" else 2.0)
    return {"diagonal": d[[0, 2]], "off_diagonal": d[[1]]}


def held_projection(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    view = groups["view"].reshape(3, 4) + np.eye(3, 4)
    view[2, 3] += 3
    mean = groups["mean"] + np.array([3, -3, 0])
    W, t = view[:, :3], view[:, :3] @ mean + view[:, 3]
    f, held = np.array([1.5, 1.25]), np.array([0.5, -0.5])
    J = np.column_stack([np.diag(f), -f * held]) / t[2]
    A, cov = J @ W, symmetric(groups["cov"], 1.0)
    G = symmetric(d_out[3:])
    d_A = 2 * G @ A @ cov
    d_J = d_A @ W.T
    d_u = f * d_out[:2]
    u = t[:2] / t[2]
    d_t = np.array([*(d_u / t[2]), d_out[2] - (d_u @ u + (d_J * J).sum()) / t[2]])
    if wrong == "clamp passed through":  # as if u' were u
        d_held = -d_J[:, 2] * f / t[2]
        d_t += [*(d_held / t[2]), -(d_held @ u) / t[2]]
    if wrong == "depth as if t_x moved":  # x zeroed, but J_xz = -f t_x / t_z^2 with t_x held
        d_t[2] -= (d_J[:, 2] * J[:, 2]).sum() / t[2]
    if wrong == "mean held too":
        d_t[:2] = 0
    d_view = np.column_stack([J.T @ d_A + np.outer(d_t, mean), d_t])
    if wrong == "rotation of the covariance forgotten":
        d_view = np.column_stack([np.outer(d_t, mean), d_t])
    return {"mean": W.T @ d_t, "cov": once(A.T @ G @ A), "view": d_view.ravel()}


def blend(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    x, y = np.meshgrid(np.arange(16) + 0.5, np.arange(2) + 0.5)
    center = groups["center"].reshape(3, 2) + np.array([[4, 1], [7, 1], [10, 1]])
    abc = groups["conic"].reshape(3, 3) + np.array([0.1, 0.02, 0.2])
    color, z, o = groups["color"].reshape(3, 3), groups["z"], groups["alpha"]
    d = d_out.reshape(2, 16, 5)
    dx, dy = (center[:, k, None, None] - (x, y)[k] for k in (0, 1))
    A, B, C = (abc[:, k, None, None] for k in range(3))
    falloff = np.exp(-0.5 * (A * dx**2 + C * dy**2) - B * dx * dy)
    alpha = o[:, None, None] * falloff
    through = np.cumprod(1 - alpha, 0)
    T = (
        through
        if wrong == "inclusive transmittance"
        else np.concatenate([0 * x[None] + 1, through])[:3]
    )
    w = T * alpha
    v = np.einsum("kc,yxc->kyx", color, d[..., :3]) + z[:, None, None] * d[..., 4]
    d_end = d[..., :3] @ groups["background"] - d[..., 3]
    if wrong == "background forgotten":
        d_end = -d[..., 3]
    later = (w * v)[::-1].cumsum(0)[::-1] - w * v
    if wrong == "off by one":
        later = later + w * v
    if wrong == "skipped splat counted":  # the walk starts one splat too late
        later[0] = later[1]
    d_alpha = T * v - (later + d_end * through[-1]) / (1 - alpha)
    if wrong == "division forgotten":
        d_alpha = T * v - later - d_end * through[-1]
    d_sigma = (1 if wrong == "inverted" else -1) * alpha * d_alpha
    halved = 0.5 if wrong == "halved conic" else 1.0
    d_abc = [0.5 * dx**2, halved * dx * dy, 0.5 * dy**2]
    d_center = [A * dx + B * dy, B * dx + C * dy]
    return {
        "center": np.stack([(d_sigma * k).sum((1, 2)) for k in d_center], -1).ravel(),
        "conic": np.stack([(d_sigma * k).sum((1, 2)) for k in d_abc], -1).ravel(),
        "alpha": (falloff * d_alpha).sum((1, 2)),
        "color": np.einsum("kyx,yxc->kc", w, d[..., :3]).ravel(),
        "z": np.einsum("kyx,yx->k", w, d[..., 4]),
        "background": np.einsum("yx,yxc->c", through[-1], d[..., :3]),
    }


Formula = Callable[[str | None, Groups, Any], Groups]
FORMULAS: dict[str, tuple[Formula, list[str]]] = {
    "gaussian_covariance": (
        covariance,
        [
            "off-diagonal twice",
            "one side of M M^T",
            "normalization forgotten",
            "length forgotten",
            "log forgotten",
        ],
    ),
    "splat_conic": (
        conic,
        [
            "halved conic fixed",
            "inverted",
            "off-diagonal once",
            "compensation forgotten",
            "low-pass forgotten",
        ],
    ),
    "splat_projection_held": (
        held_projection,
        [
            "clamp passed through",
            "depth as if t_x moved",
            "mean held too",
            "rotation of the covariance forgotten",
        ],
    ),
    "splat_blend": (
        blend,
        [
            "inclusive transmittance",
            "background forgotten",
            "off by one",
            "skipped splat counted",
            "division forgotten",
            "inverted",
            "halved conic",
        ],
    ),
}
WRONG = [(op, wrong) for op, (_, list_of) in FORMULAS.items() for wrong in list_of]


def test_every_op_of_the_table_exists() -> None:
    assert len(WRONG) == 21


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
