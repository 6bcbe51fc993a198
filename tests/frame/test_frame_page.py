"""The code of docs/frame.md runs; its descent finds the exposure."""

from __future__ import annotations

import re
from typing import Any

import pytest

from support.tree import ROOT

pytestmark = pytest.mark.usefixtures("core")


def test_the_code_of_the_page_runs(capsys: pytest.CaptureFixture[str]) -> None:
    page = (ROOT / "docs/frame.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert len(blocks) == 3
    names: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, "frame.md", "exec"), names)
    assert names["picture"].shape == (64, 64, 3)
    assert "tone map" in capsys.readouterr().out
    assert names["frame"]["history"].frames == 2
    assert abs(names["exposure"] - 0.7) < 1e-3
