"""From the handout alone: recurrence in lists, differentiated step by step."""

import numpy as np
from plenoxels import Adam, corners, loss_and_grad, march, quadrature


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
    """Derivatives of all harmonics with respect to x, y, z: (N, K, 3), by the recurrence's own."""
    x, y, z = d[:, 0], d[:, 1], d[:, 2]
    found = np.zeros((len(d), (degree + 1) ** 2, 3))
    a, b, start = np.ones(len(z)), np.zeros(len(z)), np.ones(len(z))
    less_a, less_b = 0 * z, 0 * z
    for m in range(degree + 1):
        older, old, older_z, old_z = 0 * z, start, 0 * z, 0 * z
        for ell in range(m, degree + 1):
            size = (2 * ell + 1) / (4 * np.pi) / np.prod(np.arange(ell - m + 1, ell + m + 1))
            size = np.sqrt(size * (1 + (m > 0))) * (-1.0) ** m
            for k, part, by_x, by_y in ((-m, b, less_b, less_a), (m, a, less_a, -less_b)):
                parts = (m * old * by_x, m * old * by_y, old_z * part)
                found[:, ell * (ell + 1) + k] = size * np.stack(parts, axis=1)
            grown = (2 * ell + 1) * z * old - (ell + m) * older
            grown_z = (2 * ell + 1) * (old + z * old_z) - (ell + m) * older_z
            older, old, older_z, old_z = (
                old,
                grown / (ell + 1 - m),
                old_z,
                grown_z / (ell + 1 - m),
            )
        less_a, less_b = a, b
        a, b, start = x * a - y * b, y * a + x * b, start * (2 * m + 1)
    return found


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
