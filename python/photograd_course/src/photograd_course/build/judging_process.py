"""The process in which texts are judged: `judge_program`, kept for the jobs that follow."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from ..one_thread import ONE_THREAD

PRINTED = 2000  # characters, from the end, that are worth telling


class Program:
    """Starts when the first job comes, and again where a job had to be killed.

    Args:
        folder: of the assignment.
        secret: seeds of hidden checks.
    """

    def __init__(self, folder: Path, secret: bytes) -> None:
        self._order = {"folder": str(folder), "secret": secret.hex()}
        self._process: subprocess.Popen[bytes] | None = None
        self._lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._printed = tempfile.TemporaryFile()  # noqa: SIM115 -- closed with this

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._end()
        self._printed.close()

    def run(self, job: Mapping[str, Any], seconds: float) -> tuple[list[dict[str, Any]], str]:
        """The lines that the program writes of one job, and the end of all that was printed.

        Args:
            job: see `judge_program.judge`.
            seconds: of wall clock; then the job is killed.
        """
        process = self._started()
        assert process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(json.dumps(job).encode() + b"\n")
            process.stdin.flush()
        found: list[dict[str, Any]] = []
        until = time.monotonic() + seconds
        while True:
            try:
                written = self._lines.get(timeout=max(until - time.monotonic(), 0.0))
            except queue.Empty:
                self._end()
                return found, "no answer in time"
            try:
                line = json.loads(written)
            except ValueError:  # empty, or cut off where the job was killed
                continue
            if "over" in line:
                if line["over"] == "the program":
                    self._end()
                return found, self._last_words()
            found.append(line)

    def _last_words(self) -> str:
        size = self._printed.seek(0, os.SEEK_END)
        self._printed.seek(max(size - PRINTED, 0))
        return self._printed.read().decode(errors="replace")

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is None:
            program = [sys.executable, "-I", "-m", "photograd_course.build.judge_program"]
            # One thread for linear algebra: two run at a time, and the bits stay the same.
            self._process = subprocess.Popen(
                program,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._printed,
                env={**os.environ, **ONE_THREAD},
                start_new_session=True,
            )
            self._lines = queue.SimpleQueue()
            assert self._process.stdin is not None
            self._process.stdin.write(json.dumps(self._order).encode() + b"\n")
            args = (self._process, self._lines)
            threading.Thread(target=_read, args=args, daemon=True).start()
        return self._process

    def _end(self) -> None:
        """Kill it, and the job that it has forked."""
        if self._process is None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        self._process.wait()
        self._process = None


def _read(process: subprocess.Popen[bytes], lines: queue.SimpleQueue[bytes]) -> None:
    """Pass on what is written, and that it has ended."""
    assert process.stdout is not None
    with process.stdout as written:
        for line in written:
            lines.put(line)
    lines.put(b'{"over": "the program"}')
