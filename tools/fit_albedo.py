"""Fit how much light a GGX mirror loses and how much Charlie sheen returns, by quadrature.

Usage: fit_albedo.py [--print]   (default: says by how much the committed numbers differ)

The core's ops/ggx_loss.h and ops/charlie_albedo.h hold these numbers. Nothing here is random.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OPS = Path(__file__).resolve().parent.parent / "cpp" / "photograd" / "ops"
# a, b, c, d, e of ln Lambda at alpha = 0 and 1, as in ops/charlie.h.
AT_ZERO = (25.3245, 3.32435, 0.16801, -1.27393, -4.85967)
AT_ONE = (21.5473, 3.82987, 0.19823, -1.97760, -4.32054)


def unit_nodes(count: int) -> tuple[Array, Array]:
    """Gauss-Legendre nodes and weights on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * (nodes + 1.0), 0.5 * weights


def ggx_loss(cosine: float, roughness: float, heights: int = 32, turns: int = 24) -> float:
    """What a GGX mirror under height-correlated masking does not return towards a view.

    The mean of 1 - G2 / G1 over the facets that the view sees, which are mapped from a cap.
    """
    alpha = roughness**2
    wo = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
    v = np.array([alpha * wo[0], 0.0, cosine])
    v /= np.linalg.norm(v)
    q, weight = unit_nodes(heights)
    z = 1.0 - (1.0 + v[2]) * q
    s = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    phi = np.pi * (np.arange(turns) + 0.5) / turns  # the other half is its mirror image
    h = np.stack(
        np.broadcast_arrays(
            s[:, None] * np.cos(phi) + v[0], s[:, None] * np.sin(phi), z[:, None] + v[2]
        ),
        axis=-1,
    ) * [alpha, alpha, 1.0]
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    wi = 2.0 * (h @ wo)[..., None] * h - wo
    up = np.maximum(wi[..., 2], 0.0)

    def stretched(w: Array) -> Array:
        length: Array = np.sqrt(alpha**2 * (w[..., 0] ** 2 + w[..., 1] ** 2) + w[..., 2] ** 2)
        return length

    long_o, long_i = stretched(wo), stretched(wi)
    seen = up * (cosine + long_o) / (long_o * up + long_i * cosine)
    return 1.0 - float((seen * weight[:, None]).sum() / turns)


def powers(x: Array, y: Array, degree: tuple[int, int]) -> Array:
    """x^i y^j (N, terms), j the faster."""
    return np.stack([x**i * y**j for i in range(degree[0] + 1) for j in range(degree[1] + 1)], 1)


def loss_shape(t: Array, roughness: Array, c: Array) -> tuple[Array, Array]:
    """Cosine and fitted loss (N,) at t = cosine (1 + alpha) / (cosine + alpha)."""
    alpha = roughness**2
    s = t / (1.0 + alpha)
    fit = s * (1.0 - s) ** 2 * np.exp(powers(2 * t - 1, 2 * roughness - 1, (4, 4)) @ c)
    return alpha * s / (1.0 - s), fit


def fit_ggx() -> dict[str, Array]:
    """Coefficients of ln(loss / (s (1 - s)^2)) and of ln(average loss / alpha^2)."""
    r, t = (a.ravel() for a in np.meshgrid(np.linspace(0.045, 1, 22), np.linspace(0.004, 1, 24)))
    alpha = r**2
    s = t / (1.0 + alpha)
    cosine = np.minimum(alpha * s / (1.0 - s), 1.0)
    loss = np.array([ggx_loss(*place) for place in zip(cosine, r, strict=True)])
    weight = np.maximum(loss, 1e-4)  # of logarithms: the fit is to the loss itself
    goal = np.log(np.maximum(loss, 1e-9) / (s * (1.0 - s) ** 2)) * weight
    terms = powers(2 * t - 1, 2 * r - 1, (4, 4)) * weight[:, None]
    local = np.linalg.lstsq(terms, goal, rcond=None)[0]

    rough = np.linspace(0.045, 1.0, 40)
    nodes, weights = unit_nodes(100)
    averages = []
    for value in rough:
        mu, fitted = loss_shape(nodes, np.full_like(nodes, value), local)
        stretch = value**2 / (1.0 - nodes / (1.0 + value**2)) ** 2 / (1.0 + value**2)
        averages.append((2.0 * fitted * mu * stretch * weights).sum())
    terms = powers(2 * rough - 1, np.zeros_like(rough), (5, 0))
    average = np.linalg.lstsq(terms, np.log(np.array(averages) / rough**4), rcond=None)[0]
    return {"local": local, "average": average}


