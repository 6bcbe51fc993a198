"""What voids a submission, or a whole batch, is said once, and where it is read first."""

from __future__ import annotations

import csv
import io
import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from photograd_course.cli import run
from photograd_course.grading import Status
from photograd_course.submissions.batch_text import print_summary, say_ignored
from photograd_course.submissions.exports import Ignored
from photograd_course.submissions.grades_csv import Change, grades_table
from photograd_course.submissions.report import Report, staff_notes
from photograd_course.submissions.report_gradescope import as_results
from photograd_course.submissions.report_html import render_page
from photograd_course.submissions.report_text import print_report
from photograd_course.submissions.run_folder import RunFolder
from photograd_course.submissions.said_once import BELOW, said_once
from rich.console import Console

from .test_exports import put
from .test_reports import outcome, report, wrong

FAULT = "imports sys in line 68, which the assignment does not list"


def void(name: str, reason: str = "forbidden", text: str = FAULT, visibility: str = "public"):
    details = {"exception": "ValueError: 7"} if reason == "broken" else {}
    return outcome(
        name,
        status=Status.FAILED,
        points=0.0,
        reason=reason,
        text=text,
        visibility=visibility,
        details=details,
    )


def texts_of(judged: Report) -> list[str]:
    stream = io.StringIO()
    print_report(judged, Console(file=stream, width=300))
    page = re.sub(r"<style>.*?</style>", "", render_page(judged), flags=re.DOTALL)
    results = json.dumps(as_results(judged)).replace("\\\\", "")
    table = grades_table([judged], {}).decode()
    return [stream.getvalue(), page, results, table]


@pytest.mark.parametrize("count", [2, 20])
def test_a_fault_of_all_checks_stands_at_the_top_once(count: int) -> None:
    judged = report(*(void(f"1.{k}") for k in range(count)), warnings=("answers are missing",))
    for text in texts_of(judged):
        assert text.count(FAULT) == 1
        assert f"all {count} checks" in text
    terminal, page = texts_of(judged)[:2]
    for text in (terminal, page):
        assert text.index(FAULT) < text.index("answers are missing") < text.index("1.0")
    assert page.count(BELOW) == count


def test_an_exception_while_importing_is_shown_once_and_only_from_public_checks() -> None:
    public = [void(f"1.{k}", "broken", "toy.py does not import") for k in range(3)]
    hidden = [void(f"1.{k}", "broken", "toy.py does not import", "hidden") for k in range(3, 6)]
    page = texts_of(report(*public, *hidden))[1]
    assert page.count("ValueError: 7") == 1
    assert "ValueError: 7" not in texts_of(report(*hidden))[1]


def test_a_refused_submission_is_said_once() -> None:
    problem = "there is no toy.py in the submission"
    judged = report(*(void(f"1.{k}", "submission", problem) for k in range(5)), problem=problem)
    for text in texts_of(judged):
        assert text.count(problem) == 1


def test_what_part_of_the_checks_share_and_what_one_says_alone() -> None:
    once = said_once([void("1.a"), void("1.b"), outcome("1.c"), void("1.d", text="another")])
    assert once.faults == (f"{FAULT} (2 checks)",)
    assert [each.text for each in once.checks] == [BELOW, BELOW, "", "another"]
    alike = [wrong("1.a"), wrong("1.b")]  # two wrong values are two findings
    assert said_once(alike).faults == ()
    assert said_once(alike).checks == tuple(alike)


def test_our_own_failure_of_many_checks_is_one_note() -> None:
    ours = [outcome(f"1.{k}", status=Status.ERROR_OURS, text="no mode works") for k in range(40)]
    assert staff_notes(ours, ()) == ("1.0 and 39 more: no mode works",)


@pytest.fixture
def strict(toy: Path, tmp_path: Path) -> Path:
    """The toy where no verdict may rest on mode E."""
    folder = tmp_path / "strict" / "90_toy"
    shutil.copytree(toy, folder)
    manifest = folder / "assignment.toml"
    manifest.write_text(manifest.read_text().replace('minimum_mode = "E"', 'minimum_mode = "C"'))
    return folder


@pytest.fixture
def grade(capsys: pytest.CaptureFixture[str]) -> Callable[..., tuple[int, str, str]]:
    def graded(*words: object) -> tuple[int, str, str]:
        code = run(["course", "grade", "90", *map(str, words)])
        return code, *capsys.readouterr()

    return graded


