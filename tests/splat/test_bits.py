"""Registers pictures and gradients for the test of bits; float against double."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.splats.splatting import SplatOptions, render, render_backward

from support.bits import same_bits
from tests.splat import oracle

OPTIONS = {
    "default": SplatOptions(),
    "smooth": SplatOptions().smooth(),
    "antialiased": SplatOptions(antialiased=True, stop=1e-2),
}


def run(name: str, dtype: Any = np.float32, count: int = 300) -> list[Any]:
    """All outputs and gradients of a picture of several tiles; the last ones are not whole."""
    g = oracle.cloud(count, 1).astype(dtype)
    camera = oracle.camera(75, 53, 60.0)
    picture, context = render(g, camera, background=(0.3, 0.2, 0.1), options=OPTIONS[name])
    random = np.random.default_rng(2)
    d = [random.uniform(-1, 1, a.shape).astype(dtype) for a in vars(picture).values()]
    found = render_backward(context, *d)
    return [
        *vars(picture).values(),
        *found.gaussians.values(),
        found.background,
        found.camera_from_world,
        found.screen,
    ]


@same_bits("splats", each=("float32", "float64"))
def many_splats(dtype: str) -> list[Any]:
    return run("default", np.dtype(dtype), 9000)  # three tasks of Gaussians


@same_bits("splats with options", each=OPTIONS, kernels=("blend_tile", "blend_tile_backward"))
def results_with_options(name: str) -> list[Any]:
    return run(name)


@pytest.mark.parametrize("name", OPTIONS)
def test_float_agrees_with_double(name: str) -> None:
    narrow, wide = run(name), run(name, np.float64)
    for a, b in zip(narrow, wide, strict=True):
        error = np.linalg.norm(a - b) / np.linalg.norm(b)
        assert error <= 1e-4, (a.shape, error)


def test_backward_twice_gives_twice() -> None:
    g, camera = oracle.cloud(30, 1), oracle.camera()
    picture, context = render(g, camera)
    parameters, image = list(g.arrays().values()), list(vars(picture).values())
    d_image = [np.ones_like(v) for v in image]
    gradients = [np.zeros_like(v) for v in parameters]
    rest = [np.zeros((3, 4)), np.zeros(3), np.zeros((30, 2))]
    context.prepared.backward(parameters, image, d_image, gradients, *rest)
    once = [v.copy() for v in (*gradients, *rest)]
    context.prepared.backward(parameters, image, d_image, gradients, *rest)
    for twice, v in zip((*gradients, *rest), once, strict=True):
        np.testing.assert_allclose(twice, 2 * v, rtol=1e-12, atol=1e-12)
