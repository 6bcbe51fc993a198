"""The thin film of glTF's iridescence: limits, formula, and how far it is from the spectrum."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry

from support.bsdf_proofs import albedo, hemisphere, near_mirror

MODELS = registry()
FILM, BASE = MODELS["gltf_iridescence"], MODELS["gltf"]
WO = hemisphere(200, seed=31, stream=1)
WI = near_mirror(WO, seed=31, stream=2)
GROUND: dict[str, Any] = {"base_color": [0.9, 0.5, 0.2], "metalness": 0.4, "roughness": 0.5}
RGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)


def metal(cosine: Any, color: Any, ior: float, thickness: float) -> Any:
    """F (N, 3) of a metal under the film, for half angles of these cosines."""
    s = np.sqrt(1.0 - cosine**2)
    wo, wi = (np.stack([sign * s, 0 * s, cosine], axis=1) for sign in (1, -1))
    shape = {"base_color": color, "metalness": 1.0, "roughness": 0.6}
    film = {"iridescence_factor": 1.0, "iridescence_ior": ior, "iridescence_thickness": thickness}
    lobe = MODELS["ggx_metal"].f({"f0": np.ones(3), "roughness": 0.6}, wo, wi)
    return FILM.f({**shape, **film}, wo, wi) / lobe


def formula(c1: Any, f0: Any, n: float, d: float, mistake: str = "") -> Any:
    """The extension's film (N, 3), written for arrays, with waves as complex numbers."""
    c2 = np.sqrt(1 - (1 - c1**2) / n**2)
    r12 = ((n - 1) / (n + 1)) ** 2
    r12 = (r12 + (1 - r12) * (1 - c1) ** 5)[:, None]
    g = np.sqrt(f0 + 1e-4 * (1 - f0))
    amplitude = (n - (1 + g) / (1 - g)) / (n + (1 + g) / (1 - g))
    r23 = amplitude**2 + (1 - amplitude**2) * (1 - c2[:, None]) ** 5
    turn = np.where(amplitude > 0, 2 * np.pi, np.pi)  # of both boundaries together
    if mistake == "phase":
        turn = turn - np.pi
    path = 2 * n * d * (c1 if mistake == "angle outside" else c2)
    if mistake == "one way":
        path = path / 2
    leaves = (1 - r12) ** (1 if mistake == "one passage" else 2) * r23 / (1 - r12 * r23)
    total = r12 + leaves
    lobes = (
        (5.4856e-13, 1.6810e6, 4.3278e9, 0),
        (4.4201e-13, 1.7953e6, 9.3046e9, 1),
        (5.2481e-13, 2.2084e6, 6.6121e9, 2),
        (9.7470e-14, 2.2399e6, 4.5282e9, 0),
    )
    for order in (1,) if mistake == "one order" else (1, 2):
        k = 2 * np.pi * order * path * 1e-9
        xyz = np.zeros((len(c1), 3), complex)
        for height, position, variance, axis in lobes:
            area = height * np.sqrt(2 * np.pi * variance) / 1.0685e-7
            xyz[:, axis] += area * np.exp(1j * position * k - variance * k * k)
        wave = ((xyz @ RGB.T) * np.exp(1j * order * turn)).real
        total = total + 2 * (leaves - (1 - r12)) * (r12 * r23) ** (order / 2) * wave
    return np.maximum(total, 0.0)


MISTAKES = ("phase", "angle outside", "one way", "one passage", "one order")


@pytest.mark.parametrize("ior", [1.2, 1.5, 2.1])
@pytest.mark.parametrize("thickness", [150.0, 420.0, 900.0])
def test_the_film_is_that_of_the_extension(ior: float, thickness: float) -> None:
    cosine, color = np.linspace(0.1, 1.0, 40), np.array([0.9, 0.5, 0.04])
    found = metal(cosine, color, ior, thickness)
    assert np.ptp(found[:, 0]) > 0.01
    # Heights of the four lobes have seven digits.
    np.testing.assert_allclose(found, formula(cosine, color, ior, thickness), atol=3e-7)
    for mistake in MISTAKES:
        gap = np.abs(found - formula(cosine, color, ior, thickness, mistake)).max()
        # In thick films the second wave is almost gone.
        assert gap > (5e-5 if mistake == "one order" else 1e-3), mistake


