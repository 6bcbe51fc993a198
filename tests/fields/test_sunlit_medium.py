"""Single scattering: slabs in closed form, shadows, ends of rays, wrong adjoints, the same bits.

The proofs of every representation (tests/registry/test_representations.py) cover its gradients.
"""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.bsdf.phase import registry as phase_functions
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.fields import SunlitMedium
from photograd.fields.sunlit_medium import sun_visibility
from photograd.geometry.mesh import Bvh, Mesh
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import memoized

pytestmark = pytest.mark.usefixtures("core")

# A slab 1 m thick, y from 0 to 1, so wide that its sides do not matter.
BOX = np.array([[-20.0, 0.0, -20.0], [20.0, 1.0, 20.0]])
SHAPE = (4, 64, 4)
DT = 1 / 256
ALBEDO, IRRADIANCE = np.array([0.9, 0.6, 0.3]), np.array([3.0, 2.5, 2.0])
OPTIONS = RenderOptions()


def slab(sigma_t: float, sun: Any, g: float = 0.3, **more: Any) -> SunlitMedium:
    return SunlitMedium.homogeneous(
        sigma_t,
        SHAPE,
        BOX,
        DT,
        albedo=ALBEDO,
        g=g,
        irradiance=IRRADIANCE,
        sun=sun,
        dtype=np.float64,
        **more,
    )


def one_ray(origin: Any, direction: Any) -> RayBatch:
    d = np.asarray(direction, float)
    d = d / np.linalg.norm(d)
    return RayBatch(np.array([origin], float), d[None], np.zeros(1, np.uint32))


def radiance(medium: SunlitMedium, batch: RayBatch) -> Any:
    return medium.render(batch, seed=0, step=0, options=OPTIONS)[0].color


def closed_form(sigma_t: float, sun: Any, ray: Any, g: float) -> Any:
    """Radiance of the whole slab along a ray that crosses it from outside.

    With cosines m of the ray and n of the sun against +y, at height y the sun's light has crossed
    (1 - y) / n. From above (m < 0) the camera's part is (1 - y) / |m|, from below y / m.
    """
    m, n = (np.asarray(v, float)[1] / np.linalg.norm(v) for v in (ray, sun))
    cos = np.dot(ray, sun) / np.linalg.norm(ray) / np.linalg.norm(sun)
    p = phase_functions()["henyey_greenstein"].p(np.array([g]), np.array([cos]))[0]
    if m < 0:
        rate = 1 / abs(m) + 1 / n
        share = (1 - np.exp(-sigma_t * rate)) / (rate * abs(m))
    else:
        rate = 1 / m - 1 / n
        inner = sigma_t if abs(rate) < 1e-12 else (1 - np.exp(-sigma_t * rate)) / rate
        share = np.exp(-sigma_t / n) * inner / m
    return ALBEDO * IRRADIANCE * p * share


SUNS = [(0, 1, 0), (0.6, 0.8, 0), (-0.3, 0.5, 0.7)]
RAYS = [(0, -1, 0), (0, 1, 0), (0.3, -1, 0.2), (-0.4, 1, 0.5)]


def from_outside(ray: Any, steps: float) -> RayBatch:
    """A ray that enters the slab so many steps behind its origin."""
    d = np.asarray(ray, float) / np.linalg.norm(ray)
    return one_ray(np.array([0.0, 1.0 if d[1] < 0 else 0.0, 0.0]) - steps * DT * d, d)


@pytest.mark.parametrize("sigma_t", [0.1, 1.0, 4.0])
def test_homogeneous_slab_in_closed_form(sigma_t: float) -> None:
    worst = 0.0
    for sun, ray in itertools.product(SUNS, RAYS):
        got = radiance(slab(sigma_t, sun), from_outside(ray, 256))[0]
        expected = closed_form(sigma_t, sun, ray, 0.3)
        assert expected.min() > 1e-3
        worst = max(worst, float(np.abs(got / expected - 1).max()))
    assert worst < 0.005  # measured 0.0005, 0.0005, 0.0030


