"""The real grader around one attack: a bundle, workers of one mode, and an innocent submission."""

from __future__ import annotations

import json
import shutil
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.manifest import Limits
from photograd_course.grading.remote import Connection
from photograd_course.submissions.disclosure import for_student
from photograd_course.submissions.intake import take
from photograd_course.submissions.one import Case, grade_one
from photograd_course.submissions.report import Report
from photograd_course.submissions.report_gradescope import as_results
from photograd_course.submissions.report_html import render_page
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.launch import open_worker

from course.attacks.attack import ASSIGNMENT, MODULE, solution_upload

LAST_WORDS = 5  # tenths of a second
CALL_SECONDS = 3.0  # that an attack may take for one call
PATIENT = Limits(
    seconds=120.0, cpu_seconds=60.0
)  # an honest submission must not fail on a busy day
SECRET = b"only the grader of the attack suite knows this"


class LoggingWorkers:
    """Workers whose output is kept, since that is where payloads leave their tokens."""

    note = ""

    def __init__(self, home: WorkerHome, mode: str, limits: Limits) -> None:
        self._home, self.mode, self.limits = home, mode, limits
        self._opened: list[Any] = []

    def open(self, slot: int) -> Connection:
        """See grade.workers.Workers."""
        worker = open_worker(self._home, self.mode, self.limits, slot)
        self._opened.append(worker)
        return worker

    def take_log(self, expected: str = "") -> str:
        """What all workers since the last call have written.

        They are gone by now, but the threads that read their last words may lag behind; for
        `expected` it is worth waiting a moment.
        """
        text = ""
        for _ in range(LAST_WORDS):
            text = "".join(worker.log for worker in self._opened)
            if expected in text or not self._opened:
                break
            time.sleep(0.1)
        self._opened.clear()
        return text


class Session:
    """Everything that an attack must leave alone, and the means to grade it."""

    def __init__(self, mode: str) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="session-", ignore_cleanup_errors=True)
        self.vault = Path(self._folder.name) / "vault"  # where secrets lie, for the grader only
        self.vault.mkdir(mode=0o700)
        for name in ("out", "submissions"):
            (self.vault / name).mkdir()
        (self.vault / "out" / "results.json").write_text('{"score": 12}')
        unwanted = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ASSIGNMENT, self.vault / "bundle", ignore=unwanted)
        (self.vault / "submissions" / "innocent.zip").write_bytes(solution_upload())
        self.bundle = _with_limits(read_folder(self.vault / "bundle", secret=SECRET), None)
        self.home = WorkerHome(self.bundle.manifest.imports)
        self.workers = LoggingWorkers(self.home, mode, self.bundle.manifest.limits)

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.home.close()
        self._folder.cleanup()

    def grade(self, upload: bytes, checks: Sequence[str], limits: Limits | None = None) -> Report:
        """The report on an upload, with only these checks, perhaps with other limits."""
        bundle = _with_limits(self.bundle, limits)
        suffix = ".zip" if upload[:2] == b"PK" else ".py"
        with tempfile.TemporaryDirectory(prefix="upload-") as folder:
            path = Path(folder) / (MODULE if suffix == ".py" else "upload.zip")
            path.write_bytes(upload)
            submission = take(self.bundle.manifest, path)
        chosen = tuple(check for check in bundle.checks if check.id in checks)
        assert len(chosen) == len(checks), checks
        case = Case("attacker", submission, replace(bundle, checks=chosen), "0" * 64)
        self.workers.limits = bundle.manifest.limits
        return grade_one(case, self.workers)

    def innocent(self, checks: Sequence[str] = ("91.1.hidden",)) -> bytes:
        """What the honest submission gets, without durations."""
        report = self.grade(
            (self.vault / "submissions" / "innocent.zip").read_bytes(), checks, PATIENT
        )
        data = report.to_json()
        data.pop("seconds")
        for check in data["checks"]:
            check.pop("seconds")
        return json.dumps(data, sort_keys=True, default=str).encode()


def _with_limits(bundle: Bundle, limits: Limits | None) -> Bundle:
    """With other limits; by default those of the manifest, and few seconds for each call."""
    seconds = CALL_SECONDS if limits is None else limits.seconds
    manifest = replace(bundle.manifest, limits=limits or bundle.manifest.limits)
    checks = tuple(replace(check, seconds=seconds) for check in bundle.checks)
    return replace(bundle, manifest=manifest, checks=checks)


def is_full(innocent: bytes) -> bool:
    """Whether everything passed."""
    data = json.loads(innocent)
    passed = [entry["status"] == "passed" for entry in (*data["checks"], *data["questions"])]
    return all(passed) and data["score"] == data["max_score"] > 0 and not data["staff"]


def shown(report: Report) -> str:
    """All that a student reads about hidden and secret checks."""
    hidden = [for_student(each) for each in report.checks if each.visibility != "public"]
    return json.dumps([replace(each, seconds=0.0).to_json() for each in hidden], default=str)


def pages(report: Report) -> dict[str, str]:
    """Everything that is written about a submission, by name."""
    return {
        "record": json.dumps(report.to_json(), default=str),
        "page": render_page(report),
        "results.json": json.dumps(as_results(report), default=str),
    }
