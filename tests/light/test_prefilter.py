"""Maps that are averaged beforehand: irradiance, lobes of GGX, and the split sum."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.bsdf import registry
from photograd.errors import RangeError, ShapeError
from photograd.lights import ConstantLight, EnvironmentMap, PointLight
from photograd.lights.dfg import DfgTable, dfg_table, directional_albedo
from photograd.lights.environment import DirectionMap, cell_directions
from photograd.lights.prefilter import (
    PrefilteredLight,
    SpecularMap,
    irradiance_map,
    shade,
    specular_kernel,
    specular_map,
    zonal_mean,
)
from photograd.lights.probes import sphere_quadrature
from photograd.transport.builtin import evening_map
from photograd_course.random import uniform

from support.bsdf_proofs import albedo, towards
from support.tree import ROOT
from tests.transport.light_scenes import TILT, texels

sys.path.insert(0, str(ROOT / "docs"))
import image_based_light as image

pytestmark = pytest.mark.usefixtures("core")
SPOT = EnvironmentMap(texels(6), TILT)


def test_the_table_is_the_albedo_of_the_core() -> None:
    metal, table = registry()["ggx_metal"], dfg_table(16)
    middles = (np.arange(16) + 0.5) / 16
    # By quadrature where lobes are wide and views high, else by chance: weights vary little.
    u2 = uniform(3, pixel=np.arange(1 << 16)[:, None], dimension=np.arange(2))
    u2 = (np.stack(np.divmod(np.arange(1 << 16), 256), axis=1) + u2) / 256  # one a cell
    for i, j in (
        (1, 2),
        (1, 9),
        (2, 5),
        (2, 15),
        (4, 0),
        (4, 7),
        (7, 1),
        (9, 12),
        (15, 0),
        (15, 15),
    ):
        r, c = middles[i], middles[j]
        values = {"f0": [0.0, 0.5, 1.0], "roughness": r}
        if r > 0.45 or (r > 0.25 and c > 0.2):
            found = albedo(metal, values, c)
        else:
            wo = towards(c, len(u2))
            wi = metal.sample(values, wo, u2)
            pdf = metal.pdf(values, wo, wi)[:, None]
            weight = metal.f(values, wo, wi) * wi[:, 2:] / np.where(pdf > 0, pdf, 1)
            found = weight.mean(axis=0)
        A, B = table.values[i, j]
        gap = np.abs(np.array([B, 0.5 * A + B, A + B]) - found)
        assert (gap < 5e-4).all(), (r, c, gap)  # 9e-5


def test_closed_forms_of_the_albedo() -> None:
    # alpha = 1 seen from above: 1 - ln 2. A mirror: all of f0 (1 - ramp) + ramp.
    assert directional_albedo(1.0, 1.0).sum() == pytest.approx(1 - np.log(2), abs=3e-4)
    for mu in (0.2, 0.7, 1.0):
        ramp = (1 - mu) ** 5
        np.testing.assert_allclose(directional_albedo(0.01, mu), [1 - ramp, ramp], atol=1e-5)
    found = directional_albedo([[0.2], [0.9]], [0.1, 0.5, 1.0])
    assert found.shape == (2, 3, 2)
    assert (found > 0).all()
    assert (found.sum(axis=-1) < 1).all()


def test_between_the_cells_of_the_table() -> None:
    table = dfg_table(32)
    g = np.random.default_rng(2)
    r, c = g.uniform(0.1, 1, 60), g.uniform(0.1, 1, 60)
    gap = np.abs(table.at(r, c) - directional_albedo(r, c))
    assert gap.max() < 1e-3  # 5e-4; below a cosine of 0.1 more


def plain_mean(light: EnvironmentMap, kernel: Any, count: int, n: Any) -> Any:
    """The same sum, cell by cell."""
    w = cell_directions(count).reshape(-1, 3) @ light.world_from_map.T
    area = np.repeat(np.sin((np.arange(count) + 0.5) / count * np.pi), 2 * count)
    weight = kernel(1 - n @ w.T) * area
    return weight @ light.L(np.zeros_like(w), w) / weight.sum(axis=1, keepdims=True)


@pytest.mark.parametrize(("rows", "count"), [(6, 132), (44, 132), (33, 132), (8, 128)])
def test_means_by_transforms_are_plain_sums(rows: int, count: int) -> None:
    # 22 and 16 cells of the sum to one of the result, and 3 and 4: even and odd.
    kernel = specular_kernel(0.5)
    found = zonal_mean(SPOT, kernel, 1.0, rows)
    np.testing.assert_array_equal(found.world_from_map, TILT)
    at = np.random.default_rng(1).integers(0, 2 * rows * rows, 20)
    n = cell_directions(rows).reshape(-1, 3)[at] @ TILT.T
    expected = plain_mean(SPOT, kernel, count, n)
    np.testing.assert_allclose(found.values.reshape(-1, 3)[at], expected, rtol=1e-9)
    np.testing.assert_allclose(found.at(n), expected, rtol=1e-9)


def test_a_map_of_directions_is_smooth_across_the_poles() -> None:
    w = sphere_quadrature(24)[0]
    tilted = DirectionMap(cell_directions(64) @ TILT.T, TILT)
    np.testing.assert_allclose(tilted.at(w), w, atol=7e-4)  # the sag of arcs of pi / 64: 6e-4
    clamped = EnvironmentMap(1.5 + cell_directions(64))
    pole = np.array([[0.01, 1.0, 0.0]]) / np.linalg.norm([0.01, 1.0])
    assert abs(clamped.L(np.zeros((1, 3)), pole)[0, 0] - 1.5 - pole[0, 0]) > 5e-3
    with pytest.raises(ShapeError, match="DirectionMap: values: expected shape"):
        DirectionMap(np.zeros((4, 4, 3)))


def test_irradiance_in_closed_form() -> None:
    # L = a + <b,w> gives E = pi a + 2 pi / 3 <b,n>.
    b = np.array([0.3, -0.5, 0.4])
    values = 1.0 + (cell_directions(64) @ b)[..., None] * np.array([1.0, 0.5, -0.8])
    found = irradiance_map(EnvironmentMap(values, TILT), 16)
    n = sphere_quadrature(10)[0]
    expected = np.pi + 2 * np.pi / 3 * (n @ TILT @ b)[:, None] * np.array([1.0, 0.5, -0.8])
    np.testing.assert_allclose(found.at(n), expected, rtol=0.01)
    fine = irradiance_map(EnvironmentMap(values, TILT), 64)
    np.testing.assert_allclose(fine.at(n), expected, rtol=1e-3)


@pytest.mark.parametrize("roughness", [0.1, 0.3, 1.0])
def test_no_light_is_missed(roughness: float) -> None:
    # One bright texel of 64 x 128 anywhere: the mean over all directions stays what it was.
    values = np.full((64, 128, 3), 0.01)
    values[20, 77] = [5e4, 4e4, 3e4]
    found = specular_map(EnvironmentMap(values), (roughness,), 32).levels[0].values

    def mean(rows: Any) -> Any:
        part = np.sin((np.arange(len(rows)) + 0.5) / len(rows) * np.pi)
        return (rows.mean(axis=1) * part[:, None]).sum(axis=0) / part.sum()

    # The narrowest lobe is a tenth of a cell wide of the 32 x 64 that are looked at.
    np.testing.assert_allclose(mean(found), mean(values), rtol=0.02)


def test_an_even_sky_gives_the_sums_of_the_table() -> None:
    table = dfg_table(8)
    for light in (EnvironmentMap(np.ones((8, 16, 3)), TILT), ConstantLight([1.0, 1.0, 1.0])):
        white = PrefilteredLight(
            irradiance_map(light, 8), specular_map(light, (0.3, 1.0), 8), table
        )
        np.testing.assert_allclose(white.irradiance.values, np.pi, rtol=1e-13)
        r, c = (x.ravel() for x in np.meshgrid((np.arange(8) + 0.5) / 8, (np.arange(8) + 0.5) / 8))
        n = np.broadcast_to([0.0, 0.6, 0.8], (64, 3))
        side = np.broadcast_to([1.0, 0.0, 0.0], (64, 3))
        wo = c[:, None] * n + np.sqrt(1 - c * c)[:, None] * side
        metal = shade(white, n, wo, base_color=np.ones(3), metalness=1.0, roughness=r)
        A, B = np.moveaxis(table.at(r, c), -1, 0)
        np.testing.assert_allclose(metal, np.stack([A + B] * 3, -1), rtol=1e-12)
        paint = shade(
            white, n, wo, base_color=[0.5, 0.2, 0.0], metalness=0.25, roughness=r, reflectance=1.0
        )
        f0 = 0.75 * 0.16 + 0.25 * np.array([0.5, 0.2, 0.0])
        expected = 0.75 * np.array([0.5, 0.2, 0.0]) + f0 * A[:, None] + B[:, None]
        np.testing.assert_allclose(paint, expected, rtol=1e-12)


@pytest.fixture(scope="module")
def spot() -> PrefilteredLight:
    return PrefilteredLight(
        irradiance_map(SPOT), specular_map(SPOT, (0.15, 0.5, 1.0), 32), dfg_table(32)
    )


def test_irradiance_is_that_of_brute_force() -> None:
    light = EnvironmentMap(evening_map(32))
    tables = PrefilteredLight(irradiance_map(light), SpecularMap((), ()), dfg_table(2))
    found = image.ground_under(light, tables, 16, 4096)
    assert found.brute.max() > 0.3
    assert abs(found.bias) < 1e-3  # 3e-4
    assert found.rms < 3e-3  # 1.0e-3, of which most is the path tracer's noise
    assert found.largest < 0.01  # 9.2e-3 in the worst pixel, likewise


def test_how_far_the_split_sum_is_from_brute_force(spot: PrefilteredLight) -> None:
    # Errors of lobes around the mirrored view, and of those that lean: measured 0.025 and 0.025,
    # 0.103 and 0.072, 0.259 and 0.108 for metal; 0.031, 0.032, 0.077, 0.088, 0.256, 0.153 else.
    for values, bounds in (
        (image.SILVER, {0.15: (0.035, 0.035), 0.5: (0.12, 0.085), 1.0: (0.29, 0.125)}),
        (image.COATING, {0.15: (0.045, 0.045), 0.5: (0.095, 0.105), 1.0: (0.29, 0.175)}),
    ):
        for r, (plain, leaning) in bounds.items():
            found = image.compare(SPOT, spot, values, r, 16, 1024)
            assert found.plain < plain, (r, found.plain)
            assert found.rms < leaning, (r, found.rms)
            assert r < 1 or found.rms < 0.65 * found.plain
            assert abs(found.bias) < 0.07
            # The level of another roughness is worse.
            levels = (spot.specular.levels[1], spot.specular.levels[0], spot.specular.levels[0])
            other = replace(spot, specular=SpecularMap((0.15, 0.5, 1.0), levels))
            wrong = image.split_sum(other, values, r, 16) - found.brute
            inside = image.on_ball(image.ball_camera(16))[1]
            error = image.size_of(wrong[inside]) / image.size_of(found.brute[inside])
            assert error > 1.05 * found.rms, (r, error)


def test_bad_input_is_named() -> None:
    with pytest.raises(RangeError, match="zonal_mean: rows: expected a whole number"):
        irradiance_map(SPOT, 1)
    with pytest.raises(RangeError, match=r"zonal_mean: light: expected one of Env.*, got PointL"):
        irradiance_map(PointLight([0, 1, 0], [1, 1, 1]))
    with pytest.raises(RangeError, match="specular_map: roughnesses: expected ascending"):
        specular_map(SPOT, (0.5, 0.4))
    with pytest.raises(RangeError, match="specular_map: roughnesses"):
        specular_map(SPOT, (0.01,))
    with pytest.raises(RangeError, match="zonal_mean: width: expected at most 8192 rows"):
        zonal_mean(SPOT, specular_kernel(0.5), 1e-4, 8)
    with pytest.raises(RangeError, match="dfg_table: size"):
        dfg_table(1)
    with pytest.raises(RangeError, match="directional_albedo: cosine: expected finite numbers"):
        directional_albedo(0.5, [0.5, 0.0])
    with pytest.raises(ShapeError, match="DfgTable: values"):
        DfgTable(np.zeros((4, 5, 2)))
    white = PrefilteredLight(irradiance_map(SPOT, 4), specular_map(SPOT, (0.5,), 4), dfg_table(4))
    with pytest.raises(ShapeError, match="shade: wo: expected shape"):
        shade(white, np.zeros((2, 3)), np.zeros((3, 3)), base_color=1.0, metalness=0, roughness=0.5)


def test_progress_counts_rows() -> None:
    seen: list[tuple[int, int]] = []
    specular_map(SPOT, (0.5, 1.0), 4, lambda done, every: seen.append((done, every)))
    assert seen == [(k, 8) for k in range(1, 9)]
