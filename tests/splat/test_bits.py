"""The same bits on any number of threads and every instruction set; float against double."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.splats.splatting import SplatOptions, render, render_backward

from support.instruction_sets import assert_same_bits
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


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_thread_count_changes_nothing(dtype: Any) -> None:
    results = []
    for threads in (1, 2, 5):
        _core.set_thread_count(threads)
        results.append(run("default", dtype, 9000))  # three tasks of Gaussians
    _core.set_thread_count(0)
    for other in results[1:]:
        for a, b in zip(results[0], other, strict=True):
            assert a.any()
            assert np.array_equal(a, b)


def test_every_instruction_set_gives_the_same_bits() -> None:
    assert_same_bits(
        "import hashlib; from tests.splat.test_bits import run, OPTIONS\n"
        "for v in OPTIONS:\n"
        "    print(*(hashlib.sha256(a.tobytes()).hexdigest() for a in run(v)))"
    )


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
