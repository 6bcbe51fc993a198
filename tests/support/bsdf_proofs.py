"""The proofs that every reflectance model must pass, as functions of a model."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd.bsdf import BsdfModel
from photograd_course.gradcheck import check_accumulation, check_gradient, dot_product_error
from photograd_course.mutants import check_overwriting_mutants, make_mutants
from photograd_course.random import uniform

from support.gradient_mutants import memoized
from support.group_mutants import survives
from support.statistics import chi_square_p, sidak, sphere_cell_masses, sphere_counts

Array = npt.NDArray[Any]
COSINES = (0.15, 0.6, 0.98)  # of wo, from grazing to almost straight
ROWS = 7


def hemisphere(count: int, *, seed: int, stream: int) -> Array:
    """Directions (N, 3) above the horizon, not too close: models may divide by the cosine."""
    u = uniform(seed, step=stream, pixel=np.arange(count)[:, None], dimension=np.arange(2))
    z, phi = 0.1 + 0.89 * u[:, 0], 2.0 * np.pi * u[:, 1]
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1)


def towards(cosine: float, count: int = 1) -> Array:
    """wo (N, 3) with this cosine, a little off the X axis; a negative one is below the surface."""
    s = np.sqrt(1.0 - cosine**2)
    return np.tile([s * np.cos(0.3), s * np.sin(0.3), cosine], (count, 1))


def near_mirror(wo: Array, *, seed: int, stream: int) -> Array:
    """Directions (N, 3) above the horizon around where a mirror would send wo: inside of lobes."""
    away = hemisphere(len(wo), seed=seed, stream=stream) - [0, 0, 0.5]
    wi = wo * [-1.0, -1.0, 1.0] + 0.3 * away
    wi[:, 2] = np.maximum(wi[:, 2], 0.1)
    return np.ascontiguousarray(wi / np.linalg.norm(wi, axis=1, keepdims=True))


@functools.cache
def squares(count: int, *, seed: int) -> Array:
    """Uniform numbers (N, 2), made once for all models."""
    return uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(2))


@functools.cache
def upper_grid(heights: int = 80, turns: int = 1024) -> tuple[Array, Array]:
    """Directions (M, 3) of the upper hemisphere and their solid angles (M, 1).

    Gauss-Legendre in the root of the height, since many lobes pile up at the horizon; many turns,
    since at grazing angles the lobes of facets are narrower in azimuth than in height.
    """
    nodes, weights = np.polynomial.legendre.leggauss(heights)
    root = 0.5 * (nodes + 1.0)
    phi = 2.0 * np.pi * (np.arange(turns) + 0.5) / turns
    h, t = np.meshgrid(root**2, phi, indexing="ij")
    s = np.sqrt(1.0 - h * h)
    grid = np.stack([s * np.cos(t), s * np.sin(t), h], -1).reshape(-1, 3)
    return grid, np.repeat(root * weights * 2.0 * np.pi / turns, turns)[:, None]


def albedo(model: BsdfModel, parameters: Any, cosine: float, *, fine: bool = True) -> Array:
    """The part (3,) of light that leaves, for a view of this cosine, by quadrature."""
    # Refraction squeezes a lobe: it needs more heights; none of these is narrow in azimuth.
    heights, turns = (240, 512) if bends(model, parameters) else (80, 1024)
    grid, area = upper_grid(heights, turns) if fine else upper_grid(heights // 2, turns // 4)
    wo = towards(cosine, len(grid))
    total: Array = np.zeros(3)
    for side in (1.0, -1.0) if model.transmits else (1.0,):
        wi = grid * [1.0, 1.0, side]
        power = power_factor(model, parameters, wo, wi)
        total += (model.f(parameters, wo, wi) * power * area).sum(axis=0)
    return total


def index_of(model: BsdfModel, parameters: dict[str, Any], w: Array) -> Array:
    """Refractive index (N, 3) on the side of each direction."""
    return np.where(w[:, 2:] < 0.0, model.index_inside(parameters), 1.0)


def bends(model: BsdfModel, parameters: dict[str, Any]) -> bool:
    """Whether light is refracted."""
    return model.transmits and bool((model.index_inside(parameters) != 1.0).any())


def power_factor(model: BsdfModel, parameters: dict[str, Any], wo: Array, wi: Array) -> Array:
    """What f is multiplied by to count energy (N, 3): the cosine, and what radiance gained."""
    indices = [index_of(model, parameters, w) for w in (wi, wo)]
    factor: Array = np.abs(wi[:, 2:]) * (indices[0] / indices[1]) ** 2
    return factor


def viewers(model: BsdfModel) -> tuple[float, ...]:
    """Cosines of wo; models that transmit are also seen from inside."""
    return (*COSINES, -0.5) if model.transmits else COSINES


def draw_parameters(model: BsdfModel, rows: int, *, seed: int) -> dict[str, Array]:
    """Values (N, size) inside of each parameter's range."""
    values = {}
    for number, parameter in enumerate(model.parameters):
        address = {"pixel": np.arange(rows)[:, None], "dimension": np.arange(parameter.size)}
        u = uniform(seed, step=50 + number, **address)
        values[parameter.name] = parameter.lo + (parameter.hi - parameter.lo) * (0.05 + 0.9 * u)
    return values


