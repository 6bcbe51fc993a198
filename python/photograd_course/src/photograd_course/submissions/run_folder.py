"""The folder in which a batch keeps its results, so that a killed run can go on.

records/NAME.json   one sealed record a submission, written as soon as it is judged
earlier/            the records of the run before, for the table of differences
pages/NAME.html     one page a submission
grades.csv  ignored.csv  changes.csv  similarity.csv  gradebook.csv  unmatched.csv  run.json
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from ..atomic_io import atomic_write, remove_leftovers
from ..errors import IoError, SceneError, message
from .grades_csv import page_name
from .report import Report
from .report_html import render_page
from .report_json import read_record, write_record


class RunFolder:
    """Results on disk; every file appears whole or not at all."""

    def __init__(self, path: Path, secret: bytes) -> None:
        self.path, self._secret = path, secret
        self._records, self._earlier = path / "records", path / "earlier"
        self._pages = path / "pages"

    def begin(self, facts: dict[str, str], *, resume: bool) -> None:
        """Make the folder ready.

        Without `resume`, the records of a finished run move to `earlier/`; those of an unfinished
        one are dropped.

        Args:
            facts: what the run depends on: assignment, bundle and mode.
            resume: go on where a run of the same facts was cut off.

        Raises:
            IoError: the folder cannot be made, or holds something else.
            SceneError: `resume`, but the folder is of a run with other facts.
        """
        self._require_ours()
        state = self._state()
        if resume and state and {key: state.get(key) for key in facts} != facts:
            remedy = "grade without --resume"
            expected = "a run of the same bundle and mode"
            raise SceneError(message("grade", "--resume", expected, "another", remedy))
        try:
            if not resume and self._records.is_dir():
                if state.get("state") == "done":
                    shutil.rmtree(self._earlier, ignore_errors=True)
                    self._records.rename(self._earlier)
                else:
                    shutil.rmtree(self._records)
            for folder in (self._records, self._pages):
                folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise IoError(message("grade", str(self.path), "a folder", str(error))) from error
        self._clean_up()
        self.mark(facts, "running")

    def mark(self, facts: dict[str, str], state: str) -> None:
        """Say how far the run is: "running" or "done"."""
        text = json.dumps({**facts, "state": state}, sort_keys=True)
        atomic_write(self.path / "run.json", text.encode() + b"\n")

    def keep(self, report: Report) -> None:
        """Write page and record; the record last, since it says that all is there."""
        name = page_name(report.student)
        atomic_write(self._pages / f"{name}.html", render_page(report).encode())
        atomic_write(self._records / f"{name}.json", write_record(report, self._secret))

    def kept(self, student: str) -> Report | None:
        """The report of this run on a student, if its seal is good."""
        return self._read(self._records / f"{page_name(student)}.json", student)

    def earlier(self) -> dict[str, Report]:
        """The reports of the run before, by student."""
        reports = [self._read(path) for path in sorted(self._earlier.glob("*.json"))]
        return {report.student: report for report in reports if report is not None}

    def write(self, name: str, data: bytes) -> Path:
        """A table beside the records."""
        return atomic_write(self.path / name, data)

    def _read(self, path: Path, student: str | None = None) -> Report | None:
        try:
            report = read_record(path.read_bytes(), self._secret)
        except (OSError, SceneError):
            return None
        return report if student in (None, report.student) else None

    def _state(self) -> dict[str, str]:
        try:
            state = json.loads((self.path / "run.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}
        return state if isinstance(state, dict) else {}

    def _require_ours(self) -> None:
        if self.path.exists() and not self.path.is_dir():
            raise IoError(message("grade", "--out", "a folder", f"a file at {self.path}"))
        if self.path.is_dir() and any(self.path.iterdir()) and not self._state():
            remedy = "give an empty folder, or that of an earlier run"
            raise IoError(message("grade", "--out", "a folder of grades", "another", remedy))

    def _clean_up(self) -> None:
        """Halves of files that a killed run left."""
        for folder in (self._records, self._pages):
            for entry in folder.glob(".*.tmp"):
                remove_leftovers(folder / entry.name[1:].rsplit(".", 2)[0])
