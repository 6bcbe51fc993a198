"""Points with a radius: closed form, order, one radius for all, recovery."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.fields import Points
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import check_gradient
from photograd_course.optim import Adam


def rays(origins: Any, directions: Any) -> RayBatch:
    o, d = np.atleast_2d(origins).astype(float), np.atleast_2d(directions).astype(float)
    d = d / np.linalg.norm(d, axis=1, keepdims=True)
    o, d = np.broadcast_arrays(o, d)
    return RayBatch(o.copy(), d.copy(), np.arange(len(o), dtype=np.uint32))


def seen(points: Points, batch: RayBatch, **options: Any) -> Any:
    return points.render(batch, seed=0, step=0, options=RenderOptions(**options))


def test_a_point_is_seen_by_the_distance_at_which_a_ray_passes() -> None:
    points = Points(np.array([[0.0, 0, 5]]), np.array([[0.9, 0.6, 0.3]]), np.log([0.2]))
    far = np.array([0, 0.1, 0.2, 0.4])
    batch = rays(np.column_stack([far, np.zeros((4, 2))]), [[0, 0, 1]])
    outputs, _ = seen(points, batch)
    alpha = 0.95 * np.exp(-(far**2) / 0.08)
    np.testing.assert_allclose(outputs.opacity, alpha, rtol=1e-12)
    np.testing.assert_allclose(outputs.color, alpha[:, None] * [0.9, 0.6, 0.3], rtol=1e-12)
    np.testing.assert_allclose(outputs.depth, 5 * alpha, rtol=1e-12)
    assert seen(points, rays([0.7, 0, 0], [0, 0, 1]))[0].opacity[0] == 0  # below 1/255


def test_points_cover_each_other_from_either_side() -> None:
    ends, colors = (
        np.array([[0, 0, -1.0], [0, 0, 1.0]]),
        np.array([[0.9, 0.1, 0.1], [0.1, 0.1, 0.9]]),
    )
    points = Points(ends, colors, np.log([0.3, 0.3]))
    outputs, _ = seen(points, rays([[0, 0, -4], [0, 0, 4.0]], [[0, 0, 1], [0, 0, -1.0]]))
    expected = 0.95 * (colors + 0.05 * colors[::-1])
    np.testing.assert_allclose(outputs.color, expected, rtol=1e-12)


def test_one_radius_for_all_is_the_same_picture_with_a_summed_gradient() -> None:
    own = Points.example(seed=1)
    batch = own.example_batch(seed=1)
    own.params["log_radius"][:] = np.log(0.2)
    shared = Points(own.params["position"], own.params["color"], np.log([0.2]), alpha_min=0.0)
    results = [seen(points, batch) for points in (own, shared)]
    np.testing.assert_array_equal(results[0][0].color, results[1][0].color)
    d = Outputs(np.ones((40, 3)), np.full(40, 0.5), np.full(40, -0.3))
    each, total = (
        p.render_backward(c, d) for p, (_, c) in zip((own, shared), results, strict=True)
    )
    assert total["log_radius"].shape == (1,)
    np.testing.assert_allclose(total["log_radius"], each["log_radius"].sum(), rtol=1e-12)
    np.testing.assert_array_equal(total["position"], each["position"])


def test_the_shared_radius_agrees_with_differences() -> None:
    full = Points.example(seed=2)
    points = Points(full.params["position"], full.params["color"], np.log([0.3]), alpha_min=0.0)
    batch = full.example_batch(seed=2)

    def forward(params: Any) -> Any:
        points.params = dict(params)
        return dict(vars(seen(points, batch)[0]))

    def backward(params: Any, d: Any) -> Any:
        points.params = dict(params)
        return points.render_backward(seen(points, batch)[1], Outputs(**d))

    report = check_gradient(forward, backward, dict(points.params), seed=3)
    assert report, str(report)


def test_a_cloud_is_recovered_from_rays() -> None:
    # At the corners of a cube: two that overlap may change roles, which is no error.
    corners = 1.4 * np.stack(np.meshgrid(*3 * [[-0.5, 0.5]]), axis=-1).reshape(8, 3)
    random = np.random.default_rng(2)
    colors, size = random.uniform(0.1, 0.9, (8, 3)), random.uniform(0.15, 0.4, 8)
    truth, points = (Points(corners.copy(), colors.copy(), np.log(size)) for _ in range(2))
    g = np.random.default_rng(1)
    angle = g.uniform(0, 2 * np.pi, 600)
    origins = 4 * np.column_stack([np.cos(angle), g.uniform(-0.5, 0.5, 600), np.sin(angle)])
    batch = rays(origins, g.uniform(-1.1, 1.1, (600, 3)) - origins)
    target = seen(truth, batch)[0].color
    points.params["position"] = points.params["position"] + 0.08 * g.standard_normal((8, 3))
    points.params["color"] = np.full((8, 3), 0.5)
    points.params["log_radius"] = points.params["log_radius"] + 0.2 * g.standard_normal(8)
    before = np.abs(points.params["position"] - truth.params["position"]).max()
    adam = Adam()
    rates = {name: spec.learning_rate for name, spec in points.param_groups().items()}
    for step in range(300):
        outputs, context = seen(points, batch)
        error = outputs.color - target
        decay = 0.1 ** (step / 300)
        adam.step(
            points.params,
            points.render_backward(context, Outputs(2 * error / error.size)),
            {name: rate * decay for name, rate in rates.items()},
        )
    after = np.abs(points.params["position"] - truth.params["position"]).max()
    assert before > 0.1
    assert after < 0.1 * before
    np.testing.assert_allclose(
        points.params["color"], truth.params["color"], atol=0.01
    )  # measured: 0.003


def test_wrong_arrays_are_refused() -> None:
    position, color, log_radius = Points.example(seed=1).params.values()
    with pytest.raises(
        ShapeError, match=r"log_radius: expected shape \(N,\) or \(1,\) with N = 12"
    ):
        Points(position, color, log_radius[:5])
    with pytest.raises(ShapeError, match=r"Points: position: expected shape \(N, 3\) with N >= 1"):
        Points(position[:0], color[:0], log_radius[:0])
    with pytest.raises(DtypeError, match="expected float64 as position, got float32"):
        Points(position, color, log_radius.astype(np.float32))
    with pytest.raises(RangeError, match="Points: opacity: expected a finite number in"):
        Points(position, color, log_radius, opacity=1.0)
    with pytest.raises(RangeError, match="alpha_min"):
        Points(position, color, log_radius, alpha_min=-1.0)
