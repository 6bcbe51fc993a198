"""Run the naive grader on an attack, where it can hurt nothing but a scratch folder.

Bubblewrap gives it a file system that is read-only but for the scratch folder, a network and
processes of its own, and ends all of them together. Limits of time, memory and file size hold
inside. Without bubblewrap there are no positive controls, and that is said.
"""

from __future__ import annotations

import functools
import json
import os
import shutil
import subprocess
import sys
import sysconfig
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

PROGRAM = Path(__file__).parent / "program"
HUNG_SECONDS = 8.0  # ten times what grading takes on a quiet machine
HARD_SECONDS = 60.0
FULL = 21.0
# Kilobytes of address space, blocks of 512 bytes in a file, seconds of processor time, no core.
LIMITS = "ulimit -v 2097152; ulimit -f 131072; ulimit -t 30; ulimit -c 0"


@dataclass
class Naive:
    """What came of one grading.

    Attributes:
        report: the parsed results.json, {} where there is none.
        hung: it did not end by itself.
        next_score: of the innocent submission graded afterwards, in a process of its own.
        strays: files that appeared in the scratch folder where none should.
        size: bytes of results.json.
        log: what the grader itself printed.
    """

    report: dict[str, Any] = field(default_factory=dict)
    hung: bool = False
    next_score: float | None = None
    strays: list[str] = field(default_factory=list)
    size: int = 0
    log: str = ""

    @property
    def score(self) -> float:
        """As reported."""
        return float(self.report.get("score", 0.0))


@functools.cache
def bubblewrap() -> str | None:
    """Path of a bubblewrap that works here."""
    found = shutil.which("bwrap")
    if found is None:
        return None
    words = [found, "--ro-bind", "/", "/", "--unshare-all", "true"]
    return (
        found if subprocess.run(words, capture_output=True, check=False).returncode == 0 else None
    )


def grade_naively(
    upload: bytes,
    scratch: Path,
    solution: Path,
    *,
    earlier: float | None = None,
    wait: float = 0.0,
    seconds: float = HARD_SECONDS,
) -> Naive:
    """Grade `upload`, a module or an archive, in the empty folder `scratch`.

    Args:
        upload: bytes of arena.py, or of a zip archive.
        scratch: an empty folder.
        solution: arena.py of the assignment.
        earlier: a score that an earlier upload had, whose report lies there.
        seconds: after which it counts as hung.
        wait: seconds between the end of grading and the moment the report is collected.
    """
    lay_out(upload, scratch, solution, earlier)
    command = cage(scratch, f'{LIMITS}; "$@"; sleep {wait}')
    command += [sys.executable, "grader/grade.py", "upload", "out"]
    log = scratch.parent / f"{scratch.name}.log"
    with log.open("wb") as sink:
        process = subprocess.Popen(
            command,
            cwd=scratch,
            env=environment(scratch),
            stdin=subprocess.DEVNULL,
            stdout=sink,
            stderr=sink,
        )
        try:
            process.wait(seconds)
            hung = False
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            hung = True
    return collect(scratch, log, hung)


def lay_out(upload: bytes, scratch: Path, solution: Path, earlier: float | None) -> None:
    """The folder as the naive grader finds it."""
    shutil.copytree(PROGRAM, scratch / "grader", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copyfile(solution, scratch / "grader" / "solution.py")
    for name in ("out", "other", "tmp"):
        (scratch / name).mkdir()
    shutil.copyfile(solution, scratch / "other" / "arena.py")
    (scratch / "upload").write_bytes(upload)
    if earlier is not None:
        report = scratch / "out" / "results.json"
        report.write_text(json.dumps({"score": earlier}))
        os.utime(report, (1, 1))


def cage(scratch: Path, script: str) -> list[str]:
    """The command line up to the shell that runs `script` with the words that follow."""
    wrap = bubblewrap()
    assert wrap is not None, "no bubblewrap"
    return [
        wrap,
        "--ro-bind",
        "/",
        "/",
        "--dev",
        "/dev",
        "--proc",
        "/proc",
        "--tmpfs",
        "/tmp",
        *bind(scratch),
        "--unshare-all",
        "--die-with-parent",
        "--new-session",
        "--chdir",
        str(scratch),
        "sh",
        "-c",
        script,
        "sh",
    ]


def bind(scratch: Path) -> list[str]:
    """The scratch folder writable; what the interpreter needs and lies below /tmp, readable."""
    shown = [sys.prefix, sys.base_prefix, sysconfig.get_path("purelib"), *sys.path]
    hidden = [path for path in dict.fromkeys(shown) if path.startswith("/tmp/")]
    below = [word for path in hidden for word in ("--ro-bind", path, path)]
    return [*below, "--bind", str(scratch), str(scratch)]


def environment(scratch: Path) -> dict[str, str]:
    """With the answer in it, as one does."""
    return {
        "PATH": os.environ.get("PATH", "/usr/bin:/bin"),
        "TMPDIR": str(scratch / "tmp"),
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "GRADER_ANSWERS": json.dumps({"test_c_known": known_answer()}),
    }


def known_answer() -> float:
    """What hidden_tests.test_c_known expects."""
    rng = np.random.default_rng(0)
    w, x = rng.uniform(0.5, 2.0, 5), rng.uniform(-1.0, 1.0, 5)
    return float(np.sum(w * np.exp(-x)))


def collect(scratch: Path, log: Path, hung: bool) -> Naive:
    """Read what is there, carefully: this runs outside the cage."""
    report = scratch / "out" / "results.json"
    found = Naive(hung=hung, log=log.read_bytes()[-4000:].decode("utf-8", "replace"))
    if report.is_file() and not report.is_symlink():
        found.size = report.stat().st_size
        found.report = parsed(report)
    found.next_score = parsed(scratch / "out" / "next.json").get("score")
    known = {"grader", "out", "other", "tmp", "upload", "work", "key.json"}
    found.strays = sorted(path.name for path in scratch.iterdir() if path.name not in known)
    found.strays += sorted(p.name for p in (scratch / "other").iterdir() if p.name != "arena.py")
    return found


def parsed(path: Path) -> dict[str, Any]:
    """A JSON object, or {}."""
    try:
        value = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return {}
    return value if isinstance(value, dict) else {}
