"""Times that are printed, and decide nothing."""

from __future__ import annotations

import time


class Stopwatch:
    """The time since it was made, as a text.

    No number comes out of it. What an exploration computes depends on its options and not on the
    machine, so that the same seed gives the same picture.
    """

    def __init__(self) -> None:
        self._start = time.perf_counter()
        self._end: float | None = None

    def stop(self) -> Stopwatch:
        """Keep the time that has passed until now."""
        self._end = time.perf_counter()
        return self

    def __str__(self) -> str:
        """In seconds, below a tenth of a second in milliseconds."""
        seconds = self._seconds()
        return f"{seconds:.1f} s" if seconds >= 0.1 else f"{1000 * seconds:.3g} ms"

    def times(self, other: Stopwatch) -> str:
        """How many times as long as another it took, "12 times".

        Args:
            other: what it is compared with.
        """
        return f"{self._seconds() / max(other._seconds(), 1e-9):.3g} times"

    def _seconds(self) -> float:
        return (time.perf_counter() if self._end is None else self._end) - self._start
