"""The rays per second that a fit shows are those of many steps, whichever step is asked about."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd.fitting.loop import Fit
from photograd.fitting.options import Pace, Progress

from tests.fit import scene


def test_one_long_step_among_short_ones_does_not_hide_their_pace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps of 0.1 s, and every eightieth one of 2 s, as pruning takes."""
    now = 100.0

    def step(fit: Fit) -> float:
        nonlocal now
        fit.step_number += 1
        now += 2.0 if fit.step_number % 80 == 0 else 0.1
        fit.history.append((fit.step_number, 0.5, 3.0))
        return 0.5

    monkeypatch.setattr("photograd.fitting.loop.time.perf_counter", lambda: now)
    monkeypatch.setattr(Fit, "step", step)
    monkeypatch.setattr(Fit, "save", lambda *_: None)
    monkeypatch.setattr("photograd.fitting.loop.save_snapshot", lambda *_: None)
    seen: list[Progress] = []
    fit = Fit.start(scene.capture(), scene.options(steps=200, rays=2048))
    fit.run(tmp_path, on_step=seen.append)
    rates = {progress.step: progress.rays_per_second for progress in seen}
    assert rates[1] == pytest.approx(2048 / 0.1)
    # Five seconds are 50 short steps, or 32 of which one is long.
    assert rates[159] == pytest.approx(2048 / 0.1)
    assert rates[160] == pytest.approx(2048 * 32 / (31 * 0.1 + 2.0))
    assert rates[170] == pytest.approx(2048 * 32 / (31 * 0.1 + 2.0))
    assert min(rates.values()) > 0.5 * 2048 / 0.1  # of the long step alone: a twentieth


def test_the_pace_covers_everything_until_there_is_enough() -> None:
    pace = Pace(0.0, steps=2, seconds=1.0)
    assert pace.after(10, 0.5) == pytest.approx(20.0)
    assert pace.after(10, 1.0) == pytest.approx(20.0)
    assert pace.after(10, 3.0) == pytest.approx(20 / 2.5)  # the last two steps
    assert pace.after(10, 3.1) == pytest.approx(20 / 2.1)
