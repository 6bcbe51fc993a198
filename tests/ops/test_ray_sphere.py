"""Hits of a sphere and their derivatives: closed forms, grazing rays, misses, far away in float."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.gradcheck import check_gradient

from tests.registry.test_ops import Proof, draw, flat
from tests.splat.test_mutants import TOLERANCE, Groups

pytestmark = pytest.mark.usefixtures("core")
RADIUS = 2.0
NEAR, FAR = -1, 1
# A ray along z at height z of the center: in front of the sphere, and from inside of it.
WHERE = [(NEAR, 5.0), (FAR, 0.1)]


def inputs(b: float, z: float, speed: float = 1.0, radius: float = RADIUS) -> Any:
    """A ray along z that passes the center (0, 0, z) at a distance b."""
    return np.array([b, 0, 0, 0, 0, speed, 0, 0, z, radius])


def jacobian(x: Any) -> Any:
    """(7, 10): t, position, normal with respect to origin, direction, center, radius."""
    op = _core.ops["ray_sphere"]
    return np.array([op.backward(x, row, np.zeros_like(x)) for row in np.eye(7, dtype=x.dtype)])


@pytest.mark.parametrize("b", [0.0, 0.5, 1.6, 1.99])
@pytest.mark.parametrize(("side", "z"), WHERE)
def test_a_ray_along_z_in_closed_form(side: int, z: float, b: float) -> None:
    r, speed = RADIUS, 1.3
    h = np.sqrt(r**2 - b**2)
    t = (z + side * h) / speed
    x = inputs(b, z, speed)
    point = [t, b, 0, z + side * h, b / r, 0, side * h / r]
    np.testing.assert_allclose(_core.ops["ray_sphere"].forward(x), point, rtol=1e-14)
    slide = -side * b / h  # dz/db along the sphere
    by_origin = np.array(
        [
            [slide / speed, 0, -1 / speed],
            [1, 0, 0],
            [0, 1, 0],
            [slide, 0, 0],
            [1 / r, 0, 0],
            [0, 1 / r, 0],
            [slide / r, 0, 0],
        ]
    )
    # Moved together, ray and sphere keep t and n, and the position moves with them.
    by_center = np.concatenate([np.zeros((1, 3)), np.eye(3), np.zeros((3, 3))]) - by_origin
    grow = side * r / h
    by_radius = [grow / speed, 0, 0, grow, -b / r**2, 0, side * b**2 / (h * r**2)]
    expected = np.column_stack([by_origin, t * by_origin, by_center, by_radius])
    np.testing.assert_allclose(jacobian(x), expected, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize(("side", "z"), WHERE)
def test_derivatives_of_grazing_rays_grow_as_one_over_the_half_chord(side: int, z: float) -> None:
    for h in (1e-1, 1e-3, 1e-5):
        b = np.sqrt(RADIUS**2 - h**2)
        z_of_center = z if side == NEAR else 0.5 * h
        by_radius = jacobian(inputs(b, z_of_center))[0, 9]
        # Half an ulp of b^2, 4e-16, is 4e-6 of h^2 = 1e-10.
        assert by_radius * h == pytest.approx(side * RADIUS, rel=1e-5)


def test_a_grazing_hit_far_away_keeps_the_sign_of_its_derivative_in_float() -> None:
    # h = 7e-4 is less than half a float's step at t = 32768: t is that of the nearest approach.
    b = np.nextafter(np.float32(RADIUS), np.float32(0))
    x = inputs(float(b), 32768.0).astype("f4")
    assert _core.ops["ray_sphere"].forward(x)[0] == 32768
    wide = jacobian(x.astype("f8"))[0]
    assert wide[9] < -2000
    np.testing.assert_allclose(jacobian(x)[0], wide, rtol=1e-6)


@pytest.mark.parametrize(
    "x",
    [
        inputs(RADIUS, 5.0),  # touches
        inputs(2.5, 5.0),
        inputs(0.5, -5.0),  # behind
        inputs(0.5, 5.0, speed=0.0),
    ],
)
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_a_miss_is_infinitely_far_and_has_no_derivative(dtype: str, x: Any) -> None:
    op, x = _core.ops["ray_sphere"], x.astype(dtype)
    np.testing.assert_array_equal(op.forward(x), [np.inf, 0, 0, 0, 0, 0, 0])
    before = np.arange(10, dtype=dtype)
    np.testing.assert_array_equal(op.backward(x, np.ones(7, dtype), before.copy()), before)


def ray_from_afar(rng: Any, distance: float, speed: float, aside: float) -> Any:
    """Inputs in float: a unit sphere at a distance, and a ray that passes its center at `aside`."""
    axis, other = rng.standard_normal((2, 3))
    axis /= np.linalg.norm(axis)
    side = np.cross(axis, other)
    origin = side * aside / np.linalg.norm(side)
    return np.concatenate([origin, speed * axis, distance * axis, [1.0]]).astype("f4")


def test_rounding_never_turns_the_derivative_of_a_grazing_hit_around() -> None:
    op, rng = _core.ops["ray_sphere"], np.random.default_rng(2)
    by_radius, n_dot_d = [], []
    for aside in rng.uniform(0.98, 1.0, 300):
        x = ray_from_afar(rng, 1e6, 1.0, aside)
        point = op.forward(x)
        if np.isfinite(point[0]):
            by_radius.append(op.backward(x, np.eye(7, dtype="f4")[0], np.zeros_like(x))[9])
            n_dot_d.append(point[4:] @ x[3:6])
    assert len(by_radius) > 200
    assert np.isfinite(by_radius).all()
    assert max(by_radius) < 0
    assert max(n_dot_d) > 0  # which is why the adjoint takes <n, d> from the half chord


@pytest.mark.parametrize("distance", [1e2, 1e4, 1e6])
def test_float_meets_a_unit_sphere_from_far_away(distance: float) -> None:
    op, rng, speed = _core.ops["ray_sphere"], np.random.default_rng(1), 0.7
    step = float(np.spacing(np.float32(distance)))
    errors, quadratic_errors = [], []
    for aside in rng.uniform(0, 0.9, 200):
        x = ray_from_afar(rng, distance, speed, aside)
        exact, found = op.forward(x.astype("f8")), op.forward(x)
        o, d, c, _ = np.split(x, [3, 6, 9])
        # The position lies on the sphere even where t has no digits left for it.
        assert np.linalg.norm(found[1:4] - c) == pytest.approx(1, abs=2 * step)
        errors.append(abs(found[0] - exact[0]) * speed / step)
        f = o - c
        half_b, square = f @ d, d @ d
        rest = half_b * half_b - square * (f @ f - np.float32(1))
        quadratic = (-half_b - np.sqrt(np.maximum(rest, 0))) / square
        quadratic_errors.append(abs(quadratic - exact[0]) * speed / step)
    # In steps of a float at that distance; largest measured: 3.0, and 198 to 5841.
    assert max(errors) <= 4
    assert max(quadratic_errors) >= 100


def adjoint(wrong: str | None, groups: Groups, d_out: Any) -> Groups:
    """By implicit differentiation, in NumPy, with one thing wrong."""
    o, d, c, r = (groups[name] for name in ("origin", "direction", "center", "radius"))
    inside = bool((o - c) @ (o - c) < r**2)
    if wrong == "the other hit":
        inside = not inside
    a, b = d @ d, (o - c) @ d
    root = np.sqrt(b * b - a * ((o - c) @ (o - c) - r**2))
    t = (-b + (root if inside else -root)) / a
    n = (o + t * d - c) / r
    d_t, d_x, d_n = d_out[0], d_out[1:4], d_out[4:]
    by_place = d_x if wrong == "normal held fixed" else d_x + d_n / r
    by_t = d_t if wrong == "point at a fixed t" else d_t + by_place @ d
    if wrong == "normal at a fixed t":
        by_t = d_t + d_x @ d
    k = by_t / (n @ d)
    if wrong == "divided by a direction of unit length":
        k = k * np.linalg.norm(d)
    d_o = by_place - k * n
    d_c, d_r = k * n - d_n / r, k - n @ d_n / r
    if wrong == "center forgotten in the normal":
        d_c = k * n
    if wrong == "radius forgotten in the normal":
        d_r = np.full_like(r, k)
    return {
        "origin": d_o,
        "direction": d_o if wrong == "t forgotten in t dd" else t * d_o,
        "center": -d_o if wrong == "center as the origin, negated" else d_c,
        "radius": -d_r if wrong == "sign of dr" else d_r,
    }


WRONG = [
    "the other hit",
    "normal held fixed",
    "point at a fixed t",
    "normal at a fixed t",
    "divided by a direction of unit length",
    "center forgotten in the normal",
    "radius forgotten in the normal",
    "t forgotten in t dd",
    "center as the origin, negated",
    "sign of dr",
]


@pytest.mark.parametrize("name", ["ray_sphere", "ray_sphere_inside"])
def test_the_right_formula_passes_and_equals_the_core(name: str) -> None:
    proof = Proof(name)
    place = draw(proof.op, 11)
    assert check_gradient(proof.forward, lambda p, d: adjoint(None, p, d), place, seed=11)
    d_y = np.random.default_rng(1).standard_normal(proof.op.outputs)
    mine, core = (
        flat(proof.op, found) for found in (adjoint(None, place, d_y), proof.backward(place, d_y))
    )
    np.testing.assert_allclose(mine, core, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", ["ray_sphere", "ray_sphere_inside"])
def test_wrong_adjoint_dies(name: str, wrong: str) -> None:
    proof = Proof(name)
    report = check_gradient(
        proof.forward,
        lambda p, d: adjoint(wrong, p, d),
        draw(proof.op, 11),
        seed=11,
        tolerance=TOLERANCE,
    )
    assert not report, wrong
    assert max(group.error for group in report.groups) >= 1000 * TOLERANCE, str(report)
