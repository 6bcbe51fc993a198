"""What /proc tells about processes: descent, user, processor time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

PROC = Path("/proc")
THREADS = 17  # field of `stat_fields`
TICKS = 100  # of the fields of /proc/PID/stat per second, on every architecture Linux has


def family(pid: int) -> list[int]:
    """A process and all that descend from it, parents first; empty where there is no /proc."""
    if sys.platform != "linux":
        return []
    children: dict[int, list[int]] = {}
    for entry in PROC.iterdir():
        if entry.name.isdigit() and (fields := stat_fields(int(entry.name))):
            children.setdefault(int(fields[1]), []).append(int(entry.name))
    found = [pid]
    for member in found:  # grows on the way
        found += children.get(member, [])
    return found


def stat_fields(pid: int) -> list[str]:
    """The fields of /proc/PID/stat from the third on (state, parent, ...); [] when it is gone."""
    try:
        text = (PROC / str(pid) / "stat").read_bytes()
    except OSError:
        return []
    return text[text.rindex(b")") + 2 :].decode("ascii").split()


def of_user(uid: int) -> list[int]:
    """Processes that run as a user and can still do anything."""
    found = []
    for entry in PROC.iterdir():
        if not entry.name.isdigit():
            continue
        try:
            lines = (entry / "status").read_text("utf-8", "replace").splitlines()
        except OSError:
            continue
        fields = dict(line.split(":", 1) for line in lines if ":" in line)
        ids = {int(number) for number in fields.get("Uid", "").split()}
        ended = fields.get("State", "").strip().startswith(("Z", "X"))
        if uid in ids and (not ended or int(fields.get("Threads", "1")) > 1):
            found.append(int(entry.name))
    return found


def cpu_seconds(pid: int) -> float | None:
    """Processor time of a process, its threads and its descendants, ended ones included.

    The kernel's clock of each living process counts nanoseconds; ended children are counted in
    ticks of 10 ms, by the parent that waited for them.
    """
    if sys.platform != "linux":
        return None
    total = 0.0
    for member in family(pid):
        fields = stat_fields(member)
        if not fields:
            continue
        total += (int(fields[13]) + int(fields[14])) / TICKS
        total += process_clock(member) or (int(fields[11]) + int(fields[12])) / TICKS
    return total


def process_clock(pid: int) -> float:
    """Processor time of one process and its threads, to the nanosecond; 0 once it is gone."""
    try:
        return time.clock_gettime(~pid << 3 | 2)  # man 3 clock_getcpuclockid
    except OSError:
        return 0.0


def run_delay(pid: int) -> float:
    """Seconds that a process's main thread was ready and waited; 0 where the kernel is silent."""
    try:
        return int((PROC / str(pid) / "schedstat").read_bytes().split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0


def is_alive(pid: int) -> bool:
    """Whether a process is there and no mere entry in a table.

    One whose first thread has ended looks like a dead one, and lives on in its other threads.
    """
    fields = stat_fields(pid)
    return bool(fields) and (fields[0] not in "ZX" or int(fields[THREADS]) > 1)


def finish(process: subprocess.Popen[bytes]) -> None:
    """Kill a child. Where there is no SIGKILL, terminating is just as final."""
    if hasattr(signal, "SIGKILL"):
        process.kill()
    else:
        process.terminate()


def send_end(pid: int) -> None:
    """Kill one process, if it still can be."""
    try:
        os.kill(pid, 9)
    except OSError:
        return
