"""A process beside the grader that ends its workers when the grader is gone, however it went.

The second layer. The first is the kernel, which ends a worker with its grader (PR_SET_PDEATHSIG),
while the filter of system calls keeps the worker from taking that back. The watchdog waits on a
pipe that nobody else holds.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import threading

from ..grading.failures import GraderFault
from . import processes
from .program import interpreter

STARTED = 19  # field of `processes.stat_fields`: when a process began, which tells it from a later
PATIENCE = 5.0  # seconds
# Lines "+ pid start" and "- pid start" until the pipe ends; then all that were not taken back.
PROGRAM = """
import os, sys
watched = set()
for line in sys.stdin:
    sign, *key = line.split()
    (watched.add if sign == "+" else watched.discard)(tuple(key))
for pid, start in watched:
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            text = file.read()
        if text[text.rindex(b")") + 2 :].split()[19].decode() == start:
            os.killpg(int(pid), 9)
    except OSError:
        continue
"""


class Watchdog:
    """Started with the first worker; ends with `close`, or with this process."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._watched: dict[int, str] = {}

    def watch(self, pid: int) -> None:
        """End the group of process `pid`, should this process end before `forget`.

        Raises:
            GraderFault: there is no room for a further process.
        """
        fields = processes.stat_fields(pid)
        if len(fields) <= STARTED:
            return  # gone, or no /proc
        with self._lock:
            if self._process is None:
                self._process = _start()
            self._watched[pid] = fields[STARTED]
            self._tell("+", pid)

    def forget(self, pid: int) -> None:
        """Process `pid` has ended."""
        with self._lock:
            if pid in self._watched:
                self._tell("-", pid)
                del self._watched[pid]

    def close(self) -> None:
        """End it, and with it what it still watches."""
        with self._lock:
            if self._process is None:
                return
            process, self._process = self._process, None
        assert process.stdin is not None
        with contextlib.suppress(OSError):
            process.stdin.close()
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            processes.finish(process)
            process.wait()

    def _tell(self, sign: str, pid: int) -> None:
        if self._process is None or self._process.stdin is None:
            return
        with contextlib.suppress(OSError):  # somebody ended it: the first layer holds
            self._process.stdin.write(f"{sign} {pid} {self._watched[pid]}\n".encode())


def _start() -> subprocess.Popen[bytes]:
    try:
        return subprocess.Popen(
            [interpreter(), "-I", "-S", "-c", PROGRAM],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={},
            cwd=os.sep,
            bufsize=0,
            start_new_session=True,
        )
    except OSError as error:
        raise GraderFault(f"the watchdog of the workers cannot be started: {error}") from error
