"""Every model at the ends of its roughness: derivatives, mirrors and glass, the roughest metals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.bsdf import registry
from photograd.bsdf.gallery import furnace_curve
from photograd_course.gradcheck import check_gradient

from support.bsdf_proofs import ROWS, Proof, hemisphere, squares, towards

MODELS = registry()
WIDTHS = ("roughness", "slope", "sigma", "exponent", "gloss")
INWARDS = 1e-3  # of the range: fits end where the range does, and have a kink there
ENDS = [
    (name, parameter.name, end)
    for name, model in MODELS.items()
    for parameter in model.parameters
    if any(word in parameter.name for word in WIDTHS)
    # By the square of a width the derivative at 0 is 0: a little beside it.
    for end in (
        parameter.lo + INWARDS * (parameter.hi - parameter.lo) if parameter.lo else 0.01,
        parameter.hi - INWARDS * (parameter.hi - parameter.lo),
    )
]


def even(count: int) -> Any:
    """Numbers (N, 2) that fill the unit square evenly."""
    return np.mod(0.5 + np.arange(count)[:, None] * [0.7548776662466927, 0.5698402909980532], 1.0)


def inside_of_the_lobe(proof: Proof, name: str) -> None:
    """Moves wi to where light leaves: a narrow lobe is 0 almost everywhere else."""
    groups = {
        key: value[:, 0] if value.shape[1] == 1 else value for key, value in proof.place.items()
    }
    proof.wo = hemisphere(ROWS, seed=81, stream=1)
    u2 = 0.15 + 0.7 * squares(ROWS, seed=82)
    proof.wi = proof.model.sample(groups, proof.wo, u2)
    low = (np.abs(proof.wi[:, 2]) if proof.model.transmits else proof.wi[:, 2]) < 0.05
    proof.wi[low] = proof.wo[low] * [-1, -1, 1]
    proof.wi = np.ascontiguousarray(proof.wi)
    assert (proof.model.f(groups, proof.wo, proof.wi) > 0).any(axis=1).all(), name


@pytest.mark.parametrize(("name", "parameter", "end"), ENDS)
def test_derivatives_at_both_ends_of_every_width(name: str, parameter: str, end: float) -> None:
    proof = Proof(MODELS[name], seed=8)
    proof.place[parameter][:] = end
    inside_of_the_lobe(proof, name)
    start = {parameter: proof.place[parameter]}
    report = check_gradient(
        lambda groups: proof.forward({**proof.place, **groups}),
        lambda groups, d_f: {parameter: proof.backward({**proof.place, **groups}, d_f)[parameter]},
        start,
        seed=8,
        directions=3,
        coordinates=4,
        # A lobe of roughness 0.045 is 0.002 wide: the longest steps leave it.
        steps=(1e-4, 1e-5, 1e-6, 1e-7),
    )
    assert report, str(report)


BASE = 0.5
METAL = {"metalness": 1.0, "base_color": np.full(3, BASE), "eta": 1.5, "iridescence_ior": 1.5}
METALS = [
    # Disney's masking keeps a width of its own, so that its smoothest metal is no mirror.
    name
    for name, model in MODELS.items()
    if name != "disney" and any(p.name == "metalness" for p in model.parameters)
]


def metal(name: str, roughness: float, color: float = BASE) -> dict[str, Any]:
    """All metal, no layers: what is neither metal nor rough is at the low end of its range."""
    values: dict[str, Any] = {
        p.name: np.full(3, p.lo) if p.size > 1 else p.lo for p in MODELS[name].parameters
    }
    values |= {key: METAL[key] for key in METAL if key in values}
    return {**values, "roughness": roughness, "base_color": np.full(3, color)}


@pytest.mark.parametrize("name", METALS)
def test_the_smoothest_metals_are_mirrors(name: str) -> None:
    values, model = metal(name, 0.045), MODELS[name]
    for cosine in (0.3, 0.8):
        F = BASE + (1 - BASE) * (1 - cosine) ** 5
        found = furnace_curve(model, values, np.array([cosine]))[0]
        np.testing.assert_allclose(found, F, rtol=5e-3)
        wi = model.sample(values, towards(cosine, 500), even(500))
        turned = wi @ (towards(cosine)[0] * [-1, -1, 1])
        assert np.quantile(turned, 0.5) > np.cos(0.01)


@pytest.mark.parametrize("name", [name for name in METALS if name != "principled"])
def test_the_roughest_metals_lose_what_theory_says(name: str) -> None:
    # But for `principled`, which masks each direction for itself.
    white = metal(name, 1.0, 1.0)
    found = furnace_curve(MODELS[name], white, np.array([1.0]), samples=16384)[0]
    np.testing.assert_allclose(found, 1.0 - np.log(2.0), atol=1e-3)


@pytest.mark.parametrize("name", ["ggx_conductor", "beckmann_conductor"])
def test_the_smoothest_conductors_reflect_by_fresnel(name: str) -> None:
    values = {"eta": [0.2, 1.4, 3.0], "k": [3.0, 1.9, 0.5], "roughness": 0.045}
    for cosine in (0.3, 0.8):
        F = [
            float(_core.ops["fresnel_conductor"].forward(np.array([e, k, cosine]))[0])
            for e, k in zip(values["eta"], values["k"], strict=True)
        ]
        found = furnace_curve(MODELS[name], values, np.array([cosine]))[0]
        np.testing.assert_allclose(found, F, rtol=5e-3)


@pytest.mark.parametrize("name", ["rough_dielectric", "dispersive_dielectric", "gltf_refraction"])
def test_the_smoothest_frosted_glass_is_glass(name: str) -> None:
    model, count = MODELS[name], 4000
    values: dict[str, Any] = {p.name: p.lo for p in model.parameters}
    values |= {"eta": 1.5, "roughness": 0.1}
    if name == "gltf_refraction":
        values |= {"base_color": np.ones(3), "transmission": 1.0}
    for cosine in (0.4, 0.9):
        wo = towards(cosine, count)
        wi = model.sample(values, wo, even(count))
        up, pdf = wi[:, 2] > 0, model.pdf(values, wo, wi)
        weight = np.where(pdf > 0, model.f(values, wo, wi)[:, 0] * np.abs(wi[:, 2]), 0) / np.where(
            pdf > 0, pdf, 1
        )
        F = float(_core.ops["fresnel_dielectric"].forward(np.array([1.5, cosine]))[0])
        # Reflected by F, refracted radiance by (1 - F) / eta^2; measured: 0.004 at most.
        assert weight[up].sum() / count == pytest.approx(F, abs=0.01)
        assert 1.5**2 * weight[~up].sum() / count == pytest.approx(1 - F, abs=0.01)
        bent = np.median(np.hypot(wi[~up, 0], wi[~up, 1]))
        assert bent == pytest.approx(np.sqrt(1 - cosine**2) / 1.5, abs=0.01)
