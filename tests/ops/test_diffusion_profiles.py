"""Diffusion profiles against identities (integrals, inverses, limits), and wrong adjoints."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.transport.subsurface import (
    diffusion_cdf,
    dipole,
    dipole_albedo,
    normalized_diffusion,
    sample_radius,
)
from photograd_course.gradcheck import check_gradient

from tests.registry.test_ops import Proof, draw, flat
from tests.splat.test_mutants import TOLERANCE, Groups

pytestmark = pytest.mark.usefixtures("core")
FITS: tuple[Any, ...] = ("searchlight", "diffuse", "diffuse_free_path")


def integral_over_plane(profile: Any, scale: float) -> float:
    """Of 2 pi r profile(r), from r = scale e^-18 to scale e^7."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    r = scale * np.exp(-5.5 + 12.5 * nodes)
    return float(12.5 * (weights * 2 * np.pi * r**2 * profile(r)).sum())


@pytest.mark.parametrize("eta", [1.0, 1.3, 1.5])
@pytest.mark.parametrize("sigma_a", [1e-3, 0.1, 2.0])
def test_the_dipole_integrates_to_its_closed_form(sigma_a: float, eta: float) -> None:
    sigma_s = 1.7
    found = integral_over_plane(lambda r: dipole(r, sigma_s, sigma_a, eta), 1.0)
    assert found == pytest.approx(float(dipole_albedo(sigma_s, sigma_a, eta)), rel=1e-6)


def test_the_dipole_in_limits() -> None:
    # Nothing absorbed: all comes back. Nothing scattered: nothing.
    assert dipole_albedo(3.0, 0.0, 1.3) == pytest.approx(1.0, abs=1e-14)
    assert dipole_albedo(1e-9, 1.0, 1.3) < 1e-9
    # Distances scale with the mean free path.
    assert dipole(2.0, 0.9, 0.1, 1.3) == pytest.approx(float(dipole(1.0, 1.8, 0.2, 1.3)) / 4)
    # Far away exp(-q r) / r^2: the field of a dipole in a medium that absorbs.
    r, q = np.array([200.0, 201.0]), np.sqrt(3 * 0.1)
    near, far = dipole(r, 0.9, 0.1) * r**2 * np.exp(q * r)
    assert far == pytest.approx(near, rel=1e-4)
    # A boundary that reflects light back inside lets less of it out.
    assert (np.diff(dipole_albedo(0.9, 0.1, np.array([1.0, 1.2, 1.4, 1.6]))) < 0).all()


@pytest.mark.parametrize("fit", FITS)
@pytest.mark.parametrize("albedo", [0.05, 0.5, 0.8, 0.99])
def test_normalized_diffusion_integrates_to_its_albedo(albedo: float, fit: Any) -> None:
    def profile(r: Any) -> Any:
        return normalized_diffusion(r, albedo, 0.7, fit)

    # What lies within the smallest radius is e^-18 of a length: 1e-8.
    assert integral_over_plane(profile, 0.7) == pytest.approx(albedo, rel=1e-6)
    r, h = np.array([0.01, 0.1, 0.4]), 1e-5
    slope = (
        diffusion_cdf(r * (1 + h), albedo, 0.7, fit) - diffusion_cdf(r * (1 - h), albedo, 0.7, fit)
    ) / (2 * h * r)
    np.testing.assert_allclose(slope * albedo, 2 * np.pi * r * profile(r), rtol=1e-8)


def test_the_lengths_of_the_fits() -> None:
    # The mean radius is 2.5 D: the median over u of a fine grid, of each fit of s = 1 / D.
    u = (np.arange(20000) + 0.5) / 20000
    A = np.array([0.3, 0.8, 0.95])
    expected = {
        "searchlight": 1.85 - A + 7 * np.abs(A - 0.8) ** 3,
        "diffuse": 1.9 - A + 3.5 * (A - 0.8) ** 2,
        "diffuse_free_path": 3.5 + 100 * (A - 0.33) ** 4,
    }
    for fit in FITS:
        mean = sample_radius(u[:, None], A, 1.0, fit).mean(axis=0)
        np.testing.assert_allclose(mean, 2.5 / expected[fit], rtol=1e-3)


def test_the_inverse_cdf_is_exact() -> None:
    assert sample_radius(0.0, 0.6, 2.0) == 0
    u = np.concatenate([np.logspace(-12, -1, 12), np.linspace(0.11, 0.99, 50)])
    r = sample_radius(u, 0.6, 2.0)
    np.testing.assert_allclose(diffusion_cdf(r, 0.6, 2.0), u, rtol=1e-12)
    # Towards u = 1, by what is left: 1 - C is 3/4 exp(-r / (3 D)) to the last digit.
    rest = np.logspace(-15, -9, 7)
    D = 2.0 / float(1.85 - 0.6 + 7 * 0.2**3)
    far = sample_radius(1 - rest, 0.6, 2.0)
    np.testing.assert_allclose(0.75 * np.exp(-far / (3 * D)), 1 - (1 - rest), rtol=1e-11)
    assert (np.diff(r) > 0).all()


