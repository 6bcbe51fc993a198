"""Functions of direction in a few numbers: spherical harmonics, light probes, Plenoxels.

A direction is a unit vector (x, y, z). Coefficient l (l + 1) + m belongs to the harmonic of degree
l and order m, m from -l to l; there are K = (degree + 1)^2. Signs include the phase (-1)^m, so
degree 1 is 0.4886 times (-y, z, -x). Degrees go from 0 to 4. A grid is indexed [i, j, k] along x,
y, z; points in it are measured in *cells*: the value at [i, j, k] belongs to the point (i, j, k).

Your tasks are six functions, one section of the handout each; `photograd course check 11` tells
how far you are. The other functions are given and stay as they are. All numbers are float64.
"""

from __future__ import annotations

from typing import Annotated

import numpy as np

# Arrays and their shapes; float64 where nothing else is said.
Vectors = Annotated[np.ndarray, "N 3"]
Basis = Annotated[np.ndarray, "N K"]
Weights = Annotated[np.ndarray, "N"]
Values = Annotated[np.ndarray, "N C"]
Coefficients = Annotated[np.ndarray, "K C"]
RowCoefficients = Annotated[np.ndarray, "N K C"]
Rotation = Annotated[np.ndarray, "3 3"]
Density = Annotated[np.ndarray, "X Y Z"]
Probes = Annotated[np.ndarray, "X Y Z K C"]
Rays = Annotated[np.ndarray, "2 R 3"]  # origins, directions
Colors = Annotated[np.ndarray, "R C"]
Losses = Annotated[np.ndarray, "steps"]

SAMPLES = 20  # per ray
RATE = 0.1  # of Adam
# >>> solution 11.1


def _pieces(directions, degree):
    """(x + i y)^m, and the polynomials of z by degree and order, with a zero order beyond l."""
    x, y, z = directions.T
    waves = np.stack([(x + 1j * y) ** m for m in range(degree + 1)])
    Q = np.zeros((degree + 1, degree + 2, len(z)))
    for m in range(degree + 1):
        Q[m, m] = np.prod(np.arange(1, 2 * m, 2))
        if m < degree:
            Q[m + 1, m] = (2 * m + 1) * z * Q[m, m]
        for ell in range(m + 2, degree + 1):
            Q[ell, m] = ((2 * ell - 1) * z * Q[ell - 1, m] - (ell + m - 1) * Q[ell - 2, m]) / (
                ell - m
            )
    return waves.real, waves.imag, Q


def _size(ell, m):
    """The normalization of degree l and order m >= 0, with its sign."""
    share = (2 * ell + 1) / (4 * np.pi) / np.prod(np.arange(ell - m + 1, ell + m + 1))
    return (-1) ** m * np.sqrt(share if m == 0 else 2 * share)


# <<< solution


def sh_basis(directions: Vectors, degree: int) -> Basis:
    """All harmonics up to a degree, at given directions.

    Args:
        directions: (N, 3), unit vectors.
        degree: 0 to 4.

    Returns:
        (N, K); handout equations (5) to (8).
    """
    # >>> solution 11.1
    even, odd, Q = _pieces(directions, degree)
    Y = np.zeros((len(directions), (degree + 1) ** 2))
    for ell in range(degree + 1):
        for m in range(ell + 1):
            Y[:, ell * (ell + 1) - m] = _size(ell, m) * Q[ell, m] * odd[m]
            Y[:, ell * (ell + 1) + m] = _size(ell, m) * Q[ell, m] * even[m]
    return Y
    # <<< solution


def quadrature(degree):
    """Directions (N, 3) and weights (N,) that integrate polynomials up to a degree exactly.

    The integral of f over all directions is the sum of weights times f(directions), if f is a
    polynomial in x, y, z of at most that degree. The weights sum to 4 pi and are not equal.
    """
    z, share = np.polynomial.legendre.leggauss(degree // 2 + 1)
    phi = (np.arange(degree + 1) + 0.5) * (2 * np.pi / (degree + 1))
    z, phi = (values.ravel() for values in np.meshgrid(z, phi, indexing="ij"))
    r = np.sqrt(1 - z * z)
    weights = np.repeat(share, degree + 1) * (2 * np.pi / (degree + 1))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1), weights


