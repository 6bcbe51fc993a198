"""The grader's end of a worker: start it, talk to it against the clock, and be rid of it.

Portable: pipes, threads and `kill`, on any system. What more Linux offers comes in through
`Reaper`.
"""

from __future__ import annotations

import contextlib
import os
import queue
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol

from .clocks import MOST_WAITING, Clock, Stopwatch
from .codec import MAX_BODY, Frame, FrameError, FunctionId, decode, encode
from .processes import finish
from .program import install_program, plain_command, scratch_folder

__all__ = [
    "Reaper",
    "WorkerDied",
    "WorkerLied",
    "WorkerProcess",
    "WorkerStarved",
    "WorkerTimeout",
    "contains_function",
    "install_program",
    "plain_command",
    "scratch_folder",
]

LONGEST_LOG = 64 << 10  # bytes of stderr kept
HEARTBEAT = 0.2  # seconds between looks at the clock while a write is blocked
MOST_SERVED = 64 << 20  # bytes, arguments and values, through the functions of one request
LAST_WORDS = 5.0  # seconds that the system may take to bury a killed process


class WorkerTimeout(Exception):
    """No answer before the deadline, or the processor time is used up."""


class WorkerDied(Exception):
    """The worker ended without an answer."""


class WorkerLied(Exception):
    """The worker sent something that is no valid answer."""


class WorkerStarved(Exception):
    """The machine gave the worker no processor: nothing can be said about the submission."""


class Reaper(Protocol):
    """Ends a worker, with whatever else its mode of isolation knows to belong to it."""

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """Kill the process and all that belongs to it."""


