"""Signed distances: right where they are known, never overstated, with exact derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.geometry import Body
from photograd.geometry.sdf import (
    KINDS,
    Shape,
    box,
    capsule,
    difference,
    intersection,
    placed,
    plane,
    rounded,
    rounded_box,
    scaled,
    smooth_union,
    sphere,
    torus,
    union,
)
from photograd_course.gradcheck import check_gradient
from photograd_course.random import uniform

from support.gradient_mutants import check_gradient_mutants

from .shapes import Array

TURN = [0.8, 0.2, -0.4, 0.3]
SHAPES: dict[str, Shape] = {
    "sphere": sphere(0.7),
    "box": box([0.6, 0.3, 0.4]),
    "torus": torus(0.6, 0.25),
    "plane": plane([1.0, 2.0, -0.5], 0.2),
    "capsule": capsule(0.4, 0.3),
    "union": union(sphere(0.5), box([0.9, 0.2, 0.3]), torus(0.7, 0.1)),
    "intersection": intersection(sphere(0.8), box([0.6, 0.6, 0.6])),
    "difference": difference(box([0.6, 0.6, 0.6]), sphere(0.7)),
    "smooth_union": smooth_union(sphere(0.5), box([0.9, 0.2, 0.3]), 0.3),
    "placed": placed(box([0.6, 0.3, 0.4]), [0.2, -0.1, 0.3], TURN),
    "scaled": scaled(torus(0.6, 0.25), 1.7),
    "rounded": rounded(box([0.4, 0.2, 0.3]), 0.2),
}


def all_together() -> Shape:
    """One body with every kind in it."""
    ring = placed(scaled(torus(0.5, 0.15), 1.2), [0.1, 0.3, 0.0], TURN)
    cut = difference(
        box([0.5, 0.4, 0.3]), placed(torus(0.28, 0.16), [0.3, 0.3, 0.2], [0.5, 0.6, -0.3, 0.2])
    )
    base = intersection(sphere(1.4), plane([0.1, 1.0, 0.2], -0.35))
    rod = placed(rounded(capsule(0.3, 0.05), 0.08), [-0.9, 0.4, 0.6], TURN)
    return union(smooth_union(ring, cut, 0.2), union(base, rod))


def points(count: int, seed: int, reach: float = 1.5) -> Array:
    u = uniform(seed, pixel=np.arange(count)[:, None], dimension=np.arange(3))
    return reach * (2.0 * u - 1.0)


def test_distances_known_otherwise() -> None:
    p = points(20_000, 1)
    half = np.array([0.6, 0.3, 0.4])
    outside = np.linalg.norm(p - p.clip(-half, half), axis=1)
    inside = (half - np.abs(p)).min(axis=1)
    np.testing.assert_allclose(
        Body(SHAPES["box"]).distance(p), np.where(outside > 0, outside, -inside), atol=1e-15
    )
    around = p * [1, 0, 1]
    circle = 0.6 * around / np.linalg.norm(around, axis=1, keepdims=True)
    gap = np.linalg.norm(p - circle, axis=1) - 0.25
    np.testing.assert_allclose(Body(SHAPES["torus"]).distance(p), gap, atol=1e-14)
    np.testing.assert_allclose(
        Body(SHAPES["sphere"]).distance(p), np.linalg.norm(p, axis=1) - 0.7, atol=1e-15
    )
    nearest = p * [0, 1, 0]
    nearest[:, 1] = nearest[:, 1].clip(-0.4, 0.4)
    np.testing.assert_allclose(
        Body(SHAPES["capsule"]).distance(p), np.linalg.norm(p - nearest, axis=1) - 0.3, atol=1e-15
    )
    np.testing.assert_allclose(
        Body(SHAPES["rounded"]).distance(p),
        Body(box([0.4, 0.2, 0.3])).distance(p) - 0.2,
        atol=1e-15,
    )
    small = Body(rounded_box([0.6, 0.3, 0.4], 0.1)).distance(p)  # within the box, touching it
    assert (small >= Body(SHAPES["box"]).distance(p) - 1e-12).all()
    assert Body(rounded_box([0.6, 0.3, 0.4], 0.1)).distance([[0.6, 0.1, 0.2]]) == pytest.approx(0)
    normal = np.array([1.0, 2.0, -0.5]) / np.sqrt(5.25)
    np.testing.assert_allclose(Body(SHAPES["plane"]).distance(p), p @ normal - 0.2, atol=1e-15)


def test_bodies_hold_what_their_parts_say() -> None:
    p = points(20_000, 2)
    inside = {name: Body(SHAPES[name]).distance(p) < 0 for name in SHAPES}

    def of(shape: Shape) -> Array:
        return Body(shape).distance(p) < 0

    ball, bar = of(sphere(0.5)), of(box([0.9, 0.2, 0.3]))
    np.testing.assert_array_equal(inside["union"], ball | bar | of(torus(0.7, 0.1)))
    cube = of(box([0.6, 0.6, 0.6]))
    np.testing.assert_array_equal(inside["intersection"], of(sphere(0.8)) & cube)
    np.testing.assert_array_equal(inside["difference"], cube & ~of(sphere(0.7)))
    # A smooth union adds at the seam and takes nothing away.
    assert (inside["smooth_union"] >= (ball | bar)).all()
    assert 20 < (inside["smooth_union"] & ~(ball | bar)).sum() < 2000
    np.testing.assert_allclose(
        Body(SHAPES["scaled"]).distance(p), 1.7 * Body(torus(0.6, 0.25)).distance(p / 1.7)
    )
    w, x, y, z = np.array(TURN) / np.linalg.norm(TURN)
    turn = np.array(
        [  # columns: where the axes go
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    np.testing.assert_allclose(
        Body(SHAPES["placed"]).distance(p @ turn.T + [0.2, -0.1, 0.3]),
        Body(SHAPES["box"]).distance(p),
        atol=1e-14,
    )


@pytest.mark.parametrize("name", [*SHAPES, "all"])
def test_no_distance_is_overstated(name: str) -> None:
    # 1-Lipschitz: |f(p) - f(q)| <= |p - q|, near and far.
    body = Body(all_together() if name == "all" else SHAPES[name])
    p = points(40_000, 3)
    q = p + points(40_000, 4) * 10.0 ** -(4 * uniform(5, pixel=np.arange(40_000))[:, None])
    slope = np.abs(body.distance(p) - body.distance(q)) / np.linalg.norm(p - q, axis=1)
    assert 0.99 < slope.max() < 1 + 1e-10


@pytest.mark.parametrize("name", [*SHAPES, "all"])
def test_derivatives(name: str) -> None:
    body = Body(all_together() if name == "all" else SHAPES[name])
    p = points(40, 6)
    # Kinks (seams, edges of boxes seen from inside) are where one side's slope jumps: left out.
    step = 1e-4 * np.concatenate([np.eye(3), -np.eye(3)])
    straight = np.array([body.distance(p + s) for s in step]).reshape(2, 3, -1).sum(axis=0)
    p = p[(np.abs(straight - 2 * body.distance(p)) < 1e-6).all(axis=0)]
    assert len(p) > 20

    def forward(groups: dict[str, Any]) -> Any:
        body.numbers[:] = groups["numbers"]
        return body.distance(groups["points"])

    def backward(groups: dict[str, Any], d_f: Any) -> dict[str, Any]:
        body.numbers[:] = groups["numbers"]
        d_points, d_numbers = body.distance_backward(groups["points"], d_f)
        return {"points": d_points, "numbers": d_numbers}

    place = {"points": p, "numbers": body.numbers.copy()}
    report = check_gradient(forward, backward, place, seed=6)
    assert report, str(report)
    if name == "all":
        mutants = check_gradient_mutants(
            forward,
            backward,
            place,
            0.5 + uniform(7, pixel=np.arange(len(p))),
            seed=7,
            coordinates=12,
            directions=4,
        )
        assert mutants, str(mutants)


def test_normals_are_slopes() -> None:
    body = Body(all_together())
    p = points(4000, 8)
    normal = body.normals(p)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
    ahead, behind = body.distance(p + 1e-6 * normal), body.distance(p - 1e-6 * normal)
    slope = (ahead - behind) / 2e-6
    # 1 up to rounding 1e-16 / 1e-6, less where a smooth union blends, or at a seam.
    assert slope.max() < 1 + 1e-8
    assert np.quantile(slope, 0.2) > 1 - 1e-8
    assert (Body(sphere(1.0)).normals(np.zeros((1, 3))) == 0).all()


def test_the_tree_is_laid_out_by_name() -> None:
    body = Body(all_together())
    assert (
        len(body.names)
        == len(body.numbers)
        == sum(
            len(KINDS[kind])
            for kind in (
                "torus",
                "scaled",
                "placed",
                "box",
                "torus",
                "placed",
                "smooth_union",
                "sphere",
                "plane",
                "capsule",
                "rounded",
                "placed",
            )
        )
    )
    assert body.names[:3] == ("torus 0: ring", "torus 0: tube", "scaled 1: factor")
    assert body.numbers[:3].tolist() == [0.5, 0.15, 1.2]
    many = Body(union(*[placed(sphere(0.1), [k, 0, 0]) for k in range(300)]))
    np.testing.assert_allclose(many.distance([[250.0, 0, 0], [0.5, 0, 0]]), [-0.1, 0.4], atol=1e-15)


def chain(length: int) -> Shape:
    shape = sphere(1.0)
    for _ in range(length):
        shape = scaled(shape, 1.0)
    return shape


def test_bad_arguments_are_named() -> None:
    cases: list[tuple[type[Error], str, Any]] = [
        (RangeError, "radius", lambda: sphere(0.0)),
        (RangeError, "radius", lambda: sphere(np.nan)),
        (DtypeError, "radius", lambda: sphere("1")),  # type: ignore[arg-type]
        (ShapeError, "half_sizes", lambda: box(1.0)),
        (RangeError, "the least of which is 0.2", lambda: rounded_box([0.3, 0.2, 0.4], 0.2)),
        (RangeError, "some length", lambda: plane([0, 0, 0], 1.0)),
        (RangeError, "quat", lambda: placed(sphere(1), quat=[0, 0, 0, 0])),
        (RangeError, "at least one", union),
        (RangeError, "depth of at most 256, got 257", lambda: Body(chain(256))),
        (ShapeError, "points", lambda: Body(sphere(1.0)).distance([0, 0, 0])),
        (RangeError, "row 1", lambda: Body(sphere(1.0)).distance([[0, 0, 0], [0, np.inf, 0]])),
        (ShapeError, "d_f", lambda: Body(sphere(1.0)).distance_backward(np.zeros((2, 3)), [1.0])),
    ]
    for error, words, call in cases:
        with pytest.raises(error, match=words):
            call()
    body = Body(sphere(1.0))
    body.numbers[0] = -1.0
    with pytest.raises(RangeError, match="numbers: expected radii"):
        body.distance(np.zeros((1, 3)))
    body.numbers = np.zeros(2)
    with pytest.raises(ShapeError, match="numbers"):
        body.distance(np.zeros((1, 3)))


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ([], "at least one node"),
        ([[99, -1, -1, 0]], "a known kind, got 99 in node 0"),
        ([[10, 0, -1, 0]], "earlier nodes without a parent, got 0 in node 0"),
        ([[0, -1, -1, 0], [5, 0, 0, 1]], "earlier nodes without a parent"),
        ([[0, -1, -1, 0], [0, -1, -1, 1]], "one root, got 2 of them"),
        ([[0, -1, -1, 3]], "numbers one after another, got 3"),
    ],
)
def test_what_is_no_tree_is_refused(nodes: Any, words: str) -> None:
    with pytest.raises(RangeError, match=words):
        _core.Sdf(np.array(nodes, np.int32).reshape(-1, 4))
