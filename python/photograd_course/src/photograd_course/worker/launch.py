"""Start a worker in one mode, and believe in its isolation only when it has proved it."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

from ..grading.failures import GraderFault
from . import bubblewrap, places
from .clocks import FamilyClock, ProcessorClock
from .home import WorkerHome, remove_tree
from .policy import TITLES, Policy, resource_limits
from .process import Reaper, WorkerDied, WorkerLied, WorkerProcess, WorkerTimeout
from .program import plain_command, plain_environment
from .reapers import NamespaceReaper, PlainReaper, UserReaper

if TYPE_CHECKING:
    from ..assignment.manifest import Limits

START_SECONDS = 20.0  # of the limit of a whole check; a start takes 0.2 s
MAX_BODY = 64 << 20  # bytes of arrays in one answer


def open_worker(
    home: WorkerHome, mode: str, limits: Limits, slot: int = 0, *, max_body: int = MAX_BODY
) -> WorkerProcess:
    """A worker that waits for a submission, with every layer of the mode in force.

    It is ended when the thread that opened it ends (modes A to D), when its requests have taken
    `limits.seconds`, and by `kill`.

    Args:
        home: of this grading run.
        mode: "A" to "E", as `modes.choose` gives it.
        limits: of the manifest.
        slot: numbers workers that run at the same time, from 0; each has a user of its own.
        max_body: bytes of arrays that one answer may hold.

    Raises:
        GraderFault: it does not start, or a layer does not hold.
    """
    policy = policy_of(home, mode, limits, slot)
    room = home.scratch()

    def ended() -> None:
        if mode != "E":
            home.watchdog.forget(worker.pid)
        remove_tree(room)

    try:
        worker = WorkerProcess(
            _command(home, mode),
            environment=plain_environment(),
            cwd=room,
            reaper=_reaper(mode, policy),
            seconds=limits.seconds,
            max_body=max_body,
            longest_log=limits.output_kb << 10,
            on_end=ended,
        )
    except (OSError, subprocess.SubprocessError) as error:
        remove_tree(room)
        raise GraderFault(f"mode {TITLES[mode]}: a worker cannot be started: {error}") from error
    try:
        if mode != "E":  # which promises nothing, and runs on any system
            home.watchdog.watch(worker.pid)
        _wait_until_ready(worker, mode, policy, min(START_SECONDS, limits.seconds))
    except BaseException:
        worker.kill()
        raise
    # Only the filter keeps a submission from starting processes and from lowering its priority.
    is_filtered = "system calls" in policy.layers and sys.platform == "linux"
    worker.measure(ProcessorClock(worker.pid) if is_filtered else FamilyClock(worker.pid))
    return worker


def policy_of(home: WorkerHome, mode: str, limits: Limits, slot: int) -> Policy:
    """What a worker of this mode gives up on this machine.

    Raises:
        GraderFault: the mode needs what is not installed.
    """
    if mode == "E":
        return Policy(frozenset())
    from . import landlock

    root = os.geteuid() == 0
    own_user = root and mode != "D"
    layers = {"limits", "no new privileges", "capabilities"}
    program = _filter(optional=mode == "A")
    if program is not None:
        layers.add("system calls")
    if own_user:
        layers.add("user")
    unshare = ("network", "ipc", "uts") if mode == "B" else ()
    if unshare:
        layers.add("namespaces")
    own_root = mode in "BC" and may_change_root()
    if own_root:
        layers.add("names of files")
    files = mode != "A" and landlock.version() > 0
    if files:
        layers.add("files")
    if mode == "A":
        layers |= {"mounts", "processes"}
    return Policy(
        layers=frozenset(layers),
        uid=home.uid(slot) if own_user else None,
        limits=resource_limits(limits, own_user=own_user),
        unshare=unshare,
        readable=(() if own_root else places.readable()) if files else None,
        program=program,
        preload=home.imports,
        canary=str(home.canary),
        own_mounts=mode == "A",
        own_root=own_root,
    )


def may_change_root() -> bool:
    """Whether this process has the right to give a worker an empty root folder."""
    from . import kernel

    return bool(kernel.capabilities() >> kernel.CAP_SYS_CHROOT & 1)


def _filter(*, optional: bool) -> bytes | None:
    from .syscall_filter import compiled_filter

    try:
        return compiled_filter()
    except Exception as error:
        if optional:
            return None
        raise GraderFault(
            f"system calls cannot be filtered: {type(error).__name__}: {error} "
            "(pip install 'photograd-course[grader]', and the system's package libseccomp2)"
        ) from error


def is_filtered(mode: str) -> bool:
    """Whether workers of a mode have the filter of system calls here."""
    return mode != "E" and _filter(optional=True) is not None


def _command(home: WorkerHome, mode: str) -> list[str]:
    inner = plain_command(home.program)
    if mode != "A":
        return inner
    program = bubblewrap.find()
    if program is None:
        raise GraderFault("bubblewrap is not installed (the system's package bubblewrap)")
    return bubblewrap.command(program, home.program, inner, as_root=os.geteuid() == 0)


def _reaper(mode: str, policy: Policy) -> Reaper:
    if mode == "A":
        return NamespaceReaper(policy.uid)
    return PlainReaper() if policy.uid is None else UserReaper(policy.uid)


def _wait_until_ready(worker: WorkerProcess, mode: str, policy: Policy, seconds: float) -> None:
    try:
        frame = worker.request("start", policy.to_frame(), seconds=seconds)
    except (WorkerDied, WorkerLied, WorkerTimeout) as error:
        worker.kill()
        said = worker.log.strip().splitlines()[-1:] or [str(error) or type(error).__name__]
        raise GraderFault(f"mode {TITLES[mode]}: a worker did not start: {said[0]}") from error
    holds = frame.value.get("layers", ()) if isinstance(frame.value, dict) else ()
    if missing := sorted(policy.layers - set(holds)):
        raise GraderFault(f"mode {TITLES[mode]}: not in force: {', '.join(missing)}")
