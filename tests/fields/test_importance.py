"""Importance sampling along a ray: the pdf, its inverse CDF, and what is held constant."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.fields import Nerf
from photograd.fields.importance import (
    BINS,
    EPSILON,
    cdf_of,
    fine_samples,
    inverse_cdf,
    stratified,
    weights_of,
)
from photograd.fields.nerf import NerfPolicy
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.gradcheck import check_gradient

pytestmark = pytest.mark.usefixtures("core")

BOX = ((-1.0, -0.8, -1.2), (1.0, 0.8, 1.2))
OPTIONS = RenderOptions(jitter=True)
CAMERA = RenderOptions(camera_adjoint=True)


def weights(rays: int, bins: int = 8) -> Any:
    return np.random.default_rng(3).uniform(0, 1, (rays, bins)) ** 3 / bins


def test_weights_add_up_to_the_opacity() -> None:
    sigma_t = np.random.default_rng(1).uniform(0, 30, (5, 16))
    width = np.full((5, 1), 0.05)
    opacity = 1 - np.exp(-0.05 * sigma_t.sum(axis=1))
    np.testing.assert_allclose(weights_of(sigma_t, width).sum(axis=1), opacity, rtol=1e-12)
    assert (weights_of(1e9 * sigma_t, width) >= 0).all()


def test_the_pdf_is_normalized_and_the_cdf_rises() -> None:
    cdf = cdf_of(weights(6))
    assert (cdf[:, 0] == 0).all()
    assert (cdf[:, -1] == 1).all()  # exactly: else u near 1 falls behind the last bin
    expected = (weights(6) + EPSILON) / (weights(6) + EPSILON).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(np.diff(cdf, axis=1), expected, rtol=1e-12)


@pytest.mark.parametrize("rows", [1, 7, 40_000])
def test_rays_without_weights_are_sampled_evenly(rows: int) -> None:
    cdf = cdf_of(np.zeros((rows, BINS)))
    u = np.tile([0.0, 0.25, 0.5, 1.0], (rows, 1))
    np.testing.assert_allclose(inverse_cdf(cdf, u), u, atol=1e-9)


def test_the_ends_of_bins_and_of_the_ray_are_reached() -> None:
    cdf = cdf_of(weights(9))
    ends = np.tile(np.arange(9) / 8, (9, 1))
    np.testing.assert_allclose(inverse_cdf(cdf, cdf), ends, atol=1e-12)
    last = cdf_of(np.eye(8)[None, 7] * 50)  # all of the weight in the last bin
    found = inverse_cdf(last, np.linspace(0.02, 1, 50)[None])
    assert (found > 7 / 8).all()
    assert found[0, -1] == 1


def test_sampled_distances_have_the_pdf_of_the_weights() -> None:
    """Pearson's chi-square over 8 bins, and over 4 parts of each: even within a bin."""
    cdf = cdf_of(weights(1))
    u = np.random.default_rng(11).uniform(0, 1, (1, 20_000))
    t = inverse_cdf(cdf, u)[0]
    for parts in (1, 4):
        expected = np.repeat(np.diff(cdf[0]), parts) / parts * t.size
        counts, _ = np.histogram(t, bins=8 * parts, range=(0, 1))
        chi2 = ((counts - expected) ** 2 / expected).sum()
        freedom = 8 * parts - 1
        assert chi2 < freedom + 5 * np.sqrt(2 * freedom)
    uniform = np.full(8, t.size / 8)  # the test sees another pdf
    counts, _ = np.histogram(t, bins=8, range=(0, 1))
    assert ((counts - uniform) ** 2 / uniform).sum() > 1000


def test_stratified_numbers_rise_from_0_to_1() -> None:
    u = stratified(3, 6, np.array([0.0, 0.5, 1 - 1e-9]))
    assert u.shape == (3, 7)
    assert (np.diff(u, axis=1) >= 0).all()
    assert (u[:, 0] == 0).all()
    assert (u[:, -1] == 1).all()
    np.testing.assert_array_equal(stratified(1, 1, None), [[0, 1]])


@pytest.mark.parametrize("density", [0.0, 3.0, 1e6])
def test_intervals_cover_the_ray_and_lie_where_the_weights_are(density: float) -> None:
    near, length = np.array([2.0, 2.0, 1.0]), np.array([1.0, 0.5, 0.0])

    def wall(t: Any) -> Any:
        return density * (t > 2.4)

    t, width = fine_samples(wall, near, length, 32, None)
    np.testing.assert_allclose(width.sum(axis=1), length, atol=1e-12)
    np.testing.assert_allclose(t[:, 0] - width[:, 0] / 2, near, rtol=1e-12)
    assert np.isfinite(t).all()
    assert (np.diff(t[:2], axis=1) > 0).all()
    if density > 10:
        assert ((t[0] > 2.39) & (t[0] < 2.43)).mean() > 0.6


