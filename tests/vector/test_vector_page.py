"""The code of docs/vector.md runs, and its gradient is that of its loss."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from photograd.vector import DrawingParameters

from support.tree import ROOT


def test_the_code_runs_and_the_gradient_agrees_with_central_differences() -> None:
    page = (ROOT / "docs/vector.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    setup, forward, backward = (compile(block, "vector.md", "exec") for block in blocks)
    names: dict[str, Any] = {}
    for code in (setup, forward, backward):
        exec(code, names)
    drawing = names["drawing"]
    numbers = drawing.parameters.arrays()
    for name, found in names["gradients"].arrays().items():
        direction = np.random.default_rng(1).uniform(-1, 1, found.shape)
        losses = []
        for h in (1e-6, -1e-6):
            parameters = DrawingParameters(**(numbers | {name: numbers[name] + h * direction}))
            moved = names | {"drawing": drawing.with_parameters(parameters)}
            exec(forward, moved)
            losses.append((moved["picture"] ** 2).mean())
        numeric = (losses[0] - losses[1]) / 2e-6
        assert (found * direction).sum() == pytest.approx(numeric, rel=1e-5)
