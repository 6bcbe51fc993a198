"""Materials outside of the range of their model are refused, not drawn black or negative."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError
from photograd.transport import Environment, Material, PathTracer, Scene, SphereShape, read_scene
from photograd.transport.material import MODELS

from tests.transport.gltf_samples import extension, square
from tests.transport.scenes import any_material, view
from tests.transport.test_gltf_materials import read
from tests.transport.test_scene_files import TEXT, write


def changed(model: str, **more: Any) -> Material:
    return Material(model, {**any_material(model).values, **more})


@pytest.mark.parametrize(
    ("model", "more", "words"),
    [
        ("gltf", {"roughness": 0.0}, r"roughness: expected above 0, got 0.0 \(.* mirror, glass"),
        ("gltf", {"roughness": 0.01}, r"roughness: expected 0.045 to 1, got 0.01 \(.* mirror"),
        ("gltf", {"roughness": 1.5}, r"gltf.roughness: expected 0.045 to 1, got 1.5$"),
        ("gltf", {"metalness": 7.0}, "metalness: expected 0 to 1, got 7.0"),
        ("lambert", {"albedo": [0.5, 1.5, 0.5]}, "albedo: expected 0 to 1, got"),
        ("lambert", {"albedo": [0.5, -1.0, 0.5]}, "albedo: expected 0 to 1, got"),
        ("lambert", {"alpha": 1.1}, "lambert.alpha: expected 0 to 1, got 1.1"),
        ("cook_torrance", {"slope": 0.0}, "slope: expected above 0, got 0.0"),
        ("glass", {"eta": -1.5}, "eta: expected above 0, got -1.5"),
        ("dispersive_glass", {"dispersion": -1.0}, "dispersion: expected at least 0, got -1.0"),
    ],
)
def test_values_outside_of_the_range_are_named(
    model: str, more: dict[str, Any], words: str
) -> None:
    with pytest.raises(RangeError, match=words):
        changed(model, **more)


def test_what_is_usual_does_not_bind() -> None:
    # Silver's index is 0.04, a bubble's in water 0.75, a highlight may be sharp.
    changed("ggx_conductor", eta=[0.06, 0.06, 0.04], k=[11.0, 11.0, 11.0])
    changed("glass", eta=0.75)
    changed("phong", exponent=2000.0)
    changed("ggx_anisotropic", rotation=7.0)


def test_a_file_names_the_line(tmp_path: Path) -> None:
    wrong = TEXT.replace("roughness = 0.3", "roughness = 0")
    with pytest.raises(SceneError, match=r"line 18: materials\.gold\.roughness: .*expected above"):
        read_scene(write(tmp_path, wrong))


@pytest.mark.parametrize(
    "model", [m for m in MODELS if any("roughness" in p.name for p in MODELS[m].parameters)]
)
def test_no_lobe_without_width_is_evaluated(model: str) -> None:
    # Its value would be 0 / 0 in the mirrored direction; models of another kind are smooth.
    reflectance: Any = MODELS[model]
    w = np.array([[0.6, 0.0, 0.8]])
    for parameter in reflectance.parameters:
        if "roughness" not in parameter.name:
            continue
        values = {**reflectance.at(0.5), parameter.name: 0.0}
        for ask, more in ((reflectance.f, ()), (reflectance.f_backward, (np.ones((1, 3)),))):
            if parameter.lo > 0:
                with pytest.raises(RangeError, match="mirror, glass, thin_glass"):
                    ask(values, w, w * [-1, -1, 1], *more)
            else:  # a ground, which has a width
                ask(values, w, w * [-1, -1, 1], *more)


def test_the_smoothest_metal_is_a_mirror_in_a_picture() -> None:
    # Where a roughness of 0 would be black: at its end the ball shows the mirror's picture.
    sky = Environment(np.array([1.0, 2.0, 4.0]), np.array([0.5, 0.4, 0.3]), np.full(3, 0.1))
    ball, camera = SphereShape("ball", np.zeros(3), 1.0, "m"), view(6, (0, 0, 3), (0, 0, 0))

    def picture(material: Material) -> Any:
        return (
            PathTracer(Scene("s", (ball,), {"m": material}, camera, sky))
            .render(spp=64, seed=1)
            .mean[2:4, 2:4]
        )

    color = [0.9, 0.5, 0.2]
    smooth = picture(Material("mirror", {"reflectance": color}))
    glossy = picture(Material("ggx_metal", {"f0": color, "roughness": 0.045}))
    assert smooth.min() > 0.04
    # Seen straight on, Schlick adds nothing. Measured: 4e-3.
    np.testing.assert_allclose(glossy, smooth, rtol=0.02)


def test_negative_light_of_a_file_is_named(tmp_path: Path) -> None:
    for change, emission, words in (
        (
            {"emissiveFactor": [-1, 0.5, 3]},
            [0, 0.5, 1],
            "materials[0]: emissiveFactor: [-1.   0.5  3. ] is taken as [0.  0.5 1. ]",
        ),
        (
            {"emissiveFactor": [1, 1, 1]} | extension("emissive_strength", emissiveStrength=-2),
            [0, 0, 0],
            "emissiveStrength: -2.0 is taken as 0",
        ),
    ):
        model, told = read(tmp_path, square(**change).bytes())
        np.testing.assert_array_equal(model.shapes[0].emission, emission)
        assert len(told) == 1
        assert words in told[0]
