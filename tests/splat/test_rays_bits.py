"""Registers pictures and gradients for the test of bits; float against double."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.splats.rays import RayOptions, render, render_backward

from support.bits import same_bits
from tests.splat import oracle, ray_oracle

OPTIONS = {
    "default": RayOptions(),
    "smooth": RayOptions().smooth(),
    "short": replace(RayOptions(), stop=0.2),
}


def run(name: str, dtype: Any = np.float32, count: int = 300, rays: int = 700) -> list[Any]:
    """All outputs and gradients of several tasks of rays and Gaussians."""
    g = oracle.cloud(count, 1).astype(dtype)
    origins, directions = ray_oracle.rays(rays, 4)
    # Both number types start from the same values.
    origins, directions = origins.astype(np.float32), directions.astype(np.float32)
    picture, context = render(
        g, origins, directions, background=(0.25, 0.5, 0.125), options=OPTIONS[name]
    )
    random = np.random.default_rng(2)
    d = [random.uniform(-1, 1, a.shape).astype(dtype) for a in vars(picture).values()]
    found = render_backward(context, *d, rays=True)
    return [
        *vars(picture).values(),
        *found.gaussians.values(),
        found.background,
        found.origins,
        found.directions,
    ]


@same_bits("splats on rays", each=("float32", "float64"))
def many_splats(dtype: str) -> list[Any]:
    return run("default", np.dtype(dtype), 5000)  # two tasks of preparation


@same_bits("splats on rays with options", each=OPTIONS)
def results_with_options(name: str) -> list[Any]:
    return run(name)


def test_several_slabs_add_up_to_one_picture() -> None:
    # 1.2 million crossings are two slabs; the same rays in two batches are one slab each.
    g = oracle.cloud(300, 1, degree=0).astype(np.float32)
    origins, directions = ray_oracle.rays(4400, 4)
    d = np.random.default_rng(2).uniform(0, 1, (4400, 3)).astype(np.float32)

    def gradients(part: slice) -> Any:
        _, context = render(g, origins[part], directions[part], options=OPTIONS["smooth"])
        return context.crossings, render_backward(context, d[part]).gaussians

    crossings, whole = gradients(slice(None))
    assert crossings.sum() > 2**20
    halves = [gradients(part)[1] for part in (slice(0, 2200), slice(2200, None))]
    for name, array in whole.items():
        np.testing.assert_allclose(
            halves[0][name] + halves[1][name], array, rtol=1e-5, atol=1e-5 * np.abs(array).max()
        )


@pytest.mark.parametrize("name", OPTIONS)
def test_float_agrees_with_double(name: str) -> None:
    narrow, wide = run(name), run(name, np.float64)
    for a, b in zip(narrow, wide, strict=True):
        error = np.linalg.norm(a - b) / np.linalg.norm(b)
        assert error <= 1e-4, (a.shape, error)


def test_backward_twice_gives_twice() -> None:
    g, (origins, directions) = oracle.cloud(30, 1), ray_oracle.rays(50, 1)
    picture, context = render(g, origins, directions)
    parameters, image = list(g.arrays().values()), list(vars(picture).values())
    d_image = [np.ones_like(v) for v in image]
    gradients, background = [np.zeros_like(v) for v in parameters], np.zeros(3)
    rays = [np.zeros((50, 3)), np.zeros((50, 3))]
    context.prepared.backward(parameters, image, d_image, gradients, background, rays)
    once = [v.copy() for v in (*gradients, background, *rays)]
    context.prepared.backward(parameters, image, d_image, gradients, background, rays)
    for twice, v in zip((*gradients, background, *rays), once, strict=True):
        np.testing.assert_allclose(twice, 2 * v, rtol=1e-12, atol=1e-12)
