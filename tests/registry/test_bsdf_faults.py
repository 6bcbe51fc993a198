"""The well-known mistakes of reflectance models, each made on purpose: a proof sees it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd.bsdf import BsdfModel, registry

from support.bsdf_proofs import prove_energy, prove_horizon, prove_reciprocity, prove_sampling

MODELS = registry()


class Wrong:
    """A model's core with one of its functions changed: `change(result, rows, wo, wi)`."""

    def __init__(self, right: Any, name: str, change: Callable[..., Any]) -> None:
        self.right, self.name, self.change = right, name, change

    def __getattr__(self, name: str) -> Any:
        function = getattr(self.right, name)
        if name != self.name:
            return function
        return lambda rows, wo, wi: self.change(function(rows, wo, wi), rows, wo, wi)


def half_vector_density(pdf: Any, _: Any, wo: Any, wi: Any) -> Any:
    """The density of wh, without the 1 / (4 <wo, wh>) that makes it one of wi."""
    wh = wo + wi
    wh = wh / np.linalg.norm(wh, axis=1, keepdims=True)
    return pdf * 4.0 * (wo * wh).sum(axis=1)


def without_eta_squared(f: Any, rows: Any, wo: Any, wi: Any) -> Any:
    """Refracted radiance as if it were power."""
    e = np.where(wo[:, 2:] > 0, rows[:, :1], 1.0 / rows[:, :1])
    return np.where(wo[:, 2:] * wi[:, 2:] < 0, f * e**2, f)


def red_for_blue(f: Any, _: Any, wo: Any, wi: Any) -> Any:
    """Refracted light in the channel of another index."""
    return np.where(wo[:, 2:] * wi[:, 2:] < 0, f[:, ::-1], f)


def through_the_surface(f: Any, _: Any, wo: Any, wi: Any) -> Any:
    """Light that leaks: the cosine's sign is forgotten."""
    return np.where(wo[:, 2:] * wi[:, 2:] < 0, 0.1, f)


@pytest.mark.parametrize(
    ("name", "function", "change", "proof"),
    [
        ("ggx_metal", "pdf", half_vector_density, prove_sampling),
        ("ggx_metal", "pdf", half_vector_density, prove_energy),
        ("beckmann_conductor", "pdf", half_vector_density, prove_sampling),
        ("rough_dielectric", "f", without_eta_squared, prove_reciprocity),
        ("rough_dielectric", "f", without_eta_squared, prove_energy),
        ("dispersive_dielectric", "f", red_for_blue, prove_reciprocity),
        ("gltf_transmission", "pdf", half_vector_density, prove_energy),
        ("gltf", "f", through_the_surface, prove_horizon),
    ],
)
def test_a_mistake_is_seen(
    name: str, function: str, change: Callable[..., Any], proof: Callable[[BsdfModel], None]
) -> None:
    right = MODELS[name]
    with pytest.raises(AssertionError):
        proof(dataclasses.replace(right, core=Wrong(right.core, function, change)))


def test_claims_that_are_not_kept_are_seen() -> None:
    with pytest.raises(AssertionError, match="burley_diffuse is conserving"):
        prove_energy(dataclasses.replace(MODELS["burley_diffuse"], energy=("conserving", 1.0)))
    with pytest.raises(AssertionError, match="phong"):
        prove_reciprocity(dataclasses.replace(MODELS["phong"], reciprocal=True))
    with pytest.raises(AssertionError, match="lambert"):
        prove_reciprocity(dataclasses.replace(MODELS["lambert"], reciprocal=False))