def test_a_reason_of_the_whole_batch_is_said_once_before_it_starts(
    strict: Path, tmp_path: Path, grade: Callable[..., tuple[int, str, str]]
) -> None:
    for name in ("ada", "bo", "cy"):
        put(tmp_path / "in" / name / "toy.py")
    words = (tmp_path / "in", "--bundle", strict, "--mode", "E", "--out", tmp_path / "out")
    for more in ((), (), ("--resume",)):
        code, out, err = grade(*words, *more)
        assert code == 3
        assert (out + err).count("weaker than the required C") == 1
        assert err.startswith("nothing can be graded on this machine")
        assert len((out + err).splitlines()) < 12
    with (tmp_path / "out" / "grades.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["score"], row["status"]) for row in rows] == [("", "error-ours")] * 3
    assert all(row["notes"].count("weaker than the required C") == 1 for row in rows)


def test_ids_late_marks_and_what_is_ignored_reach_the_tables(
    strict: Path, tmp_path: Path, grade: Callable[..., tuple[int, str, str]]
) -> None:
    put(tmp_path / "in" / "doejane_LATE_101_900_toy.py")
    put(tmp_path / "in" / "roejim_102_901_toy.py")
    put(tmp_path / "in" / "notes.csv")
    put(tmp_path / "in" / ".DS_Store")
    book = tmp_path / "book.csv"
    book.write_text('Student,ID,Section,Toy (9)\n"Doe, Jane",101,1,5\n')
    words = (tmp_path / "in", "--bundle", strict, "--mode", "E", "--out", tmp_path / "out")
    code, out, err = grade(*words, "--gradebook", book, "--gradebook-column", "toy", "--json")
    assert code == 3
    assert "warning: notes.csv is not graded: neither" in err
    assert "DS_Store" not in err
    result = json.loads(out.splitlines()[-1])
    assert [each["entry"] for each in result["ignored"]] == [".DS_Store", "notes.csv"]
    assert [(each["id"], each["late"]) for each in result["grades"]] == [
        ("101", True),
        ("102", False),
    ]
    assert result["gradebook"]["rows"] == 0
    assert "roejim (102): the number 102 is not in the gradebook" in err
    out_folder = tmp_path / "out"
    with (out_folder / "grades.csv").open(newline="") as file:
        rows = [(row["student"], row["id"], row["late"]) for row in csv.DictReader(file)]
    assert rows == [("doejane", "101", "yes"), ("roejim", "102", "")]
    ignored = (out_folder / "ignored.csv").read_text().splitlines()
    assert ignored[0] == "entry,reason"
    assert len(ignored) == 3
    assert (out_folder / "gradebook.csv").read_text() == book.read_text()
    assert len((out_folder / "unmatched.csv").read_text().splitlines()) == 3
    code, _, err = grade(*words, "--gradebook", tmp_path / "in" / "notes.csv")
    assert code == 1
    assert "expected a gradebook" in err


def test_a_second_grading_says_a_line_for_each_student(tmp_path: Path) -> None:
    checks = tuple(f"90.1.check{k}: passed 3 -> failed 0" for k in range(40))
    changed = [Change(f"student{k:02}", 75.0, 15.0, checks) for k in range(50)]
    stream = io.StringIO()
    folder = RunFolder(tmp_path, b"s" * 16)
    console = Console(file=stream, width=80)
    print_summary([report(student="student00")], changed, folder, console, "")
    text = stream.getvalue()
    assert len([line for line in text.splitlines() if "student" in line]) == 1 + 20
    assert "40 checks and questions" in text
    assert "and 30 more" in text
    assert "changes.csv" in text
    stream.truncate(0)
    print_summary([report()], [Change("Ada", 3.0, 0.0, checks[:1])], folder, console, "")
    assert "90.1.check0: passed 3 -> failed 0" in stream.getvalue()


def test_what_is_ignored_is_listed_up_to_a_number(capsys: pytest.CaptureFixture[str]) -> None:
    say_ignored([Ignored(f"n{k}\x1b[2J", "none") for k in range(30)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 21
    assert "10 more entries are not graded: see ignored.csv" in lines[-1]
    assert "\x1b" not in "".join(lines)
