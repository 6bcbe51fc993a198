"""What the picture of `photograd evaluate` shows: which views, and which of their pixels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from photograd.capture.load import load_capture
from photograd.commands import compare
from photograd.commands.evaluate import picked_views
from photograd.fitting.compare import parse_candidates
from photograd.fitting.evaluate import evaluate
from photograd.fitting.model import load_model
from photograd_course import viz

from support import capture_files as files
from tests.commands.conftest import Photograd
from tests.fit import scene


@pytest.mark.parametrize(
    ("psnr", "picked"),
    [
        ([20.0], [0]),
        ([21.0, 20.0], [1, 0]),
        ([21.0, 20.0, 22.0], [1, 0, 2]),
        ([25.0, 21.0, 20.0, 22.0, 23.0], [2, 3, 0]),
    ],
)
def test_no_view_is_shown_twice_and_worst_comes_first(psnr: list[float], picked: list[int]) -> None:
    assert picked_views(psnr) == picked


def test_the_border_of_a_lens_is_reported_and_not_drawn_as_an_error(
    photograd: Photograd, model_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    figures: list[Any] = []
    draw = viz.comparison_strips

    def keep(*args: Any, **options: Any) -> Any:
        figures.append((draw(*args, **options), options["caption"]))
        return figures[-1][0]

    monkeypatch.setattr(viz, "comparison_strips", keep)
    capture = tmp_path / "capture"
    files.write_nerfstudio(capture, scene.cameras(9, elevation=15.0), camera_model="OPENCV", k1=0.1)
    done = photograd("evaluate", model_folder, capture, "--json", "--out", tmp_path / "out.png")
    assert done.code == 0, done.err
    views = load_capture(capture).test
    shares = [view.valid_mask().mean() for view in views]
    assert 0.7 < max(shares) < 1
    assert [view["valid_share"] for view in done.result()["views"]] == shares
    assert "over valid pixels" in done.result()["protocol"]
    result = evaluate(load_model(model_folder), views)
    labels = parse_candidates("dense_grid:8,dense_grid:16")
    compare.draw([result, result], labels, "balls", tmp_path / "compare.png")
    for figure, caption in figures:
        errors = [a.images[0].get_array() for a in figure.axes if a.get_xlabel().endswith("dB")]
        assert len(errors) == len(views)
        for error in errors:
            assert (error.mask == ~views[0].valid_mask()).all()
        assert caption.endswith(" Gray: not valid, not scored.")
    assert len(figures) == 2