def sh_project(directions: Vectors, weights: Weights, values: Values, degree: int) -> Coefficients:
    """Coefficients of a function that is known at the directions of a quadrature.

    Args:
        directions: (N, 3), unit vectors.
        weights: (N,), solid angles that sum to 4 pi.
        values: (N, C), the function there.
        degree: 0 to 4.

    Returns:
        (K, C); handout equation (9).
    """
    # >>> solution 11.2
    return sh_basis(directions, degree).T @ (weights[:, None] * values)
    # <<< solution


def sh_color(coefficients, v):
    """View-dependent colors: for each row, the sum of coefficients times harmonics.

    Args:
        coefficients: (N, K, C), a set for each vector.
        v: (N, 3), vectors of any length but 0; only their directions matter.

    Returns:
        (N, C); handout equation (10).
    """
    degree = round(coefficients.shape[1] ** 0.5) - 1
    d = v / np.linalg.norm(v, axis=1, keepdims=True)
    return np.einsum("nk,nkc->nc", sh_basis(d, degree), coefficients)


def sh_color_adjoint(
    coefficients: RowCoefficients, v: Vectors, g: Values
) -> tuple[RowCoefficients, Vectors]:
    """The adjoint of `sh_color` with respect to the coefficients and the vectors.

    Args:
        coefficients: (N, K, C).
        v: (N, 3), of any length but 0.
        g: (N, C), the derivative of some loss with respect to each color.

    Returns:
        (d_coefficients, d_v), of the shapes of coefficients and v; equations (11) to (14).
    """
    # >>> solution 11.3
    degree = round(coefficients.shape[1] ** 0.5) - 1
    length = np.linalg.norm(v, axis=1)
    d = v / length[:, None]
    d_coefficients = sh_basis(d, degree)[:, :, None] * g[:, None, :]
    pull = np.einsum("nkc,nc->kn", coefficients, g)
    even, odd, Q = _pieces(d, degree)
    slope = np.zeros((3, len(v)))
    for ell in range(1, degree + 1):
        for m in range(ell + 1):
            plus, minus = pull[ell * (ell + 1) + m], pull[ell * (ell + 1) - m]
            slope[2] += _size(ell, m) * Q[ell, m + 1] * (plus * even[m] + minus * odd[m])
            if m > 0:
                common = _size(ell, m) * m * Q[ell, m]
                slope[0] += common * (plus * even[m - 1] + minus * odd[m - 1])
                slope[1] += common * (minus * even[m - 1] - plus * odd[m - 1])
    along = np.sum(slope.T * d, axis=1)
    return d_coefficients, (slope.T - along[:, None] * d) / length[:, None]
    # <<< solution


def sh_rotate(coefficients: Coefficients, R: Rotation) -> Coefficients:
    """Coefficients of a rotated function: the value that was at d is now at R d.

    Args:
        coefficients: (K, C).
        R: (3, 3), a rotation matrix.

    Returns:
        (K, C); handout equation (15).
    """
    # >>> solution 11.4
    degree = round(len(coefficients) ** 0.5) - 1
    directions, weights = quadrature(2 * degree)
    before = sh_basis(directions @ R, degree) @ coefficients
    return sh_project(directions, weights, before, degree)
    # <<< solution


def corners(shape, p):
    """The eight values around each point, and their trilinear weights.

    Args:
        shape: (X, Y, Z) of a grid.
        p: (N, 3), points in cells; beyond the border its values are repeated.

    Returns:
        (index, weight), both (8, N): index counts rows of the grid reshaped to (X Y Z, ...).
    """
    last = np.array(shape) - 1
    q = np.clip(p, 0, last)
    low = np.minimum(np.floor(q).astype(int), np.maximum(last - 1, 0))
    index, weight = [], []
    for corner in np.ndindex(2, 2, 2):
        cell = np.minimum(low + corner, last)
        index.append((cell[:, 0] * shape[1] + cell[:, 1]) * shape[2] + cell[:, 2])
        weight.append(np.prod(np.where(corner, q - low, 1 - (q - low)), axis=1))
    return np.stack(index), np.stack(weight)


