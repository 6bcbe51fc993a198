"""One run at a time in a folder: two would delete and mix each other's files."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from photograd_course.file_locks import HeldElsewhereError, open_locked

from photograd.errors import IoError, message

LOCK_NAME = ".photograd.lock"


@contextmanager
def one_run_in(
    command: str, folder: Path, *written: str, argument: str = "--out"
) -> Iterator[None]:
    """Hold `folder` for this process alone; it is made if need be, and removed if left empty.

    The lock ends with the process, also with one that is killed.

    Args:
        command: on whose behalf the error speaks.
        folder: where the command writes.
        written: names in it of files that are replaced at the end.
        argument: what the caller calls the folder.

    Raises:
        IoError: another run holds it, or it cannot be made or written to.
    """
    who = command, argument
    with _made(who, folder), _one_run(who, folder, folder / LOCK_NAME):
        _require_replaceable(who, *(folder / name for name in written))
        yield


@contextmanager
def one_run_for(
    command: str, out: Path, *beside: Path, argument: str = "--out", parents: bool = False
) -> Iterator[None]:
    """Hold the output file `out`, and files beside it that differ in the suffix, for this process.

    Args:
        command: on whose behalf the error speaks.
        out: the file.
        beside: other files that are written.
        argument: what the caller calls it.
        parents: make the folder that it lies in; it is removed if left empty.

    Raises:
        IoError: another run holds it, or nothing can be written there.
    """
    who = command, argument
    made = _made(who, out.parent) if parents else contextlib.nullcontext()
    with made, _one_run(who, out, out.with_name(f".{out.stem}.lock")):
        _require_replaceable(who, out, *beside)
        yield


@contextmanager
def _made(who: tuple[str, str], folder: Path) -> Iterator[None]:
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        with _explained(who, f"a folder that can be made at {folder}"):
            folder.mkdir(parents=True, exist_ok=True)
        yield
    finally:
        with contextlib.suppress(OSError):  # not empty, as a rule
            for path in made:
                path.rmdir()


def _require_replaceable(who: tuple[str, str], *files: Path) -> None:
    """Raise IoError for a file that cannot be replaced, although its folder takes new ones.

    Files are replaced as a whole, so that their mode is no hindrance; an immutable one stays.
    """
    for file in files:
        if file.is_dir():
            raise IoError(message(*who, f"a file that can be written at {file}", "a folder"))
        if file.is_file():
            with _explained(who, f"a file that can be replaced at {file}"):
                try:
                    os.close(os.open(file, os.O_WRONLY))
                except PermissionError as failure:
                    if failure.errno != errno.EACCES:  # of the mode
                        raise


@contextmanager
def _one_run(who: tuple[str, str], out: Path, lock: Path) -> Iterator[None]:
    try:
        with _explained(who, f"a place to write to at {out}"):
            file = open_locked(lock)
    except HeldElsewhereError as failure:
        remedy = "wait until it ends, or choose another"
        expected = f"{out} without another run in it"
        raise IoError(message(*who, expected, _holder(lock), remedy)) from failure
    with file:
        file.truncate()
        file.write(f"{os.getpid()} photograd {who[0]}\n".encode())
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
def _explained(who: tuple[str, str], expected: str) -> Iterator[None]:
    try:
        yield
    except OSError as failure:
        got = failure.strerror or f"{failure}"
        raise IoError(message(*who, expected, got)) from failure
