"""Reports as files: nothing a submission wrote becomes markup, a formula or a command."""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.grading import Outcome, Status
from photograd_course.printable import csv_cell, file_name, markdown, printable
from photograd_course.submissions.answers import Answered
from photograd_course.submissions.grades_csv import changes, changes_table, grades_table, page_name
from photograd_course.submissions.report import Report
from photograd_course.submissions.report_gradescope import ResultsFile, as_results, best_earlier
from photograd_course.submissions.report_html import render_page
from photograd_course.submissions.report_json import write_record
from photograd_course.submissions.report_text import print_report
from rich.console import Console

NASTY = (
    '</p><script>alert(1)</script><img src=x onerror="x">&amp; [red]b[/red] `c` **d** \x1b[2J\u202e'
)
FORMULAS = ["=1+1", "+1", "-1+cmd|' /C calc'!A0", "@SUM(A1)", "\t=1", "|x", "%0A=1", "  =1"]


def outcome(name: str = "1.a", **changes: Any) -> Outcome:
    base = Outcome(name, "It holds.", "1", "public", Status.PASSED, 3.0, 3.0)
    return replace(base, **changes)


def wrong(name: str = "1.b", **changes: Any) -> Outcome:
    details = {"error": 0.1, "tolerance": 1e-9, "worst_index": [3, 1], "exception": NASTY}
    return outcome(
        name,
        status=Status.FAILED,
        points=0.0,
        reason="wrong",
        text=NASTY,
        hint=NASTY,
        details=details,
        **changes,
    )


def report(*checks: Outcome, **changes: Any) -> Report:
    question = Answered("1.q", "concept", "failed", 0.0, 2.0, "not right", NASTY)
    base = Report(
        "Ada",
        "",
        "01",
        "Descent",
        "a" * 64,
        "b" * 64,
        "C",
        checks or (outcome(), wrong()),
        (question,),
        versions={"numpy": "2"},
    )
    return replace(base, **changes)


