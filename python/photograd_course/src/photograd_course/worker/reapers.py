"""How the workers of each mode are ended so that nothing of them survives."""

from __future__ import annotations

import contextlib
import os
import subprocess
import time
from dataclasses import dataclass

from ..grading.failures import GraderFault
from . import processes
from .program import interpreter

PATIENCE = 5.0  # seconds
# Becomes the user and kills all that this user may kill, itself excepted.
SWEEPER = """
import os, sys
uid = int(sys.argv[1])
os.setgroups([]); os.setresgid(uid, uid, uid); os.setresuid(uid, uid, uid)
os.kill(-1, 9)
"""


@dataclass(frozen=True)
class PlainReaper:
    """A process in a session of its own; on Linux with its descendants. Any system."""

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """See Reaper. What has left family and session escapes."""
        family = processes.family(process.pid) if process.poll() is None else []
        kill_group = getattr(os, "killpg", None)
        if kill_group is not None:
            with contextlib.suppress(OSError):
                kill_group(process.pid, 9)
        processes.finish(process)
        for member in family[1:]:
            processes.send_end(member)


@dataclass(frozen=True)
class UserReaper(PlainReaper):
    """A process that has turned into a user of its own: all of that user's processes end."""

    uid: int

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """See Reaper."""
        super().end(process)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(PATIENCE)
        sweep(self.uid)


@dataclass(frozen=True)
class NamespaceReaper(PlainReaper):
    """A process namespace: its first process takes all others along. `uid` where it has one."""

    uid: int | None

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """See Reaper."""
        family = processes.family(process.pid) if process.poll() is None else []
        super().end(process)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(PATIENCE)
        until = time.monotonic() + PATIENCE
        while any(map(processes.is_alive, family[1:])) and time.monotonic() < until:
            time.sleep(0.002)
        if self.uid is not None:
            sweep(self.uid)


def sweep(uid: int) -> None:
    """Kill every process of a user, again and again until /proc shows none.

    Raises:
        GraderFault: some cannot be killed.
    """
    until = time.monotonic() + PATIENCE
    while left := processes.of_user(uid):
        if time.monotonic() > until:
            raise GraderFault(f"processes {left[:5]} of user {uid} cannot be killed")
        command = [interpreter(), "-I", "-S", "-c", SWEEPER, str(uid)]
        subprocess.run(command, check=False, capture_output=True, env={}, cwd="/")