def profile_adjoint(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    """Of the op diffusion_searchlight, in NumPy, with one thing wrong."""
    r, A, mfp, u = (float(groups[name][0]) for name in ("radius", "albedo", "mean_free_path", "u"))
    c = A - 0.8
    s, ds = 1.85 - A + 7 * abs(c) ** 3, -1 + 21 * c * abs(c)
    if wrong == "even power of the fit":
        ds = -1 + 21 * c * c
    D = mfp / s
    near, far = np.exp(-r / D), np.exp(-r / (3 * D))
    R = A * (near + far) / (8 * np.pi * D * r)
    slope = -A / (8 * np.pi * D**2 * r) * (near + far / 3)
    R_r = slope if wrong == "1 / r held fixed" else slope - R / r
    R_D = -slope * r / D - (0 if wrong == "norm held fixed" else R / D)
    C_r = (near + far) / (4 * D)
    radius = float(sample_radius(u, A, mfp))
    x = np.exp(-radius / (3 * D))
    radius_u = 4 * D / (x + (0 if wrong == "cubic without its cube" else x**3))
    d_R, d_C, d_radius = d_out
    d_D = d_R * R_D - d_C * C_r * r / D + d_radius * radius / D
    d_A = d_R * R / A - d_D * D / s * ds
    if wrong == "length does not depend on the albedo":
        d_A = d_R * R / A
    return {
        "radius": np.array([d_R * R_r + d_C * C_r]),
        "albedo": np.array([d_A]),
        "mean_free_path": np.array([d_D * (1.0 if wrong == "length for free path" else 1 / s)]),
        "u": np.array([d_radius * radius_u]),
    }


def dipole_adjoint(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    """Of the op dipole, in NumPy by complex steps through the formula, with one thing wrong."""
    radius = groups["radius"]
    x = np.concatenate([groups[name] for name in ("sigma_s", "sigma_a", "eta")])

    def outputs(x: Any, radius: Any) -> Any:
        s, a, eta = x
        t = s + a
        k = 3 * a * (t.real if wrong == "k with sigma_t held fixed" else t)
        F = -1.44 / eta**2 + 0.71 / eta + 0.668 + 0.0636 * eta
        B = 1 + 4 / 3 * (1 + F) / (1 - F)
        if wrong == "boundary held fixed":
            B = B.real
        q, total, rows = np.sqrt(k), 0, 0
        below, above = 1 / t, B / t
        if wrong == "second source held fixed":
            above = above.real
        for z in (below, above):
            d = np.sqrt(radius**2 + z**2)
            rows = rows + z * (1 + q * d) * np.exp(-q * d) / d**3
            total = total + np.exp(-q * z)
        albedo = s / (t.real if wrong == "albedo with sigma_t held fixed" else t)
        return np.append(albedo / (4 * np.pi) * rows, albedo / 2 * total)

    h = 1e-30
    d_x = [d_out @ outputs(x + 1j * h * e, radius).imag / h for e in np.eye(3)]
    d_radius = [d_out @ outputs(x + 0j, radius + 1j * h * e).imag / h for e in np.eye(3)]
    return {
        "radius": np.array(d_radius),
        "sigma_s": np.array(d_x[:1]),
        "sigma_a": np.array(d_x[1:2]),
        "eta": np.array(d_x[2:]),
    }


ADJOINTS: dict[str, Any] = {"diffusion_searchlight": profile_adjoint, "dipole": dipole_adjoint}
WRONG = {
    "diffusion_searchlight": [
        "even power of the fit",
        "1 / r held fixed",
        "norm held fixed",
        "cubic without its cube",
        "length does not depend on the albedo",
        "length for free path",
    ],
    "dipole": [
        "k with sigma_t held fixed",
        "boundary held fixed",
        "second source held fixed",
        "albedo with sigma_t held fixed",
    ],
}


@pytest.mark.parametrize("name", ADJOINTS)
def test_the_right_formula_passes_and_equals_the_core(name: str) -> None:
    proof = Proof(name)
    place = draw(proof.op, 11)
    assert check_gradient(proof.forward, lambda p, d: ADJOINTS[name](None, p, d), place, seed=11)
    d_y = np.random.default_rng(1).standard_normal(proof.op.outputs)
    mine, core = (
        flat(proof.op, found)
        for found in (ADJOINTS[name](None, place, d_y), proof.backward(place, d_y))
    )
    np.testing.assert_allclose(mine, core, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize(("name", "wrong"), [(n, w) for n, all_ in WRONG.items() for w in all_])
def test_wrong_adjoint_dies(name: str, wrong: str) -> None:
    proof = Proof(name)
    report = check_gradient(
        proof.forward,
        lambda p, d: ADJOINTS[name](wrong, p, d),
        draw(proof.op, 11),
        seed=11,
        tolerance=TOLERANCE,
    )
    assert not report, wrong
    assert max(group.error for group in report.groups) >= 1000 * TOLERANCE, str(report)


def test_a_medium_that_absorbs_nothing_has_a_derivative_at_each_distance() -> None:
    # R_d is smooth in sigma_a sigma_t, not in its root; the core keeps the root out.
    rows = np.array([[1.5, 2.0, 0.0, 1.3]])
    d_rows = np.zeros_like(rows)
    _core.dipole_backward(rows, np.ones(1), d_rows)
    h = 1e-6
    slope = (dipole(1.5, 2.0, h, 1.3) - dipole(1.5, 2.0, 0.0, 1.3)) / h
    # One-sided: of first order in sqrt(h) through the third power of the root.
    assert d_rows[0, 2] == pytest.approx(float(slope), rel=5e-3)
