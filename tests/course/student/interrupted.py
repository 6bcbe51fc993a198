"""End a command at any of its writes: by the kernel, by Ctrl-C, or by a full disk.

A child of this process runs it. Python tells of each file that is opened to write, renamed or
removed before that happens (audit events); at the chosen one the child ends. One that would be cut
off between opening a file and filling it leaves it empty.
"""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from photograd_course.cli import run

CHANGES = ("os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.link", "os.symlink", "os.chmod")
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC
MORE_THAN_ANY = 10_000


class Ending:
    """What happens at the chosen event."""

    def __init__(self, name: str, act: Callable[[], None]) -> None:
        self.name = name
        self.act = act

    def __repr__(self) -> str:
        return self.name


def _kill() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def _interrupt() -> None:
    raise KeyboardInterrupt


def _full() -> None:
    raise OSError(errno.ENOSPC, "No space left on device", "here")


KILLED = Ending("killed", _kill)
INTERRUPTED = Ending("interrupted", _interrupt)
FULL = Ending("full", _full)


def run_until(words: list[str], home: Path, event: int, ending: Ending) -> tuple[int, int]:
    """Run `photograd WORDS` in a child that ends at the event of this number.

    Args:
        words: of the command line.
        home: events elsewhere do not count.
        event: the first is 0.
        ending: what happens there.

    Returns:
        How the child ended, as `os.waitstatus_to_exitcode` has it, and how many events it has met.
    """
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _as_child(words, home, event, ending, writing)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        met = len(pipe.read())
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status), met


def _as_child(words: list[str], home: Path, event: int, ending: Ending, told: int) -> None:
    """Never returns."""
    code = 99
    with contextlib.suppress(BaseException):
        null = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(null, stream)
        sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115  the child ends with it
        place = f"{home.resolve()}{os.sep}"
        owner, busy, count = os.getpid(), False, 0

        def watch(name: str, arguments: tuple[Any, ...]) -> None:
            nonlocal busy, count
            if busy or os.getpid() != owner or not _changes(name, arguments, place):
                return
            busy = True
            try:
                os.write(told, b".")
                count += 1
                if count == event + 1:
                    if name == "open" and ending is KILLED:
                        _empty(arguments)
                    ending.act()
            finally:
                busy = False

        sys.addaudithook(watch)
        try:
            code = run(words, plugins=[])
        except BaseException:
            traceback.print_exc()
    os._exit(code)


def _changes(name: str, arguments: tuple[Any, ...], place: str) -> bool:
    if name == "open":
        path, mode, flags = arguments[:3]
        writes = any(letter in mode for letter in "wxa+") if mode else bool(flags & WRITES)
        return writes and isinstance(path, (str, os.PathLike)) and _inside(path, place)
    return name in CHANGES and any(
        _inside(each, place) for each in arguments if isinstance(each, (str, os.PathLike))
    )


def _inside(path: str | os.PathLike[str], place: str) -> bool:
    return os.path.abspath(path).startswith(place)  # noqa: PTH100  as the command wrote it


def _empty(arguments: tuple[Any, ...]) -> None:
    """The file as it is when a command is killed right after it was opened."""
    path, mode, flags = arguments[:3]
    truncates = (mode and "w" in mode) or flags & os.O_TRUNC
    kind = os.O_TRUNC if truncates else 0
    with contextlib.suppress(OSError):
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | kind, 0o666))
