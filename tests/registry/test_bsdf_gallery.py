"""What a model's row of the gallery shows is what it returns, and what its parameters change."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import image as pictures
from photograd.bsdf import registry
from photograd.bsdf.gallery import derivatives, furnace_curve, gallery_picture

from support.bsdf_proofs import albedo, hemisphere
from support.tree import ROOT

MODELS = registry()


@pytest.mark.parametrize("name", ["lambert", "ggx_metal", "gltf", "rough_dielectric", "sheen"])
def test_a_furnace_curve_is_the_albedo(name: str) -> None:
    model = MODELS[name]
    cosines = np.array([0.15, 0.6, 1.0])
    values = model.at(0.6)
    found = furnace_curve(model, values, cosines, samples=4096)
    expected = np.array([albedo(model, values, c) for c in cosines])
    # Lambert's has no error; measured otherwise: 7e-4.
    np.testing.assert_allclose(found, expected, rtol=1e-12 if name == "lambert" else 2e-3)
    assert np.ptp(expected[:, 0]) > 0.02 or name == "lambert"


def test_a_derivative_is_a_difference() -> None:
    model, values, h = MODELS["disney"], MODELS["disney"].at(0.4), 1e-6
    wo, wi = (hemisphere(50, seed=71, stream=k) for k in (1, 2))
    slopes = derivatives(model, values, wo, wi)
    assert list(slopes) == [parameter.name for parameter in model.parameters]
    for name, slope in slopes.items():
        ends: list[Any] = [
            model.f({**values, name: values[name] + step}, wo, wi).mean(axis=1) for step in (h, -h)
        ]
        assert np.abs(slope).max() > 0
        np.testing.assert_allclose(
            slope, (ends[0] - ends[1]) / (2 * h), rtol=1e-5, atol=1e-6 * np.abs(slope).max()
        )


def test_a_row_has_its_curve_and_its_derivatives(tmp_path: Path) -> None:
    gallery_picture(MODELS["ggx_metal"], tmp_path / "a.png")
    picture = pictures.imread(tmp_path / "a.png")[..., :3]
    below = picture[int(0.7 * len(picture)) :]
    curve, balls = below[:, :270], below[:, 320:]
    # Lines of four colors left; red and blue, the signs of derivatives, right.
    assert ((curve.max(axis=2) - curve.min(axis=2)) > 0.5).sum() > 200
    red, blue = balls[..., 0] - balls[..., 2] > 0.4, balls[..., 2] - balls[..., 0] > 0.4
    assert min(red.sum(), blue.sum()) > 20


def test_the_page_has_a_row_for_every_model() -> None:
    text = (ROOT / "docs" / "gallery.md").read_text("utf-8")
    rows = [line.partition("](")[2].rstrip(")") for line in text.splitlines() if "](images" in line]
    assert rows == [f"images/reflectance/{name}.jpg" for name in MODELS]
    for row in rows:
        assert (ROOT / "docs" / row).stat().st_size > 5000
