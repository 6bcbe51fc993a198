"""Whatever one submission holds, the others get their grades, and the culprit is named."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.errors import IoError
from photograd_course.grading import StudentFailure
from photograd_course.printable import printable
from photograd_course.submissions import answers, batch, one
from photograd_course.submissions.answers import plain_answers, score_answers
from photograd_course.submissions.batch import Batch, run_batch
from photograd_course.submissions.exports import find_sources
from photograd_course.submissions.load import load
from photograd_course.submissions.one import Case, grade_guarded, grade_one
from photograd_course.submissions.report import Report
from photograd_course.submissions.run_folder import RunFolder
from photograd_course.submissions.submission import OTHER_BYTES, SOURCE_BYTES, Submission
from photograd_course.submissions.workers import isolated_workers

# Each had ended a whole batch, or taken gigabytes or minutes.
HEX = '[answers]\n"90.c1" = 0x' + "F" * 4000 + "\n"
DOTS = "a." * 32_000 + "a = 1\n"
QUOTES = ("'" + "\\'" * 101_000)[: SOURCE_BYTES - 1] + "\n"
assert len(DOTS) <= OTHER_BYTES


@pytest.mark.parametrize("text", [HEX, DOTS], ids=["hex", "dots"])
def test_answers_that_cannot_be_shown_or_parsed_fail(bundle: Bundle, text: str) -> None:
    results, _, _ = score_answers(bundle, Submission({"answers.toml": text.encode()}))
    assert {result.status for result in results} == {"failed"}


def test_numbers_are_drawn_from_any_text_at_once(bundle: Bundle) -> None:
    text = '[answers]\n"90.g1" = 4\n'
    files = {"toy.py": QUOTES.encode(), "answers.toml": text.encode()}
    results, _, _ = score_answers(bundle, Submission(files))
    assert {result.status for result in results} <= {"failed", "passed"}


def test_what_python_will_not_write_is_shown_as_such() -> None:
    assert printable(16**4000) == "(int too long to be shown)"


@pytest.mark.parametrize(
    ("raises_for", "status"), [("9", "failed"), ("19", "error-ours")], ids=["theirs", "ours"]
)
def test_the_control_tells_whose_answers_are_to_blame(
    bundle: Bundle, monkeypatch: pytest.MonkeyPatch, raises_for: str, status: str
) -> None:
    real = answers.draw

    def draw(question: Any, student: str, source: str) -> Any:
        if student == "9" or raises_for == "19":
            raise ZeroDivisionError
        return real(question, student, source)

    monkeypatch.setattr(answers, "draw", draw)
    files = {**plain_answers(bundle).files}
    files["answers.toml"] = b'student = "9"\n' + files["answers.toml"]
    report = grade_one(Case("Ada", Submission(files), replace(bundle, checks=()), "0"), None)
    assert {result.status for result in report.questions} == {status}
    assert report.is_sound is (status == "failed")


@pytest.mark.parametrize("trouble", [MemoryError(), OSError("no room")])
def test_a_machine_in_trouble_blames_nobody(
    bundle: Bundle, monkeypatch: pytest.MonkeyPatch, trouble: Exception
) -> None:
    def score(*_: object) -> Any:
        raise trouble

    monkeypatch.setattr(one, "score_answers", score)
    report = grade_one(Case("Ada", Submission({}), replace(bundle, checks=()), "0"), None)
    assert {result.status for result in report.questions} == {"error-ours"}


def test_a_mistake_of_ours_becomes_a_report_but_no_room_to_write_ends_the_run(
    bundle: Bundle,
) -> None:
    def fails(error: Exception) -> Callable[[], Report]:
        def grade() -> Report:
            raise error

        return grade

    case = Case("Ada", Submission({}), bundle, "0")
    report = grade_guarded(case, None, fails(StudentFailure("odd", "nobody expects it")))
    assert (report.score, report.student) == (None, "Ada")
    assert len(report.checks) == len(bundle.checks)
    assert "nobody expects it" in report.staff[0]
    with pytest.raises(IoError):
        grade_guarded(case, None, fails(IoError("full")))


def test_a_batch_names_who_broke_it_and_grades_the_rest(
    quick: Path, solution: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {
        "Ada": {"toy.py": solution},
        "Bo": {"toy.py": solution, "answers.toml": HEX},
        "Cy": {"toy.py": solution + "# odd\n"},
        "Di": {"toy.py": QUOTES, "answers.toml": DOTS},
    }
    for student, texts in files.items():
        (tmp_path / "in" / student).mkdir(parents=True)
        for name, text in texts.items():
            (tmp_path / "in" / student / name).write_text(text)
    real = batch.grade_one

    def grade(case: Case, *args: Any, **options: Any) -> Report:
        if case.student == "Cy":
            raise ZeroDivisionError("a mistake of ours")
        return real(case, *args, **options)

    monkeypatch.setattr(batch, "grade_one", grade)
    loaded = load("90", quick)
    manifest = loaded.read().manifest
    with isolated_workers(manifest, "E") as workers:
        job = Batch(find_sources(manifest, tmp_path / "in"), loaded, workers)
        run_batch(job, RunFolder(tmp_path / "out", loaded.secret))
    with (tmp_path / "out" / "grades.csv").open(newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert {name: row["score"] for name, row in rows.items()} == {
        "Ada": "3",
        "Bo": "3",
        "Cy": "",
        "Di": "0",
    }
    assert "a mistake of ours" in rows["Cy"]["notes"]
    assert (tmp_path / "out" / "pages" / rows["Cy"]["page"]).exists()
    assert '"Ada","Bo",1.00' in (tmp_path / "out" / "similarity.csv").read_text()
