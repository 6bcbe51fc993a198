"""Light probes: irradiance against brute force, the blend, derivatives, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.lights.probes import ProbeGrid, bake, sphere_quadrature
from photograd_course.gradcheck import check_gradient, dot_product_error

from support.gradient_mutants import check_gradient_mutants

pytestmark = pytest.mark.usefixtures("core")

BOX = np.array([[-1.0, 0.0, 2.0], [3.0, 1.0, 5.0]])
SHAPE = (4, 2, 3)


def random(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def unit(n: int, seed: int) -> Any:
    d = random(seed).normal(size=(n, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def some_probes(degree: int = 2, seed: int = 1) -> ProbeGrid:
    return ProbeGrid(random(seed).normal(size=(*SHAPE, sh.count(degree), 3)), BOX)


def some_points(n: int, seed: int = 2, margin: float = 0.3) -> Any:
    """Points in the box and around it."""
    extent = BOX[1] - BOX[0]
    return BOX[0] - margin + random(seed).random((n, 3)) * (extent + 2 * margin)


def daylight(position: Any, d: Any) -> Any:
    """A smooth sky with a broad glow around a hidden sun, and a reddish ground."""
    sky = np.array([0.5, 0.7, 1.0]) * (1 + d[:, 1:2]) + np.array([0.5, 0.3, 0.2]) * (1 - d[:, 1:2])
    sun = np.array([2.0, 3.0, 1.0]) / np.sqrt(14)
    return sky + np.array([2.0, 1.8, 1.2]) * np.exp(2 * (d @ sun - 1))[:, None] + 0 * position[0]


def brute_irradiance(position: Any, normals: Any) -> Any:
    """The cosine-weighted integral over each normal's own hemisphere, in its own frame."""
    d, w = sphere_quadrature(48)
    height, w = 0.5 * (d[:, 2] + 1), 0.5 * w  # the upper half, exactly
    phi, r = np.arctan2(d[:, 1], d[:, 0]), np.sqrt(1 - height**2)
    local = np.stack([r * np.cos(phi), r * np.sin(phi), height], axis=-1)
    found = []
    for n in normals:
        x = np.cross(np.eye(3)[np.argmin(np.abs(n))], n)
        x /= np.linalg.norm(x)
        frame = np.stack([x, np.cross(n, x), n])
        found.append(((w * height)[:, None] * daylight(position, local @ frame)).sum(axis=0))
    return np.stack(found)


def worst_error(degree: int) -> float:
    grid = bake(daylight, (2, 2, 2), BOX, degree=degree)
    normals = unit(200, 3)
    points = np.broadcast_to(BOX.mean(axis=0), (200, 3))
    expected = brute_irradiance(BOX[0], normals)
    assert expected.min() > 1
    return float(np.abs(grid.irradiance(points, normals) / expected - 1).max())


def test_nine_coefficients_give_the_irradiance_of_smooth_light() -> None:
    assert worst_error(2) < 0.03  # the claim of the method; measured 0.0015
    assert worst_error(1) > 0.03  # four coefficients do not: 0.11


def test_a_uniform_sky_gives_pi_times_its_radiance() -> None:
    grid = bake(lambda _, d: np.full((len(d), 3), 0.25), (1, 1, 1), BOX)
    np.testing.assert_allclose(
        grid.irradiance(some_points(9), unit(9, 4)), 0.25 * np.pi, rtol=1e-12
    )


def test_the_blend_reproduces_affine_fields() -> None:
    grid = some_probes()
    slope, offset = random(5).normal(size=(3, 9, 3)), random(6).normal(size=(9, 3))
    grid.coefficients[...] = np.tensordot(grid.positions, slope, 1) + offset
    lo, hi = grid.positions[0, 0, 0], grid.positions[-1, -1, -1]
    inside = lo + random(7).random((200, 3)) * (hi - lo)
    expected = np.tensordot(inside, slope, 1) + offset
    np.testing.assert_allclose(grid.interpolate(inside), expected, atol=1e-13)
    outside = np.array([[-9.0, 0.5, 3.0], [1.0, 9.0, 9.0]])
    beside = np.tensordot(np.clip(outside, lo, hi), slope, 1) + offset
    np.testing.assert_allclose(grid.interpolate(outside), beside, atol=1e-13)
    # float32 coefficients, float32 weights
    single = ProbeGrid(grid.coefficients.astype(np.float32), BOX)
    assert single.interpolate(inside).dtype == np.float32
    np.testing.assert_allclose(single.interpolate(inside), expected, atol=2e-5)