@pytest.mark.parametrize("sigma_t", [1.0, 4.0])
def test_jitter_makes_up_for_steps_that_the_slab_cuts(sigma_t: float) -> None:
    worst, count = 0.0, 256
    for sun, ray in itertools.product(SUNS, RAYS):
        one = from_outside(ray, 200.7)
        pixel = np.arange(count, dtype=np.uint32)
        batch = RayBatch(one.origins.repeat(count, 0), one.directions.repeat(count, 0), pixel)
        options = RenderOptions(jitter=True)
        color = slab(sigma_t, sun).render(batch, seed=1, step=0, options=options)[0].color
        expected = closed_form(sigma_t, sun, ray, 0.3)
        worst = max(worst, float(np.abs(color.mean(axis=0) / expected - 1).max()))
    assert worst < 0.005  # measured 0.0004, 0.0030


@pytest.mark.parametrize("up", [-1.0, 1.0])
def test_the_error_falls_with_the_square_of_voxel_and_step(up: float) -> None:
    # Sun and ray are upright: no lattice is cut, and what is left is the order of the method.
    errors = []
    for n in (8, 16, 32, 64):
        medium = SunlitMedium.homogeneous(
            2.0,
            (4, n, 4),
            BOX,
            0.5 / n,
            albedo=ALBEDO,
            g=0.3,
            irradiance=IRRADIANCE,
            sun=(0, 1, 0),
            dtype=np.float64,
        )
        got = radiance(medium, one_ray([0, 0.5 - 1.5 * up, 0], (0, up, 0)))[0, 0]
        errors.append(abs(got / closed_form(2.0, (0, 1, 0), (0, up, 0), 0.3)[0] - 1))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders[-2:], 2, atol=0.15)  # measured 1.97 and 1.98


def plate(lo: Any, hi: Any, y: float) -> Mesh:
    """A horizontal rectangle from (x, z) lo to hi."""
    (x0, z0), (x1, z1) = lo, hi
    vertices = np.array([[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]], np.float32)
    return Mesh(vertices, np.array([[0, 2, 1], [0, 3, 2]], np.uint32))


def test_what_the_sun_does_not_see_stays_dark_and_the_rest_is_as_it_was() -> None:
    roof = Bvh(plate((0.0, -30.0), (30.0, 30.0), 1.5))
    shadow = sun_visibility(roof, BOX, SHAPE, (0, 1, 0))
    np.testing.assert_array_equal(np.unique(shadow), [0, 1])
    np.testing.assert_array_equal(shadow[:, 0, 0], [1, 1, 0, 0])
    lit, dark = one_ray([-10, -1, 0], (0, 1, 0)), one_ray([10, -1, 0], (0, 1, 0))
    covered = slab(1.0, (0, 1, 0), visibility=shadow)
    assert (radiance(covered, dark) == 0).all()
    np.testing.assert_allclose(
        radiance(covered, lit), closed_form(1.0, (0, 1, 0), (0, 1, 0), 0.3)[None], rtol=5e-3
    )


def test_half_a_voxel_in_shadow_is_half_visible() -> None:
    roof = Bvh(plate((5.0, -30.0), (30.0, 30.0), 1.5))  # x = 5 halves the third column of 10 m
    shadow = sun_visibility(roof, BOX, SHAPE, (0, 1, 0), samples=4)
    np.testing.assert_allclose(shadow[:, 0, 0], [1, 1, 0.5, 0])


def test_a_ray_ends_at_a_solid() -> None:
    # Down into the slab with a floor in its middle: what lies below is neither seen nor counted.
    floor = Bvh(plate((-50.0, -50.0), (50.0, 50.0), 0.5))
    medium = slab(2.0, (0, 1, 0), solids=floor)
    outputs, _ = medium.render(one_ray([0, 3, 0], (0, -1, 0)), seed=0, step=0, options=OPTIONS)
    np.testing.assert_allclose(outputs.opacity, 1 - np.exp(-2.0 * 0.5), rtol=1e-12)
    p = 1 / (4 * np.pi) * (1 - 0.09) / (1 + 0.09 + 0.6) ** 1.5
    expected = ALBEDO * IRRADIANCE * p * (1 - np.exp(-2.0 * 2 * 0.5)) / 2
    # Light of the voxels on both sides of the floor blends over half a voxel: measured 0.0014.
    np.testing.assert_allclose(outputs.color[0], expected, rtol=5e-3)


def test_phase_functions_can_be_chosen() -> None:
    batch = one_ray([0, 3, 0], (0, -1, 0))
    names = "henyey_greenstein", "cornette_shanks"
    one, two = (radiance(slab(1.0, (0.6, 0.8, 0), phase=name), batch) for name in names)
    g, cos = np.array([0.3]), np.array([-0.8])
    p_one, p_two = (phase_functions()[name].p(g, cos)[0] for name in names)
    np.testing.assert_allclose(two / one, p_two / p_one, rtol=1e-12)


