"""Sphere tracing never steps through a surface, and its hits have derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.geometry import Body, SdfHits, draw_body
from photograd.geometry.sdf import GAVE_UP, HIT, MISSED, box, placed, plane, sphere, union
from photograd.transport.builtin import camera_at
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from support.gradient_mutants import check_gradient_mutants

from .shapes import Array, random_rays
from .test_sdf import all_together

BALLS = (([0.4, 0.2, -0.3], 0.5), ([-0.6, -0.2, 0.5], 0.35))
HALF, SHIFT, FLOOR = np.array([0.3, 0.5, 0.2]), np.array([-0.5, 0.3, -0.6]), -0.9


def known_body() -> Body:
    balls = [placed(sphere(radius), center) for center, radius in BALLS]
    return Body(union(*balls, placed(box(HALF), SHIFT), plane([0, 1, 0], FLOOR)))


def known_hits(origins: Array, directions: Array) -> tuple[Array, Array]:
    """First t (R,) in closed form, and whether the origin is inside."""
    found = []
    inside = origins[:, 1] < FLOOR
    for center, radius in BALLS:
        offset = origins - center
        b, c = (offset * directions).sum(1), (offset**2).sum(1) - radius**2
        rest = b * b - c
        t = -b - np.sqrt(np.maximum(rest, 0))
        found.append(np.where((rest > 0) & (t > 0), t, np.inf))
        inside |= c < 0
    with np.errstate(divide="ignore"):
        sides = np.stack([s * HALF + SHIFT - origins for s in (-1, 1)]) / directions
        near, far = sides.min(axis=0).max(axis=1), sides.max(axis=0).min(axis=1)
        floor = (FLOOR - origins[:, 1]) / directions[:, 1]
    found.append(np.where((near < far) & (near > 0), near, np.inf))
    inside |= (np.abs(origins - SHIFT) < HALF).all(axis=1)
    found.append(np.where(floor > 0, floor, np.inf))
    return np.min(found, axis=0), inside


def stepped_past(t: Array, exact: Array) -> Array:
    """Where a ray is behind its first hit, by more than rounding."""
    return np.flatnonzero(t > exact + 1e-9)


def test_a_million_rays_stop_at_the_first_surface() -> None:
    body, early_rays = known_body(), 0
    for seed in range(4):
        origins, directions = random_rays(250_000, seed=seed)
        exact, inside = known_hits(origins, directions)
        exact = np.where(inside, 0.0, exact)
        # A ray that starts low and runs nearly level comes down to the floor by very many steps.
        hits = body.trace(origins, directions, t_max=20.0, max_steps=100_000)
        assert 0.5 < hits.hit.mean() < 0.95
        assert not (hits.end == GAVE_UP).any()
        # A hit beyond t_max, of the floor under a nearly level ray, is a miss.
        exact = np.where(exact > 20.0, np.inf, exact)
        assert stepped_past(np.where(hits.hit, hits.t, np.inf), exact).size == 0
        # Nor too early: but within the tolerance of 1e-6 m a ray that passes by has touched, at up
        # to sqrt(2 radius tolerance) = 1 mm before the place where it is nearest.
        early = hits.hit & (hits.t < exact - 1e-9)
        early_rays += int(early.sum())
        touched = origins[early] + hits.t[early, None] * directions[early]
        assert np.abs(body.distance(touched)).max(initial=0.0) <= 1e-6
    assert early_rays < 100


def march(body: Body, origins: Array, directions: Array, stride: float) -> Array:
    """Sphere tracing in NumPy by `stride` times the distance: t after 200 steps, or a hit."""
    t = np.zeros(len(origins))
    for _ in range(200):
        f = body.distance(origins + t[:, None] * directions)
        t += np.where(np.abs(f) > 1e-9, stride * np.abs(f), 0.0)
    return t


def test_longer_steps_would_be_seen() -> None:
    origins, directions = random_rays(3000, seed=2)
    exact, inside = known_hits(origins, directions)
    keep = ~inside & (exact < 20)
    origins, directions, exact = origins[keep], directions[keep], exact[keep]
    body = known_body()
    assert stepped_past(march(body, origins, directions, 1.0), exact).size == 0
    assert stepped_past(march(body, origins, directions, 1.4), exact).size > 10


def test_nothing_lies_before_a_hit() -> None:
    # No closed form here: the way to the hit is sampled, and must be free.
    body = Body(all_together())
    origins, directions = random_rays(4000, seed=3, spread=2.0)
    hits = body.trace(origins, directions, t_max=20.0)
    assert 0.1 < hits.hit.mean() < 0.9
    end = np.where(hits.hit, hits.t, 6.0)
    at = np.linspace(0, 1, 200, endpoint=False)
    way = origins[:, None] + (end[:, None] * at)[..., None] * directions[:, None]
    f = body.distance(way.reshape(-1, 3)).reshape(len(origins), -1)
    free = hits.t > 0
    assert f[free].min() > 0
    surface = origins[hits.hit] + hits.t[hits.hit, None] * directions[hits.hit]
    outside = hits.t[hits.hit] > 0
    # Polished to rounding, but for rays that only touch.
    left = np.abs(body.distance(surface))[outside]
    assert np.quantile(left, 0.98) < 1e-14
    assert left.max() <= 1e-6


def steep_rays(body: Body, count: int, seed: int) -> tuple[Array, Array]:
    """Rays whose hits are no seams, and not at a silhouette: there, derivatives exist."""
    origins, directions = random_rays(4000, seed=seed, spread=2.0)
    hits = body.trace(origins, directions, t_max=20.0)
    place = origins + np.where(hits.hit, hits.t, 0)[:, None] * directions
    normal = body.normals(place)
    cosine = -(normal * directions).sum(axis=1)
    step = 1e-3 * np.concatenate([np.eye(3), -np.eye(3)])
    bend = np.array([np.abs(body.normals(place + s) - normal).max(axis=1) for s in step]).max(
        axis=0
    )
    good = hits.hit & (hits.t > 0.01) & (cosine > 0.2) & (bend < 0.02)
    keep = np.flatnonzero(good)[:count]
    assert len(keep) == count
    return origins[keep], directions[keep]


def test_derivatives_of_a_hit() -> None:
    body = Body(all_together())
    origins, directions = steep_rays(body, 150, seed=4)

    def hits_of(groups: dict[str, Any]) -> SdfHits:
        body.numbers[:] = groups["numbers"]
        return body.trace(groups["origins"], groups["directions"], t_max=20.0)

    def forward(groups: dict[str, Any]) -> Any:
        return hits_of(groups).t

    def backward(groups: dict[str, Any], d_t: Any) -> dict[str, Any]:
        found = body.trace_backward(groups["origins"], groups["directions"], hits_of(groups), d_t)
        return dict(zip(("numbers", "origins", "directions"), found, strict=True))

    place = {"numbers": body.numbers.copy(), "origins": origins, "directions": 1.3 * directions}
    # Every number of every shape moves some hit: a derivative of zero would not be checked.
    assert (backward(place, np.ones(150))["numbers"] != 0).all()
    # Larger steps would make rays miss.
    steps = (1e-4, 1e-5, 1e-6)
    report = check_gradient(forward, backward, place, seed=4, coordinates=20, steps=steps)
    assert report, str(report)
    mutants = check_gradient_mutants(
        forward,
        backward,
        place,
        0.5 + np.arange(150) / 150,
        seed=5,
        coordinates=6,
        directions=3,
        steps=steps[:2],
    )
    assert mutants, str(mutants)


def test_the_hit_of_a_ball_in_closed_form() -> None:
    # At a distance p from the axis t = 3 - h, h = sqrt(r^2 - p^2): dt/dr = -r / h.
    body = Body(sphere(1.0))
    aside = np.array([0.0, 0.3, 0.6, 0.9])
    origins = np.column_stack([aside, np.zeros(4), np.full(4, 3.0)])
    directions = np.broadcast_to([0.0, 0.0, -1.0], (4, 3))
    hits = body.trace(origins, directions)
    half = np.sqrt(1 - aside**2)
    np.testing.assert_allclose(hits.t, 3 - half, rtol=1e-14)
    for k in range(4):
        d_radius, d_origin, _ = body.trace_backward(origins, directions, hits, np.eye(4)[k])
        np.testing.assert_allclose(d_radius, -1 / half[k], rtol=1e-12)
        np.testing.assert_allclose(d_origin[k], [aside[k] / half[k], 0, 1], atol=1e-12)
        assert not d_origin[np.arange(4) != k].any()


@same_bits("sphere tracing")
def hits_and_gradients() -> list[Any]:
    body = Body(all_together())
    origins, directions = random_rays(6000, seed=6, spread=2.0)
    hits = body.trace(origins, directions)
    back = body.trace_backward(origins, directions, hits, np.ones(6000))
    return [hits.t, hits.steps, hits.end, *back]


def test_how_rays_end() -> None:
    body = Body(sphere(1.0))
    origins = np.array([[0.0, 0, 3], [0, 0, 3], [0, 0, 0], [1 + 1e-5, 0, 3], [0, 0, 3]])
    directions = np.array([[0.0, 0, -1], [0, 0, 1], [1, 0, 0], [0, 0, -1], [0, 0, -2.0]])
    hits = body.trace(origins, directions, max_steps=20)
    assert hits.end.tolist() == [HIT, MISSED, HIT, GAVE_UP, HIT]
    np.testing.assert_allclose(hits.t[[0, 2, 4]], [2.0, 0.0, 1.0], atol=1e-12)
    assert hits.t[1] == np.inf
    assert 2.5 < hits.t[3] < 3.0  # known to be free so far
    assert hits.steps[3] == 20
    back = body.trace_backward(origins, directions, hits, np.array([0.0, 1, 1, 1, 0]))
    assert not any(array.any() for array in back)
    assert body.trace(origins[:1], directions[:1], t_max=1.9).end.tolist() == [MISSED]


def test_bad_rays_and_options_are_named() -> None:
    body = Body(sphere(1.0))
    o, d = np.zeros((2, 3)), np.eye(2, 3)
    cases: list[tuple[type[Exception], str, Any, Any, dict[str, Any]]] = [
        (ShapeError, "origins", o[0], d, {}),
        (RangeError, "some length", o, 0 * d, {}),
        (RangeError, "row 0", o + np.nan, d, {}),
        (RangeError, "t_max", o, d, {"t_max": np.inf}),
        (RangeError, "tolerance", o, d, {"tolerance": 0.0}),
        (RangeError, "max_steps", o, d, {"max_steps": 0}),
    ]
    for error, words, origins, directions, options in cases:
        with pytest.raises(error, match=words):
            body.trace(origins, directions, **options)
    hits = body.trace(o, d)
    with pytest.raises(ShapeError, match="d_t"):
        body.trace_backward(o, d, hits, np.ones(3))
    with pytest.raises(ShapeError, match="hits"):
        body.trace_backward(o[:1], d[:1], hits, np.ones(1))


def test_a_picture_of_a_ball_on_a_floor_in_closed_form() -> None:
    body = Body(union(placed(sphere(0.5), [0, 0.5, 0]), plane([0, 1, 0], 0.0)))
    camera = camera_at([0.0, 2.0, 5.0], [0.0, 0.4, 0.0], 30.0, 40, 40)
    sun = np.array([0.6, 0.8, 0.0])
    picture = draw_body(body, camera, albedo=[0.5, 0.4, 0.3], towards_sun=sun, sky=0.0)
    _, directions = camera.rays()
    met = np.isfinite(picture.depth)
    place = camera.position + picture.depth[met][:, None] * directions.reshape(40, 40, 3)[met]
    ball = place[:, 1] > 1e-6
    normal = np.where(ball[:, None], (place - [0, 0.5, 0]) / 0.5, [0.0, 1.0, 0.0])
    np.testing.assert_allclose(picture.normal[met], normal, atol=1e-9)
    to = np.array([0, 0.5, 0]) - place
    beside = np.linalg.norm(to - (to @ sun)[:, None] * sun, axis=1)
    dark = ~ball & (beside < 0.5) & (to @ sun > 0)
    lit = np.where(dark, 0.0, (normal @ sun).clip(0)) * 3.0 / np.pi
    sure = np.abs(beside - 0.5) > 1e-2
    assert 20 < dark.sum() < 400
    expected = lit[:, None] * [0.5, 0.4, 0.3]
    np.testing.assert_allclose(picture.radiance[met][sure | ball], expected[sure | ball], atol=1e-9)
    np.testing.assert_array_equal(picture.shadow[met][sure & ~ball], dark[sure & ~ball])
    assert not picture.radiance[~met].any()
    for change, words in (
        ({"albedo": [2, 0, 0]}, "albedo"),
        ({"towards_sun": [0, 0, 0]}, "sun"),
        ({"sky": -1.0}, "sky"),
        ({"albedo": 0.5}, "albedo"),
    ):
        with pytest.raises((RangeError, ShapeError), match=words):
            draw_body(body, camera, **change)