class WorkerProcess:
    """One worker, from start to end."""

    def __init__(
        self,
        command: Sequence[str],
        *,
        environment: dict[str, str],
        cwd: Path,
        reaper: Reaper | None = None,
        seconds: float = float("inf"),
        max_body: int = MAX_BODY,
        longest_log: int = LONGEST_LOG,
        on_end: Callable[[], None] | None = None,
    ) -> None:
        """Start it.

        Args:
            command, environment, cwd: as for Popen.
            reaper: how to end it; the plain way where None.
            seconds: limit of all its requests together, as a Stopwatch counts them.
            max_body: bytes; an answer that announces more is a lie.
            longest_log: bytes of its output that are kept; the rest is drained.
            on_end: called once, after it has ended.
        """
        self._seconds, self._spent = seconds, 0.0
        self._clock: Clock | None = None
        self._stopwatch: Stopwatch | None = None
        self._reaper, self._on_end = reaper, on_end
        self._max_body, self._longest_log = max_body, longest_log
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            cwd=cwd,
            bufsize=0,
            start_new_session=hasattr(os, "killpg"),
        )
        self._frames: queue.Queue[Frame | Exception] = queue.Queue()
        self._wanted = threading.Semaphore(0)  # frames that may be read: never more than asked for
        self._ended = threading.Event()
        self._log = bytearray()
        self._number = 0
        self._functions: dict[int, Callable[..., Any]] = {}
        self._log_reader = threading.Thread(target=self._read_log, daemon=True)
        self._log_reader.start()
        for target in (self._read_frames, self._watch):
            threading.Thread(target=target, daemon=True).start()

    @property
    def pid(self) -> int:
        """Of the process that was started."""
        return self._process.pid

    @property
    def log(self) -> str:
        """What the worker wrote to stdout and stderr, cut short."""
        return bytes(self._log).decode("utf-8", errors="replace")

    def last_words(self) -> str:
        """The log of a worker that was ended, once all of it has been read."""
        self._log_reader.join(LAST_WORDS)
        return self.log

    def measure(self, clock: Clock) -> None:
        """Count time by this clock from now on; before, by the wall clock."""
        self._clock = clock

    @property
    def spent(self) -> float:
        """Seconds that its requests have taken so far, without waiting that is not its own."""
        return self._spent

    def request(self, kind: str, value: Any, *, seconds: float, callbacks: int = 200_000) -> Frame:
        """Send a frame and wait for its answer, serving callbacks on the way.

        Args:
            kind, value: as for ``codec.encode``; the worker can call functions in ``value``.
            seconds: limit of the whole exchange, as a Stopwatch counts it.
            callbacks: how many calls of such functions are served. What passes through them is
                limited too: a check may keep all that it was asked.

        Raises:
            WorkerTimeout, WorkerDied, WorkerLied: no valid answer came.
            WorkerStarved: nor can it be expected on this machine.
        """
        self._number += 1
        data = encode(kind, self._number, value, self._name)
        stopwatch = Stopwatch(min(seconds, self._seconds - self._spent), self._clock)
        self._stopwatch = stopwatch
        try:
            return self._exchange(data, stopwatch, callbacks)
        finally:
            self._stopwatch = None
            self._spent += stopwatch.spent()

    def _exchange(self, data: bytes, stopwatch: Stopwatch, callbacks: int) -> Frame:
        self._send(data, stopwatch)
        served = 0
        for _ in range(callbacks + 1):
            frame = self._next(stopwatch)
            if frame.number != self._number:
                raise WorkerLied("an answer to another question")
            if frame.kind != "callback":
                return frame
            with stopwatch.serving():
                reply = self._reply(frame) if frame.size <= MOST_SERVED else b""
            served += frame.size + len(reply)
            if served > MOST_SERVED:
                most = f"{MOST_SERVED >> 20} MB"
                raise WorkerLied(f"more than {most} through the functions it was given")
            self._send(reply, stopwatch)
        raise WorkerLied(f"more than {callbacks} calls of the functions it was given")

    def cpu_seconds(self) -> float | None:
        """Processor time of the worker and all it has started; None where nobody can tell."""
        if self._clock is None or self._ended.is_set():
            return None
        return self._clock.used()

    def kill(self) -> None:
        """End the worker and all that belongs to it; returns when it is gone. Can be repeated."""
        first = not self._ended.is_set()
        self._end()
        if self._process.stdin is not None:
            with contextlib.suppress(OSError):
                self._process.stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(LAST_WORDS)
        if first and self._on_end is not None:
            self._on_end()

    def _end(self) -> None:
        self._ended.set()
        self._wanted.release()  # lets the reading thread see the end
        if self._reaper is None:
            finish(self._process)
        else:
            self._reaper.end(self._process)

    def _watch(self) -> None:
        """End the worker when its time is over, so that no write to it can block for longer."""
        while not self._ended.wait(HEARTBEAT):
            stopwatch = self._stopwatch
            if stopwatch is not None and (stopwatch.left() < -HEARTBEAT or stopwatch.is_starved()):
                finish(self._process)
                return

    def _name(self, function: Callable[..., Any]) -> int:
        self._functions[len(self._functions)] = function
        return len(self._functions) - 1

    def _reply(self, frame: Frame) -> bytes:
        try:
            function = self._functions[frame.value["function"]]
            return encode("reply", self._number, function(*frame.value["args"]))
        except Exception as error:
            # Our exception's own text may hold what the submission must not see.
            said = f"a function given to you cannot take these arguments ({type(error).__name__})"
            return encode("refusal", self._number, said)

    def _send(self, data: bytes, stopwatch: Stopwatch) -> None:
        stream = self._process.stdin
        assert stream is not None
        view = memoryview(data)
        try:
            while view:
                view = view[stream.write(view) :]
        except (OSError, ValueError) as error:
            raise self._cause_of_death(stopwatch) from error

    def _next(self, stopwatch: Stopwatch) -> Frame:
        self._wanted.release()
        while True:
            pause, asked = min(HEARTBEAT, max(0.001, stopwatch.left())), time.monotonic()
            try:
                item = self._frames.get(timeout=pause)
                break
            except queue.Empty:
                # What goes beyond the pause, this process itself has waited for a processor.
                stopwatch.excuse(max(0.0, time.monotonic() - asked - pause))
            if stopwatch.left() <= 0:
                raise self._late(stopwatch)
            if stopwatch.is_starved():
                raise self._starved(stopwatch)
        if isinstance(item, FrameError):
            raise WorkerLied(str(item))
        if isinstance(item, Exception):
            raise self._cause_of_death(stopwatch)
        return item

    def _late(self, stopwatch: Stopwatch) -> WorkerTimeout:
        """Whose time is over: one answer's, or that of the whole process."""
        if self._spent + stopwatch.spent() >= self._seconds:
            return WorkerTimeout("the time of the whole process is used up")
        return WorkerTimeout()

    def _starved(self, stopwatch: Stopwatch) -> WorkerStarved:
        spent, limit = stopwatch.spent(), stopwatch.limit
        return WorkerStarved(
            f"the machine is too busy: after {MOST_WAITING:g} times the limit of {limit:g} s "
            f"the worker has had {spent:.1f} s"
        )

    def _cause_of_death(self, stopwatch: Stopwatch) -> WorkerTimeout | WorkerDied | WorkerStarved:
        """Why the pipe is closed: the clock, the limit on processor time, or the submission."""
        if stopwatch.left() <= 0:
            return self._late(stopwatch)
        if stopwatch.is_starved():
            return self._starved(stopwatch)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(HEARTBEAT)
        status = self._process.returncode
        exhausted = getattr(signal, "SIGXCPU", None)
        # Bubblewrap passes a signal on as a shell does.
        if exhausted is not None and status in (-exhausted, 128 + exhausted):
            return WorkerTimeout("its processor time is used up")
        return WorkerDied("it ended" if status is None else f"it ended with status {status}")

    def _read_frames(self) -> None:
        stream = self._process.stdout
        assert stream is not None

        def read(count: int) -> bytes:
            parts = []
            while count:
                part = stream.read(min(count, 1 << 20))
                if not part:
                    raise EOFError
                parts.append(part)
                count -= len(part)
            return b"".join(parts)

        with stream:  # closed by the thread that reads it, or the close could meet a read
            while True:
                self._wanted.acquire()
                if self._ended.is_set():
                    return
                try:
                    self._frames.put(decode(read, max_body=self._max_body))
                except Exception as error:
                    self._frames.put(error)
                    return

    def _read_log(self) -> None:
        stream = self._process.stderr
        assert stream is not None
        with contextlib.suppress(OSError, ValueError), stream:
            while part := stream.read(1 << 16):
                self._log += part[: max(0, self._longest_log - len(self._log))]


def contains_function(value: Any) -> bool:
    """Whether a value received from a worker still holds a reference to one of its functions."""
    if isinstance(value, FunctionId):
        return True
    items = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(contains_function(item) for item in items)
