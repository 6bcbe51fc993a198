"""Diffusion profiles: light that leaves a surface at another point than where it enters.

What random walks in a medium (`photograd.transport`) find, as a function of the distance alone, for
a half space that is the same everywhere:

- the dipole [Jensen2001], by the coefficients of the medium. Diffusion theory: right where light is
  scattered often before it is absorbed, and a few mean free paths from where it enters.
- normalized diffusion [Christensen2015], by the albedo of the surface: fitted to random walks
  behind a boundary that does not refract. It integrates to that albedo exactly.

Profiles are R(r) in 1/m^2: times the watts that enter at a point, the watts per m^2 that leave at a
distance r from it. Their integral over the plane is the part of the light that comes back.

Arguments are numbers or arrays that broadcast against one another; the result is of their common
shape, float64. `foo_backward` takes dL/dfoo of that shape and returns dL/dargument for each
argument of `foo`, in its shape. The mathematics is in cpp/photograd/ops/dipole.h and
cpp/photograd/ops/normalized_diffusion.h.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._compiled import _core
from photograd.errors import RangeError, ShapeError, message
from photograd.types import FloatArray

DiffusionFit = Literal["searchlight", "diffuse", "diffuse_free_path"]

# The bounds of each argument.
_RANGES: dict[str, dict[str, float]] = {
    "radius": {"above": 0.0},
    "sigma_s": {"above": 0.0},
    "sigma_a": {"low": 0.0},
    "eta": {"low": 1.0, "high": 5.0},
    "albedo": {"low": 0.0, "high": 1.0},
    "mean_free_path": {"above": 0.0},
    "u": {"low": 0.0, "below": 1.0},
    "cos_theta": {"low": 0.0, "high": 1.0},
}


def dipole(
    radius: ArrayLike, sigma_s: ArrayLike, sigma_a: ArrayLike, eta: ArrayLike = 1.0
) -> FloatArray:
    """The dipole's R_d for a thin beam along the normal, in 1/m^2.

    Args:
        radius: distance from where the light enters, m; above 0.
        sigma_s: reduced scattering coefficient, (1 - g) times that of the medium, 1/m; above 0.
        sigma_a: absorption coefficient, 1/m.
        eta: refractive index of the medium over that outside, 1 to 5; 1 for none.

    Raises:
        RangeError, ShapeError: arguments that are out of range or do not broadcast.
    """
    rows, shape, _ = _rows("dipole", radius=radius, sigma_s=sigma_s, sigma_a=sigma_a, eta=eta)
    return _core.dipole(rows).reshape(shape)


def dipole_backward(
    radius: ArrayLike, sigma_s: ArrayLike, sigma_a: ArrayLike, eta: ArrayLike, d_R: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """dL/dradius, dL/dsigma_s, dL/dsigma_a and dL/deta of `dipole`, for dL/dR.

    Args:
        radius: r, in meters.
        sigma_s: reduced scattering, in 1/m.
        sigma_a: absorption, in 1/m.
        eta: relative index of refraction.
        d_R: dL/dR.

    Raises:
        RangeError, ShapeError: as `dipole`, or d_R of another shape than its result.
    """
    name = "dipole_backward"
    rows, shape, shapes = _rows(name, radius=radius, sigma_s=sigma_s, sigma_a=sigma_a, eta=eta)
    d_rows = np.zeros_like(rows)
    _core.dipole_backward(rows, _cotangent(name, "d_R", d_R, shape), d_rows)
    a, b, c, d = _columns(d_rows, shape, shapes)
    return a, b, c, d


def dipole_albedo(sigma_s: ArrayLike, sigma_a: ArrayLike, eta: ArrayLike = 1.0) -> FloatArray:
    """The integral of `dipole` over the plane: what part of the light comes back.

    Of a refracting surface that is the part of what has entered; the mirrored part is apart.

    Args:
        sigma_s: reduced scattering, in 1/m.
        sigma_a: absorption, in 1/m.
        eta: relative index of refraction.

    Raises:
        RangeError, ShapeError: as `dipole`.
    """
    rows, shape, _ = _rows("dipole_albedo", sigma_s=sigma_s, sigma_a=sigma_a, eta=eta)
    return _core.dipole_albedo(rows).reshape(shape)


def dipole_albedo_backward(
    sigma_s: ArrayLike, sigma_a: ArrayLike, eta: ArrayLike, d_albedo: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/dsigma_s, dL/dsigma_a and dL/deta of `dipole_albedo`, for dL/dalbedo.

    Args:
        sigma_s: reduced scattering, in 1/m.
        sigma_a: absorption, in 1/m.
        eta: relative index of refraction.
        d_albedo: dL/dalbedo.

    Raises:
        RangeError: as `dipole`, or sigma_a of 0, where the albedo falls infinitely fast with it.
        ShapeError: arguments that do not broadcast, d_albedo of another shape than the result.
    """
    name = "dipole_albedo_backward"
    rows, shape, shapes = _rows(name, sigma_s=sigma_s, sigma_a=sigma_a, eta=eta)
    if not (rows[:, 1] > 0).all():
        raise RangeError(message(name, "sigma_a", "numbers above 0", "0"))
    d_rows = np.zeros_like(rows)
    _core.dipole_albedo_backward(rows, _cotangent(name, "d_albedo", d_albedo, shape), d_rows)
    a, b, c = _columns(d_rows, shape, shapes)
    return a, b, c


