"""The grader's end of a worker: start it, talk to it against the clock, and be rid of it."""

from __future__ import annotations

import contextlib
import queue
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from .codec import Frame, FrameError, FunctionId, decode, encode

PROGRAM = ("__init__.py", "__main__.py", "channel.py", "codec.py", "modules.py", "screen.py")
LONGEST_LOG = 64 << 10  # bytes of stderr kept
BOOT = "import sys; sys.path.insert(0, sys.argv[1]); import photograd_worker.__main__"


class WorkerTimeout(Exception):
    """No answer before the deadline."""


class WorkerDied(Exception):
    """The worker ended without an answer."""


class WorkerLied(Exception):
    """The worker sent something that is no valid answer."""


def install_program(folder: Path) -> Path:
    """Copy the worker program to ``folder/photograd_worker`` and return ``folder``."""
    target = folder / "photograd_worker"
    target.mkdir(parents=True)
    for name in PROGRAM:
        shutil.copyfile(Path(__file__).parent / name, target / name)
    return folder


class WorkerProcess:
    """One worker. Portable: pipes, a reading thread and ``kill``, on any system."""

    def __init__(self, command: Sequence[str], *, environment: dict[str, str], cwd: Path) -> None:
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            cwd=cwd,
            bufsize=0,
        )
        self._frames: queue.Queue[Frame | Exception] = queue.Queue()
        self._log = bytearray()
        self._number = 0
        self._functions: dict[int, Callable[..., Any]] = {}
        for target in (self._read_frames, self._read_log):
            threading.Thread(target=target, daemon=True).start()

    @property
    def log(self) -> str:
        """What the worker wrote to stdout and stderr, cut short."""
        return bytes(self._log).decode("utf-8", errors="replace")

    def request(self, kind: str, value: Any, *, seconds: float, callbacks: int = 200_000) -> Frame:
        """Send a frame and wait for its answer, serving callbacks on the way.

        Args:
            kind, value: as for ``codec.encode``; the worker can call functions in ``value``.
            seconds: wall-clock limit of the whole exchange.
            callbacks: how many calls of such functions are served.

        Raises:
            WorkerTimeout, WorkerDied, WorkerLied: no valid answer came.
        """
        self._number += 1
        self._send(encode(kind, self._number, value, self._name))
        deadline = time.monotonic() + seconds
        for _ in range(callbacks + 1):
            frame = self._next(deadline)
            if frame.number != self._number:
                raise WorkerLied("an answer to another question")
            if frame.kind != "callback":
                return frame
            self._serve(frame)
        raise WorkerLied(f"more than {callbacks} calls of the functions it was given")

    def cpu_seconds(self) -> float | None:
        """Processor time of the worker; not measured here, since no portable way exists."""
        return None

    def kill(self) -> None:
        """End the process; returns when it is gone."""
        self._process.kill()
        if self._process.stdin is not None:
            with contextlib.suppress(OSError):
                self._process.stdin.close()
        self._process.wait()

    def _name(self, function: Callable[..., Any]) -> int:
        self._functions[len(self._functions)] = function
        return len(self._functions) - 1

    def _serve(self, frame: Frame) -> None:
        try:
            function = self._functions[frame.value["function"]]
            reply = encode("reply", self._number, function(*frame.value["args"]))
        except Exception as error:
            reply = encode("refusal", self._number, f"{type(error).__name__}: {error}"[:500])
        self._send(reply)

    def _send(self, data: bytes) -> None:
        stream = self._process.stdin
        assert stream is not None
        view = memoryview(data)
        try:
            while view:
                view = view[stream.write(view) :]
        except (OSError, ValueError) as error:
            raise WorkerDied("it closed its input") from error

    def _next(self, deadline: float) -> Frame:
        try:
            item = self._frames.get(timeout=max(0.0, deadline - time.monotonic()))
        except queue.Empty:
            raise WorkerTimeout from None
        if isinstance(item, FrameError):
            raise WorkerLied(str(item))
        if isinstance(item, Exception):
            raise WorkerDied("it ended")
        return item

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

        while True:
            try:
                self._frames.put(decode(read))
            except Exception as error:
                self._frames.put(error)
                return

    def _read_log(self) -> None:
        stream = self._process.stderr
        assert stream is not None
        while part := stream.read(1 << 16):
            self._log += part[: max(0, LONGEST_LOG - len(self._log))]


def contains_function(value: Any) -> bool:
    """Whether a value received from a worker still holds a reference to one of its functions."""
    if isinstance(value, FunctionId):
        return True
    items = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return any(contains_function(item) for item in items)


def plain_command(folder: Path) -> list[str]:
    """How to start the worker installed in ``folder`` without any isolation."""
    return [sys.executable, "-I", "-c", BOOT, str(folder)]


def scratch_folder() -> tempfile.TemporaryDirectory[str]:
    """A folder for one worker, removed even where a file in it resists."""
    return tempfile.TemporaryDirectory(prefix="photograd-", ignore_cleanup_errors=True)
