"""Schedules at points computed by hand."""

from __future__ import annotations

import pytest
from photograd_course import schedules
from photograd_course.errors import DtypeError, RangeError


def test_values_by_hand() -> None:
    assert schedules.constant(0.3)(17) == 0.3
    falling = schedules.exponential(0.01, 100)
    assert [falling(0), falling(100), falling(1000)] == [1.0, 0.01, 0.01]
    assert falling(50) == pytest.approx(0.1, rel=1e-15)
    half = schedules.cosine(10, final=0.2)
    assert half(0) == 1.0
    assert half(5) == pytest.approx(0.6, rel=1e-15)
    assert half(10) == half(11) == pytest.approx(0.2, rel=1e-15)
    stairs = schedules.step_decay(3, 0.5)
    assert [stairs(step) for step in (0, 2, 3, 5, 6)] == [1.0, 1.0, 0.5, 0.5, 0.25]
    rising = schedules.warmup(4, schedules.constant(2.0))
    assert [rising(step) for step in range(6)] == [0.5, 1.0, 1.5, 2.0, 2.0, 2.0]
    assert schedules.warmup(2, stairs)(3) == 0.5


def test_bad_input_is_refused() -> None:
    with pytest.raises(RangeError, match="final"):
        schedules.exponential(0.0, 10)
    with pytest.raises(RangeError, match="steps"):
        schedules.cosine(0)
    for schedule in (schedules.constant(), schedules.cosine(3), schedules.step_decay(1, 0.5)):
        with pytest.raises(RangeError, match="step"):
            schedule(-1)
        with pytest.raises(DtypeError, match="step"):
            schedule(1.5)  # type: ignore[arg-type]