def test_no_film_is_the_base_to_the_bit() -> None:
    plain = BASE.f(GROUND, WO, WI)
    for factor, thickness in ((0.0, 400.0), (1.0, 0.0)):
        film = {"iridescence_factor": factor, "iridescence_thickness": thickness}
        bare = FILM.f({**GROUND, **film, "iridescence_ior": 1.5}, WO, WI)
        np.testing.assert_array_equal(bare, plain)
    full = {"iridescence_factor": 1.0, "iridescence_thickness": 400.0, "iridescence_ior": 1.5}
    assert np.abs(FILM.f({**GROUND, **full}, WO, WI) - plain).max() > 0.01


def test_a_film_shows_its_color_most_where_it_is_thin() -> None:
    straight = np.array([1.0])
    thin, thick = (metal(straight, np.full(3, 0.3), 1.8, d)[0] for d in (300.0, 20_000.0))
    assert np.ptp(thin) > 0.1
    assert np.ptp(thick) < 1e-6  # so many waves in the eye's bands that none stands out
    # Towards the horizon the path shortens, and colors run as in a thinner film.
    cosine = np.array([0.6])
    inside = np.sqrt(1 - (1 - 0.36) / 1.3**2)
    tilted = metal(cosine, np.full(3, 0.3), 1.3, 400.0)[0]
    thinner = metal(np.array([1.0]), np.full(3, 0.3), 1.3, 400.0 * inside)[0]
    assert np.argmax(tilted) == np.argmax(thinner)


def spectral(cosine: Any, f0: float, n: float, d: float) -> Any:
    """F (N, 3): all waves, both polarisations, each wavelength by itself [Born1999, Sec. 7.6].

    The eye's sensitivities as a fit of Gaussians [Wyman2013]; even light is white.
    """
    lengths = np.arange(380.0, 781.0, 4.0)

    def bell(peak: float, below: float, above: float) -> Any:
        t = (lengths - peak) * np.where(lengths < peak, below, above)
        return np.exp(-0.5 * t * t)

    x = 1.056 * bell(599.8, 0.0264, 0.0323) + 0.362 * bell(442.0, 0.0624, 0.0374)
    x -= 0.065 * bell(501.1, 0.0490, 0.0382)
    y = 0.821 * bell(568.8, 0.0213, 0.0247) + 0.286 * bell(530.9, 0.0613, 0.0322)
    z = 1.217 * bell(437.0, 0.0845, 0.0278) + 0.681 * bell(459.0, 0.0385, 0.0725)
    base = (1 + np.sqrt(f0)) / (1 - np.sqrt(f0))
    c1 = cosine[:, None]
    c2, c3 = (np.sqrt(1 - (1 - c1**2) / m**2) for m in (n, base))
    wave = np.exp(4j * np.pi * n * d * c2 / lengths)
    power = 0.0
    for a, b in (
        ((c1 - n * c2) / (c1 + n * c2), (n * c2 - base * c3) / (n * c2 + base * c3)),
        ((n * c1 - c2) / (n * c1 + c2), (base * c2 - n * c3) / (base * c2 + n * c3)),
    ):
        power = power + 0.5 * np.abs((a + b * wave) / (1 + a * b * wave)) ** 2
    eye = np.stack([x, y, z], axis=1) @ RGB.T
    return power @ eye / eye.sum(axis=0)


@pytest.mark.parametrize(
    ("f0", "least_cosine", "mean", "largest"),
    [
        (0.04, 0.2, 0.0129, 0.098),
        (0.04, 0.7, 0.0044, 0.02),
        (0.3, 0.2, 0.0443, 0.450),
        (0.3, 0.7, 0.0129, 0.056),
    ],
)
def test_how_far_the_approximation_is_from_the_spectrum(
    f0: float, least_cosine: float, mean: float, largest: float
) -> None:
    cosine = np.linspace(least_cosine, 1.0, 17)
    gaps = [
        np.abs(metal(cosine, np.full(3, f0), n, d) - spectral(cosine, f0, n, d))
        for n in (1.33, 1.8)
        for d in np.linspace(100.0, 800.0, 15)
    ]
    assert np.mean(gaps) == pytest.approx(mean, abs=5e-4)
    assert np.max(gaps) == pytest.approx(largest, abs=5e-3)


def test_energy_stays_below_the_claim() -> None:
    film = {"iridescence_factor": 1.0, "iridescence_ior": 2.3, "iridescence_thickness": 150.0}
    worst = [
        albedo(FILM, {**GROUND, **film, "base_color": np.ones(3), "metalness": m}, c).max()
        for m, c in ((0.0, 0.05), (1.0, 0.5))
    ]
    assert 1.0 < max(worst) < FILM.energy[1]
