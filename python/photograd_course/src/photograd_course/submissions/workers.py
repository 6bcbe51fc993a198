"""Where submissions run: fresh workers in the best isolation mode, each against the clock."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from ..assignment.manifest import Manifest
from ..grading.remote import Connection
from ..worker.codec import Frame
from ..worker.home import WorkerHome
from ..worker.launch import open_worker
from ..worker.modes import choose
from ..worker.modes import note as note_on
from ..worker.process import WorkerTimeout


class Workers(Protocol):
    """Gives out started workers."""

    @property
    def mode(self) -> str:
        """Of isolation, "A" to "E"."""

    @property
    def note(self) -> str:
        """What staff should know about this mode here; "" where there is nothing to say."""

    def open(self, slot: int) -> Connection:
        """A fresh worker; `slot` numbers those that run at the same time.

        Raises:
            GraderFault: it does not start, or its isolation does not hold.
        """


class IsolatedWorkers:
    """Workers of one mode, with the limits of an assignment."""

    def __init__(self, home: WorkerHome, mode: str, manifest: Manifest) -> None:
        self._home, self._limits = home, manifest.limits
        self.mode, self.note = mode, note_on(mode)

    def open(self, slot: int) -> Connection:
        """See Workers."""
        return open_worker(self._home, self.mode, self._limits, slot)


@contextlib.contextmanager
def isolated_workers(
    manifest: Manifest, only: str | None = None, secrets: Sequence[Path] = ()
) -> Iterator[Workers]:
    """Workers in the strongest mode that works here, for as long as the context lasts.

    Args:
        manifest: names the weakest mode that will do, limits and imports.
        only: this mode or none.
        secrets: files and folders that no worker may read.

    Raises:
        GraderFault: no mode is strong enough; the text tells staff why.
        RangeError: `only` is no mode.
    """
    mode = choose(manifest.minimum_mode, only, secrets)
    with WorkerHome(manifest.imports) as home:
        yield IsolatedWorkers(home, mode, manifest)


@dataclass
class Budget:
    """Seconds that the workers of one submission may still take, all together."""

    left: float


class Clocked:
    """A connection whose requests are taken from a budget, however long each may take by itself."""

    def __init__(self, connection: Connection, budget: Budget) -> None:
        self._connection, self._budget = connection, budget

    def request(self, kind: str, value: Any, *, seconds: float, callbacks: int = 200_000) -> Frame:
        """See Connection."""
        left, before = self._budget.left, self._connection.spent
        if left <= 0:
            raise WorkerTimeout("the time for this submission is used up")
        try:
            return self._connection.request(
                kind, value, seconds=min(seconds, left), callbacks=callbacks
            )
        finally:
            self._budget.left -= self._connection.spent - before

    @property
    def spent(self) -> float:
        """See Connection."""
        return self._connection.spent

    def cpu_seconds(self) -> float | None:
        """See Connection."""
        return self._connection.cpu_seconds()

    def kill(self) -> None:
        """See Connection."""
        self._connection.kill()