def test_a_probe_returns_its_own_coefficients() -> None:
    grid = some_probes()
    at = grid.positions.reshape(-1, 3)
    own = grid.coefficients.reshape(-1, 9, 3)
    np.testing.assert_allclose(grid.interpolate(at), own, atol=1e-13)
    np.testing.assert_allclose(grid.positions[0, 0, 0], [-0.5, 0.25, 2.5])


def irradiance_pair(degree: int) -> tuple[Any, Any, dict[str, Any]]:
    """Irradiance of the groups "coefficients" and "normals", its adjoint, and a place."""
    points = some_points(12)
    place = {
        "coefficients": some_probes(degree).coefficients,
        "normals": 1.1 * unit(12, 8),  # no unit vectors: the formula is differentiated as it is
    }

    def forward(p: dict[str, Any]) -> Any:
        return ProbeGrid(p["coefficients"], BOX).irradiance(points, p["normals"])

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        grid = ProbeGrid(p["coefficients"], BOX)
        d_c, d_n = grid.irradiance_backward(points, p["normals"], d)
        return {"coefficients": d_c, "normals": d_n}

    return forward, backward, place


@pytest.mark.parametrize("degree", [1, 2, 4])
def test_derivatives(degree: int) -> None:
    forward, backward, place = irradiance_pair(degree)
    assert np.abs(forward(place)).min() > 1e-3
    report = check_gradient(forward, backward, place, seed=1)
    assert report, str(report)


def test_wrong_derivatives_die() -> None:
    forward, backward, place = irradiance_pair(2)
    d = random(9).normal(size=(12, 3))
    report = check_gradient_mutants(forward, backward, place, d, seed=1)
    assert report, str(report)

    def no_lobe(p: dict[str, Any], d: Any) -> dict[str, Any]:
        grid = ProbeGrid(p["coefficients"], BOX)
        blended = grid.interpolate(some_points(12))
        d_c, d_n = sh.evaluate_backward(blended, p["normals"], d)
        return {"coefficients": grid.interpolate_backward(some_points(12), d_c), "normals": d_n}

    assert not check_gradient(forward, no_lobe, place, seed=1)


def test_the_adjoint_of_the_blend_is_its_transpose() -> None:
    points = some_points(40)

    def jvp(_: dict[str, Any], v: dict[str, Any]) -> Any:
        return ProbeGrid(v["coefficients"], BOX).interpolate(points)  # linear: J v = f(v)

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        return {"coefficients": ProbeGrid(p["coefficients"], BOX).interpolate_backward(points, d)}

    report = dot_product_error(jvp, backward, {"coefficients": some_probes().coefficients}, seed=1)
    assert report, str(report)


def test_bad_input_is_refused() -> None:
    c = np.zeros((2, 2, 2, 9, 3))
    with pytest.raises(ShapeError, match="X, Y, Z, K, C"):
        ProbeGrid(c[0], BOX)
    with pytest.raises(DtypeError, match="float32"):
        ProbeGrid(c.astype(int), BOX)
    with pytest.raises(RangeError, match="lower below upper"):
        ProbeGrid(c, BOX[::-1])
    with pytest.raises(RangeError, match="1, 4, 9"):
        ProbeGrid(c[:, :, :, :8], BOX)
    with pytest.raises(RangeError, match="channels"):
        ProbeGrid(c[..., :2], BOX)
    with pytest.raises(RangeError, match=r"^ProbeGrid\.interpolate: points: .* in row 0"):
        ProbeGrid(c, BOX).interpolate(np.array([[0, 0, np.nan]]))
    with pytest.raises(ShapeError, match="normals"):
        ProbeGrid(c, BOX).irradiance(np.zeros((1, 3)), np.zeros(3))
    with pytest.raises(ShapeError, match="radiance"):
        bake(lambda _, d: d[0], (2, 2, 2), BOX)
