"""Judge many texts of a module: two at a time, results kept by content."""

from __future__ import annotations

import hashlib
import json
import sys
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import numpy as np

from ..assignment.brought import brought_sources
from ..assignment.check_files import check_files
from ..assignment.manifest import read_manifest
from ..atomic_io import atomic_write
from ..errors import Error, message
from .judging_process import Program

WORKERS = 2
WALL = 6.0  # seconds of wall clock for a second of processor time: for what sleeps
# Files of a folder that decide what becomes of a text, its checks apart; and what of this package
# does not.
DECIDING = ("assignment.toml", "adapters.py")
ASIDE = ("build", "cli", "kits", "student", "submissions", "viz")
RULES_SECRET = b"seeds of hidden checks while rules are looked at"


@dataclass(frozen=True)
class Verdict:
    """What became of one text.

    Attributes:
        outcomes: of the checks that ran, as `Outcome.to_json` has them.
        hung: ids of checks that were running when their time was up.
    """

    outcomes: tuple[dict[str, Any], ...]
    hung: tuple[str, ...] = ()

    @property
    def lost(self) -> tuple[str, ...]:
        """Ids of the checks that are not passed, in order."""
        bad = [each["id"] for each in self.outcomes if each["status"] != "passed"]
        return (*bad, *self.hung)

    @property
    def passed(self) -> tuple[str, ...]:
        """Ids of the checks that are passed."""
        return tuple(each["id"] for each in self.outcomes if each["status"] == "passed")

    def of(self, checks: Collection[str]) -> Verdict:
        """The part about some checks, by id."""
        outcomes = tuple(each for each in self.outcomes if each["id"] in checks)
        return Verdict(outcomes, tuple(each for each in self.hung if each in checks))

    def followed_by(self, other: Verdict) -> Verdict:
        """Both, about different checks."""
        return Verdict((*self.outcomes, *other.outcomes), (*self.hung, *other.hung))

    @property
    def ours(self) -> tuple[dict[str, Any], ...]:
        """Outcomes that are our own fault: a check that falters on a wrong answer."""
        return tuple(each for each in self.outcomes if each["status"] == "error-ours")


@dataclass(frozen=True)
class Job:
    """One text to judge; see `judge_program.judge`.

    `patient`: it may be slower than the solution; each check has the time of all of them.
    `trace`: the verdict tells which functions each check enters.
    """

    text: str
    first: bool = False
    task: str = ""
    passed: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()
    patient: bool = False
    trace: bool = False


@dataclass
class Judge:
    """Judges texts of one assignment.

    Attributes:
        folder: its source.
        secret: seeds of hidden checks.
        cache: a folder for results, or None.
        seconds: of processor time for one check; more counts as an endless loop.
        seconds_of: the same, by id, for checks that have a time of their own.
        ran: how many texts were run rather than found in the cache.
    """

    folder: Path
    secret: bytes = RULES_SECRET
    cache: Path | None = None
    seconds: float = 60.0
    seconds_of: Mapping[str, float] = field(default_factory=dict)
    ran: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock)

    @cached_property
    def _decides(self) -> str:
        return what_decides(self.folder)

    def judge(self, job: Job) -> Verdict:
        """The verdict on one text, from the cache where it is known.

        Raises:
            Error: the judging itself does not work; no fault of the text.
        """
        return self.judge_all([job])[0]

    def judge_all(
        self, jobs: Sequence[Job], done: Callable[[int], None] | None = None
    ) -> list[Verdict]:
        """The verdicts, in the order of the jobs; ``done`` hears how many there are.

        Raises:
            Error: the judging itself does not work; no fault of the texts.
        """
        finished = 0
        programs: SimpleQueue[Program] = SimpleQueue()

        def one(job: Job) -> Verdict:
            nonlocal finished
            program = programs.get()
            try:
                verdict = self._judge(job, program)
            finally:
                programs.put(program)
            with self._lock:
                finished += 1
                if done is not None:
                    done(finished)
            return verdict

        with ExitStack() as stack:
            for _ in range(WORKERS):
                programs.put(stack.enter_context(Program(self.folder, self.secret)))
            pool = stack.enter_context(ThreadPoolExecutor(WORKERS))
            return list(pool.map(one, jobs))

    def _judge(self, job: Job, program: Program) -> Verdict:
        place = None
        if self.cache is not None:
            decides = f"{self._decides}|{self.secret.hex()}|{job!r}"
            key = hashlib.sha256(decides.encode()).hexdigest()
            place = self.cache / key[:2] / f"{key}.json"
            if place.exists():
                return _from_json(place.read_bytes())
        verdict = self._run(job, program)
        with self._lock:
            self.ran += 1
        if place is not None:
            place.parent.mkdir(parents=True, exist_ok=True)
            record = {"outcomes": verdict.outcomes, "hung": verdict.hung}
            atomic_write(place, json.dumps(record, default=str).encode())
        return verdict

    def _run(self, job: Job, program: Program) -> Verdict:
        outcomes: list[dict[str, Any]] = []
        hung: list[str] = []
        failed = list(job.failed)
        passed = list(job.passed)
        while True:
            found, running = self._once(replace(job, passed=(*passed,), failed=(*failed,)), program)
            outcomes += found
            if running is None:
                return Verdict(tuple(outcomes), tuple(hung))
            hung.append(running)
            if job.first:
                return Verdict(tuple(outcomes), tuple(hung))
            passed += [each["id"] for each in found if each["status"] == "passed"]
            failed += [each["id"] for each in found if each["status"] != "passed"] + [running]

    def _once(self, job: Job, program: Program) -> tuple[list[dict[str, Any]], str | None]:
        """Outcomes of one run, and the check in which it hung or died."""
        seconds_of = {} if job.patient else dict(self.seconds_of)
        order = {**asdict(job), "seconds": self.seconds, "seconds_of": seconds_of}
        lines, problem = program.run(order, WALL * self.seconds)
        outcomes = [line for line in lines if "status" in line]
        if any("end" in line for line in lines):
            return outcomes, None
        begun = [line["begins"] for line in lines if "begins" in line]
        finished = {each["id"] for each in outcomes}
        open_ones = [each for each in begun if each not in finished and each not in job.failed]
        if not open_ones:
            got = f"an end before the first: {problem}"
            raise Error(message("judge", self.folder.name, "an outcome of each check", got))
        return outcomes, open_ones[-1]


def what_decides(folder: Path) -> str:
    """What verdicts on texts of an assignment depend on, besides the text and the secret.

    Its checks, the reference, what it brings from earlier assignments, and the package.
    """
    manifest = read_manifest(folder)
    paths = [folder / name for name in (*DECIDING, f"{manifest.module}.py")]
    parts = [np.__version__, sys.version.split()[0], _package_digest()]
    parts += [f"{path.name}:{path.read_text('utf-8')}" for path in paths if path.exists()]
    parts += [f"{path}:{text}" for path, text in check_files(folder).items()]
    parts += brought_sources(folder, manifest).values()
    return hashlib.sha256("|".join(parts).encode()).hexdigest()


@lru_cache(maxsize=1)
def _package_digest() -> str:
    """Of the part of this package that judges."""
    package = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256(Path(__file__).with_name("judge_program.py").read_bytes())
    for path in sorted(package.rglob("*.py")):
        if path.relative_to(package).parts[0] not in ASIDE:
            digest.update(path.relative_to(package).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def _from_json(data: bytes) -> Verdict:
    record = json.loads(data)
    return Verdict(tuple(record["outcomes"]), tuple(record["hung"]))
