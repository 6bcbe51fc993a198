"""Spherical harmonics: orthonormal, named signs, rotation, projection, irradiance, derivatives."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from photograd import sh
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import check_gradient

pytestmark = pytest.mark.usefixtures("core")


def quadrature(n: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Directions (M, 3) and weights in sr, exact for polynomials of degree 2 n - 1."""
    z, wz = np.polynomial.legendre.leggauss(n)
    phi = 2 * np.pi * np.arange(2 * n) / (2 * n)
    Z, P = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - Z**2)
    directions = np.stack([r * np.cos(P), r * np.sin(P), Z], -1).reshape(-1, 3)
    return directions, np.repeat(wz, 2 * n) * np.pi / n


def unit(n: int, seed: int) -> np.ndarray:
    d = np.random.default_rng(seed).normal(size=(n, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def some_rotation(seed: int) -> np.ndarray:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def test_the_basis_is_orthonormal() -> None:
    d, w = quadrature()
    Y = sh.basis(d, 4)
    gram = Y.T @ (w[:, None] * Y)
    np.testing.assert_allclose(gram, np.eye(25), atol=1e-13)  # measured 2e-15


@pytest.mark.parametrize(
    ("direction", "expected"),
    [
        # Y_00; Y_1: (-y, z, -x) 0.4886; Y_2: xy, -yz, 2zz-xx-yy, -xz, xx-yy with their constants
        ([1, 0, 0], [0.2820948, 0, 0, -0.4886025, 0, 0, -0.3153916, 0, 0.5462742]),
        ([0, 1, 0], [0.2820948, -0.4886025, 0, 0, 0, 0, -0.3153916, 0, -0.5462742]),
        ([0, 0, 1], [0.2820948, 0, 0.4886025, 0, 0, 0, 0.6307831, 0, 0]),
        (
            [0.6, 0.8, 0],
            [0.2820948, -0.3908820, 0, -0.2931615, 0.5244233, 0, -0.3153916, 0, -0.1529568],
        ),
        (
            [0, 0.6, 0.8],
            [0.2820948, -0.2931615, 0.3908820, 0, 0, -0.5244233, 0.2901602, 0, -0.1966587],
        ),
    ],
)
def test_golden_values_of_the_named_convention(
    direction: list[float], expected: list[float]
) -> None:
    Y = sh.basis(np.array([direction], float), 2)[0]
    np.testing.assert_allclose(Y, expected, atol=6e-8)  # seven printed digits
    plain = sh.to_convention(Y[:, None], "no_phase")[:, 0]
    odd = [1, 3, 5, 7]
    np.testing.assert_allclose(plain[odd], -np.array(expected)[odd], atol=6e-8)
    even = [0, 2, 4, 6, 8]
    np.testing.assert_allclose(plain[even], np.array(expected)[even], atol=6e-8)


def test_conventions_go_and_come_back() -> None:
    c = np.random.default_rng(1).normal(size=(5, 25, 3))
    there = sh.to_convention(c, "no_phase")
    assert not np.allclose(there, c)
    np.testing.assert_array_equal(sh.from_convention(there, "no_phase"), c)
    np.testing.assert_array_equal(sh.from_convention(c, "splat"), c)


@pytest.mark.parametrize("degree", range(5))
@pytest.mark.parametrize("channels", [1, 3])
def test_values_are_the_sum_over_the_basis(degree: int, channels: int) -> None:
    d = unit(50, degree)
    c = np.random.default_rng(2).normal(size=(50, sh.count(degree), channels))
    expected = np.einsum("nk,nkc->nc", sh.basis(d, degree), c)
    np.testing.assert_allclose(sh.evaluate(c, d), expected, rtol=1e-12, atol=1e-12)
    single = sh.evaluate(c.astype(np.float32), d.astype(np.float32))
    assert np.linalg.norm(single - expected) < 1e-6 * np.linalg.norm(expected)


@pytest.mark.parametrize("degree", range(5))
@pytest.mark.parametrize("channels", [1, 3])
def test_both_derivatives(degree: int, channels: int) -> None:
    point = {
        "coefficients": np.random.default_rng(3).normal(size=(4, sh.count(degree), channels)),
        "directions": unit(4, 4) * 1.1,  # no unit vectors: the formula is differentiated as it is
    }
    if degree == 0:
        del point["directions"]
    directions = point.get("directions", unit(4, 4))

    def value(p):
        return sh.evaluate(p["coefficients"], p.get("directions", directions))

    def backward(p, d_out):
        d_c, d_d = sh.evaluate_backward(p["coefficients"], p.get("directions", directions), d_out)
        if degree == 0:
            assert not d_d.any()
        return {"coefficients": d_c, "directions": d_d} if degree else {"coefficients": d_c}

    report = check_gradient(value, backward, point, seed=5)
    assert report, report


def test_rows_and_threads_do_not_mix() -> None:
    n = 9000  # more than two tasks
    d, c = unit(n, 6), np.random.default_rng(7).normal(size=(n, 9, 3))
    w = np.random.default_rng(8).normal(size=(n, 3))
    whole = sh.evaluate(c, d)
    d_c, d_d = sh.evaluate_backward(c, d, w)
    for part in (slice(0, 10), slice(4090, 4100), slice(8990, 9000)):
        np.testing.assert_array_equal(sh.evaluate(c[part], d[part]), whole[part])
        part_c, part_d = sh.evaluate_backward(c[part], d[part], w[part])
        np.testing.assert_array_equal(part_c, d_c[part])
        np.testing.assert_array_equal(part_d, d_d[part])


def test_projection_recovers_a_band_limited_function() -> None:
    d, w = quadrature()
    c = np.random.default_rng(9).normal(size=(25, 3))
    values = sh.basis(d, 4) @ c
    np.testing.assert_allclose(sh.project(d, values, w, 4), c, atol=1e-12)


def test_the_error_of_a_projection_falls_with_degree() -> None:
    d, w = quadrature(40)
    values = np.exp(2 * d[:, 2:]) * (1 + d[:, :1])  # smooth, not band-limited
    errors = []
    for degree in range(5):
        rebuilt = sh.basis(d, degree) @ sh.project(d, values, w, degree)
        errors.append(float(np.sqrt((w[:, None] * (rebuilt - values) ** 2).sum())))
    assert all(later < 0.6 * earlier for earlier, later in itertools.pairwise(errors))


@pytest.mark.parametrize("degree", range(5))
def test_rotating_coefficients_is_projecting_the_rotated_function(degree: int) -> None:
    R = some_rotation(degree)
    c = np.random.default_rng(10).normal(size=(sh.count(degree), 3))
    turned = sh.rotation(R, degree) @ c
    d = unit(100, 11)
    np.testing.assert_allclose(
        sh.basis(d @ R.T, degree) @ turned, sh.basis(d, degree) @ c, atol=1e-11
    )


def test_rotations_compose_and_are_orthonormal() -> None:
    A, B = some_rotation(1), some_rotation(2)
    a, b = sh.rotation(A, 4), sh.rotation(B, 4)
    np.testing.assert_allclose(sh.rotation(A @ B, 4), a @ b, atol=1e-11)
    np.testing.assert_allclose(a @ a.T, np.eye(25), atol=1e-11)


def test_irradiance_of_a_band_limited_light_is_exact() -> None:
    d, w = quadrature(60)
    c = np.random.default_rng(12).normal(size=(9, 3))
    n = unit(4, 13)
    # The half-space edge cuts through the quadrature: compare with one turned to each normal.
    for normal in n:
        other = np.array([1.0, 0, 0]) if abs(normal[0]) < 0.5 else np.array([0.0, 1, 0])
        x = np.cross(other, normal)
        x /= np.linalg.norm(x)
        frame = np.stack([x, np.cross(normal, x), normal])
        half_z, half_w = 0.5 * (d[:, 2] + 1), 0.5 * w  # the upper hemisphere, exactly
        r = np.sqrt(1 - half_z**2)
        phi = np.arctan2(d[:, 1], d[:, 0])
        local = np.stack([r * np.cos(phi), r * np.sin(phi), half_z], -1)
        radiance = sh.basis(local @ frame, 2) @ c
        brute = ((half_w * half_z)[:, None] * radiance).sum(0)
        np.testing.assert_allclose(sh.irradiance(c, normal[None])[0], brute, rtol=1e-6, atol=1e-6)


def test_a_constant_light_gives_pi_times_itself() -> None:
    c = np.zeros((1, 3))
    c[0] = 2.0 / 0.28209479177387814
    np.testing.assert_allclose(sh.irradiance(c, unit(5, 1)), 2 * np.pi, rtol=1e-12)


def test_odd_degrees_see_the_sign_of_a_direction_and_even_ones_do_not() -> None:
    d, c = unit(20, 14), np.random.default_rng(15).normal(size=(20, 25, 1))
    for band in range(5):
        only = np.zeros_like(c)
        at = slice(band * band, (band + 1) ** 2)
        only[:, at] = c[:, at]
        sign = 1 if band % 2 == 0 else -1
        np.testing.assert_allclose(sh.evaluate(only, -d), sign * sh.evaluate(only, d), atol=1e-12)


def test_bad_input_is_refused_by_name() -> None:
    d, c = unit(3, 1), np.zeros((3, 9, 3))
    with pytest.raises(RangeError, match="degree"):
        sh.count(5)
    with pytest.raises(RangeError, match="1, 4, 9, 16 or 25"):
        sh.evaluate(np.zeros((3, 5, 3)), d)
    with pytest.raises(RangeError, match="channels"):
        sh.evaluate(np.zeros((3, 9, 2)), d)
    with pytest.raises(ShapeError, match="coefficients"):
        sh.evaluate(np.zeros((9, 3)), d)
    with pytest.raises(ShapeError, match=r"directions: .* N = 4"):
        sh.evaluate(np.zeros((4, 9, 3)), d)
    with pytest.raises(DtypeError):
        sh.evaluate(c.astype(np.float32), d)
    with pytest.raises(RangeError, match="rotation"):
        sh.rotation(np.diag([1.0, 1.0, -1.0]), 2)
    with pytest.raises(RangeError, match="convention"):
        sh.from_convention(c, "other")  # type: ignore[arg-type]