class Proof:
    """A model at fixed directions, one row of parameters each, in the form the checks take."""

    def __init__(self, model: BsdfModel, *, seed: int) -> None:
        self.model = model
        self.place = draw_parameters(model, ROWS, seed=seed)
        self.wo, self.wi = (hemisphere(ROWS, seed=seed, stream=k) for k in (1, 2))
        rows = slice(None, None, 1 if model.transmits else 2)
        self.wi[rows] = near_mirror(self.wo[rows], seed=seed, stream=7)
        if model.transmits:  # both sides to both sides; what passes goes almost straight on
            self.wi[1::2, 2] *= -1.0
            self.wo[3:5, 2] *= -1.0
            self.wi[3:5, 2] *= -1.0

    def rows(self, groups: dict[str, Array]) -> Array:
        parts = [groups[parameter.name] for parameter in self.model.parameters]
        return np.ascontiguousarray(np.concatenate(parts, axis=1))

    def split(self, rows: Array) -> dict[str, Array]:
        ends = np.cumsum([parameter.size for parameter in self.model.parameters])[:-1]
        names = [parameter.name for parameter in self.model.parameters]
        return dict(zip(names, np.split(rows, ends, axis=1), strict=True))

    def forward(self, groups: dict[str, Array]) -> Array:
        value: Array = self.model.core.f(self.rows(groups), self.wo, self.wi)
        return value

    def backward(self, groups: dict[str, Array], d_f: Array) -> dict[str, Array]:
        rows, d_f = self.rows(groups), np.ascontiguousarray(d_f)
        d = self.model.core.f_backward(rows, self.wo, self.wi, d_f, np.zeros_like(rows))
        return self.split(d)

    def accumulate(self, groups: dict[str, Array], d_f: Array, d_groups: dict[str, Array]) -> None:
        rows, buffer = self.rows(groups), self.rows(d_groups)
        self.model.core.f_backward(rows, self.wo, self.wi, np.ascontiguousarray(d_f), buffer)
        for name, part in self.split(buffer).items():
            d_groups[name][...] = part

    def jvp(self, groups: dict[str, Array], directions: dict[str, Array]) -> Array:
        jv: Array = self.model.core.jvp(self.rows(groups), self.rows(directions), self.wo, self.wi)
        return jv


def prove_gradients(model: BsdfModel, *, seed: int = 1) -> None:
    """T1, T3, accumulation, and the death of the automatic mutants."""
    proof = Proof(model, seed=seed)
    d_f = 0.5 + uniform(seed, step=9, pixel=np.arange(ROWS)[:, None], dimension=np.arange(3))
    forward = memoized(proof.forward)
    report: Any = check_gradient(forward, proof.backward, proof.place, seed=seed)
    assert report, str(report)
    report = dot_product_error(proof.jvp, proof.backward, proof.place, seed=seed)
    assert report, str(report)
    report = check_accumulation(proof.accumulate, proof.place, d_f)
    assert report, str(report)
    for mutant in make_mutants(proof.backward, proof.place, d_f):
        assert not survives(forward, proof.place, mutant, seed=seed), mutant.name
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, proof.place, d_f), proof.accumulate, proof.place, d_f
    )
    assert report, str(report)


def prove_shared_row(model: BsdfModel, *, seed: int = 2) -> None:
    """One row of parameters for all directions gets the sum of the rows' derivatives."""
    proof = Proof(model, seed=seed)
    rows = proof.rows({name: value[:1] for name, value in proof.place.items()})
    many = np.ascontiguousarray(np.repeat(rows, ROWS, axis=0))
    d_f = np.ones((ROWS, 3))
    each = model.core.f_backward(many, proof.wo, proof.wi, d_f, np.zeros_like(many))
    once = model.core.f_backward(rows, proof.wo, proof.wi, d_f, np.zeros_like(rows))
    assert np.abs(once).max() > 0
    # The same few additions in another order.
    np.testing.assert_allclose(once[0], each.sum(axis=0), rtol=1e-13, atol=1e-15)


def prove_float(model: BsdfModel, *, seed: int = 3) -> None:
    """float32 against float64: rounding 6e-8, times the few operations of a model."""
    proof = Proof(model, seed=seed)
    rows, d_f = proof.rows(proof.place), np.ones((ROWS, 3))
    narrow = [a.astype("f4") for a in (rows, proof.wo, proof.wi)]
    f, back = model.core.f, model.core.f_backward
    for call in (f, lambda p, o, i: back(p, o, i, d_f.astype(p.dtype), np.zeros_like(p))):
        wide, thin = call(rows, proof.wo, proof.wi), call(*narrow)
        assert np.linalg.norm(wide) > 0
        assert np.linalg.norm(thin - wide) <= 1e-4 * np.linalg.norm(wide)


