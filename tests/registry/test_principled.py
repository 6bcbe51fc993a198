"""The principled model: its definition, and the kernel that evaluates it many times."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.bsdf import principled, registry
from photograd.errors import DtypeError, ShapeError

from support.bits import same_bits
from support.bsdf_proofs import albedo, hemisphere

pytestmark = pytest.mark.usefixtures("core")

Array = Any
MODEL = registry()["principled"]


def directions(count: int, stream: int) -> Array:
    """(N, 3) float32; every seventh lies below the surface."""
    w = hemisphere(count, seed=5, stream=stream)
    w[::7, 2] *= -1.0
    return w.astype(np.float32)


def parameter_rows(count: int) -> Array:
    u = np.random.default_rng(count).random((count, 5))
    return principled.rows(u[:, :3], u[:, 3], 0.1 + 0.9 * u[:, 4])


def written_out(wo: Array, wi: Array, row: Array) -> Array:
    """The model as it is usually written down: half vectors, D, G1, two Fresnel terms."""
    base, metalness, roughness = row[:3], row[3], row[4]
    alpha2 = roughness**4
    wh = wo + wi
    wh /= np.linalg.norm(wh, axis=1, keepdims=True)
    c, o, i = (wo * wh).sum(axis=1), wo[:, 2], wi[:, 2]

    def G1(z: Array) -> Array:
        return 2 / (1 + np.sqrt(1 + alpha2 * (1 - z * z) / (z * z)))

    D = alpha2 / (np.pi * (wh[:, 2] ** 2 * (alpha2 - 1) + 1) ** 2)
    lobe = D * G1(o) * G1(i) / (4 * o * i)
    t = np.sqrt(1 - (1 - c * c) / 1.5**2)
    across, within = (c - 1.5 * t) / (c + 1.5 * t), (1.5 * c - t) / (1.5 * c + t)
    varnish = (1 - metalness) * (across**2 + within**2) / 2
    metal = metalness * (base + (1 - base) * (1 - c[:, None]) ** 5)
    F_o, F_i, R = (1 - o) ** 5, (1 - i) ** 5, 2 * roughness * c * c
    ground = (1 - F_o / 2) * (1 - F_i / 2) + R * (F_o + F_i + F_o * F_i * (R - 1))
    diffuse = (1 - metalness) * ground[:, None] * base / np.pi
    return diffuse + (varnish[:, None] + metal) * lobe[:, None]


@pytest.mark.parametrize(
    "row", [(0.7, 0.4, 0.2, 0.3, 0.35), (0.1, 0.9, 0.5, 0.0, 1.0), (0.8, 0.6, 0.3, 1.0, 0.15)]
)
def test_values_are_those_of_the_formula(row: tuple[float, ...]) -> None:
    wo, wi = (hemisphere(400, seed=2, stream=k) for k in (1, 2))
    found = MODEL.f({"base_color": row[:3], "metalness": row[3], "roughness": row[4]}, wo, wi)
    np.testing.assert_allclose(found, written_out(wo, wi, np.array(row)), rtol=1e-12)


def test_most_light_comes_back_along_a_rough_surface() -> None:
    white = {"base_color": np.ones(3), "metalness": 0.0}
    found = [float(albedo(MODEL, {**white, "roughness": r}, 1e-4)[0]) for r in (0.6, 0.8, 1.0)]
    np.testing.assert_allclose(found, [1.247, 1.410, 1.605], atol=2e-3)
    assert max(found) < MODEL.energy[1]


@pytest.mark.parametrize("count", [1, 16, 37, 16384 + 19])
@pytest.mark.parametrize("rows", [1, 3, 16, 40])
def test_kernel_and_model_agree_bit_for_bit(count: int, rows: int) -> None:
    wo, wi = directions(count, 1), directions(count, 2)
    parameters = parameter_rows(rows)
    taken = parameters[np.arange(count) % rows]
    expected = MODEL.core.f(np.ascontiguousarray(taken), wo, wi)
    found = principled.evaluate(parameters, wo, wi)
    np.testing.assert_array_equal(found, expected)
    above = (wo[:, 2] > 0) & (wi[:, 2] > 0)
    assert (found[above] > 0).all()
    assert (found[~above] == 0).all()
    cosine = principled.evaluate(parameters, wo, wi, cosine=True)
    np.testing.assert_array_equal(cosine, expected * np.where(above, wi[:, 2], 1)[:, None])


@pytest.mark.parametrize("rows", [1, 3, 40])
@pytest.mark.parametrize("cosine", [False, True])
def test_derivatives_are_sums_of_the_models(rows: int, cosine: bool) -> None:
    count = 5000
    wo, wi = directions(count, 3), directions(count, 4)
    parameters = parameter_rows(rows)
    d = np.random.default_rng(6).normal(size=(count, 3)).astype(np.float32)
    found = principled.evaluate_backward(parameters, wo, wi, d, cosine=cosine)
    taken = parameters[np.arange(count) % rows].astype(np.float64)
    scaled = d.astype(np.float64) * (wi[:, 2:].astype(np.float64) if cosine else 1.0)
    single = MODEL.core.f_backward(
        taken, wo.astype(np.float64), wi.astype(np.float64), scaled, np.zeros_like(taken)
    )
    expected = np.zeros((rows, 5))
    np.add.at(expected, np.arange(count) % rows, single)
    assert np.abs(expected).min() > 0
    for column in range(5):
        size = np.linalg.norm(expected[:, column])
        assert np.linalg.norm(found[:, column] - expected[:, column]) < 2e-5 * size
    twice = principled.evaluate_backward(parameters, wo, wi, d, cosine=cosine, out=found.copy())
    np.testing.assert_allclose(twice, 2 * found, rtol=1e-6)


def test_nothing_beside_the_rows_is_written() -> None:
    wo, wi = directions(21, 1), directions(21, 2)
    for rows in (1, 5):
        parameters = parameter_rows(rows)
        values = np.full((25, 3), 7, np.float32)
        _core.principled_values(parameters, wo, wi, True, values[2:23])
        gradient = np.full((rows + 4, 5), 7, np.float32)
        _core.principled_values_backward(
            parameters, wo, wi, True, np.ones_like(wo), gradient[2 : rows + 2]
        )
        for array in (values, gradient):
            assert (array[:2] == 7).all()
            assert (array[-2:] == 7).all()


def test_bad_arrays_are_named() -> None:
    wo, wi = directions(4, 1), directions(4, 2)
    parameters = parameter_rows(1)
    with pytest.raises(ShapeError, match="wi: expected"):
        principled.evaluate(parameters, wo, wi[:3])
    with pytest.raises(DtypeError, match=r"^principled\.evaluate: parameters: expected float32"):
        principled.evaluate(parameters.astype(np.float64), wo, wi)
    with pytest.raises(ShapeError, match=r"\(T, 5\) with T >= 1"):
        principled.evaluate(parameters[:0], wo, wi)


@same_bits("principled", kernels=("principled_values", "principled_values_backward"))
def values_and_gradients() -> list[Any]:
    """One material for all rows, and more materials than one task takes."""
    wo, wi = directions(70_000, 1), directions(70_000, 2)
    results = []
    for rows in (1, 3000):
        parameters = parameter_rows(rows)
        results.append(principled.evaluate(parameters, wo, wi, cosine=True))
        results.append(principled.evaluate_backward(parameters, wo, wi, wo))
    return results
