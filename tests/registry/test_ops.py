"""Every op of the list is proved: T1, T2, T3, accumulation, float against double, mutants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.gradcheck import (
    check_accumulation,
    check_gradient,
    dot_product_error,
    taylor_slope,
)
from photograd_course.mutants import check_overwriting_mutants
from photograd_course.random import uniform

from support.gradient_mutants import check_gradient_mutants

OPS = sorted(_core.ops)


def draw(op: Any, seed: int) -> dict[str, Any]:
    """A random place inside of each group's range."""
    groups = {}
    for number, (name, size, lo, hi) in enumerate(op.inputs):
        u = uniform(seed, step=number, pixel=np.arange(size), sample=0, dimension=0)
        groups[name] = lo + (hi - lo) * (0.02 + 0.96 * u)
    return groups


def flat(op: Any, groups: dict[str, Any]) -> Any:
    return np.concatenate([np.asarray(groups[name]) for name, *_ in op.inputs])


def split(op: Any, x: Any) -> dict[str, Any]:
    ends = np.cumsum([size for _, size, *_ in op.inputs])[:-1]
    return {name: part for (name, *_), part in zip(op.inputs, np.split(x, ends), strict=True)}


class Proof:
    """An op in the form the checks take."""

    def __init__(self, name: str) -> None:
        self.op = _core.ops[name]

    def forward(self, groups: dict[str, Any]) -> Any:
        return self.op.forward(flat(self.op, groups))

    def backward(self, groups: dict[str, Any], d_y: Any) -> dict[str, Any]:
        x = flat(self.op, groups)
        return split(self.op, self.op.backward(x, np.ascontiguousarray(d_y), np.zeros_like(x)))

    def accumulate(self, groups: dict[str, Any], d_y: Any, d_groups: dict[str, Any]) -> None:
        buffer = flat(self.op, d_groups)
        self.op.backward(flat(self.op, groups), np.ascontiguousarray(d_y), buffer)
        for name, part in split(self.op, buffer).items():
            d_groups[name][...] = part

    def jvp(self, groups: dict[str, Any], directions: dict[str, Any]) -> Any:
        return self.op.jvp(flat(self.op, groups), flat(self.op, directions))


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("name", OPS)
def test_backward_agrees_with_central_differences(name: str, seed: int) -> None:
    proof = Proof(name)
    place = draw(proof.op, seed)
    report = check_gradient(proof.forward, proof.backward, place, seed=seed)
    assert report, str(report)


@pytest.mark.parametrize("name", OPS)
def test_backward_is_the_transpose_of_the_dual_derivative(name: str) -> None:
    proof = Proof(name)
    report = dot_product_error(proof.jvp, proof.backward, draw(proof.op, 4), seed=4)
    assert report, str(report)


@pytest.mark.parametrize("name", OPS)
def test_taylor_remainder_falls_quadratically(name: str) -> None:
    proof = Proof(name)
    report = taylor_slope(proof.forward, proof.backward, draw(proof.op, 5), seed=5)
    assert report, str(report)


@pytest.mark.parametrize("name", OPS)
def test_backward_adds_to_its_buffers(name: str) -> None:
    proof = Proof(name)
    report = check_accumulation(
        proof.accumulate, draw(proof.op, 6), proof.forward(draw(proof.op, 6))
    )
    assert report, str(report)


@pytest.mark.parametrize("name", OPS)
def test_float_agrees_with_double(name: str) -> None:
    # 1e-4 norm-relative: float rounding is 6e-8, and the longest sum here has 32 terms.
    op = _core.ops[name]
    x = flat(op, draw(op, 7))
    d_y = 0.5 - uniform(7, step=9, pixel=np.arange(op.outputs), sample=0, dimension=0)
    narrow = op.backward(x.astype("f4"), d_y.astype("f4"), np.zeros(len(x), "f4"))
    wide = op.backward(x, d_y, np.zeros_like(x))
    assert np.linalg.norm(wide) > 0
    assert np.linalg.norm(narrow - wide) <= 1e-4 * np.linalg.norm(wide)
    values = op.forward(x.astype("f4")) - op.forward(x)
    assert np.linalg.norm(values) <= 1e-5 * np.linalg.norm(op.forward(x))


@pytest.mark.parametrize("name", OPS)
def test_automatic_mutants_die(name: str) -> None:
    proof = Proof(name)
    place = draw(proof.op, 8)
    d_y = 0.5 + uniform(8, step=9, pixel=np.arange(proof.op.outputs), sample=0, dimension=0)
    report = check_gradient_mutants(
        proof.forward, proof.backward, place, d_y, seed=8, coordinates=8
    )
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda accumulate: check_accumulation(accumulate, place, d_y), proof.accumulate, place, d_y
    )
    assert report, str(report)