def probe_irradiance(probes: Probes, p: Vectors, normals: Vectors) -> Values:
    """Irradiance of surfaces: interpolate light probes, apply the cosine lobe.

    Args:
        probes: (X, Y, Z, K, C), coefficients of the light that arrives at each probe.
        p: (N, 3), points of the surfaces, in cells.
        normals: (N, 3), unit vectors.

    Returns:
        (N, C); handout equations (16) to (19).
    """
    # >>> solution 11.5
    K, C = probes.shape[3:]
    degree = round(K**0.5) - 1
    index, weight = corners(probes.shape[:3], p)
    blended = np.einsum("en,enkc->nkc", weight, probes.reshape(-1, K, C)[index])
    lobe = np.pi * np.array([1, 2 / 3, 1 / 4, 0, -1 / 24])
    lobe = np.repeat(lobe[: degree + 1], 2 * np.arange(degree + 1) + 1)
    return np.einsum("nk,k,nkc->nc", sh_basis(normals, degree), lobe, blended)
    # <<< solution


def march(shape, rays):
    """Samples of rays in a grid that fills the cube from -1 to 1 in x, y and z.

    Args:
        shape: (X, Y, Z) of the grid.
        rays: (2, R, 3), origins and unit directions; rays that miss the cube have no samples.

    Returns:
        a tuple for `render` and `loss_and_grad`: (shape, v (R, 3) toward the viewer, step (R,),
        index and weight (8, R SAMPLES)).
    """
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
    """For both passes: transmittance, weights, and coefficients of samples and of rays."""
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
    """Colors of rays through a volume before a black background.

    Along a ray the direction is constant, so weighted coefficients are summed first and `sh_color`
    is called once per ray.

    Args:
        density: (X, Y, Z), extinction per unit of length, not negative.
        coefficients: (X, Y, Z, K, C), of the color by the direction toward the viewer.
        samples: of `march`, for this shape.

    Returns:
        (R, C).
    """
    return sh_color(_along_rays(density, coefficients, samples)[3], samples[1])


def loss_and_grad(density, coefficients, samples, target):
    """Mean squared error of the colors of rays, and its derivatives.

    Args:
        density, coefficients, samples: as for `render`.
        target: (R, C), measured colors.

    Returns:
        (loss, d_density, d_coefficients).
    """
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
    """Adam for one array, as in assignment 01, with beta1 = 0.9 and beta2 = 0.99."""

    def __init__(self):
        self.m = self.v = self.k = 0

    def step(self, x, d_x):
        """The array after one step with learning rate RATE; x does not change."""
        self.k += 1
        self.m = 0.9 * self.m + 0.1 * d_x
        self.v = 0.99 * self.v + 0.01 * d_x**2
        m, v = self.m / (1 - 0.9**self.k), self.v / (1 - 0.99**self.k)
        return x - RATE * m / (np.sqrt(v) + 1e-8)


def fit_plenoxels(
    density: Density, coefficients: Probes, rays: Rays, target: Colors, levels: int, steps: int
) -> tuple[Density, Probes, Losses]:
    """Recover a volume coarse to fine.

    Args:
        density: (X, Y, Z), the initial guess; these arrays must not change.
        coefficients: (X, Y, Z, K, C), likewise.
        rays: (2, R, 3), origins and unit directions.
        target: (R, C), the measured colors.
        levels: the number of resolutions, 1 or more; each has twice the cells of the one before.
        steps: of Adam at each resolution, 0 or more.

    Returns:
        (density, coefficients, losses): of the finest level; losses (levels steps,), before each
        step. Handout equations (20) to (23).
    """
    # >>> solution 11.6
    losses = []
    for level in range(levels):
        if level > 0:
            fine = tuple(2 * n for n in density.shape)
            p = (np.stack(np.indices(fine), axis=-1).reshape(-1, 3) + 0.5) / 2 - 0.5
            index, weight = corners(density.shape, p)
            density = np.sum(weight * density.ravel()[index], axis=0).reshape(fine)
            rest = coefficients.shape[3:]
            rows = coefficients.reshape(-1, *rest)[index]
            coefficients = np.einsum("en,en...->n...", weight, rows).reshape(*fine, *rest)
        samples = march(density.shape, rays)
        of_density, of_coefficients = Adam(), Adam()
        for _ in range(steps):
            value, d_density, d_coefficients = loss_and_grad(density, coefficients, samples, target)
            density = np.maximum(of_density.step(density, d_density), 0)
            coefficients = of_coefficients.step(coefficients, d_coefficients)
            losses.append(value)
    return density, coefficients, np.array(losses)
    # <<< solution
