"""The bar shows what it is told, on a clock of our own, as lines or on a terminal."""

from __future__ import annotations

import io

import pytest
from photograd_course.cli import Column, Progress
from photograd_course.cli.progress import clock_text, short_number
from photograd_course.errors import RangeError

COLUMNS = [Column("loss", "{:.2e}".format), Column("rays", short_number, "rays/s")]


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_lines_every_few_seconds_and_at_the_end() -> None:
    stream, clock = io.StringIO(), Clock()
    with Progress("fit", 100, COLUMNS, stream=stream, interval_s=5.0, clock=clock) as bar:
        for step in range(1, 101):
            clock.now += 0.125  # exact in binary
            bar.update(step, loss=1.0 / step)
    assert stream.getvalue().splitlines() == [
        "fit 40/100 (40 %)  loss 2.50e-02  rays/s –  left 0:08",
        "fit 80/100 (80 %)  loss 1.25e-02  rays/s –  left 0:03",
        "fit 100/100 (100 %)  loss 1.00e-02  rays/s –  left 0:00",
    ]


def test_values_stay_and_a_resumed_run_counts_from_its_start() -> None:
    stream, clock = io.StringIO(), Clock()
    with Progress("fit", 100, COLUMNS, start=90, stream=stream, clock=clock) as bar:
        assert bar.seconds_left() is None
        clock.now += 4.0
        bar.update(92, loss=0.5, rays=1.25e6)
        assert bar.seconds_left() == 16.0  # 2 s a step, 8 steps to go
        clock.now += 2.0
        bar.update(93)
    assert stream.getvalue() == "fit 93/100 (93 %)  loss 5.00e-01  rays/s 1.25M  left 0:14\n"


def test_the_last_state_is_shown_when_an_error_ends_it() -> None:
    stream = io.StringIO()

    def fail() -> None:
        with Progress("fit", 10, stream=stream, clock=Clock()) as bar:
            bar.update(3)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert stream.getvalue().startswith("fit 3/10 (30 %)")


def test_a_terminal_gets_a_bar_that_is_redrawn_and_left_tidy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    for name in ("NO_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("COLUMNS", "100")
    stream, clock = Terminal(), Clock()
    with Progress("fit", 4, COLUMNS, stream=stream, clock=clock) as bar:
        for step in range(1, 5):
            clock.now += 1.0
            bar.update(step, loss=0.5)
    text = stream.getvalue()
    for part in ("1/4", "4/4", "loss 5.00e-01", "left 0:00", "\x1b[?25l", "\x1b[?25h"):
        assert part in text  # the last two hide the cursor and show it again


def test_wrong_use_is_refused() -> None:
    with pytest.raises(RangeError, match="total"):
        Progress("fit", 0)
    with Progress("fit", 10, COLUMNS, stream=io.StringIO()) as bar:
        with pytest.raises(RangeError, match="did you mean 'loss'"):
            bar.update(1, los=1.0)
        with pytest.raises(RangeError, match="step"):
            bar.update(11)


def test_texts_of_numbers_and_times() -> None:
    assert [clock_text(s) for s in (None, 0.0, 0.2, 59.5, 61.0, 3661.0)] == [
        "–",
        "0:00",
        "0:01",
        "1:00",
        "1:01",
        "1:01:01",
    ]
    numbers = (0.0, 950.0, 999.6, 12_345.0, 99_960.0, 4.56e6, 7.891e9, -2e3)
    shown = ["0", "950", "1.00k", "12.3k", "100k", "4.56M", "7.89G", "-2.00k"]
    assert [short_number(number) for number in numbers] == shown