class NoShadow(SunlitMedium):
    """Forgets that the medium dims the sun."""

    def _shadow_backward(self, _: Any, d_through: Any) -> Any:
        return np.zeros_like(d_through)


class NoVisibility(SunlitMedium):
    """Differentiates the sun's way where it is blocked."""

    def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
        kept, self.visibility = self.visibility, np.ones_like(self.visibility)
        try:
            return super().render_backward(context, d_outputs)
        finally:
            self.visibility = kept


class Swapped(SunlitMedium):
    """Exchanges the derivatives with respect to the two factors."""

    def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
        d = super().render_backward(context, d_outputs)
        return d | {"albedo": d["irradiance"], "irradiance": d["albedo"]}


class NoPhase(SunlitMedium):
    """Forgets the phase function in the backward pass of the volume."""

    def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
        even = replace(context, p=np.ones_like(context.p))
        d = super().render_backward(context, d_outputs)
        return d | {"sigma_t": super().render_backward(even, d_outputs)["sigma_t"]}


def test_wrong_adjoints_die() -> None:
    place = dict(SunlitMedium.example(seed=3).params)

    def render(kind: type[SunlitMedium], params: dict[str, Any]) -> Any:
        medium = kind.example(seed=3)
        medium.params = dict(params)
        batch = medium.example_batch(seed=3)
        return medium, *medium.render(batch, seed=0, step=0, options=OPTIONS)

    forward = memoized(lambda p: render(SunlitMedium, p)[1].color)
    assert np.abs(forward(place)).min() > 1e-4
    for kind in (SunlitMedium, NoShadow, NoVisibility, Swapped, NoPhase):

        def backward(p: dict[str, Any], d: Any, kind: type[SunlitMedium] = kind) -> Any:
            medium, _, context = render(kind, p)
            return medium.render_backward(context, Outputs(d))

        right = check_gradient(forward, backward, place, seed=1)
        assert bool(right) == (kind is SunlitMedium), kind.__name__


@same_bits("sunlit medium")
def picture_and_gradients() -> list[Any]:
    medium = SunlitMedium.homogeneous(
        1.5, (24, 24, 24), [[0, 0, 0], [1, 1, 1]], 1 / 48, g=0.4, sun=(1, 2, 0.5)
    )
    outputs, context = medium.render(medium.example_batch(seed=1), seed=0, step=0, options=OPTIONS)
    gradients = medium.render_backward(context, Outputs(np.ones_like(outputs.color)))
    return [outputs.color, *gradients.values()]


def test_bad_input_is_refused() -> None:
    good = SunlitMedium.example(seed=1).params
    box, sun = [[0, 0, 0], [1, 1, 1]], (0, 1, 0)
    with pytest.raises(RangeError, match="exactly"):
        SunlitMedium({"sigma_t": good["sigma_t"]}, box, 0.1, sun=sun)
    with pytest.raises(ShapeError, match="albedo"):
        SunlitMedium(good | {"albedo": np.ones(1)}, box, 0.1, sun=sun)
    with pytest.raises(ShapeError, match="sigma_t"):
        SunlitMedium(good | {"sigma_t": np.ones((4, 1, 4))}, box, 0.1, sun=sun)
    with pytest.raises(DtypeError, match="float32"):
        SunlitMedium(good | {"g": np.zeros(1, np.float32)}, box, 0.1, sun=sun)
    with pytest.raises(RangeError, match="dt"):
        SunlitMedium(good, box, 0.0, sun=sun)
    with pytest.raises(RangeError, match="direction"):
        SunlitMedium(good, box, 0.1, sun=(0, 0, 0))
    with pytest.raises(RangeError, match="henyey_greenstein"):
        SunlitMedium(good, box, 0.1, sun=sun, phase="mie")
    with pytest.raises(ShapeError, match="visibility"):
        SunlitMedium(good, box, 0.1, sun=sun, visibility=np.ones((2, 2, 2)))
    with pytest.raises(RangeError, match="samples"):
        sun_visibility(Bvh(plate((0, 0), (1, 1), 0)), box, (2, 2, 2), sun, samples=0)
