"""Scalar loops: one direction, one harmonic at a time, by angles."""

import math

import numpy as np
from plenoxels import Adam, corners, loss_and_grad, march, quadrature


def _legendre_terms(ell, m):
    """Coefficients, highest power first, of the m-th derivative of a Legendre polynomial of z."""
    terms = [0.0] * (max(ell - m, 0) + 1)
    for k in range(ell // 2 + 1):
        power = ell - 2 * k
        if power < m:
            continue
        term = (-1) ** k * math.factorial(2 * ell - 2 * k) / 2**ell
        term /= math.factorial(k) * math.factorial(ell - k) * math.factorial(power)
        terms[ell - power] = term * math.perm(power, m)
    return terms


TERMS = {(ell, m): _legendre_terms(ell, m) for ell in range(5) for m in range(ell + 2)}


def _legendre(ell, m, z):
    value = 0.0
    for term in TERMS[ell, m]:
        value = value * z + term
    return value


def _norm(ell, m):
    n = (2 * ell + 1) * math.factorial(ell - m) / math.factorial(ell + m) / (4 * math.pi)
    return (-1) ** m * math.sqrt(n if m == 0 else 2 * n)


def _wave(m, x, y):
    """Real or imaginary part of (x + i y)^|m|, for a negative m the latter."""
    p = complex(x, y) ** abs(m)
    return p.real if m >= 0 else p.imag


def _wave_slopes(m, x, y):
    p = abs(m) * complex(x, y) ** (abs(m) - 1) if m != 0 else 0j
    return (p.real, -p.imag) if m >= 0 else (p.imag, p.real)


def sh_basis(directions, degree):
    rows = []
    orders = [(ell, m) for ell in range(degree + 1) for m in range(-ell, ell + 1)]
    sizes = [_norm(ell, abs(m)) for ell, m in orders]
    for x, y, z in directions.tolist():
        Q = [[_legendre(ell, m, z) for m in range(ell + 1)] for ell in range(degree + 1)]
        waves = {m: _wave(m, x, y) for m in range(-degree, degree + 1)}
        rows.append(
            [s * Q[ell][abs(m)] * waves[m] for (ell, m), s in zip(orders, sizes, strict=True)]
        )
    return np.array(rows)


def sh_project(directions, weights, values, degree):
    Y = sh_basis(directions, degree)
    result = np.zeros((Y.shape[1], values.shape[1]))
    for n in range(len(Y)):
        for k in range(Y.shape[1]):
            result[k] += weights[n] * Y[n, k] * values[n]
    return result


def sh_color_adjoint(coefficients, v, g):
    degree = math.isqrt(coefficients.shape[1]) - 1
    d_c, d_v = np.zeros(coefficients.shape), np.zeros(v.shape)
    for n in range(len(v)):
        length = math.sqrt(sum(a * a for a in v[n].tolist()))
        x, y, z = (v[n] / length).tolist()
        raw = [0.0, 0.0, 0.0]
        for ell in range(degree + 1):
            for m in range(-ell, ell + 1):
                k, a = ell * (ell + 1) + m, abs(m)
                size, polynomial, wave = _norm(ell, a), _legendre(ell, a, z), _wave(m, x, y)
                d_c[n, k] = size * polynomial * wave * g[n]
                pull = size * float(coefficients[n, k] @ g[n])
                by_x, by_y = _wave_slopes(m, x, y)
                raw[0] += pull * polynomial * by_x
                raw[1] += pull * polynomial * by_y
                raw[2] += pull * _legendre(ell, a + 1, z) * wave
        radial = raw[0] * x + raw[1] * y + raw[2] * z
        d_v[n] = [(r - radial * e) / length for r, e in zip(raw, (x, y, z), strict=True)]
    return d_c, d_v


def sh_rotate(coefficients, R):
    degree = math.isqrt(len(coefficients)) - 1
    directions, weights = quadrature(2 * degree + 2)
    values = np.zeros((len(directions), coefficients.shape[1]))
    for n, d in enumerate(directions):
        values[n] = sh_basis((R.T @ d)[None], degree)[0] @ coefficients
    return sh_project(directions, weights, values, degree)


def probe_irradiance(probes, p, normals):
    lobe = (math.pi, 2 * math.pi / 3, math.pi / 4, 0.0, -math.pi / 24)
    X, Y, Z, K, C = probes.shape
    harmonics = sh_basis(normals, math.isqrt(K) - 1)
    result = np.zeros((len(p), C))
    for n in range(len(p)):
        q = [min(max(float(a), 0.0), s - 1.0) for a, s in zip(p[n], (X, Y, Z), strict=True)]
        light = np.zeros((K, C))
        for i in range(X):
            for j in range(Y):
                for k in range(Z):
                    hats = [max(0.0, 1 - abs(a - b)) for a, b in zip(q, (i, j, k), strict=True)]
                    light += hats[0] * hats[1] * hats[2] * probes[i, j, k]
        for k in range(K):
            result[n] += lobe[math.isqrt(k)] * harmonics[n, k] * light[k]
    return result


def _refined(values):
    shape = values.shape[:3]
    fine = np.zeros((*(2 * n for n in shape), *values.shape[3:]))
    for cell in np.ndindex(fine.shape[:3]):
        place = np.array([[(i + 0.5) / 2 - 0.5 for i in cell]])
        index, weight = corners(shape, place)
        for e in range(8):
            at = np.unravel_index(index[e, 0], shape)
            fine[cell] += weight[e, 0] * values[at]
    return fine


def fit_plenoxels(density, coefficients, rays, target, levels, steps):
    density, coefficients, losses = density.copy(), coefficients.copy(), []
    for level in range(levels):
        if level:
            density, coefficients = _refined(density), _refined(coefficients)
        samples = march(density.shape, rays)
        first, second = Adam(), Adam()
        for _ in range(steps):
            loss, a, b = loss_and_grad(density, coefficients, samples, target)
            losses.append(loss)
            density = first.step(density, a)
            density[density < 0] = 0.0
            coefficients = second.step(coefficients, b)
    return density, coefficients, np.array(losses, dtype=float)
