"""docs/bridges.md: its blocks run, and what it says of the loss holds (`./run test --all`)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from support.missing import need_module
from support.tree import ROOT

pytestmark = pytest.mark.usefixtures("core")


def blocks() -> list[str]:
    page = (ROOT / "docs/bridges.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def run(number: int, library: str) -> dict[str, Any]:
    need_module(library, by_choice=True)
    names: dict[str, Any] = {}
    exec(compile(blocks()[number], f"bridges.md block {number}", "exec"), names)
    return names


def test_a_network_learns_through_the_renderer() -> None:
    names = run(0, "torch")
    losses = names["losses"]
    assert losses[0] > 1e-3
    assert losses[-1] < 0.1 * losses[0]
    assert all(p.grad.abs().max() > 0 for p in names["network"].parameters())


def test_jax_compiles_the_gradient() -> None:
    names = run(1, "jax")
    values = names["field"].params["values"]
    found = np.asarray(names["slope"](values))
    assert found.shape == values.shape
    assert np.abs(found).max() > 0


def test_paths_and_any_pair() -> None:
    assert (run(2, "torch")["albedo"].grad > 0).all()
    assert run(3, "torch")["corners"].grad.abs().max() > 0
    assert len(blocks()) == 4
