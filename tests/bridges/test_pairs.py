"""What the bridges hand to PyTorch and JAX: pairs of NumPy functions, proved by differences."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import photograd
import pytest
from photograd._bridges import representation_pair, splat_pair, tracer_pair
from photograd.errors import DtypeError, IoError, RangeError, ShapeError
from photograd.fields import DenseGrid
from photograd.representation import RenderOptions
from photograd.transport.path_options import DEFAULTS
from photograd_course.gradcheck import check_gradient

from tests.bridges.renderers import CASES, adjoint, case, cotangents

pytestmark = pytest.mark.usefixtures("core")
NUMBERS: dict[str, Any] = {"seed": 0, "step": 0, "options": RenderOptions()}


@pytest.mark.parametrize("name", [name for name in CASES if name != "paths"])
def test_the_backward_pass_of_a_pair_is_its_derivative(name: str) -> None:
    this = case(name)
    pair = this.pair(tuple(this.inputs))

    def forward(arrays: Any) -> Any:
        return {k: v for k, v in pair.forward(arrays)[0].items() if v.any()}

    def backward(arrays: Any, d_outputs: Any) -> Any:
        return pair.backward(pair.forward(arrays)[1], d_outputs)

    outputs = pair.forward(this.inputs)[0]
    assert {k: v.shape for k, v in outputs.items()} == dict(pair.shapes)
    assert max(np.abs(v).max() for v in outputs.values()) > 0.01
    assert all(np.abs(d).max() > 0 for d in adjoint(name).values())
    report = check_gradient(forward, backward, this.inputs, seed=2, tolerance=1e-6, directions=4)
    assert report.passed, report


def test_light_comes_from_emitters_alone() -> None:
    """A picture is linear in all emission, so that emission times its gradient is the picture."""
    this, found = case("paths"), adjoint("paths")
    image = this.pair(tuple(this.inputs)).forward(this.inputs)[0]["image"]
    d_image = cotangents(this.pair(tuple(this.inputs)))["image"]
    emitted = [name for name in this.inputs if name.startswith("emission.")]
    assert emitted
    total = sum(float((this.inputs[name] * found[name]).sum()) for name in emitted)
    assert total == pytest.approx(float((image * d_image).sum()), rel=1e-9)  # measured 1e-15
    assert total > 0.1


def test_a_scene_stays_as_it_is() -> None:
    field = DenseGrid.example(seed=1)
    before = field.params["values"].copy()
    pair = representation_pair("t", field, ("values",), field.example_batch(seed=1), **NUMBERS)
    outputs, context = pair.forward({"values": before + 1})
    assert np.array_equal(field.params["values"], before)
    assert not np.array_equal(outputs["color"], pair.forward({"values": before})[0]["color"])
    found = pair.backward(context, {"color": np.ones_like(outputs["color"])})
    assert found["values"].shape == before.shape
    tracer = photograd.PathTracer(photograd.builtin_scene("cornell-box", 4))
    own = {name: array.copy() for name, array in tracer.params.items()}
    name = "materials.red.albedo"
    paths = {"spp": 2, "seed": 0, "backward_seed": 1, "options": DEFAULTS, "camera": None}
    traced = tracer_pair("t", tracer, (name,), **paths)  # type: ignore[arg-type]
    image, kept = traced.forward({name: np.full(3, 0.9)})
    slope = traced.backward(kept, {"image": np.ones_like(image["image"])})[name]
    assert slope.shape == (3,)
    assert slope.max() > 0
    assert all(np.array_equal(tracer.params[key], own[key]) for key in own)
    none = traced.backward(kept, {"image": None})[name]
    assert not none.any()


def test_wrong_names_and_shapes_are_refused() -> None:
    field = DenseGrid.example(seed=1)
    batch = field.example_batch(seed=1)
    with pytest.raises(RangeError, match="expected one of values, origins, directions, got 'colo"):
        representation_pair("t", field, ("colors",), batch, **NUMBERS)
    with pytest.raises(RangeError, match="at least one array"):
        representation_pair("t", field, (), batch, **NUMBERS)
    with pytest.raises(DtypeError, match="Representation"):
        representation_pair("t", field.params, ("values",), batch, **NUMBERS)  # type: ignore[arg-type]
    pair = representation_pair("t", field, ("values",), batch, **NUMBERS)
    with pytest.raises(ShapeError, match="values: expected shape"):
        pair.forward({"values": np.zeros((2, 2, 2, 4))})
    with pytest.raises(RangeError, match="got no quats"):
        splat_pair("t", ("means", "log_scales", "opacity_logits", "sh"), None, None)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["torch", "jax"])
def test_a_missing_package_is_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, name, None)
    field = DenseGrid.example(seed=1)
    module = getattr(photograd, name)
    with pytest.raises(IoError, match=rf"pip install 'photograd\[{name}\]'"):
        module.render(field, field.params, field.example_batch(seed=1))
