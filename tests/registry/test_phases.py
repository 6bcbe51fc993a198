"""Every registered phase function: normalized, its mean cosine, its derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf.phase import registry
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd_course.gradcheck import check_accumulation, check_gradient, dot_product_error
from photograd_course.mutants import check_overwriting_mutants

from support.gradient_mutants import check_gradient_mutants

PHASES = registry()
NAMES = sorted(PHASES)
COS, WEIGHT = np.polynomial.legendre.leggauss(200)
WEIGHT = 2 * np.pi * WEIGHT  # solid angle of a ring
G = (-0.8, -0.3, 0.0, 0.5, 0.9)


def random(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


@pytest.mark.parametrize("g", G)
@pytest.mark.parametrize("name", NAMES)
def test_it_integrates_to_one_over_the_sphere(name: str, g: float) -> None:
    p = PHASES[name].p(np.array([g]), COS)
    assert p.min() > 0
    assert WEIGHT @ p == pytest.approx(1, abs=1e-10)  # measured below 1e-14


@pytest.mark.parametrize("g", G)
def test_mean_cosines(g: float) -> None:
    at = np.array([g])
    henyey, cornette = (PHASES[n].p(at, COS) for n in ("henyey_greenstein", "cornette_shanks"))
    assert WEIGHT @ (henyey * COS) == pytest.approx(g, abs=1e-10)
    # [Cornette1992]
    mean = g * 3 * (4 + g * g) / (5 * (2 + g * g))
    assert WEIGHT @ (cornette * COS) == pytest.approx(mean, abs=1e-10)


def test_known_values() -> None:
    even = PHASES["henyey_greenstein"].p(np.zeros(1), COS)
    np.testing.assert_allclose(even, 1 / (4 * np.pi), rtol=1e-14)
    rayleigh = PHASES["cornette_shanks"].p(np.zeros(1), COS)
    np.testing.assert_allclose(rayleigh, 3 / (16 * np.pi) * (1 + COS**2), rtol=1e-14)
    # Straight on and straight back: (1 - g^2) / (1 -+ g)^3
    ends = PHASES["henyey_greenstein"].p(np.array([0.5]), np.array([1.0, -1.0]))
    np.testing.assert_allclose(4 * np.pi * ends, [0.75 / 0.125, 0.75 / 3.375], rtol=1e-14)


class Proof:
    """A phase function in the form that the checks take."""

    def __init__(self, name: str) -> None:
        phase = PHASES[name]
        lo = np.array([q.lo for q in phase.parameters])
        hi = np.array([q.hi for q in phase.parameters])
        share = 0.1 + 0.8 * random(1).random(len(lo))
        self.phase = phase
        self.place = {
            "parameters": lo + share * (hi - lo),
            "cos_theta": random(2).uniform(-0.95, 0.95, 16),
        }
        self.d_p = random(3).uniform(0.5, 1.5, 16)

    def forward(self, place: dict[str, Any]) -> Any:
        return self.phase.p(place["parameters"], place["cos_theta"])

    def accumulate(self, place: dict[str, Any], d_p: Any, d: dict[str, Any]) -> None:
        d_p = np.ascontiguousarray(d_p)
        self.phase.core.p_backward(
            place["parameters"], place["cos_theta"], d_p, d["parameters"], d["cos_theta"]
        )

    def backward(self, place: dict[str, Any], d_p: Any) -> dict[str, Any]:
        d = {name: np.zeros_like(value) for name, value in place.items()}
        self.accumulate(place, d_p, d)
        return d

    def jvp(self, place: dict[str, Any], v: dict[str, Any]) -> Any:
        order = ("parameters", "cos_theta")
        return self.phase.core.jvp(*(place[k] for k in order), *(v[k] for k in order))


@pytest.mark.parametrize("name", NAMES)
def test_derivatives(name: str) -> None:
    proof = Proof(name)
    report: Any = check_gradient(proof.forward, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = dot_product_error(proof.jvp, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = check_accumulation(proof.accumulate, proof.place, proof.d_p)
    assert report, str(report)


@pytest.mark.parametrize("name", NAMES)
def test_wrong_derivatives_die(name: str) -> None:
    proof = Proof(name)
    report: Any = check_gradient_mutants(
        proof.forward, proof.backward, proof.place, proof.d_p, seed=1
    )
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, proof.place, proof.d_p),
        proof.accumulate,
        proof.place,
        proof.d_p,
    )
    assert report, str(report)


@pytest.mark.parametrize("name", NAMES)
def test_float_agrees_with_double(name: str) -> None:
    proof = Proof(name)
    narrow = {key: value.astype(np.float32) for key, value in proof.place.items()}
    wide = {key: value.astype(np.float64) for key, value in narrow.items()}
    d_p = proof.d_p.astype(np.float32)
    pairs = [(proof.forward(narrow), proof.forward(wide))]
    few, full = proof.backward(narrow, d_p), proof.backward(wide, d_p.astype(np.float64))
    pairs += [(few[key], full[key]) for key in full]
    for got, expected in pairs:
        assert got.dtype == np.float32
        assert np.linalg.norm(got - expected) < 1e-5 * np.linalg.norm(expected)


def test_bad_input_is_refused() -> None:
    phase = PHASES["henyey_greenstein"]
    with pytest.raises(RangeError, match="did you mean 'henyey_greenstein'"):
        PHASES["henyey_greenstien"]
    for values in (np.zeros(2), {"g": [0.1, 0.2]}):
        with pytest.raises(ShapeError, match=r"^PhaseModel\.p: henyey_greenstein"):
            phase.p(values, COS)
    with pytest.raises(RangeError, match=r"^PhaseModel\.p: henyey_greenstein.values: .*\['g'\]"):
        phase.p({"h": 0.1}, COS)
    with pytest.raises(DtypeError, match=r"^PhaseModel\.p: henyey_greenstein: expected float64 as"):
        phase.p(np.zeros(1, np.float32), COS)
    with pytest.raises(DtypeError, match=r"^PhaseModel\.p_backward: d_p"):
        phase.p_backward({"g": 0.1}, COS, COS.astype(np.float32))


def test_values_by_name_and_packed_are_the_same() -> None:
    phase = PHASES["henyey_greenstein"]
    by_name = phase.p({"g": 0.3}, [0.5, 0.1])
    np.testing.assert_array_equal(by_name, phase.p([0.3], np.array([0.5, 0.1])))
    d_values, d_cos = phase.p_backward({"g": 0.3}, COS, COS)
    assert d_values["g"].shape == ()
    assert d_cos.shape == COS.shape
