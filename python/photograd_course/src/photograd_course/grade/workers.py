"""Where hand-ins run: fresh workers in one isolation mode, against the clock."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol

from ..grading.failures import GraderFault
from ..grading.remote import Connection
from ..worker.codec import Frame
from ..worker.process import (
    WorkerDied,
    WorkerLied,
    WorkerProcess,
    WorkerTimeout,
    install_program,
    plain_command,
)

START_SECONDS = 30.0


class Workers(Protocol):
    """Gives out started workers.

    Attributes:
        mode: of isolation, "A" to "E".
    """

    @property
    def mode(self) -> str:
        """Of isolation, "A" to "E"."""

    def open(self, slot: int) -> Connection:
        """A fresh worker; `slot` numbers those that run at the same time."""


class PlainWorkers:
    """Processes without any isolation: mode E, whose verdicts are indicative only."""

    mode = "E"

    def __enter__(self) -> PlainWorkers:
        self._folder = tempfile.TemporaryDirectory(prefix="photograd-", ignore_cleanup_errors=True)
        self._root = install_program(Path(self._folder.name) / "program")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._folder.cleanup()

    def open(self, slot: int) -> Connection:
        """See Workers."""
        del slot
        worker = WorkerProcess(plain_command(self._root), environment={}, cwd=self._root)
        try:
            worker.request("start", {}, seconds=START_SECONDS)
        except (WorkerDied, WorkerLied, WorkerTimeout) as error:
            worker.kill()
            raise GraderFault(f"a worker did not start: {type(error).__name__}") from error
        return worker


class Clocked:
    """A connection whose requests end at a deadline, however long each may take by itself."""

    def __init__(self, connection: Connection, deadline: float) -> None:
        self._connection = connection
        self._deadline = deadline

    def request(self, kind: str, value: Any, *, seconds: float, callbacks: int = 200_000) -> Frame:
        """See Connection."""
        left = self._deadline - time.monotonic()
        if left <= 0:
            raise WorkerTimeout
        return self._connection.request(
            kind, value, seconds=min(seconds, left), callbacks=callbacks
        )

    def cpu_seconds(self) -> float | None:
        """See Connection."""
        return self._connection.cpu_seconds()

    def kill(self) -> None:
        """See Connection."""
        self._connection.kill()