def normalized_diffusion(
    radius: ArrayLike,
    albedo: ArrayLike,
    mean_free_path: ArrayLike,
    fit: DiffusionFit = "searchlight",
) -> FloatArray:
    """Normalized diffusion R in 1/m^2; it integrates to `albedo` over the plane.

    Args:
        radius: distance from where the light enters, m; above 0, where R grows as 1 / radius.
        albedo: of the surface, 0 to 1: the part of the light that comes back. `half_space_albedo`
            finds it from the albedo of a scattering event.
        mean_free_path: m, in the volume (1 / sigma_t, of reduced coefficients); for the fit
            "diffuse_free_path", the diffuse one along the surface.
        fit: "searchlight", a thin beam along the normal; "diffuse" or "diffuse_free_path", light
            from all sides.

    Raises:
        RangeError, ShapeError: arguments that are out of range or do not broadcast.
    """
    rows, shape, _ = _rows(
        "normalized_diffusion", radius=radius, albedo=albedo, mean_free_path=mean_free_path
    )
    return _core.normalized_diffusion(rows, _known("normalized_diffusion", fit)).reshape(shape)


def normalized_diffusion_backward(
    radius: ArrayLike,
    albedo: ArrayLike,
    mean_free_path: ArrayLike,
    d_R: ArrayLike,
    fit: DiffusionFit = "searchlight",
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/dradius, dL/dalbedo and dL/dmean_free_path of `normalized_diffusion`, for dL/dR.

    Args:
        radius: r, in meters.
        albedo: of the surface.
        mean_free_path: in meters.
        d_R: dL/dR.
        fit: as of `normalized_diffusion`.

    Raises:
        RangeError, ShapeError: as `normalized_diffusion`, or d_R of another shape than its result.
    """
    name = "normalized_diffusion_backward"
    rows, shape, shapes = _rows(name, radius=radius, albedo=albedo, mean_free_path=mean_free_path)
    d_rows = np.zeros_like(rows)
    d = _cotangent(name, "d_R", d_R, shape)
    _core.normalized_diffusion_backward(rows, _known(name, fit), d, d_rows)
    a, b, c = _columns(d_rows, shape, shapes)
    return a, b, c


def diffusion_cdf(
    radius: ArrayLike,
    albedo: ArrayLike,
    mean_free_path: ArrayLike,
    fit: DiffusionFit = "searchlight",
) -> FloatArray:
    """The part of the light that leaves within `radius`, of what leaves at all; see
    `normalized_diffusion`.

    Args:
        radius: r, in meters.
        albedo: of the surface.
        mean_free_path: in meters.
        fit: as of `normalized_diffusion`.
    """
    rows, shape, _ = _rows(
        "diffusion_cdf", radius=radius, albedo=albedo, mean_free_path=mean_free_path
    )
    return _core.diffusion_cdf(rows, _known("diffusion_cdf", fit)).reshape(shape)


def diffusion_cdf_backward(
    radius: ArrayLike,
    albedo: ArrayLike,
    mean_free_path: ArrayLike,
    d_cdf: ArrayLike,
    fit: DiffusionFit = "searchlight",
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/dradius, dL/dalbedo and dL/dmean_free_path of `diffusion_cdf`, for dL/dcdf.

    Args:
        radius: r, in meters.
        albedo: of the surface.
        mean_free_path: in meters.
        d_cdf: dL/d of the part.
        fit: as of `normalized_diffusion`.
    """
    name = "diffusion_cdf_backward"
    rows, shape, shapes = _rows(name, radius=radius, albedo=albedo, mean_free_path=mean_free_path)
    d_rows = np.zeros_like(rows)
    d = _cotangent(name, "d_cdf", d_cdf, shape)
    _core.diffusion_cdf_backward(rows, _known(name, fit), d, d_rows)
    a, b, c = _columns(d_rows, shape, shapes)
    return a, b, c


def sample_radius(
    u: ArrayLike, albedo: ArrayLike, mean_free_path: ArrayLike, fit: DiffusionFit = "searchlight"
) -> FloatArray:
    """Radii in m, distributed as the light that leaves: `diffusion_cdf` inverted, exactly.

    Of a uniform u, and with a uniform angle, points of the plane come with density
    `normalized_diffusion` / albedo, 1/m^2.

    Args:
        u: 0 to below 1.
        albedo, mean_free_path, fit: as for `normalized_diffusion`.

    Raises:
        RangeError, ShapeError: arguments that are out of range or do not broadcast.
    """
    rows, shape, _ = _rows("sample_radius", u=u, albedo=albedo, mean_free_path=mean_free_path)
    return _core.sample_diffusion_radius(rows, _known("sample_radius", fit)).reshape(shape)


def sample_radius_backward(
    u: ArrayLike,
    albedo: ArrayLike,
    mean_free_path: ArrayLike,
    d_radius: ArrayLike,
    fit: DiffusionFit = "searchlight",
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """dL/du, dL/dalbedo and dL/dmean_free_path of `sample_radius`, for dL/dradius.

    Args:
        u: in 0 to 1.
        albedo: of the surface.
        mean_free_path: in meters.
        d_radius: dL/dradius.
        fit: as of `normalized_diffusion`.
    """
    name = "sample_radius_backward"
    rows, shape, shapes = _rows(name, u=u, albedo=albedo, mean_free_path=mean_free_path)
    d_rows = np.zeros_like(rows)
    d = _cotangent(name, "d_radius", d_radius, shape)
    _core.sample_diffusion_radius_backward(rows, _known(name, fit), d, d_rows)
    a, b, c = _columns(d_rows, shape, shapes)
    return a, b, c


def half_space_albedo(albedo: ArrayLike, cos_theta: ArrayLike = 1.0) -> FloatArray:
    """What part of a beam comes back from a half space that scatters alike in all directions.

    1 - H(mu) sqrt(1 - a) with Chandrasekhar's H, by quadrature of its logarithm
    [Chandrasekhar1960, Ch. V]; the boundary does not refract. It is the albedo of the surface that
    `normalized_diffusion` wants, of a medium with a given albedo of a scattering event.

    Args:
        albedo: sigma_s / sigma_t, 0 to 1, of reduced coefficients.
        cos_theta: of the beam and the normal, 0 to 1.

    Raises:
        RangeError, ShapeError: arguments that are out of range or do not broadcast.
    """
    rows, shape, _ = _rows("half_space_albedo", albedo=albedo, cos_theta=cos_theta)
    a, mu = rows[:, :1], rows[:, 1:]
    # ln H = -mu / pi integral_0^(pi/2) ln(1 - a t cot t) / (cos^2 t + mu^2 sin^2 t) dt. Both ends
    # are steep, of a near 1 and of grazing light; t = (pi / 2) ease(s) flattens them.
    nodes, weights = np.polynomial.legendre.leggauss(200)
    s = 0.5 * (nodes + 1)
    t = np.pi / 2 * s**3 * (10 - 15 * s + 6 * s**2)
    dt = np.pi / 4 * weights * 30 * (s * (1 - s)) ** 2
    series = t**2 * (1 / 3 + t**2 * (1 / 45 + t**2 * (2 / 945)))
    rest = np.where(t < 0.03, series, 1 - t / np.tan(t))  # 1 - t cot t
    log = np.log((1 - a) + a * rest)
    ln_H = -mu / np.pi * (log / (np.cos(t) ** 2 + (mu * np.sin(t)) ** 2) @ dt)[:, None]
    return (1 - np.exp(ln_H) * np.sqrt(1 - a)).reshape(shape)


def _rows(name: str, **arguments: ArrayLike) -> tuple[FloatArray, tuple[int, ...], Any]:
    """Rows (N, K) of the arguments, their common shape, and the shape of each."""
    call = Arguments(name, np.float64)
    given = {}
    for key, value in arguments.items():
        bounds = _RANGES[key]
        low, high, above, below = (bounds.get(k) for k in ("low", "high", "above", "below"))
        given[key] = call.array(key, value, low=low, high=high, above=above, below=below)
    shapes = [value.shape for value in given.values()]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        names, got = ", ".join(given), ", ".join(map(str, shapes))
        raise ShapeError(message(name, names, "shapes that broadcast", got)) from None
    columns = [np.broadcast_to(value, shape).ravel() for value in given.values()]
    return np.stack(columns, axis=1), shape, shapes


def _known(name: str, fit: DiffusionFit) -> DiffusionFit:
    known: DiffusionFit = typed(name, "fit", DiffusionFit, fit)
    return known


def _cotangent(name: str, argument: str, value: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    return Arguments(name, np.float64).array(argument, value, shape, finite=False).ravel()


def _columns(d_rows: FloatArray, shape: tuple[int, ...], shapes: Any) -> list[FloatArray]:
    """Derivatives of the arguments: rows summed over the axes that were broadcast."""
    found = []
    for column, own in zip(d_rows.T, shapes, strict=True):
        d = column.reshape(shape)
        d = d.sum(axis=tuple(range(len(shape) - len(own))))
        stretched = tuple(k for k, n in enumerate(own) if n == 1 and d.shape[k] != 1)
        found.append(d.sum(axis=stretched, keepdims=True).reshape(own))
    return found
