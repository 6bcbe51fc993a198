"""What a worker's time is: read from the kernel by the grader, and never reported by the worker."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Protocol

from . import processes

# A request may take this many times its limit by the wall clock while the worker waits for a
# processor. Beyond that the machine is too busy to judge anybody.
MOST_WAITING = 10.0


class Clock(Protocol):
    """Of one worker, all processes and threads of it included."""

    def used(self) -> float | None:
        """Processor seconds so far; None where nobody can tell."""

    def counted(self) -> tuple[float, float]:
        """For a Stopwatch: processor seconds, and seconds ready to run without a processor."""


class ProcessorClock:
    """The clock of a worker under the filter of system calls, which lets it start no process.

    Its processes are found once, before it loads a submission; from then on reading the clock
    takes one system call for each of them, however many processes the machine has. The clock of a
    process counts its threads, ended ones included. Waiting is the main thread's: other threads
    cannot hide work behind it, since the processor time of all of them is counted beside it.
    """

    def __init__(self, pid: int) -> None:
        self._members = processes.family(pid) or [pid]

    def used(self) -> float:
        """See Clock."""
        return sum(map(processes.process_clock, self._members))

    def counted(self) -> tuple[float, float]:
        """See Clock."""
        return self.used(), processes.run_delay(self._members[-1])


class FamilyClock:
    """The clock of a worker that may start processes: its descendants are searched each time.

    Such a worker could lower its own priority, so waiting excuses nothing: a Stopwatch goes by the
    wall clock.
    """

    def __init__(self, pid: int) -> None:
        self._pid = pid

    def used(self) -> float | None:
        """See Clock."""
        return processes.cpu_seconds(self._pid)

    def counted(self) -> tuple[float, float]:
        """See Clock."""
        return 0.0, 0.0


class Stopwatch:
    """The time of one request that counts against its limit.

    That is the wall clock without what the grader spends itself and without what the worker waits
    for a processor; but at least the processor time that the worker uses, so that threads which
    take the processor from one another gain nothing.
    """

    def __init__(self, limit: float, clock: Clock | None) -> None:
        self.limit, self._clock = limit, clock
        self._began, self._late = time.monotonic(), 0.0
        self._served, self._serving_since = 0.0, 0.0
        self._used, self._waited = clock.counted() if clock is not None else (0.0, 0.0)

    def excuse(self, seconds: float) -> None:
        """Leave out time in which the grader itself has waited for a processor."""
        self._late += seconds

    @contextlib.contextmanager
    def serving(self) -> Iterator[None]:
        """Leave out the time of this context, in which the grader works for the worker."""
        self._serving_since = time.monotonic()
        try:
            yield
        finally:
            self._served += time.monotonic() - self._serving_since
            self._serving_since = 0.0

    def spent(self) -> float:
        """Seconds that count."""
        used, waited = self._clock.counted() if self._clock is not None else (0.0, 0.0)
        waited += self._late - self._waited
        return max(used - self._used, self._wall() - waited)

    def left(self) -> float:
        """Seconds until the limit; not positive once it is reached."""
        return self.limit - self.spent()

    def is_starved(self) -> bool:
        """Whether the worker has hardly run for much longer than its limit."""
        return self._wall() > MOST_WAITING * self.limit and self.left() > 0

    def _wall(self) -> float:
        now, since = time.monotonic(), self._serving_since
        return now - self._began - self._served - (now - since if since else 0.0)
