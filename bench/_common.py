"""What every benchmark script shares: options, timing, and the one JSON line it prints.

The fields of the line, and how time is taken, are described in docs/bench.md.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

T = TypeVar("T")
Timing = dict[str, Any]

QUIET = 0.15  # cores that others may use during a run that counts as undisturbed


def options(description: str, **sizes: int) -> argparse.ArgumentParser:
    """A parser with one integer option for each size, and the options that all scripts have."""
    parser = argparse.ArgumentParser(description=description)
    for name, default in sizes.items():
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--reps", type=int, default=3, help="quiet runs to take (default 3)")
    parser.add_argument("--warmup", type=int, default=1, help="runs before those (default 1)")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    return parser


def own_cpu_seconds() -> float:
    """User and system time of all threads of this process so far."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def machine_cpu_seconds() -> float:
    """What all processors have worked so far, time stolen by a hypervisor included."""
    cells = Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()
    user, nice, system, _idle, _wait, irq, softirq, steal = (int(cell) for cell in cells[1:9])
    busy = user + nice + system + irq + softirq + steal
    return busy / os.sysconf("SC_CLK_TCK")


def timed(function: Callable[[], T]) -> tuple[tuple[float, float, float], T]:
    """((cores used by others, wall seconds, own CPU seconds), result) of one call."""
    machine, own, wall = machine_cpu_seconds(), own_cpu_seconds(), time.perf_counter()
    result = function()
    wall = time.perf_counter() - wall
    own = own_cpu_seconds() - own
    foreign = machine_cpu_seconds() - machine - own
    return (max(foreign, 0.0) / wall, wall, own), result


def measure(
    function: Callable[[], T], reps: int, warmup: int = 1, *, max_seconds: float = 45.0
) -> tuple[Timing, T]:
    """Times calls until `reps` of them were quiet, and reports the quietest `reps`.

    Gives up after 4 reps calls, or after max_seconds once there are enough calls at all: "foreign"
    then shows how many cores others used during the calls that were kept. The first call of all is
    reported apart as "first". Returns the timing and the result of the last call.
    """
    firsts = [timed(function)[0][1] for _ in range(warmup)]
    runs: list[tuple[float, float, float]] = []
    deadline = time.perf_counter() + max_seconds
    while True:
        run, result = timed(function)
        runs.append(run)
        enough = len(runs) >= reps and time.perf_counter() > deadline
        if enough or len(runs) >= 4 * reps or sum(r[0] < QUIET for r in runs) >= reps:
            break
    kept = sorted(runs)[:reps]
    foreign, wall, own = (list(column) for column in zip(*kept, strict=True))
    timing = {
        "median": float(np.median(wall)),
        "min": min(run[1] for run in runs),
        "all": [round(seconds, 5) for seconds in wall],
        "foreign": [round(cores, 2) for cores in foreign],
        "cpu_median": float(np.median(own)),
        "first": firsts[0] if firsts else None,
        "tries": len(runs),
    }
    return timing, result


def peak_memory_mb() -> float | None:
    """Largest resident set of this process so far, libraries and inputs included."""
    for line in Path("/proc/self/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmHWM:"):
            return round(int(line.split()[1]) / 1024, 1)
    return None


def machine() -> dict[str, Any]:
    """The processor, as far as the system names it."""
    info = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if "model name" in line]
    return {"cpu": names[0] if names else platform.processor(), "cores": os.cpu_count()}


def report(
    workload: str,
    args: argparse.Namespace,
    size: Mapping[str, Any],
    quality: Mapping[str, Any],
    *,
    forward: Timing,
    both: Timing | None = None,
    **more: Any,
) -> None:
    """Print the one JSON line of a script; `more` adds fields of its own."""
    from photograd._compiled import _core

    row = {
        "workload": workload,
        "peer": "photograd",
        "version": _core.__version__,
        "size": dict(size),
        "threads": args.threads,
        "seconds_fwd": forward["median"],
        "seconds_fwdbwd": both["median"] if both else None,
        "peak_rss_mb": peak_memory_mb(),
        "quality": dict(quality),
        "timings_fwd": forward,
        "timings_fwdbwd": both,
        "loadavg": [round(load, 2) for load in os.getloadavg()],
        "machine": machine() | {"instruction_set": _core.instruction_set()},
        **more,
    }
    sys.stdout.write(json.dumps(row) + "\n")
    sys.stdout.flush()