def charlie_albedo(cosine: float, roughness: float, heights: int = 32, turns: int = 24) -> float:
    """What white Charlie sheen returns towards a view."""
    alpha = roughness**2
    w = (1.0 - alpha) ** 2
    a, b, c, d, e = (one + (zero - one) * w for zero, one in zip(AT_ZERO, AT_ONE, strict=True))

    def log_lambda(x: Any) -> Any:
        low = np.minimum(np.where(x < 0.5, x, 1.0 - x), 0.5)
        low = np.maximum(low, 1e-12)
        value = a / (1.0 + b * low**c) + d * low + e
        half = a / (1.0 + b * 0.5**c) + d * 0.5 + e
        return np.where(x < 0.5, value, 2.0 * half - value)

    root, weight = unit_nodes(heights)
    z = root**2
    phi = np.pi * (np.arange(turns) + 0.5) / turns  # the other half is its mirror image
    s, so = np.sqrt(1.0 - z * z)[:, None], np.sqrt(1.0 - cosine**2)
    h = [so + s * np.cos(phi), s * np.sin(phi), np.repeat((z + cosine)[:, None], turns, 1)]
    sine2 = 1.0 - h[2] ** 2 / (h[0] ** 2 + h[1] ** 2 + h[2] ** 2)
    D = (2.0 + 1.0 / alpha) * np.maximum(sine2, 1e-24) ** (0.5 / alpha) / (2.0 * np.pi)
    masked = 1.0 + np.exp(log_lambda(np.asarray(cosine))) + np.exp(log_lambda(z))
    area = 2.0 * root * weight * 2.0 * np.pi / turns
    return float((D * (area / (4.0 * cosine * masked))[:, None]).sum())


def fit_charlie() -> dict[str, Array]:
    """Coefficients of the albedo in 2 cosine^(1/4) - 1 and 2 roughness - 1."""
    low = [0.003, 0.006, 0.01, 0.015, 0.02]
    r, mu = (
        a.ravel()
        for a in np.meshgrid(
            np.linspace(0.3, 1.0, 12), np.concatenate([low, np.linspace(0.03, 1.0, 20)])
        )
    )
    value = np.array([charlie_albedo(*place) for place in zip(mu, r, strict=True)])
    terms = powers(2 * mu**0.25 - 1, 2 * r - 1, (5, 3))
    return {"albedo": np.linalg.lstsq(terms, value, rcond=None)[0]}


def committed(header: str, name: str) -> Array:
    """The numbers of array `name` in a header of ops/."""
    text = (OPS / header).read_text()
    found = re.search(rf"double {name}\[[^\]]*\][^=]*= *\{{([^;]*)\}};", text)
    assert found, f"{header} has no array {name}"
    return np.array([float(n) for n in re.findall(r"-?\d+\.\d+(?:e-?\d+)?", found[1])])


def main() -> int:
    """Print the fits, or say how far the committed ones are from them."""
    fits = {"ggx_loss.h": fit_ggx(), "charlie_albedo.h": fit_charlie()}
    if "--print" in sys.argv:
        for header, arrays in fits.items():
            for name, numbers in arrays.items():
                print(header, name, ", ".join(f"{n:.6f}" for n in numbers))
        return 0
    worst = max(
        float(np.abs(committed(header, name) - numbers).max())
        for header, arrays in fits.items()
        for name, numbers in arrays.items()
    )
    print(f"committed and fitted numbers differ by at most {worst:.1e}")
    return int(worst > 1e-4)


if __name__ == "__main__":
    raise SystemExit(main())
