"""Diffusion profiles from Python: broadcasting, derivatives in the arguments' shapes, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.transport import subsurface
from photograd.transport.subsurface import half_space_albedo
from photograd_course.gradcheck import check_gradient

from tests.transport.test_media_closed_forms import h_function

pytestmark = pytest.mark.usefixtures("core")
R = np.array([[0.3], [0.7], [2.0]])  # (3, 1)
A = np.array([0.4, 0.95])  # (2,)
CASES: dict[str, tuple[Any, ...]] = {
    "dipole": (R, A, 0.2, np.array([[1.3]])),
    "dipole_albedo": (R, A, 1.4),
    "normalized_diffusion": (R, A, 0.7),
    "diffusion_cdf": (R, A, np.array([0.7, 1.1])),
    "sample_radius": (0.4 * R, A, 0.7),
}


@pytest.mark.parametrize("name", CASES)
def test_arguments_broadcast_and_derivatives_have_their_shapes(name: str) -> None:
    value, backward = getattr(subsurface, name), getattr(subsurface, name + "_backward")
    given = [np.array(x, np.float64) for x in CASES[name]]
    whole = value(*given)
    assert whole.shape == (3, 2)
    for i, j in np.ndindex(3, 2):
        one = [np.broadcast_to(x, (3, 2))[i, j] for x in given]
        assert value(*one) == whole[i, j]
    keys = [f"x{k}" for k in range(len(given))]

    def derivatives(groups: Any, d: Any) -> Any:
        found = backward(*groups.values(), d)
        assert [x.shape for x in found] == [x.shape for x in given]
        return dict(zip(keys, found, strict=True))

    place = dict(zip(keys, given, strict=True))
    report = check_gradient(lambda groups: value(*groups.values()), derivatives, place, seed=1)
    assert report, str(report)


def test_three_fits_are_three() -> None:
    found = [
        subsurface.normalized_diffusion(1.0, 0.6, 1.0, fit)
        for fit in ("searchlight", "diffuse", "diffuse_free_path")
    ]
    assert len({float(x) for x in found}) == 3
    radii = [
        subsurface.sample_radius_backward(0.5, 0.6, 1.0, 1.0, fit)[2]
        for fit in ("searchlight", "diffuse", "diffuse_free_path")
    ]
    assert len({float(x) for x in radii}) == 3


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: subsurface.dipole(0.0, 1, 1), "dipole: radius: expected a finite number above 0"),
        (lambda: subsurface.dipole(1, 0, 1), "dipole: sigma_s: expected a finite number above 0"),
        (
            lambda: subsurface.dipole(1, 1, -1),
            "dipole: sigma_a: expected a finite number of at least",
        ),
        (lambda: subsurface.dipole(np.nan, 1, 1), "dipole: radius: .*got nan"),
        (
            lambda: subsurface.dipole(1, 1, 1, 0.9),
            "dipole: eta: expected a finite number in .1, 5., got 0.9",
        ),
        (lambda: subsurface.dipole_albedo(1, np.inf), "dipole_albedo: sigma_a: .*got inf"),
        (
            lambda: subsurface.dipole_albedo_backward(1, 0, 1, 1.0),
            "sigma_a: expected numbers above",
        ),
        (
            lambda: subsurface.normalized_diffusion(1, 1.1, 1),
            "albedo: expected a finite number in .0, 1., got 1.1",
        ),
        (
            lambda: subsurface.diffusion_cdf(1, 0.5, 0),
            "diffusion_cdf: mean_free_path: expected a fin",
        ),
        (
            lambda: subsurface.sample_radius(1.0, 0.5, 1),
            "sample_radius: u: expected a finite number in .0, 1.",
        ),
        (
            lambda: half_space_albedo(0.5, 2),
            "half_space_albedo: cos_theta: expected a finite number in .0, 1.",
        ),
        (
            lambda: subsurface.normalized_diffusion(1, 0.5, 1, "best"),  # type: ignore[arg-type]
            "normalized_diffusion: fit: expected one of searchlight, diffuse, ",
        ),
        (
            lambda: subsurface.sample_radius(0.5, 0.5, 1, "best"),  # type: ignore[arg-type]
            "sample_radius: fit: expected one of searchlight, diffuse, ",
        ),
    ],
)
def test_what_is_out_of_range_is_refused(call: Any, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        call()


def test_shapes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ShapeError, match="dipole: radius, sigma_s, sigma_a, eta: expected shapes"):
        subsurface.dipole(np.ones(2), np.ones(3), 1.0)
    with pytest.raises(ShapeError, match=r"dipole_backward: d_R: expected shape \(2,\)"):
        subsurface.dipole_backward(np.ones(2), 1.0, 1.0, 1.0, np.ones(3))


@pytest.mark.parametrize("mu", [0.0, 0.05, 1.0])
def test_the_albedo_of_a_half_space(mu: float) -> None:
    # By quadrature of ln H here, by iterating the equation for H there.
    a = np.array([0.0, 0.3, 0.8, 0.95, 0.999])
    expected = [1 - h_function(x, mu) * np.sqrt(1 - x) for x in a]
    np.testing.assert_allclose(half_space_albedo(a, mu), expected, rtol=1e-8, atol=2e-9)
    assert half_space_albedo(1.0, mu) == 1
    # Close to 1: 1 - A = H sqrt(1 - a), with H(1) = 2.9078 [Chandrasekhar1960, Table XI].
    assert (1 - half_space_albedo(1 - 1e-12)) / 1e-6 == pytest.approx(2.9078, abs=1e-4)
