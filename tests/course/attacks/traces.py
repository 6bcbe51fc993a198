"""What an attack may have left: changed files, processes, strays, secrets in a report."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.assignment.bundle import Bundle
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.runner import run_checks
from photograd_course.worker import processes
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.users import BLOCK, BLOCKS, FIRST

SHARED = tuple(Path(name) for name in ("/tmp", "/var/tmp", "/dev/shm", "/run/lock", "/run"))
STRAYS = re.compile(r"photograd-attack|^escaped$|^results\.json$|^usercustomize\.py$")
WORKER_USERS = range(FIRST, FIRST + BLOCK * BLOCKS)
MOST_NUMBERS = 64  # of an array: among thousands, some agree with any text
DIGITS = re.compile(r"\d\.\d{4,}|\d{2,}\.\d{3,}")


def fingerprint_of(folder: Path) -> str:
    """Hash of names, modes and contents below a folder."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        total.update(f"{path.relative_to(folder)}|{path.lstat().st_mode}|".encode())
        if path.is_file():
            total.update(path.read_bytes())
    return total.hexdigest()


def program_of(home: WorkerHome) -> str:
    """Hash of the worker's program, which the next worker will run."""
    return fingerprint_of(home.folder / "program")


def shared_names() -> set[Path]:
    """Files in folders for all that a worker made, or that bear the name of an attack."""
    found = set()
    for folder in SHARED:
        try:
            entries = list(folder.iterdir())
        except OSError:
            continue
        for path in entries:
            try:
                owner = path.lstat().st_uid
            except OSError:
                continue
            if owner in WORKER_USERS or STRAYS.search(path.name):
                found.add(path)
    return found


def living(home: WorkerHome) -> list[int]:
    """Processes of the users that this home has lent to its workers."""
    if not home.has_users:
        return []
    return [pid for slot in range(2) for pid in processes.of_user(home.uid(slot))]


class _Recorder(LocalStudent):
    """Notes every number that a check hands out or expects back."""

    seen: set[str]

    def call(self, function: str, args: Sequence[Any], *, seconds: float) -> Any:
        value = super().call(function, args, seconds=seconds)
        for each in (*args, *(value if isinstance(value, list) else [value])):
            if np.size(each) <= MOST_NUMBERS and isinstance(each, (float, np.ndarray)):
                self.seen |= {_digits(float(number)) for number in np.ravel(np.asarray(each))}
        return value


def hidden_numbers(bundle: Bundle, source: str) -> set[str]:
    """Inputs and answers of hidden checks, to six digits, without sign and exponent."""
    seen: set[str] = set()

    def open_student(substitutes: Mapping[str, Any]) -> _Recorder:
        student = _Recorder({bundle.manifest.module: source}, substitutes)
        student.seen = seen
        return student

    hidden = [check for check in bundle.checks if check.visibility != "public"]
    run_checks(hidden, bundle.setting, open_student)
    return {digits for digits in seen if len(digits) >= 6}


def quoted(text: str, numbers: set[str]) -> list[str]:
    """Those of the hidden numbers that a text quotes to six digits or more."""
    found = {_digits(float(word)) for word in DIGITS.findall(text)}
    return sorted(found & numbers)


def _digits(value: float) -> str:
    if not np.isfinite(value) or value == 0:
        return ""
    return f"{abs(value):.5e}".split("e")[0].rstrip("0").replace(".", "")
