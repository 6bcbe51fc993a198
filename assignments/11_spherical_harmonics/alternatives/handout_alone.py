"""From the handout alone: recurrence in lists, complex steps for the derivatives."""

from __future__ import annotations

import numpy as np

SAMPLES = 20
RATE = 0.1


def sh_basis(directions, degree):
    columns = [None] * (degree + 1) ** 2
    x, y, z = directions[:, 0], directions[:, 1], directions[:, 2]
    a, b = np.ones(len(z)), np.zeros(len(z))
    start = np.ones(len(z))
    for m in range(degree + 1):
        older, old = 0 * z, start
        for ell in range(m, degree + 1):
            N = (2 * ell + 1) / (4 * np.pi)
            for j in range(ell - m + 1, ell + m + 1):
                N = N / j
            N = np.sqrt(N) * (-1.0) ** m
            if m == 0:
                columns[ell * (ell + 1)] = N * old
            else:
                columns[ell * (ell + 1) + m] = np.sqrt(2) * N * old * a
                columns[ell * (ell + 1) - m] = np.sqrt(2) * N * old * b
            older, old = old, ((2 * ell + 1) * z * old - (ell + m) * older) / (ell + 1 - m)
        a, b = x * a - y * b, y * a + x * b
        start = start * (2 * m + 1)
    return np.stack(columns, axis=1)


def sh_project(directions, weights, values, degree):
    Y = sh_basis(directions, degree)
    return np.stack(
        [(Y[:, [k]] * values * weights[:, None]).sum(axis=0) for k in range(Y.shape[1])]
    )


def _slopes(d, degree):
    """Derivatives of all harmonics by x, y, z: (N, K, 3), by complex steps."""
    rows = []
    for i in range(3):
        moved = d.astype(complex)
        moved[:, i] += 1e-30j
        x, y, z = moved[:, 0], moved[:, 1], moved[:, 2]
        columns = [None] * (degree + 1) ** 2
        a, b, start = np.ones_like(z), np.zeros_like(z), np.ones_like(z)
        for m in range(degree + 1):
            older, old = 0 * z, start
            for ell in range(m, degree + 1):
                size = (2 * ell + 1) / (4 * np.pi) / np.prod(np.arange(ell - m + 1, ell + m + 1))
                size = np.sqrt(size * (1 + (m > 0))) * (-1.0) ** m
                columns[ell * (ell + 1) - m] = size * old * b
                columns[ell * (ell + 1) + m] = size * old * a
                older, old = old, ((2 * ell + 1) * z * old - (ell + m) * older) / (ell + 1 - m)
            a, b, start = x * a - y * b, y * a + x * b, start * (2 * m + 1)
        rows.append(np.stack(columns, axis=1).imag / 1e-30)
    return np.stack(rows, axis=2)


def sh_color_adjoint(coefficients, v, g):
    degree = round(np.sqrt(coefficients.shape[1])) - 1
    length = np.linalg.norm(v, axis=1)[:, None]
    d = v / length
    d_Y = (coefficients * g[:, None, :]).sum(axis=2)
    d_d = (d_Y[:, :, None] * _slopes(d, degree)).sum(axis=1)
    d_v = (d_d - d * (d * d_d).sum(axis=1)[:, None]) / length
    return sh_basis(d, degree)[:, :, None] * g[:, None, :], d_v


def sh_rotate(coefficients, R):
    degree = round(np.sqrt(len(coefficients))) - 1
    d, w = quadrature(8)
    return sh_project(d, w, sh_basis((R.T @ d.T).T, degree) @ coefficients, degree)


def probe_irradiance(probes, p, normals):
    X, Y, Z, K, C = probes.shape
    degree = round(np.sqrt(K)) - 1
    A = {0: np.pi, 1: 2 * np.pi / 3, 2: np.pi / 4, 3: 0.0, 4: -np.pi / 24}
    light = np.zeros((len(p), K, C))
    for i, w in zip(*corners((X, Y, Z), p), strict=True):
        light += w[:, None, None] * probes.reshape(X * Y * Z, K, C)[i]
    for ell in range(degree + 1):
        light[:, ell * ell : (ell + 1) ** 2] *= A[ell]
    return (sh_basis(normals, degree)[:, :, None] * light).sum(axis=1)


def fit_plenoxels(density, coefficients, rays, target, levels, steps):
    losses = []
    for level in range(levels):
        samples = march(density.shape, rays)
        adams = Adam(), Adam()
        for _ in range(steps):
            loss, d_density, d_coefficients = loss_and_grad(density, coefficients, samples, target)
            losses += [loss]
            density = np.where(
                (new := adams[0].step(density, d_density)) > 0, new, np.zeros_like(new)
            )
            coefficients = adams[1].step(coefficients, d_coefficients)
        if level < levels - 1:
            fine = 2 * np.array(density.shape)
            cells = np.array(list(np.ndindex(*fine)))
            index, weight = corners(density.shape, cells / 2 - 0.25)
            K, C = coefficients.shape[3:]
            flat, flat_c = density.reshape(-1), coefficients.reshape(-1, K, C)
            density = sum(w * flat[i] for i, w in zip(index, weight, strict=True)).reshape(fine)
            blended = sum(w[:, None, None] * flat_c[i] for i, w in zip(index, weight, strict=True))
            coefficients = blended.reshape(*fine, K, C)
    return density, coefficients, np.array(losses)


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
