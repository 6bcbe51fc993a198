"""The worker's end of the pipe, taken away from standard input and output before anything runs."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, BinaryIO

from .codec import Frame, FrameError, FunctionId, decode, encode


class Channel:
    """Frames in and out. Functions that the grader sent become stubs that call back."""

    def __init__(self, source: BinaryIO, sink: BinaryIO) -> None:
        self._source, self._sink = source, sink
        self._number = 0  # of the request being answered

    @classmethod
    def from_standard_streams(cls) -> Channel:
        """Move the pipe to private descriptors; print() goes to stderr, input() meets an end."""
        source = os.fdopen(os.dup(0), "rb", buffering=0)
        sink = os.fdopen(os.dup(1), "wb", buffering=0)
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        os.dup2(2, 1)
        return cls(source, sink)

    @property
    def descriptors(self) -> set[int]:
        """Of the pipe."""
        return {self._source.fileno(), self._sink.fileno()}

    def receive(self) -> Frame:
        """The next request, with stubs in the place of functions."""
        frame = decode(self._read)
        self._number = frame.number
        return Frame(frame.kind, frame.number, self._with_stubs(frame.value))

    def send(self, kind: str, value: Any) -> None:
        """Answer the request last received."""
        data = memoryview(encode(kind, self._number, value))
        while data:
            data = data[self._sink.write(data) :]

    def _read(self, count: int) -> bytes:
        parts = []
        while count:
            part = self._source.read(min(count, 1 << 20))
            if not part:
                raise EOFError
            parts.append(part)
            count -= len(part)
        return b"".join(parts)

    def _with_stubs(self, value: Any) -> Any:
        if isinstance(value, FunctionId):
            return self.stub(value.id)
        if isinstance(value, list):
            return [self._with_stubs(item) for item in value]
        if isinstance(value, dict):
            return {key: self._with_stubs(item) for key, item in value.items()}
        return value

    def stub(self, function: int) -> Callable[..., Any]:
        """A function that asks the grader for its value."""

        def call_grader(*args: Any) -> Any:
            self.send("callback", {"function": function, "args": list(args)})
            frame = decode(self._read)
            if frame.kind == "reply":
                return frame.value
            if frame.kind == "refusal":
                raise ValueError(frame.value)
            raise FrameError(f"unexpected {frame.kind}")

        return call_grader