def prove_sampling(model: BsdfModel, *, seed: int = 4, level: float = 0.01) -> None:
    """T4: 10^6 samples against the integrated density, for three parameter sets and angles.

    With the seed fixed the result is fixed; a right sampler would fail for one seed in a hundred.
    """
    places = [(fraction, cosine) for fraction in (0.2, 0.5, 0.9) for cosine in viewers(model)]
    samples = 1_000_000 // len(places)
    z = np.linspace(-1.0 if model.transmits else 0.0, 1.0, 41 if model.transmits else 21)
    u2 = squares(1_000_000, seed=seed)
    for number, (fraction, cosine) in enumerate(places):
        parameters = model.at(fraction)
        part = u2[number * samples : (number + 1) * samples]
        wi = model.sample(parameters, towards(cosine, samples), part)
        np.testing.assert_allclose(np.linalg.norm(wi, axis=1), 1.0, atol=1e-12)
        # Samples below the horizon, or in it for models that transmit, are lost on purpose.
        kept = wi[:, 2] != 0.0 if model.transmits else wi[:, 2] >= 0.0
        lost, pdf = 1.0 - kept.mean(), functools.partial(model.pdf, parameters)
        # As many nodes as a narrow lobe, or the sharp edge of the cone of refracted rays, needs.
        for order in (15, 30) if bends(model, parameters) else (5, 15, 30):
            masses = sphere_cell_masses(
                lambda w, f=pdf, c=cosine: f(towards(c, len(w)), w), z, 40, order=order
            )
            if abs(masses.sum() + lost - 1.0) < 4e-3:
                break
        # 4 standard errors of `lost` are 5e-3; quadrature of the coarsest lobes adds some.
        assert abs(masses.sum() + lost - 1.0) < 1e-2, f"{model.name} at {fraction}, cos {cosine}"
        counts = sphere_counts(wi[kept], z, 40)
        p = chi_square_p(counts, masses / masses.sum())
        least = sidak(level, len(places))
        assert p > least, f"{model.name} at {fraction}, cos {cosine}: p = {p:.2g}"


def prove_energy(model: BsdfModel, *, seed: int = 5) -> None:
    """T5: the directional albedo by sampling against quadrature, and the declared class."""
    samples = 100_000
    kind, most = model.energy
    u2 = squares(samples, seed=seed)
    for fraction in (0.2, 0.6, 1.0):
        parameters = model.at(fraction)
        for cosine in viewers(model):
            wo = towards(cosine, samples)
            wi = model.sample(parameters, wo, u2)
            pdf = model.pdf(parameters, wo, wi)[:, None]
            power = power_factor(model, parameters, wo, wi)
            weight = model.f(parameters, wo, wi) * power * (pdf > 0) / np.where(pdf > 0, pdf, 1.0)
            error = 3.0 * weight.std(axis=0) / np.sqrt(samples)
            slack = 1.001 if kind == "conserving" else 1.0 + 1e-9  # rounding
            for fine in (False, True):  # wide lobes need few directions
                exact = albedo(model, parameters, cosine, fine=fine)
                gap = np.abs(weight.mean(axis=0) - exact)
                if (gap <= error + 0.005 * exact).all() and exact.max() <= most * slack:
                    break
            # A metal is dark inside; prove_horizon looks there.
            assert exact.max() > 0 or cosine < 0
            where = f"{model.name} at {fraction}, cos {cosine}"
            assert (gap <= error + 0.005 * exact).all(), f"{where}: {gap} beyond {error}"
            assert exact.max() <= most * slack, f"{model.name} is {kind}: {exact.max()}"


def prove_reciprocity(model: BsdfModel, *, seed: int = 6) -> None:
    """T6: f(wo, wi) = f(wi, wo) to 1e-6; a model that denies it must really break it.

    Through a boundary, f over the squared index on the viewer's side is what stays.
    """
    wo, wi = (hemisphere(500, seed=seed, stream=k) for k in (3, 4))
    if model.transmits:
        wi[::2, 2] *= -1.0
    parameters = model.at(0.5)
    there = model.f(parameters, wo, wi) / index_of(model, parameters, wo) ** 2
    back = model.f(parameters, wi, wo) / index_of(model, parameters, wi) ** 2
    assert there.max() > 0
    error = np.abs(there - back).max() / there.max()
    assert (error <= 1e-6) == model.reciprocal, f"{model.name}: {error:.1e}"


def prove_horizon(model: BsdfModel) -> None:
    """Nothing is reflected through the surface, and nothing is sampled for a viewer below it.

    Unless the model transmits: then light must come through from both sides.
    """
    if model.transmits:
        wo = np.array([[0.0, 0.6, 0.8], [0.0, 0.6, -0.8]])
        for w in (model.f(model.at(0.9), wo, -wo), model.pdf(model.at(0.9), wo, -wo)):
            assert (w > 0).all()
        return
    up, down = np.array([[0.0, 0.6, 0.8]]), np.array([[0.0, 0.6, -0.8]])
    for wo, wi in ((up, down), (down, up)):
        assert (model.f(model.at(0.5), wo, wi) == 0).all()
        assert (model.pdf(model.at(0.5), wo, wi) == 0).all()


PROOFS = (
    prove_gradients,
    prove_shared_row,
    prove_float,
    prove_sampling,
    prove_energy,
    prove_reciprocity,
    prove_horizon,
)
