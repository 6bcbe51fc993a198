"""Run pytest as two pools beside each other: tests that compute, and tests that mostly wait.

Usage: pools.py [PATH ...] [options of pytest]

The places of WAITING make the second pool: their tests wait for limits of time and use little of
the processor, so more of them run at once. The first pool has a lower priority, since limits of
time are tight in the second one only. Output of the second pool follows that of the first; then
come the dearest tests of both and one line that counts all; build/log/test_costs.json holds the
costs of all tests. Options go to both pools.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
WAITING = (
    "tests/course/attacks",
    "tests/course/isolation",
    "tests/course/submissions/test_many.py",
)
COMPUTING = 2 if "CI" in os.environ else 3  # processes: a machine of CI may have other work
COSTS = "PHOTOGRAD_COSTS"  # the environment variable with the file that a pool writes its costs to
NO_BYTECODE = "PYTHONDONTWRITEBYTECODE"
PACKAGES = [str(ROOT / "python/photograd"), str(ROOT / "python/photograd_course/src")]
NO_TESTS = 5  # pytest's exit status
SHOWN = 20
ALL_COSTS = ROOT / "build" / "log" / "test_costs.json"
COUNTED = ("failed", "passed", "skipped", "xfailed", "xpassed", "errors")


@dataclass
class Pool:
    """A run of pytest.

    Attributes:
        name: of its files.
        paths: what it collects; without any it does not run.
        processes: how many share the tests. A file stays in one of them, so that its shared results
            are made once. Files go in the order of their names, not by their number of tests: those
            of the course, few and long, are not left over for one process at the end.
        options: of this pool alone.
        nice: by how much its priority is lowered.
    """

    name: str
    paths: list[str]
    processes: int
    options: list[str] = field(default_factory=list)
    nice: int = 0

    def start(self, options: Sequence[str], costs: Path, output: Any) -> subprocess.Popen[bytes]:
        """Begin to run; the costs are written at the end."""
        words = ["-n", str(self.processes), "--dist", "loadfile", "--no-loadscope-reorder"]
        command = [sys.executable, "-m", "pytest", *words, *self.options, *options, *self.paths]
        return subprocess.Popen(
            ["nice", "-n", str(self.nice), *command],
            cwd=ROOT,
            env=_env() | {COSTS: str(costs)},
            stdout=output,
            stderr=subprocess.STDOUT if output else None,
        )


def split(words: Iterable[str]) -> tuple[list[Pool], list[str]]:
    """The pools that have something to run, and the words that are options.

    A word that names a file or a folder, or a test in one, is a path; without any it is "tests".
    """
    options: list[str] = []
    paths: list[str] = []
    for word in words:
        is_path = not word.startswith("-") and (ROOT / word.split("::")[0]).exists()
        (paths if is_path else options).append(word)
    paths = paths or ["tests"]
    waiting = [path for path in paths if _waits(path)]
    computing = [path for path in paths if path not in waiting]
    around = [(ROOT / path).resolve() for path in computing]
    waiting += [w for w in WAITING if any((ROOT / w).is_relative_to(path) for path in around)]
    ignored = [f"--ignore={place}" for place in WAITING]
    pools = [
        Pool("computing", computing, COMPUTING, ignored, nice=5),
        Pool("waiting", waiting, 4, ["-o", "cache_dir=.pytest_cache/waiting"]),
    ]
    return [pool for pool in pools if pool.paths], options


def _env() -> dict[str, str]:
    """The environment, with bytecode written; tests/conftest.py ends that after collection."""
    return {name: value for name, value in os.environ.items() if name != NO_BYTECODE}


def _waits(path: str) -> bool:
    place = (ROOT / path.split("::", maxsplit=1)[0]).resolve()
    return any(place.is_relative_to(ROOT / folder) for folder in WAITING)


def dearest(tests: dict[str, list[float]]) -> list[str]:
    """Lines of a table of the tests {name: [seconds of processor time, seconds]} that cost most."""
    rows = sorted(tests.items(), key=lambda row: -row[1][0])[:SHOWN]
    lines = [f"{cpu:9.1f} {wall:9.1f}  {name}" for name, (cpu, wall) in rows]
    return ["processor   seconds  the dearest tests", *lines]


def last_line(counts: dict[str, int], seconds: float) -> str:
    """For example "9068 passed, 12 skipped in 700.12 s"."""
    found = [f"{counts[name]} {name}" for name in COUNTED if counts.get(name)]
    return f"{', '.join(found) or 'no tests ran'} in {seconds:.0f} s"


def status_of(found: Sequence[int]) -> int:
    """The exit status of all: a pool without tests is no fault while another has some."""
    ran = [status for status in found if status != NO_TESTS]
    return max((abs(status) for status in ran), default=NO_TESTS)


def main(words: Sequence[str]) -> int:
    """Exit status: 0 where all tests passed."""
    pools, options = split(words)
    started = time.monotonic()
    # The many processes that tests start need not compile the packages again.
    subprocess.run([sys.executable, "-m", "compileall", "-q", *PACKAGES], env=_env(), check=True)
    with tempfile.TemporaryDirectory() as folder:
        costs = [Path(folder) / f"{pool.name}.json" for pool in pools]
        if sys.stdout.isatty():
            options = ["--color=yes", *options]
        output = Path(folder) / "output"
        with output.open("wb") as later:
            # The first pool is seen while it runs.
            runs = [
                pool.start(options, path, None if number == 0 else later)
                for number, (pool, path) in enumerate(zip(pools, costs, strict=True))
            ]
            found = [run.wait() for run in runs]
        sys.stdout.write(output.read_text(encoding="utf-8", errors="replace"))
        read = [json.loads(path.read_text(encoding="utf-8")) for path in costs if path.exists()]
    counts: Counter[str] = Counter()
    tests: dict[str, list[float]] = {}
    for each in read:
        counts.update(each["counts"])
        tests |= each["tests"]
    ALL_COSTS.parent.mkdir(parents=True, exist_ok=True)
    ALL_COSTS.write_text(json.dumps(tests, indent=1, sort_keys=True), encoding="utf-8")
    print("", *dearest(tests), "", last_line(counts, time.monotonic() - started), sep="\n")
    return status_of(found)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
