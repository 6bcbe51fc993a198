"""photograd.torch: tensors in, tensors out, and gradients that are the project's adjoints.

PyTorch is installed by choice: `./run test --all` has it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import photograd
import pytest
from photograd.errors import RangeError
from photograd.fields import DenseGrid
from photograd.raster import soft_silhouette, soft_silhouette_backward

from support.missing import need_module
from tests.bridges.renderers import CASES, adjoint, case, cotangents

pytestmark = pytest.mark.usefixtures("core")
torch: Any = need_module("torch", by_choice=True)


def tensors(name: str) -> dict[str, Any]:
    found = {key: torch.from_numpy(array.copy()) for key, array in case(name).inputs.items()}
    return {key: tensor.requires_grad_() for key, tensor in found.items()}


@pytest.mark.parametrize("name", CASES)
def test_gradients_are_the_adjoints(name: str) -> None:
    this, given = case(name), tensors(name)
    pair = this.pair(tuple(given))
    outputs = this.call(photograd.torch, given)
    expected = pair.forward(this.inputs)[0]
    for output, array in zip(outputs, expected.values(), strict=True):
        assert np.array_equal(output.detach().numpy(), array)
        assert output.dtype == torch.float64
    loss = sum(
        (output * torch.from_numpy(d)).sum()
        for output, d in zip(outputs, cotangents(pair).values(), strict=True)
    )
    loss.backward()
    for key, d in adjoint(name).items():
        assert np.array_equal(given[key].grad.numpy(), d), key
        assert d.any()


@pytest.mark.parametrize("name", ["grid", "splats"])
def test_gradcheck_of_torch_agrees(name: str) -> None:
    this, given = case(name), tensors(name)
    names = tuple(given)
    chosen = dict(list(given.items())[:1]) if name == "grid" else given
    fixed = {key: value.detach() for key, value in given.items()}

    def function(*values: Any) -> Any:
        return this.call(photograd.torch, {**fixed, **dict(zip(chosen, values, strict=True))})

    assert set(chosen) <= set(names)
    assert torch.autograd.gradcheck(function, tuple(chosen.values()), fast_mode=True)


def test_memory_is_shared_and_changes_are_noticed() -> None:
    seen: list[Any] = []

    def forward(x: Any) -> Any:
        seen.append(x)
        return (2 * x,), x

    given = torch.ones(5, dtype=torch.float64, requires_grad=True)
    (double,) = photograd.torch.apply(forward, lambda _x, d: (2 * d,), given)
    assert np.shares_memory(seen[0], given.detach().numpy())
    with torch.no_grad():
        given += 1
    with pytest.raises(RuntimeError, match="modified by an inplace operation"):
        double.sum().backward()


def test_any_pair_of_the_project_can_be_applied() -> None:
    faces = np.array([[0, 1, 2]])
    corners = np.array([[2.0, 2.0, 1.0], [9.0, 3.0, 1.0], [4.0, 9.0, 1.0]])

    def forward(positions: Any) -> Any:
        return (soft_silhouette(positions, faces, (12, 12), 2.0),), positions

    def backward(positions: Any, d_silhouette: Any) -> Any:
        return (soft_silhouette_backward(positions, faces, d_silhouette, 2.0),)

    given = torch.tensor(corners, requires_grad=True)
    assert torch.autograd.gradcheck(
        lambda x: photograd.torch.apply(forward, backward, x), (given,), fast_mode=True
    )


def test_single_precision_and_unused_outputs() -> None:
    field = DenseGrid.example(seed=1, dtype=np.float32)
    values = torch.from_numpy(field.params["values"]).requires_grad_()
    rendered = photograd.torch.render(field, {"values": values}, field.example_batch(seed=1))
    rendered.opacity.sum().backward()
    assert rendered.color.dtype == torch.float32
    assert values.grad.dtype == torch.float32
    assert values.grad[..., 3].abs().max() > 0
    assert values.grad[..., :3].abs().max() == 0  # opacity has no color
    with pytest.raises(RangeError, match=r"values: expected a tensor of floating-point numbers"):
        photograd.torch.render(field, dict(field.params), field.example_batch(seed=1))
