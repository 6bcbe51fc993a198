"""One run at a time in a folder: two would delete and mix each other's files."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from photograd_course.file_locks import HeldElsewhereError, open_locked

from photograd.errors import IoError, message

LOCK_NAME = ".photograd.lock"


@contextmanager
def one_run_in(command: str, folder: Path) -> Iterator[None]:
    """Hold `folder` for this process alone; it is made if need be, and removed if left empty.

    The lock ends with the process, also with one that is killed.

    Args:
        command: on whose behalf the error speaks.
        folder: where the command writes.

    Raises:
        IoError: another run holds it, or it cannot be made or written to.
    """
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        with _explained(command, f"a folder that can be made at {folder}"):
            folder.mkdir(parents=True, exist_ok=True)
        with _one_run(command, folder, folder / LOCK_NAME):
            yield
    finally:
        with contextlib.suppress(OSError):  # not empty, as a rule
            for path in made:
                path.rmdir()


@contextmanager
def one_run_for(command: str, out: Path) -> Iterator[None]:
    """Hold the output file `out`, and files beside it that differ in the suffix, for this process.

    Raises:
        IoError: another run holds it, or nothing can be written there.
    """
    with _one_run(command, out, out.with_name(f".{out.stem}.lock")):
        yield


@contextmanager
def _one_run(command: str, out: Path, lock: Path) -> Iterator[None]:
    try:
        with _explained(command, f"a place to write to at {out}"):
            file = open_locked(lock)
    except HeldElsewhereError as failure:
        remedy = "wait until it ends, or choose another"
        expected = f"{out} without another run in it"
        raise IoError(message(command, "--out", expected, _holder(lock), remedy)) from failure
    with file:
        file.truncate()
        file.write(f"{os.getpid()} photograd {command}\n".encode())
        file.flush()
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                lock.unlink()  # while it is held: nobody can have locked this file since


def _holder(lock: Path) -> str:
    """What the process that holds the lock says of itself."""
    try:
        number, _, words = lock.read_text(encoding="utf-8", errors="replace").partition(" ")
    except OSError:
        number, words = "", ""
    return f"process {number}, '{words.strip()}'" if number else "another process"


@contextmanager
def _explained(command: str, expected: str) -> Iterator[None]:
    try:
        yield
    except OSError as failure:
        got = failure.strerror or f"{failure}"
        raise IoError(message(command, "--out", expected, got)) from failure
