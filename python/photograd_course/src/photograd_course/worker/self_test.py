"""Try each mode before trusting it: a worker is started that attempts what must fail."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from ..grading.failures import GraderFault
from .home import WorkerHome
from .launch import open_worker, policy_of
from .policy import TITLES
from .process import WorkerDied, WorkerLied, WorkerProcess, WorkerTimeout

SECONDS = 30.0
COURSE = Path(__file__).resolve().parent.parent


@cache
def self_test(mode: str, secrets: tuple[Path, ...] = ()) -> str:
    """Nothing where a mode keeps its promises on this machine, else the reason why it does not.

    Found out once per process and set of secrets.

    Args:
        mode: "A" to "E".
        secrets: files and folders that a worker must not be able to read. Mode E reads them all.
    """
    from ..assignment.manifest import Limits

    try:
        _require_system(mode)
        with WorkerHome() as home:
            limits = Limits(SECONDS, SECONDS, 1024, 64)
            worker = open_worker(home, mode, limits)
            attempts = _attempts(home, policy_of(home, mode, limits, 0).layers, secrets)
            try:
                return "" if mode == "E" else _try_everything(worker, attempts)
            finally:
                worker.kill()
    except GraderFault as fault:
        return fault.text
    except (WorkerDied, WorkerLied, WorkerTimeout) as error:
        return f"mode {TITLES[mode]}: the test ended with {type(error).__name__}: {error}"


def _require_system(mode: str) -> None:
    if mode == "E":
        return
    import sys

    if sys.platform != "linux":
        raise GraderFault("needs Linux")
    from . import landlock

    if mode in "BC" and os.geteuid() != 0:
        raise GraderFault("needs root")
    if mode == "D" and landlock.version() == 0:
        raise GraderFault("needs Landlock, which this kernel does not have")


def _try_everything(worker: WorkerProcess, attempts: Iterable[tuple[Any, ...]]) -> str:
    source = (Path(__file__).parent / "attempts.py").read_text(encoding="utf-8")
    load: dict[str, Any] = {"graded": [], "allowed": [], "substitutes": {}}
    frame = worker.request("load", {**load, "sources": {"attempts": source}}, seconds=SECONDS)
    if frame.kind != "loaded":
        return f"the test did not load: {frame.value}"
    for function, *args in attempts:
        call = {"function": f"attempts.{function}", "args": args}
        frame = worker.request("call", call, seconds=SECONDS)
        if frame.kind != "result":
            return f"the attempt {function} broke off: {frame.value}"
        if frame.value != "":
            return f"a worker could get {frame.value}"
    return ""


def _attempts(
    home: WorkerHome, layers: Collection[str], secrets: Sequence[Path]
) -> Iterator[tuple[Any, ...]]:
    """Function of `attempts.py` and arguments."""
    private = home.folder / "private"
    private.write_text("for the grader only\n", encoding="utf-8")
    private.chmod(0o600)
    yield ("open_network",)
    if "system calls" in layers:  # else mode A's namespace is the limit
        yield ("start_process",)
    yield "signal_process", os.getpid()
    yield "look_into_process", os.getpid()
    yield "read", str(private)
    hidden = [COURSE] if {"files", "mounts", "names of files"} & set(layers) else []
    for secret in (*hidden, *secrets):
        yield "read", str(secret)
    if {"mounts", "names of files"} & set(layers):
        for path in (str(private), str(COURSE), *map(str, secrets)):
            yield "find", path
    for folder in (tempfile.gettempdir(), str(home.folder), "/dev/shm", "/tmp", "."):
        yield "write", folder
    yield ("count_descriptors",)
