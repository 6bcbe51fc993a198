"""A bar for work that takes longer than a few seconds, drawn by steps."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from .environment import kernel
from .stopwatch import Stopwatch

WIDTH = 30  # characters of a bar


class Progress:
    """One line, drawn again at each thirtieth of the steps, on a terminal or in a notebook."""

    def __init__(self, label: str, steps: int) -> None:
        """A bar at 0.

        Args:
            label: what is done, at the head of the line.
            steps: how many there are in all.
        """
        self._label, self._steps, self._done = label, max(1, steps), 0
        self._watch = Stopwatch()
        self._is_shown = sys.stderr.isatty() or kernel() is not None

    def step(self, note: str = "") -> None:
        """One more is done.

        Args:
            note: stands behind the bar.
        """
        self._done += 1
        filled = min(WIDTH, WIDTH * self._done // self._steps)
        if not self._is_shown or filled == WIDTH * (self._done - 1) // self._steps:
            return
        bar = "#" * filled + "." * (WIDTH - filled)
        line = f"\r{self._label} [{bar}] {self._done}/{self._steps}, {self._watch} {note} "
        sys.stderr.write(line + ("\n" if filled == WIDTH else ""))
        sys.stderr.flush()


@contextmanager
def count_calls(label: str, steps: int, module: ModuleType, name: str) -> Iterator[None]:
    """A bar for the calls of a function while a loop of the same module makes them.

    Args:
        label: what is done.
        steps: how many calls are expected.
        module: the student's; its function is wrapped until the block ends.
        name: of the function.
    """
    progress, function = Progress(label, steps), getattr(module, name)

    def counted(*arguments: Any, **named: Any) -> Any:
        progress.step()
        return function(*arguments, **named)

    setattr(module, name, counted)
    try:
        yield
    finally:
        setattr(module, name, function)
