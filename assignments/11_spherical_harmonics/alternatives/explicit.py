"""Explicit polynomials of each harmonic and their gradients; rotation by least squares."""

import numpy as np
from plenoxels import Adam, corners, loss_and_grad, march, quadrature


def _table(d, degree):
    """Harmonics (25, N) written out, and their gradients (25, 3, N)."""
    x, y, z = d.T
    o = np.ones_like(x)
    n = o * 0
    xx, yy, zz = x * x, y * y, z * z
    pi = np.pi
    a1 = np.sqrt(3 / (4 * pi))
    a2 = np.sqrt(15 / (4 * pi))
    a33, a32, a31 = np.sqrt(35 / (32 * pi)), np.sqrt(105 / (4 * pi)), np.sqrt(21 / (32 * pi))
    a30 = np.sqrt(7 / (16 * pi))
    a44, a43 = 0.75 * np.sqrt(35 / pi), 0.75 * np.sqrt(35 / (2 * pi))
    a42, a41, a40 = 0.75 * np.sqrt(5 / pi), 0.75 * np.sqrt(5 / (2 * pi)), 3 / 16 * np.sqrt(1 / pi)
    rows = [
        (0.5 / np.sqrt(pi), o, (n, n, n)),
        (-a1, y, (n, o, n)),
        (a1, z, (n, n, o)),
        (-a1, x, (o, n, n)),
        (a2, x * y, (y, x, n)),
        (-a2, y * z, (n, z, y)),
        (np.sqrt(5 / (16 * pi)), 3 * zz - 1, (n, n, 6 * z)),
        (-a2, x * z, (z, n, x)),
        (a2 / 2, xx - yy, (2 * x, -2 * y, n)),
        (-a33, y * (3 * xx - yy), (6 * x * y, 3 * (xx - yy), n)),
        (a32, x * y * z, (y * z, x * z, x * y)),
        (-a31, y * (5 * zz - 1), (n, 5 * zz - 1, 10 * y * z)),
        (a30, 5 * z * zz - 3 * z, (n, n, 15 * zz - 3)),
        (-a31, x * (5 * zz - 1), (5 * zz - 1, n, 10 * x * z)),
        (a32 / 2, z * (xx - yy), (2 * x * z, -2 * y * z, xx - yy)),
        (-a33, x * (xx - 3 * yy), (3 * (xx - yy), -6 * x * y, n)),
        (a44, x * y * (xx - yy), (y * (3 * xx - yy), x * (xx - 3 * yy), n)),
        (-a43, y * z * (3 * xx - yy), (6 * x * y * z, 3 * z * (xx - yy), y * (3 * xx - yy))),
        (a42, x * y * (7 * zz - 1), (y * (7 * zz - 1), x * (7 * zz - 1), 14 * x * y * z)),
        (-a41, y * z * (7 * zz - 3), (n, z * (7 * zz - 3), y * (21 * zz - 3))),
        (a40, 35 * zz * zz - 30 * zz + 3, (n, n, 140 * z * zz - 60 * z)),
        (-a41, x * z * (7 * zz - 3), (z * (7 * zz - 3), n, x * (21 * zz - 3))),
        (
            a42 / 2,
            (xx - yy) * (7 * zz - 1),
            (2 * x * (7 * zz - 1), -2 * y * (7 * zz - 1), 14 * z * (xx - yy)),
        ),
        (-a43, x * z * (xx - 3 * yy), (3 * z * (xx - yy), -6 * x * y * z, x * (xx - 3 * yy))),
        (
            a44 / 4,
            xx * xx - 6 * xx * yy + yy * yy,
            (4 * x * (xx - 3 * yy), -4 * y * (3 * xx - yy), n),
        ),
    ]
    rows = rows[: (degree + 1) ** 2]
    Y = np.stack([size * value for size, value, _ in rows])
    return Y, np.stack([size * np.stack(slopes) for size, _, slopes in rows])


def sh_basis(directions, degree):
    return _table(directions, degree)[0].T.copy()


def sh_project(directions, weights, values, degree):
    return np.einsum("nk,n,nc->kc", sh_basis(directions, degree), weights, values)


def sh_color_adjoint(coefficients, v, g):
    degree = int(np.sqrt(coefficients.shape[1])) - 1
    length = np.sqrt(np.sum(v * v, axis=1))
    d = v / length[:, None]
    Y, slopes = _table(d, degree)
    raw = np.einsum("kin,nkc,nc->ni", slopes, coefficients, g)
    tangent = (np.eye(3) - d[:, :, None] * d[:, None, :]) / length[:, None, None]
    return np.einsum("kn,nc->nkc", Y, g), np.einsum("nij,nj->ni", tangent, raw)


def sh_rotate(coefficients, R):
    degree = int(np.sqrt(len(coefficients))) - 1
    d = quadrature(12)[0]
    result = np.linalg.lstsq(sh_basis(d @ R.T, degree), sh_basis(d, degree) @ coefficients, None)
    return result[0]


def probe_irradiance(probes, p, normals):
    degree = int(np.sqrt(probes.shape[3])) - 1
    factors = []
    for ell in range(degree + 1):
        t, share = np.polynomial.legendre.leggauss(8)
        t, share = (t + 1) / 2, share / 2
        value = np.polynomial.legendre.legval(t, np.eye(5)[ell])
        factors += [2 * np.pi * np.sum(share * t * value)] * (2 * ell + 1)
    Y = sh_basis(normals, degree) * np.array(factors)
    index, weight = corners(probes.shape[:3], p)
    each = np.einsum("nk,enkc->enc", Y, probes.reshape(-1, *probes.shape[3:])[index])
    return np.sum(weight[:, :, None] * each, axis=0)


def _finer(values):
    for axis in range(3):
        n = values.shape[axis]
        before = np.take(values, np.maximum(np.arange(n) - 1, 0), axis)
        after = np.take(values, np.minimum(np.arange(n) + 1, n - 1), axis)
        pair = np.stack([(before + 3 * values) / 4, (3 * values + after) / 4], axis=axis + 1)
        shape = list(values.shape)
        shape[axis] = 2 * n
        values = pair.reshape(shape)
    return values


def fit_plenoxels(density, coefficients, rays, target, levels, steps):
    losses = np.zeros(levels * steps)
    for k in range(levels * max(steps, 1)):
        if k % max(steps, 1) == 0:
            if k > 0:
                density, coefficients = _finer(density), _finer(coefficients)
            samples, descents = march(density.shape, rays), (Adam(), Adam())
        if steps > 0:
            losses[k], *slopes = loss_and_grad(density, coefficients, samples, target)
            density = np.clip(descents[0].step(density, slopes[0]), 0, None)
            coefficients = descents[1].step(coefficients, slopes[1])
    return density, coefficients, losses
