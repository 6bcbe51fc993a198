"""The proofs that `photograd.check_gradients` runs: on instances, and on wrong adjoints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import photograd
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.fields import DenseGrid
from photograd.representation import Outputs, ParamSpec, RayBatch, Representation


class Sky(Representation):
    """color = matrix @ (direction, 1)."""

    name, capabilities = "sky", frozenset({"rays"})

    def __init__(self, matrix: Any) -> None:
        self.params = {"matrix": matrix}

    @classmethod
    def example(cls, *, seed: int, dtype: Any = np.float64) -> Sky:
        return cls(np.random.default_rng(seed).random((3, 4)).astype(dtype))

    def example_batch(self, *, seed: int) -> RayBatch:
        d = np.random.default_rng(seed).normal(size=(20, 3))
        d /= np.linalg.norm(d, axis=1, keepdims=True)
        return RayBatch(0 * d, d, np.arange(20, dtype=np.uint32))

    def param_groups(self) -> Mapping[str, ParamSpec]:
        return {"matrix": ParamSpec((3, 4), "1", (-np.inf, np.inf), 0.01, "world")}

    def render(self, batch: RayBatch, **_: Any) -> tuple[Outputs, Any]:
        context = np.c_[batch.directions, np.ones(len(batch.directions))]
        return Outputs(context @ self.params["matrix"].T), context

    def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
        return {"matrix": d_outputs.color.T @ context}


def test_a_class_and_an_instance_of_a_user() -> None:
    own = Sky(np.ones((3, 4), np.float32))
    for given in (Sky, own):
        checks = photograd.check_gradients(given, seed=1)
        assert checks, str(checks)
        assert checks.taylor.linear
        assert checks.differences.groups[0].name == "matrix"
    assert own.params["matrix"].dtype == np.float32
    text = str(checks)
    assert all(word in text for word in ("gradient check passed", "dot product", "Taylor"))


def test_an_instance_and_a_batch_of_one_of_ours() -> None:
    field = DenseGrid.example(seed=3, dtype=np.float32)
    before = field.params["values"].tobytes()
    batch = DenseGrid.example(seed=4).example_batch(seed=5)
    checks = photograd.check_gradients(field, batch=batch, camera=True)
    assert checks, str(checks)
    assert checks.camera is not None
    assert field.params["values"].tobytes() == before


@pytest.mark.parametrize(
    "wrong",
    [
        lambda d: 2 * d,
        lambda d: -d,
        lambda d: d * [[1, 1, 1, 0]],
        lambda d: d[::-1],
        lambda d: d + 1e-4 * np.abs(d).max(),
    ],
)
def test_wrong_adjoints_fail_every_proof(wrong: Any) -> None:
    class Wrong(Sky):
        def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
            return {"matrix": wrong(super().render_backward(context, d_outputs)["matrix"])}

    checks = photograd.check_gradients(Wrong)
    assert not checks
    assert not checks.differences
    assert not checks.dot_product
    assert not checks.taylor
    assert "FAILED" in str(checks)


def test_a_missing_gradient_is_named() -> None:
    class Forgetful(Sky):
        def render_backward(self, context: Any, d_outputs: Outputs) -> dict[str, Any]:
            del context, d_outputs
            return {}

    with pytest.raises(ShapeError, match=r"a gradient for each of \['matrix'\], got \[\]"):
        photograd.check_gradients(Forgetful)
    with pytest.raises(ShapeError, match=r"a gradient for each of \['directions', 'origins'\]"):
        photograd.check_gradients(Sky, camera=True)


@pytest.mark.parametrize("given", [3, "dense_grid", int])
def test_what_is_no_representation_is_refused(given: Any) -> None:
    with pytest.raises(DtypeError, match=r"^check_gradients: representation: expected a Rep"):
        photograd.check_gradients(given)


@pytest.mark.parametrize(
    ("groups", "error", "words"),
    [
        ({}, RangeError, r"groups: expected \['matrix'\], got \[\]"),
        ({"matrix": ParamSpec((7,), "1", (0, 1), 1, "none")}, ShapeError, "shape of 'matrix'"),
        ({"matrix": ParamSpec((3, 4), "1", (50, 60), 1, "none")}, RangeError, "range of 'matrix'"),
        ({"matrix": ParamSpec((3, 4), "1", (0, 1), 1, "wrld")}, RangeError, "frame of 'matrix'"),
    ],
)
def test_groups_that_do_not_describe_the_parameters(
    groups: Any, error: type[Exception], words: str
) -> None:
    class Misdescribed(Sky):
        def param_groups(self) -> Mapping[str, ParamSpec]:
            described: Mapping[str, ParamSpec] = groups
            return described

    with pytest.raises(error, match=rf"^sky\.param_groups: {words}"):
        photograd.check_gradients(Misdescribed)


def test_a_render_without_context_and_a_field_without_params() -> None:
    class Bare(Sky):
        def render(self, batch: RayBatch, **_: Any) -> Any:
            return super().render(batch)[0]

    with pytest.raises(DtypeError, match=r"^sky\.render: return value: expected a pair"):
        photograd.check_gradients(Bare)

    class Forgetful(Sky):
        def __init__(self, matrix: Any) -> None:
            del matrix

    with pytest.raises(DtypeError, match=r"^sky: params: expected .*__init__"):
        photograd.check_gradients(Forgetful)
