"""Scalar loops: one direction, one harmonic at a time, by angles."""

from __future__ import annotations

import math

import numpy as np

SAMPLES = 20
RATE = 0.1


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


def quadrature(degree):
    z, share = np.polynomial.legendre.leggauss(degree // 2 + 1)
    phi = (np.arange(degree + 1) + 0.5) * (2 * np.pi / (degree + 1))
    z, phi = (values.ravel() for values in np.meshgrid(z, phi, indexing="ij"))
    r = np.sqrt(1 - z * z)
    weights = np.repeat(share, degree + 1) * (2 * np.pi / (degree + 1))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1), weights


def sh_color(coefficients, v):
    degree = round(coefficients.shape[1] ** 0.5) - 1
    d = v / np.linalg.norm(v, axis=1, keepdims=True)
    return np.einsum("nk,nkc->nc", sh_basis(d, degree), coefficients)


def corners(shape, p):
    last = np.array(shape) - 1
    q = np.clip(p, 0, last)
    low = np.minimum(np.floor(q).astype(int), np.maximum(last - 1, 0))
    index, weight = [], []
    for corner in np.ndindex(2, 2, 2):
        cell = np.minimum(low + corner, last)
        index.append((cell[:, 0] * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2])
        weight.append(np.prod(np.where(corner, q - low, 1 - (q - low)), axis=1))
    return np.stack(index), np.stack(weight)


def march(shape, rays):
    origin, direction = rays
    with np.errstate(divide="ignore"):
        ends = (np.array([[[-1.0]], [[1.0]]]) - origin) / direction
    near = np.maximum(ends.min(axis=0).max(axis=1), 0)
    step = np.maximum(ends.max(axis=0).min(axis=1) - near, 0) / SAMPLES
    t = near[:, None] + step[:, None] * (np.arange(SAMPLES) + 0.5)
    place = origin[:, None] + t[:, :, None] * direction[:, None]
    p = (place + 1) / 2 * np.array(shape) - 0.5
    return (tuple(shape), -direction, step, *corners(shape, p.reshape(-1, 3)))


def _along_rays(density, coefficients, samples):
    _, _, step, index, weight = samples
    K, C = coefficients.shape[3:]
    sigma = np.sum(weight * density.ravel()[index], axis=0).reshape(len(step), -1)
    kept = np.cumprod(np.exp(-sigma * step[:, None]), axis=1)
    T = np.concatenate([np.ones((len(step), 1)), kept[:, :-1]], axis=1)
    w = T - kept
    at = np.einsum("en,enf->nf", weight, coefficients.reshape(-1, K * C)[index])
    at = at.reshape(*w.shape, K, C)
    return kept, w, at, np.einsum("rs,rskc->rkc", w, at)


def render(density, coefficients, samples):
    return sh_color(_along_rays(density, coefficients, samples)[3], samples[1])


def loss_and_grad(density, coefficients, samples, target):
    shape, v, step, index, weight = samples
    kept, w, at, blended = _along_rays(density, coefficients, samples)
    residual = sh_color(blended, v) - target
    d_blended, _ = sh_color_adjoint(blended, v, 2 * residual / residual.size)
    flat = index.ravel()
    d_at = (w[:, :, None, None] * d_blended[:, None]).reshape(w.size, -1)
    d_grid = [
        np.bincount(flat, (weight * column).ravel(), int(np.prod(shape))) for column in d_at.T
    ]
    d_w = np.einsum("rskc,rkc->rs", at, d_blended)
    behind = np.cumsum((w * d_w)[:, ::-1], axis=1)[:, ::-1] - w * d_w
    d_sigma = step[:, None] * (kept * d_w - behind)
    d_density = np.bincount(flat, (weight * d_sigma.ravel()).ravel(), int(np.prod(shape)))
    d_coefficients = np.stack(d_grid, axis=-1).reshape(coefficients.shape)
    return float(np.mean(residual**2)), d_density.reshape(shape), d_coefficients


class Adam:
    def __init__(self):
        self.m = self.v = self.k = 0

    def step(self, x, d_x):
        self.k += 1
        self.m = 0.9 * self.m + 0.1 * d_x
        self.v = 0.99 * self.v + 0.01 * d_x**2
        m, v = self.m / (1 - 0.9**self.k), self.v / (1 - 0.99**self.k)
        return x - RATE * m / (np.sqrt(v) + 1e-8)
