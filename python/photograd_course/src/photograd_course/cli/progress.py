"""How far a long computation has come: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as RichProgress
from rich.text import Text

from ..checks import require_integer
from ..errors import RangeError, message
from ..suggest import choose_from

REFRESH_S = 0.1  # seconds between two pictures of the bar
UNKNOWN = "\N{EN DASH}"


@dataclass(frozen=True)
class Column:
    """One number beside the bar, for example ``Column("loss", "{:.3e}".format)``."""

    name: str
    form: Callable[[float], str]
    label: str | None = None  # what is printed before the number; the name if None


class Progress:
    """A context manager that shows steps, the given columns and the time left, on stderr.

    >>> import io
    >>> with Progress("fit", 2, [Column("loss", "{:.1e}".format)], stream=io.StringIO()) as bar:
    ...     bar.update(1, loss=0.5)
    """

    def __init__(
        self,
        title: str,
        total: int,
        columns: Sequence[Column] = (),
        *,
        start: int = 0,
        stream: TextIO | None = None,
        interval_s: float = 5.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Nothing is shown before the ``with`` block begins.

        Args:
            title: what is going on, in a word.
            total: the step at which it is done, at least 1.
            columns: the numbers to show, in order.
            start: the step at which it begins; a resumed run does not begin at 0.
            stream: where to write; stderr if None.
            interval_s: seconds between two lines where the stream is no terminal.
            clock: seconds from any origin.

        Raises:
            RangeError: ``total`` or ``start`` is no step.
        """
        self._title = title
        self._total = require_integer("Progress", "total", total, least=1)
        self._start = require_integer("Progress", "start", start, least=0, most=total)
        self._columns = {column.name: column for column in columns}
        self._interval_s = interval_s
        self._clock = clock
        self._console = Console(file=sys.stderr if stream is None else stream, highlight=False)
        self._step = self._start
        self._values: dict[str, float] = {}
        self._began = self._shown = clock()
        self._stale = True  # something has changed since it was last shown
        self._bar: RichProgress | None = None

    def __enter__(self) -> Progress:
        self._began = self._shown = self._clock()
        if self._console.is_terminal and not self._console.is_dumb_terminal:
            self._bar = RichProgress(
                TextColumn("[bold]{task.description}"),
                BarColumn(bar_width=None),
                MofNCompleteColumn(),
                TextColumn("{task.fields[numbers]}"),
                console=self._console,
                auto_refresh=False,  # no thread: drawn from update() only
                expand=True,
            )
            self._bar.start()
            self._bar.add_task(
                self._title, total=self._total, completed=self._start, numbers=self._numbers()
            )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._stale:
            self._show()
        if self._bar is not None:
            self._bar.stop()  # also puts the cursor back when an error flies through

    def update(self, step: int, **values: float) -> None:
        """Report that ``step`` steps are done; columns that are not given keep their number.

        Raises:
            RangeError: a step beyond the total, or a column that was not declared.
        """
        self._step = require_integer("update", "step", step, least=0, most=self._total)
        for name in values:
            if name not in self._columns:
                known = choose_from(name, self._columns)
                raise RangeError(message("update", name, "a declared column", "none", known))
        self._values.update(values)
        self._stale = True
        pause = self._interval_s if self._bar is None else REFRESH_S
        if self._clock() - self._shown >= pause:
            self._show()

    def seconds_left(self) -> float | None:
        """At the pace since the start; None before the first step is done."""
        done = self._step - self._start
        if done <= 0:
            return None
        return (self._clock() - self._began) * (self._total - self._step) / done

    def _show(self) -> None:
        self._shown, self._stale = self._clock(), False
        if self._bar is not None:
            task = self._bar.task_ids[0]
            self._bar.update(task, completed=self._step, numbers=self._numbers(), refresh=True)
            return
        share = 100 * self._step // self._total
        head = f"{self._title} {self._step}/{self._total} ({share} %)"
        self._console.print(Text(f"{head}  {self._numbers()}"), soft_wrap=True)

    def _numbers(self) -> str:
        parts = []
        for column in self._columns.values():
            value = self._values.get(column.name)
            shown = UNKNOWN if value is None else column.form(value)
            parts.append(f"{column.label or column.name} {shown}")
        return "  ".join([*parts, f"left {clock_text(self.seconds_left())}"])


def clock_text(seconds: float | None) -> str:
    """``m:ss`` or ``h:mm:ss``, rounded up, so that 0:00 means done."""
    if seconds is None:
        return UNKNOWN
    whole = math.ceil(seconds)
    hours, minutes, rest = whole // 3600, whole % 3600 // 60, whole % 60
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def short_number(value: float) -> str:
    """Three significant digits and a unit: 950, 12.3k, 4.56M, 7.89G.

    >>> short_number(1234567.0)
    '1.23M'
    """
    for factor, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        # 0.9995 of the unit rounds up to 1.00 of it rather than down to 1e+03 of the smaller one.
        if abs(value) >= 0.9995 * factor:
            scaled = value / factor
            digits = 2 if abs(scaled) < 9.995 else 1 if abs(scaled) < 99.95 else 0
            return f"{scaled:.{digits}f}{unit}"
    return f"{value:.3g}"
