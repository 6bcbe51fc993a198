"""The code of docs/caustics.md runs; its figure's script says what the page says, in small."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.caustics.measure import correlation
from photograd.transport.mesh_files import read_model
from PIL import Image

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_caustic_design as figure


def test_the_code_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = (ROOT / "docs/caustics.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(block, "caustics.md", "exec"), names)
    assert names["found"].correlation > 0.9
    assert len(read_model(tmp_path / "lens.stl").shapes[0].faces) == 2 * 2 * 32 * 32 + 2 * 4 * 32


def test_the_figure_in_small() -> None:
    """32 x 32 cells: transport is near, descent nearer, and power is kept."""
    start, best, plane = figure.designs(32, 65, 12)
    assert 0.9 < correlation(start, best.target) < best.correlation
    assert plane.correlation > 0.5
    assert best.caustic.received == pytest.approx(best.caustic.emitted * 0.96**2, rel=0.01)
    drawn = figure.design_figure(start, best, plane)
    assert len(drawn.axes) == 6


def test_the_picture_is_there_and_large_enough() -> None:
    with Image.open(figure.IMAGES / "caustic_design.png") as picture:
        assert picture.width >= 960
        assert np.ptp(np.asarray(picture.convert("L"))) > 100