def nerf(dtype: Any, importance: int) -> Nerf:
    policy = NerfPolicy(BOX, 0.05, octaves=4, hidden="softplus", importance=importance)
    field = Nerf.initial(policy, seed=3, sigma_t=1.0, dtype=dtype)
    random = np.random.default_rng(5)
    for values in field.params.values():
        values[...] += random.normal(scale=0.1, size=values.shape).astype(values.dtype)
    return field


def rays(count: int, dtype: Any) -> RayBatch:
    random = np.random.default_rng(count)
    origins = random.normal(size=(count, 3))
    origins *= 3 / np.linalg.norm(origins, axis=1, keepdims=True)
    to = random.uniform(-0.6, 0.6, (count, 3)) - origins
    to /= np.linalg.norm(to, axis=1, keepdims=True)
    return RayBatch(origins.astype(dtype), to.astype(dtype), np.arange(count, dtype=np.uint32))


def test_many_samples_by_importance_show_what_the_lattice_shows() -> None:
    batch = rays(64, np.float64)
    lattice = nerf(np.float64, 0).with_dt(0.004)
    expected, _ = lattice.render(batch, seed=0, step=0, options=RenderOptions())
    errors = []
    for count in (16, 256):
        field = nerf(np.float64, count)
        field.policy = replace(field.policy, dt=0.004)  # the same ends of the rays
        found, context = field.render(batch, seed=0, step=0, options=RenderOptions())
        assert context.sample_count == 64 * count
        errors.append(np.abs(found.color - expected.color).max())
        assert found.depth is not None
        assert expected.depth is not None
        np.testing.assert_allclose(found.depth, expected.depth, atol=1 / count)
    assert errors[1] < 0.2 * errors[0]
    assert errors[1] < 2e-3


def test_the_gradient_is_that_of_samples_held_where_they_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    field, batch = nerf(np.float64, 12), rays(5, np.float64)
    _, first = field.render(batch, seed=1, step=2, options=OPTIONS)
    held = first.rays, first.placed

    def render(groups: Any, *, hold: bool) -> Any:
        field.params = dict(groups)
        with monkeypatch.context() as patch:
            if hold:
                patch.setattr(field, "_sampled", lambda *_, **__: held)
            return field.render(batch, seed=1, step=2, options=OPTIONS)

    def function(groups: Any) -> Any:
        outputs, _ = render(groups, hold=True)
        return {"color": outputs.color, "opacity": outputs.opacity, "depth": outputs.depth}

    def backward(groups: Any, cotangent: Any) -> Any:
        _, context = render(groups, hold=False)
        return field.render_backward(context, Outputs(**cotangent))

    report = check_gradient(function, backward, dict(field.params), seed=3)
    assert report, report


def test_kept_samples_and_other_batches_change_no_bit() -> None:
    field, batch = nerf(np.float32, 24), rays(300, np.float32)
    field.reached = np.where(np.indices((64,) * 3)[2] % 9 < 6, 1e30, 0).astype(np.float32)
    outputs, context = field.render(batch, seed=1, step=2, options=OPTIONS)
    keep = replace(OPTIONS, keep_samples=True)
    _, kept = field.render(batch, seed=1, step=2, options=keep)
    d = Outputs(np.ones_like(outputs.color), np.ones_like(outputs.opacity))
    expected, found = field.render_backward(context, d), field.render_backward(kept, d)
    for name in expected:
        np.testing.assert_array_equal(found[name], expected[name])
    some = RayBatch(batch.origins[100:], batch.directions[100:], batch.pixel[100:])
    alone, _ = field.render(some, seed=1, step=2, options=OPTIONS)
    np.testing.assert_allclose(alone.color, outputs.color[100:], atol=1e-6)


def test_empty_space_and_rays_that_miss_give_zeros() -> None:
    field = nerf(np.float32, 16)
    field.reached = np.zeros((64,) * 3, np.float32)
    field.reached[0, 0, 0] = 1e30
    batch = rays(8, np.float32)
    away = RayBatch(batch.origins, -batch.directions, batch.pixel)
    for empty in (batch, away):
        outputs, context = field.render(empty, seed=1, step=2, options=OPTIONS)
        assert not outputs.color.any()
        ones = Outputs(np.ones_like(outputs.color), np.ones_like(outputs.opacity))
        assert not any(d.any() for d in field.render_backward(context, ones).values())


def test_half_the_step_takes_twice_the_samples_and_cameras_have_no_adjoint() -> None:
    field = nerf(np.float32, 16)
    assert field.with_dt(0.025).policy.importance == 32
    with pytest.raises(RangeError, match=r"samples that do not move with the camera, got import"):
        field.render(
            rays(2, np.float32), seed=0, step=0, options=RenderOptions(camera_adjoint=True)
        )
    with pytest.raises(RangeError, match=r"NerfPolicy: importance"):
        NerfPolicy(BOX, 0.05, importance=-1)
