"""The code of docs/rasterizer.md runs, and its gradient is that of its loss."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from support.tree import ROOT

MOST_LINES = 12


def blocks() -> list[str]:
    page = (ROOT / "docs/rasterizer.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def test_a_picture_and_its_gradient_take_twelve_lines() -> None:
    assert len(blocks()) == 3
    assert sum(len(block.splitlines()) for block in blocks()[1:]) <= MOST_LINES


def test_the_code_runs_and_the_gradient_agrees_with_central_differences() -> None:
    setup, forward, backward = (compile(block, "rasterizer.md", "exec") for block in blocks())
    names: dict[str, Any] = {}
    for code in (setup, forward, backward):
        exec(code, names)
    assert names["visibility"].covered.sum() > 50
    for name, found in (("vertices", names["gradients"].vertices), ("colors", names["d_colors"])):
        direction = np.random.default_rng(1).uniform(-1, 1, found.shape)
        losses = []
        for h in (1e-6, -1e-6):
            moved = names | {name: names[name] + h * direction}
            exec(forward, moved)
            losses.append((moved["picture"] ** 2).mean())
        numeric = (losses[0] - losses[1]) / 2e-6
        assert (found * direction).sum() == pytest.approx(numeric, rel=1e-5)