class Tags(HTMLParser):
    """The tags and attributes of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: set[str] = set()
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes |= {name for name, _ in attrs}

    def handle_data(self, data: str) -> None:
        self.text += data


def test_a_page_holds_no_markup_of_a_submission() -> None:
    page = render_page(
        report(student=NASTY, ignored=(NASTY,), problem=NASTY, warnings=(NASTY,), title="T")
    )
    tags = Tags()
    tags.feed(page)
    assert not {"script", "img", "a", "iframe", "link", "form"} & set(tags.tags)
    assert tags.attributes <= {
        "lang",
        "charset",
        "http-equiv",
        "content",
        "name",
        "class",
        "style",
        "title",
    }
    assert "default-src 'none'" in page
    assert tags.text.count("<script>alert(1)</script>") >= 7  # shown as what it is
    assert "\x1b" not in page
    assert "\u202e" not in page
    assert not re.search(r"(src|href|url)\s*[=(]", re.sub(r"src=x", "", page))


def test_a_page_says_verdict_error_and_tolerance_in_words() -> None:
    hidden = wrong("1.c", visibility="hidden")
    page = render_page(report(outcome(), wrong(), hidden, outcome("1.d", visibility="secret")))
    for said in (
        "passed",
        "failed",
        "<b>6</b> of 14 points",
        "1.a",
        "1.d",
        "error 1e-01, allowed 1e-09: 8 powers of ten above",
        "[3, 1]",
    ):
        assert said in page
    assert page.count("[3, 1]") == 1  # not for the hidden one


def test_a_page_of_ours_shows_no_zero() -> None:
    ours = outcome("1.c", status=Status.ERROR_OURS, points=0.0, text="KeyError: secret")
    page = render_page(report(outcome(), ours, staff=("1.c: KeyError: secret",)))
    assert "secret" not in page
    assert "no points are lost" in page
    assert "of 8 points" not in page


def test_the_terminal_gets_no_escapes_and_no_markup() -> None:
    stream = io.StringIO()
    print_report(report(student=NASTY, staff=(NASTY,)), Console(file=stream, width=400))
    assert "\x1b" not in stream.getvalue()
    assert "[red]b[/red]" in stream.getvalue()


def test_gradescope_results_have_its_shape() -> None:
    checks = (outcome(), wrong("1.h", visibility="hidden"), wrong("1.s", visibility="secret"))
    results = json.loads(json.dumps(as_results(report(*checks))))
    assert results["score"] == 3.0
    assert results["output_format"] == results["test_output_format"] == "md"
    assert [test["number"] for test in results["tests"]] == ["1", "2", "3", "4"]
    shown = [test["visibility"] for test in results["tests"]]
    assert shown == ["visible", "after_published", "hidden", "after_published"]
    for test in results["tests"]:
        assert set(test) == {
            "name",
            "score",
            "max_score",
            "status",
            "output",
            "visibility",
            "number",
        }
        assert test["status"] in {"passed", "failed"}
        assert 0 <= test["score"] <= test["max_score"]
    assert results["tests"][2]["output"] == ""


def test_gradescope_texts_are_escaped() -> None:
    output = as_results(report())["tests"][1]["output"]
    assert "<script>" not in output.replace("\\<script\\>", "")
    assert "\\*\\*d\\*\\*" in output
    assert "\\`c\\`" in output
    assert "\x1b" not in output


def test_gradescope_partial_results_and_earlier_scores(bundle: Bundle, tmp_path: Path) -> None:
    path = tmp_path / "results.json"
    file = ResultsFile(path, bundle)
    first = json.loads(path.read_text())
    assert not {"score", "max_score"} & {key for table in (first, *first["tests"]) for key in table}
    assert {test["output"] for test in first["tests"]} == {"not graded yet"}
    check = bundle.checks[0]
    file.on_outcome(outcome(check.id, max=check.points, points=check.points))
    second = json.loads(path.read_text())
    assert second["score"] == check.points
    assert len(second["tests"]) == len(bundle.checks)
    file.finish(report())
    assert json.loads(path.read_text())["score"] == 3.0

    ours = report(outcome(), staff=("1.b: broken",))
    assert as_results(ours, earlier=11.5)["score"] == 11.5
    assert as_results(ours, earlier=1.0)["score"] == 3.0
    unscored = as_results(ours)
    assert "no points are lost" in unscored["output"]
    assert not {"score", "max_score"} & {
        key for each in (unscored, *unscored["tests"]) for key in each
    }
    assert as_results(report(), earlier=11.5)["score"] == 3.0  # a sound grade stands for itself
    metadata = tmp_path / "submission_metadata.json"
    metadata.write_text('{"previous_submissions": [{"score": "4.0"}, {"score": 11.5}]}')
    assert best_earlier(metadata) == 11.5
    metadata.write_text("{}")
    assert best_earlier(metadata) is None
    assert best_earlier(tmp_path / "none.json") is None


@pytest.mark.parametrize("text", FORMULAS)
def test_no_cell_is_a_formula(text: str) -> None:
    assert csv_cell(text).startswith("'")
    table = grades_table([report(student=text, problem=text)], {})
    rows = list(csv.reader(io.StringIO(table.decode())))
    assert len(rows) == 2
    assert not any(cell.lstrip()[:1] in "=+-@|%" for cell in rows[1] if cell)


def test_numbers_and_names_stay_themselves() -> None:
    assert [csv_cell(v) for v in (-1.5, 3, "Ada", "O'Neil")] == ["-1.5", "3", "Ada", "O'Neil"]
    assert printable("a\nb\x00c\u202ed", 5) == "a b\N{REPLACEMENT CHARACTER}…"
    assert markdown("a_b <c>") == "a\\_b \\<c\\>"
    assert file_name("../../étc/passwd") == "etc-passwd"
    assert page_name("ADA") != page_name("ada")
    assert page_name("CON").startswith("CON-")


def first_row(reports: list[Report], earlier: dict[str, Report]) -> dict[str, str]:
    return next(csv.DictReader(io.StringIO(grades_table(reports, earlier).decode())))


def test_our_own_failure_lowers_no_grade_and_saves_none() -> None:
    broken = outcome("1.b", status=Status.ERROR_OURS, points=0.0)
    ours = report(wrong("1.a"), broken, staff=("1.b: broken",))
    row = first_row([ours], {})
    assert (row["score"], row["status"]) == ("", "error-ours")
    better = report(outcome(), outcome("1.b"))
    row = first_row([ours], {"Ada": better})
    # 1.b keeps what it had; 1.a has failed this time, and that counts.
    assert (row["score"], row["status"]) == ("3", "error-ours, earlier points kept")
    # Points of another submission say nothing about this one.
    other = replace(better, submission="c" * 64)
    row = first_row([ours], {"Ada": other})
    assert (row["score"], row["status"]) == ("", "error-ours")


def test_two_submissions_that_declare_one_name_are_pointed_out() -> None:
    who = [("Ada", "Ada L."), ("Bo", "Ada L."), ("Cy", "Cy"), ("Di", "")]
    reports = [report(student=name, declared=declared) for name, declared in who]
    rows = csv.DictReader(io.StringIO(grades_table(reports, {}).decode()))
    flagged = [row["student"] for row in rows if "as another submission does" in row["notes"]]
    assert flagged == ["Ada", "Bo"]


def test_differences_name_who_and_by_what() -> None:
    before = {
        "Ada": report(outcome(), outcome("1.b")),
        "Bo": report(student="Bo"),
        "Cy": report(student="Cy"),
    }
    now = [report(outcome(), wrong()), report(student="Bo"), report(student="Di")]
    found = {change.student: change for change in changes(now, before)}
    assert set(found) == {"Ada", "Cy", "Di"}
    assert (found["Ada"].before, found["Ada"].after) == (6.0, 3.0)
    assert found["Ada"].checks == ("1.b: passed 3 -> failed 0",)
    assert found["Di"].checks == ("new",)
    assert b"1.b: passed 3 -> failed 0" in changes_table(list(found.values()))


def test_a_record_takes_whatever_a_check_put_into_its_details() -> None:
    odd = {"array": np.ones(2), "number": np.float64("nan"), "set": {1}, "error": float("inf")}
    record = write_record(report(wrong("1.z"), outcome("1.y", details=odd)), b"s" * 16)
    data = json.loads(record)
    assert data["report"]["checks"][1]["details"] == {
        "array": [1.0, 1.0],
        "number": "nan",
        "set": "{1}",
        "error": "inf",
    }
