"""Derivatives with respect to texels of an environment map, alone and through samples."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.lights import EnvironmentMap, about_y
from photograd_course.gradcheck import check_accumulation, check_gradient, dot_product_error
from photograd_course.mutants import check_overwriting_mutants
from photograd_course.random import uniform

from light.seen import POINT, UP, texels
from support.gradient_mutants import check_gradient_mutants
from support.light_proofs import square

COUNT = 300
LIGHT = EnvironmentMap(texels(4), about_y(0.7), 0.3)


class Proof:
    """Radiance of fixed directions as a function of the texels."""

    def __init__(self, function: str) -> None:
        self.core, (emission, *self.rest) = LIGHT.core_call(np.float64)
        (self.name,) = LIGHT.named(emission)
        self.place = {self.name: emission}
        self.function = function
        self.points = np.tile(POINT, (COUNT, 1))
        samples = LIGHT.sample(self.points, square(COUNT, seed=51))
        keep = samples.pdf > 0
        self.points, self.w = self.points[keep], samples.direction[keep]
        self.d = 0.5 + uniform(52, pixel=np.arange(keep.sum())[:, None], dimension=np.arange(3))

    def forward(self, groups: dict[str, Any]) -> Any:
        return self.core.radiance(groups[self.name], *self.rest, self.points, self.w)

    def accumulate(self, groups: dict[str, Any], d: Any, d_groups: dict[str, Any]) -> None:
        backward = getattr(self.core, self.function)
        d = np.ascontiguousarray(d)
        backward(groups[self.name], *self.rest, self.points, self.w, d, d_groups[self.name])

    def backward(self, groups: dict[str, Any], d: Any) -> dict[str, Any]:
        d_groups = {self.name: np.zeros_like(groups[self.name])}
        self.accumulate(groups, d, d_groups)
        return d_groups

    def jvp(self, _: dict[str, Any], directions: dict[str, Any]) -> Any:
        """Radiance is linear in emission, but the core refuses a negative one: two halves."""
        v = directions[self.name]
        return self.forward({self.name: np.maximum(v, 0.0)}) - self.forward(
            {self.name: np.maximum(-v, 0.0)}
        )


@pytest.mark.parametrize("function", ["radiance_backward", "sample_backward"])
def test_gradients(function: str) -> None:
    proof = Proof(function)
    report: Any = check_gradient(proof.forward, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = dot_product_error(proof.jvp, proof.backward, proof.place, seed=1)
    assert report, str(report)
    report = check_accumulation(proof.accumulate, proof.place, proof.d)
    assert report, str(report)
    report = check_gradient_mutants(proof.forward, proof.backward, proof.place, proof.d, seed=1)
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, proof.place, proof.d),
        proof.accumulate,
        proof.place,
        proof.d,
    )
    assert report, str(report)


def test_a_shifted_or_unwrapped_adjoint_is_seen() -> None:
    proof = Proof("radiance_backward")

    def shifted(groups: Any, d: Any) -> Any:
        return {"texels": np.roll(proof.backward(groups, d)["texels"], 1, axis=1)}

    def unwrapped(groups: Any, d: Any) -> Any:
        found = proof.backward(groups, d)["texels"]
        found[:, 0] = 0.0
        return {"texels": found}

    for wrong in (shifted, unwrapped):
        assert not check_gradient(proof.forward, wrong, proof.place, seed=1)


def irradiance_gradient(light: EnvironmentMap, *, seed: int) -> tuple[Any, Any]:
    """d(irradiance at UP)/dtexels of the first channel by samples: mean and standard error."""
    parts = []
    for batch in range(20):
        u2 = square(5000, seed=seed + batch)
        points = np.zeros((5000, 3))
        samples = light.sample(points, u2)
        cosine = np.maximum(samples.direction @ UP, 0.0) / samples.pdf / len(points)
        d = np.repeat(cosine[:, None], 3, axis=1)
        parts.append(light.sample_backward(points, samples, d)["texels"][..., 0])
    stack = np.stack(parts)
    return stack.mean(axis=0), stack.std(axis=0, ddof=1) / np.sqrt(len(parts))


def known_gradient(height: int) -> Any:
    """The same by the midpoint rule on all directions."""
    rows = 256
    h = 1.0 - (np.arange(rows) + 0.5) * 2.0 / rows
    phi = (np.arange(2 * rows) + 0.5) * np.pi / rows
    y, p = (part.ravel() for part in np.meshgrid(h, phi, indexing="ij"))
    r = np.sqrt(1.0 - y * y)
    w = np.ascontiguousarray(np.stack([r * np.cos(p), y, r * np.sin(p)], axis=1))
    light = EnvironmentMap(np.ones((height, 2 * height, 3)))
    d = np.repeat(np.maximum(w @ UP, 0.0)[:, None] * (4.0 * np.pi / len(w)), 3, axis=1)
    return light.L_backward(np.zeros_like(w), w, d)["texels"][..., 0]


def test_black_texels_learn_only_from_the_uniform_share() -> None:
    image = texels(4)
    image[:, 2:6] = 0.0  # a black window; its middle has no bright neighbor
    known = known_gradient(4)
    # dE/dtexels sums to the integral of the cosine.
    np.testing.assert_allclose(known.sum(), np.pi, rtol=1e-3)
    assert known[:, 3:5].max() > 0.01
    blind, _ = irradiance_gradient(EnvironmentMap(image), seed=60)
    assert (blind[:, 3:5] == 0.0).all()
    found, error = irradiance_gradient(EnvironmentMap(image, uniform_share=0.3), seed=60)
    # Student's t with 19 degrees of freedom: 7 standard errors are 1e-6; quadrature adds 1e-4.
    assert (np.abs(found - known) <= 7.0 * error + 1e-4).all()
    assert error.max() < 0.05


def test_texels_may_change_under_a_sampler_that_stays() -> None:
    start = EnvironmentMap(np.ones((4, 8, 3)), uniform_share=0.5)
    later = start.with_texels(texels(4))
    u2, points = square(1000, seed=70), np.zeros((1000, 3))
    a, b = start.sample(points, u2), later.sample(points, u2)
    np.testing.assert_array_equal(a.direction, b.direction)
    np.testing.assert_array_equal(a.pdf, b.pdf)
    # A sample knows its place in the map; a lookup finds it again, but for rounding: 2.4e-14.
    np.testing.assert_allclose(b.radiance, later.L(points, b.direction), rtol=1e-12)
    assert np.abs(a.radiance - b.radiance).max() > 0.1
    fresh = EnvironmentMap(texels(4), uniform_share=0.5)
    estimates = [
        (s.radiance[:, 0] / s.pdf)
        for s in (
            light.sample(np.zeros((100_000, 3)), square(100_000, seed=71))
            for light in (later, fresh)
        )
    ]
    means = [e.mean() for e in estimates]
    errors = [e.std() / np.sqrt(len(e)) for e in estimates]
    assert abs(means[0] - means[1]) < 5.0 * np.hypot(*errors)
    assert errors[1] < errors[0], "a table made from the light itself is less noisy"
