"""docs/five_tasks.md runs, in few lines, and does what it says."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import photograd
import pytest
from photograd_course.cli import run
from PIL import Image
from tests.commands.test_trace import SCENE

from support.tree import ROOT

MOST_LINES = 9


def blocks() -> list[str]:
    page = (ROOT / "docs/five_tasks.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def test_the_first_four_tasks_take_less_than_ten_lines() -> None:
    assert len(blocks()) == 5
    assert all(len([line for line in b.splitlines() if line]) <= MOST_LINES for b in blocks()[:4])


@pytest.mark.usefixtures("core")
def test_the_tasks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    words = ["--scene", "toy_table", "--views", "4", "--test-views", "1", "--size", "16"]
    assert run(["capture", *words, "--spp", "1", "--out", "photos"]) == 0
    Path("room.toml").write_text(SCENE.replace("gray", "wall"), encoding="utf-8")
    names: dict[str, Any] = {}
    for number, block in enumerate(blocks()):
        exec(compile(block, f"five_tasks.md block {number}", "exec"), names)
    for picture in ("view.png", "loss.png", "gradient.png"):
        assert np.ptp(np.asarray(Image.open(picture).convert("L"))) > 0
    assert (names["gradients"]["materials.wall.albedo"] > 0).all()
    assert photograd.check_gradients(names["Stripes"])
