"""Every registered reflectance model passes every proof; its picture and benchmark row exist."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from photograd.bsdf import BsdfModel, registry
from photograd.bsdf.gallery import benchmark_row, gallery_picture
from photograd.errors import DtypeError, RangeError, ShapeError
from PIL import Image

from support.bsdf_proofs import PROOFS, prove_energy, prove_reciprocity, prove_sampling

MODELS = registry()


@pytest.mark.parametrize("proof", PROOFS, ids=lambda proof: proof.__name__)
@pytest.mark.parametrize("name", sorted(MODELS))
def test_proof(name: str, proof: Callable[[BsdfModel], None]) -> None:
    proof(MODELS[name])


@pytest.mark.parametrize("name", sorted(MODELS))
def test_picture_and_benchmark_row(name: str, tmp_path: Path) -> None:
    gallery_picture(MODELS[name], tmp_path / "a.png")
    picture = np.asarray(Image.open(tmp_path / "a.png").convert("RGB"), float)
    assert picture.shape[1] > 600
    assert picture.std() > 10.0
    row = benchmark_row(MODELS[name], count=5000)
    assert row["model"] == name
    assert min(row["forward_per_s"], row["backward_per_s"], row["mean"]) > 0


def test_a_picture_is_the_same_every_time(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        gallery_picture(MODELS["lambert"], tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_lambert_reflects_its_albedo_exactly() -> None:
    # The closed form: f = albedo / pi, and every sample of f cos / pdf weighs the albedo.
    model = MODELS["lambert"]
    albedo = {"albedo": np.array([0.2, 0.5, 0.8])}
    wo = np.array([[0.6, 0.0, 0.8]])
    np.testing.assert_allclose(model.f(albedo, wo, wo), albedo["albedo"][None] / np.pi, rtol=1e-15)
    assert model.energy == ("conserving", 1.0)


class Wrong:
    """Lambert with a fault, in the place of the core's class."""

    def __init__(self, fault: str) -> None:
        self.right, self.fault = MODELS["lambert"].core, fault

    def f(self, rows: np.ndarray, wo: np.ndarray, wi: np.ndarray) -> np.ndarray:
        value = self.right.f(rows, wo, wi)
        if self.fault == "one-sided lobe":
            return value * wo[:, 2:]
        return value * (1.01 if self.fault == "too bright" else 1.0)

    def sample(self, rows: np.ndarray, wo: np.ndarray, u2: np.ndarray) -> np.ndarray:
        if self.fault == "clustered":
            u2 = u2 * [0.98, 1.0]
        return self.right.sample(rows, wo, u2)

    def index_inside(self, rows: np.ndarray) -> np.ndarray:
        return self.right.index_inside(rows)

    def pdf(self, rows: np.ndarray, wo: np.ndarray, wi: np.ndarray) -> np.ndarray:
        uniform = np.full(len(wi), 0.5 / np.pi) * (wi[:, 2] > 0)
        return uniform if self.fault == "uniform pdf" else self.right.pdf(rows, wo, wi)


@pytest.mark.parametrize(
    ("fault", "proof"),
    [
        ("uniform pdf", prove_sampling),
        ("uniform pdf", prove_energy),
        ("clustered", prove_sampling),
        ("too bright", prove_energy),
        ("one-sided lobe", prove_reciprocity),
    ],
)
def test_the_physics_proofs_see_faults(fault: str, proof: Callable[[BsdfModel], None]) -> None:
    right = MODELS["lambert"]
    wrong = dataclasses.replace(right, core=Wrong(fault))
    with pytest.raises(AssertionError):
        proof(wrong)


def test_bad_arguments_are_named() -> None:
    model = MODELS["lambert"]
    w = np.array([[0.0, 0.0, 1.0]])
    with pytest.raises(RangeError, match="exactly"):
        model.f({"color": [1, 1, 1]}, w, w)
    with pytest.raises(ShapeError, match="albedo"):
        model.f({"albedo": [1.0, 1.0]}, w, w)
    with pytest.raises(RangeError, match="finite"):
        model.f({"albedo": [1.0, np.nan, 1.0]}, w, w)
    with pytest.raises(
        ShapeError, match=r"^BsdfModel\.f: wi: expected shape .N, 3. with N = 1 as in wo"
    ):
        model.f({"albedo": [1.0, 1.0, 1.0]}, w, w[:, :2])
    with pytest.raises(DtypeError, match="wi: expected float64 as wo"):
        model.f({"albedo": [1.0, 1.0, 1.0]}, w, w.astype("f4"))
