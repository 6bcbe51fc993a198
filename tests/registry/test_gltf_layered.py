"""All layers of a glTF material in one model: what it is with one of them, and how they nest."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry
from photograd_course.random import uniform

from support.bsdf_proofs import hemisphere, index_of, power_factor, squares, towards

MODELS = registry()
LAYERED = ("gltf_layered", "gltf_layered_volume")
WO, WI = (hemisphere(200, seed=61, stream=k) for k in (1, 2))
THROUGH = WI * [1.0, 1.0, -1.0]
BARE: dict[str, Any] = {
    "base_color": [0.9, 0.5, 0.2],
    "metalness": 0.3,
    "roughness": 0.4,
    "eta": 1.5,
    "specular_factor": 1.0,
    "specular_color_factor": np.ones(3),
    "anisotropy": 0.0,
    "rotation": 0.0,
    "anisotropy_x": 1.0,
    "anisotropy_y": 0.0,
    "iridescence_factor": 0.0,
    "iridescence_ior": 1.3,
    "iridescence_thickness": 400.0,
    "sheen_color_factor": np.zeros(3),
    "sheen_roughness_factor": 0.5,
    "coat": 0.0,
    "coat_roughness": 0.1,
    "transmission": 0.0,
}
SHEEN = {"sheen_color_factor": [0.8, 0.3, 0.6], "sheen_roughness_factor": 0.4}
FILM = {"iridescence_factor": 0.7, "iridescence_ior": 1.4, "iridescence_thickness": 330.0}
SPECULAR = {"eta": 1.8, "specular_factor": 0.6, "specular_color_factor": [1.5, 0.4, 1.0]}
BRUSH = {"anisotropy": 0.7, "rotation": 0.8}
ALL = BARE | SHEEN | FILM | SPECULAR | BRUSH | {"coat": 0.8, "coat_roughness": 0.2}


def value(name: str, parameters: dict[str, Any], wo: Any = WO, wi: Any = WI) -> Any:
    names = {parameter.name for parameter in MODELS[name].parameters}
    given = {"dispersion": 0.0, **parameters}
    return MODELS[name].f({key: given[key] for key in names}, wo, np.ascontiguousarray(wi))


@pytest.mark.parametrize(
    ("name", "layer"),
    [
        ("gltf", {}),
        ("gltf_sheen", SHEEN),
        ("gltf_iridescence", FILM),
        ("gltf_specular", SPECULAR),
        ("gltf_transmission", {"transmission": 0.6, "eta": 1.3}),
    ],
)
def test_with_one_layer_it_is_the_model_of_that_layer(name: str, layer: dict[str, Any]) -> None:
    for wi in (WI, THROUGH):
        one = value(name, BARE | layer, wi=wi)
        # Measured 2e-12: a turned half vector is rounded once more.
        np.testing.assert_allclose(value("gltf_layered", BARE | layer, wi=wi), one, rtol=1e-10)
        sides = value("gltf_layered", BARE | layer, -WO, -wi)
        np.testing.assert_allclose(
            sides,
            value("gltf_layered", BARE | layer, WO * [-1, -1, 1], wi * [-1, -1, 1]),
            rtol=1e-10,
        )


def test_a_brushed_metal_is_the_brushed_metal() -> None:
    metal = BARE | BRUSH | {"metalness": 1.0}
    one = value("ggx_anisotropic", metal | {"f0": metal["base_color"]})
    np.testing.assert_allclose(value("gltf_layered", metal), one, rtol=1e-10)


@pytest.mark.parametrize("name", LAYERED)
def test_a_tangent_turns_as_the_rotation_does(name: str) -> None:
    turned = value(name, ALL)
    by_tangent = {
        "rotation": 0.3,
        "anisotropy_x": 0.4 * np.cos(0.5),
        "anisotropy_y": 0.4 * np.sin(0.5),
    }
    np.testing.assert_allclose(value(name, ALL | by_tangent), turned, rtol=1e-9)
    nowhere = value(name, ALL | {"anisotropy_x": 0.0, "anisotropy_y": 0.0})
    np.testing.assert_array_equal(nowhere, turned)
    assert np.abs(value(name, ALL | {"rotation": 0.3}) / turned - 1).max() > 0.1


@pytest.mark.parametrize("name", LAYERED)
def test_layers_nest_as_the_extensions_print_them(name: str) -> None:
    # fresnel_coat(sheen + albedo scaling(base)), each written here with one-layer models.
    base = value(name, ALL | {"coat": 0.0, "sheen_color_factor": np.zeros(3)})
    fibers = MODELS["sheen"].f({"color": SHEEN["sheen_color_factor"], "roughness": 0.4}, WO, WI)
    white: dict[str, Any] = {"base_color": np.ones(3), "metalness": 1.0, "roughness": 0.7}
    cloth = MODELS["gltf_sheen"].f(white | SHEEN, WO, WI) - fibers
    left = cloth / MODELS["gltf"].f(white, WO, WI)
    S = 0.04 + 0.96 * (1 - WO[:, 2:]) ** 5
    coat = MODELS["ggx_metal"].f({"f0": np.ones(3), "roughness": 0.2}, WO, WI)
    printed = (1 - 0.8 * S) * (fibers + left * base) + 0.8 * S * coat
    np.testing.assert_allclose(value(name, ALL), printed, rtol=1e-9)


def test_film_and_coating_are_mixed_as_finished_layers() -> None:
    # mix(fresnel_mix(base, layer), rgb_mix(base, layer, film), iridescence), colored coatings too.
    for layer in (SPECULAR, {}):
        ends = [
            value("gltf_layered", BARE | FILM | layer | {"iridescence_factor": w})
            for w in (0.0, 1.0)
        ]
        found = value("gltf_layered", BARE | FILM | layer)
        np.testing.assert_allclose(found, 0.3 * ends[0] + 0.7 * ends[1], rtol=1e-9)
    matt = BARE | FILM | {"specular_factor": 0.0, "metalness": 0.0}
    lambert = np.broadcast_to(np.array(BARE["base_color"]) / np.pi, WO.shape)
    np.testing.assert_allclose(value("gltf_layered", matt), lambert, rtol=1e-12)


def test_bodies_part_colors_as_frosted_glass_does() -> None:
    # White, whole and colorless: Fresnel apart, the lobes are those of dispersive_dielectric.
    glass = BARE | {"base_color": np.ones(3), "metalness": 0.0, "transmission": 1.0}
    glass |= {"dispersion": 1.5, "specular_factor": 0.0}
    for wo in (WO, -WO):
        wi = -wo + 0.2 * (hemisphere(len(wo), seed=62, stream=3) - [0, 0, 0.5])
        wi[:, 2] = np.sign(wi[:, 2]) * np.maximum(np.abs(wi[:, 2]), 0.05)
        wi /= np.linalg.norm(wi, axis=1, keepdims=True)
        found = value("gltf_layered_volume", glass, wo, wi)
        other = value("dispersive_dielectric", glass, wo, wi)
        lit = (other > 1e-6).all(axis=1)
        assert lit.sum() > 50
        # Without a coating everything passes: other = (1 - F) found, with F exact.
        left = (other / np.where(found > 0, found, 1))[lit]
        assert left.max() <= 1 + 1e-9
        assert np.median(left) == pytest.approx(0.95, abs=0.04)


def test_light_that_refracts_has_one_fresnel_both_ways() -> None:
    # f / index^2 is the same both ways, and nothing is lost at a facet: white glass of one channel.
    glass = BARE | FILM | {"base_color": np.ones(3), "metalness": 0.0, "transmission": 1.0}
    glass |= {"dispersion": 0.7}
    model = MODELS["gltf_layered_volume"]
    there = value(model.name, glass, WO, THROUGH) / index_of(model, glass, WO) ** 2
    back = value(model.name, glass, THROUGH, WO) / index_of(model, glass, THROUGH) ** 2
    assert there.max() > 0.1
    np.testing.assert_allclose(back, there, rtol=1e-9)


CONSERVING = ("gltf_layered_conserving", "gltf_layered_volume_conserving")


def corners(name: str, rows: int, *, seed: int) -> dict[str, Any]:
    """Parameters at the ends of their ranges or anywhere between; most of them white."""
    values: dict[str, Any] = {}
    for number, p in enumerate(MODELS[name].parameters):
        u = uniform(
            seed, step=number, pixel=np.arange(rows)[:, None], dimension=np.arange(p.size + 1)
        )
        part = np.where(u[:, :1] < 0.25, 0.0, np.where(u[:, :1] < 0.5, 1.0, u[:, 1:]))
        if p.name == "base_color":
            part = np.ones_like(part)
        values[p.name] = p.lo + (p.hi - p.lo) * (part if p.size > 1 else part[:, 0])
    return values


def returned(name: str, row: dict[str, Any], cosine: float) -> tuple[float, float]:
    """The part of the light that leaves, of the brightest channel, by samples; and its error."""
    model, u2 = MODELS[name], squares(4096, seed=64)
    wo = towards(cosine, len(u2))
    wi = model.sample(row, wo, u2)
    pdf = model.pdf(row, wo, wi)[:, None]
    value = model.f(row, wo, wi) * power_factor(model, row, wo, wi)
    weight = np.where(pdf > 0, value / np.where(pdf > 0, pdf, 1.0), 0.0)
    mean = weight.mean(axis=0)
    error = weight.std(axis=0)[mean.argmax()] / np.sqrt(len(u2))
    return float(mean.max()), float(error)


@pytest.mark.parametrize("name", CONSERVING)
def test_the_conserving_variant_never_gains(name: str) -> None:
    rows, printed = corners(name, 12, seed=63), name.removesuffix("_conserving")
    for number in range(12):
        row = {key: numbers[number] for key, numbers in rows.items()}
        for cosine in (0.02, 0.3, -0.5 if "volume" in name else 0.9):
            mean, error = returned(name, row, cosine)
            assert mean - 4 * error < 1.005, (row, cosine)
    least = {p.name: p.lo for p in MODELS[name].parameters}
    smooth = {**BARE, "dispersion": 0.0, "base_color": np.ones(3), "metalness": 0.0}
    smooth |= {key: least[key] for key in ("roughness", "eta")}
    white = {key: smooth[key] for key in least}
    assert returned(printed, white, 0.02)[0] > 1.5  # the printed formula does
    assert returned(name, white, 0.02)[0] < 1.005


def test_the_conserving_variant_changes_what_gains_and_little_else() -> None:
    up = np.array([[0.0, 0.0, 1.0]])
    wi = np.ascontiguousarray(WI[WI[:, 2] > 0.8])
    wo = np.repeat(up, len(wi), axis=0)
    printed = value("gltf_layered", ALL, wo, wi)
    held = value("gltf_layered_conserving", ALL, wo, wi)
    assert (held > 0.7 * printed).all()
    assert (held < 1.05 * printed).all()
    np.testing.assert_allclose(
        value("gltf_layered_conserving", ALL),
        value("gltf_layered_conserving", ALL, WI, WO),
        rtol=1e-9,
    )
