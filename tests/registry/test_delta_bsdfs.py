"""Every smooth surface: derivatives, energy, Snell's law, both ways through a boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf.specular import DeltaModel, registry
from photograd.errors import DtypeError, ShapeError
from photograd_course.gradcheck import check_accumulation, check_gradient, dot_product_error
from photograd_course.mutants import check_overwriting_mutants

from support.bsdf_proofs import draw_parameters, hemisphere
from support.gradient_mutants import check_gradient_mutants

MODELS = registry()
NAMES = sorted(MODELS)
ROWS = 6
CLEAR = {"eta": 1.5, "tint": np.ones(3)}


def both_sides(count: int, seed: int) -> Any:
    """Viewers above and below, some of the latter under total reflection."""
    wo = hemisphere(count, seed=seed, stream=1)
    wo[1::2] *= -1.0
    return np.ascontiguousarray(wo)


class Proof:
    """A model at fixed viewers, one row of parameters each, in the form the checks take."""

    def __init__(self, name: str) -> None:
        self.model: DeltaModel = MODELS[name]
        self.place = draw_parameters(self.model, ROWS, seed=1)
        # A mirror has only a front; the others are seen from both sides.
        self.wo = both_sides(ROWS, 2) if name != "mirror" else hemisphere(ROWS, seed=2, stream=1)
        shape = (ROWS, self.model.lobe_count, 3)
        random = np.random.default_rng(3)
        self.d = {key: random.uniform(0.5, 1.5, shape) for key in ("wi", "weight")}
        if "glass" not in name or name == "thin_glass":  # the directions depend on no parameter
            del self.d["wi"]

    def rows(self, groups: dict[str, Any]) -> Any:
        return np.ascontiguousarray(
            np.concatenate([groups[q.name] for q in self.model.parameters], axis=1)
        )

    def outputs(self, pair: Any) -> dict[str, Any]:
        return {key: a for key, a in zip(("wi", "weight"), pair, strict=True) if key in self.d}

    def forward(self, groups: dict[str, Any]) -> dict[str, Any]:
        return self.outputs(self.model.core.lobes(self.rows(groups), self.wo))

    def accumulate(self, groups: dict[str, Any], d: Any, d_groups: dict[str, Any]) -> None:
        buffer = self.rows(d_groups)
        weight = np.ascontiguousarray(d["weight"])
        wi = np.ascontiguousarray(d["wi"]) if "wi" in d else np.zeros_like(weight)
        self.model.core.lobes_backward(self.rows(groups), self.wo, wi, weight, buffer)
        ends = np.cumsum([q.size for q in self.model.parameters])[:-1]
        for q, part in zip(self.model.parameters, np.split(buffer, ends, axis=1), strict=True):
            d_groups[q.name][...] = part

    def backward(self, groups: dict[str, Any], d: Any) -> dict[str, Any]:
        d_groups = {name: np.zeros_like(value) for name, value in groups.items()}
        self.accumulate(groups, d, d_groups)
        return d_groups

    def jvp(self, groups: dict[str, Any], v: dict[str, Any]) -> dict[str, Any]:
        return self.outputs(self.model.core.jvp(self.rows(groups), self.rows(v), self.wo))


@pytest.mark.parametrize("name", NAMES)
def test_derivatives(name: str) -> None:
    proof = Proof(name)
    report: Any = check_gradient(proof.forward, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = dot_product_error(proof.jvp, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = check_accumulation(proof.accumulate, proof.place, proof.d)
    assert report, str(report)


@pytest.mark.parametrize("name", NAMES)
def test_wrong_derivatives_die(name: str) -> None:
    proof = Proof(name)
    report: Any = check_gradient_mutants(
        proof.forward, proof.backward, proof.place, proof.d, seed=1, coordinates=8
    )
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, proof.place, proof.d),
        proof.accumulate,
        proof.place,
        proof.d,
    )
    assert report, str(report)


@pytest.mark.parametrize("name", NAMES)
def test_float_agrees_with_double_and_one_row_serves_all(name: str) -> None:
    proof = Proof(name)
    rows = proof.rows(proof.place)
    narrow = proof.model.core.lobes(rows.astype("f4"), proof.wo.astype("f4"))
    for thin, wide in zip(narrow, proof.model.core.lobes(rows, proof.wo), strict=True):
        assert np.linalg.norm(thin - wide) < 1e-5 * np.linalg.norm(wide)
    d = np.ones((ROWS, proof.model.lobe_count, 3))
    one, many = rows[:1].copy(), np.repeat(rows[:1], ROWS, axis=0)
    each = proof.model.core.lobes_backward(many, proof.wo, d, d, np.zeros_like(many))
    once = proof.model.core.lobes_backward(one, proof.wo, d, d, np.zeros_like(one))
    assert np.abs(once).max() > 0
    np.testing.assert_allclose(once[0], each.sum(axis=0), rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("name", ["glass", "thin_glass"])
def test_what_is_not_reflected_passes(name: str) -> None:
    wo = both_sides(200, 4)
    wi, weight = MODELS[name].lobes(CLEAR, wo)
    # Energy, not radiance: a refracted cone is wider by e^2 and seen under another cosine.
    e = np.where(wo[:, 2] > 0, 1.5, 1 / 1.5) if name == "glass" else np.ones(200)
    total = weight[:, 0, 0] + weight[:, 1, 0] * e**2
    np.testing.assert_allclose(total, 1.0, rtol=1e-13)
    stopped = weight[:, 1, 0] == 0
    assert stopped.any() == (name == "glass")
    assert (wo[stopped, 2] < 0).all()
    np.testing.assert_allclose(np.linalg.norm(wi[~stopped], axis=2), 1.0, rtol=1e-14)


def test_light_goes_back_the_way_it_came() -> None:
    glass = MODELS["glass"]
    wo = hemisphere(200, seed=5, stream=1)
    wi, weight = glass.lobes(CLEAR, wo)
    back, back_weight = glass.lobes(CLEAR, np.ascontiguousarray(wi[:, 1]))
    np.testing.assert_allclose(back[:, 1], wo, atol=1e-12)  # measured 2e-15
    # Reciprocity through a boundary: f(wo, wi) e_o^2 = f(wi, wo) e_i^2, that is weights' ratio e^4.
    np.testing.assert_allclose(weight[:, 1] * 1.5**2, back_weight[:, 1] / 1.5**2, rtol=1e-12)


def test_snells_law_and_the_critical_angle() -> None:
    glass = MODELS["glass"]
    wo = hemisphere(50, seed=6, stream=1)
    wi, _ = glass.lobes(CLEAR, wo)
    sines = [np.hypot(w[:, 0], w[:, 1]) for w in (wo, wi[:, 1])]
    np.testing.assert_allclose(sines[0], 1.5 * sines[1], rtol=1e-12)
    sine = 1 / 1.5
    for factor, passes in ((1 - 1e-9, True), (1 + 1e-9, False)):
        s = sine * factor
        _, weight = glass.lobes(CLEAR, np.array([[s, 0.0, -np.sqrt(1 - s * s)]]))
        assert (weight[0, 1, 0] > 0) == passes


def test_two_boundaries_reflect_twice_as_much_less_what_they_share() -> None:
    wo = hemisphere(50, seed=7, stream=1)
    r = MODELS["glass"].lobes(CLEAR, wo)[1][:, 0, 0]
    _, weight = MODELS["thin_glass"].lobes(CLEAR, wo)
    np.testing.assert_allclose(weight[:, 0, 0], 2 * r / (1 + r), rtol=1e-13)
    # Straight on through a window: 0.04 at each side, 7.7 % together.
    _, straight = MODELS["thin_glass"].lobes(CLEAR, np.array([[0.0, 0.0, 1.0]]))
    assert straight[0, 0, 0] == pytest.approx(0.08 / 1.04, rel=1e-12)
    # Black glass reflects at its front alone; at the horizon everything is a mirror.
    _, black = MODELS["thin_glass"].lobes({"eta": 1.5, "tint": np.zeros(3)}, wo)
    np.testing.assert_allclose(black[:, 0, 0], r, rtol=1e-14)
    assert (black[:, 1] == 0).all()
    _, edge = MODELS["thin_glass"].lobes(CLEAR, np.array([[1.0, 0.0, 0.0]]))
    np.testing.assert_array_equal(edge[0, :, 0], [1.0, 0.0])


def test_the_back_of_a_mirror_is_black() -> None:
    wi, weight = MODELS["mirror"].lobes({"reflectance": [0.9, 0.8, 0.7]}, both_sides(4, 8))
    np.testing.assert_array_equal(weight[1::2], 0.0)
    np.testing.assert_array_equal(weight[::2, 0], [[0.9, 0.8, 0.7]] * 2)
    np.testing.assert_array_equal(wi[::2, 0], both_sides(4, 8)[::2] * [-1, -1, 1])


def test_bad_arguments_are_named() -> None:
    glass = MODELS["glass"]
    wo = np.array([[0.0, 0.0, 1.0]])
    with pytest.raises(DtypeError):
        glass.lobes(CLEAR, wo.astype(int))
    with pytest.raises(ShapeError, match="d_weight"):
        glass.lobes_backward(CLEAR, wo, np.zeros((1, 2, 3)), np.zeros((1, 1, 3)))
    d = glass.lobes_backward(CLEAR, wo, np.zeros((1, 2, 3)), np.ones((1, 2, 3)))
    assert d["tint"].shape == (1, 3)
    assert d["eta"].shape == (1,)
