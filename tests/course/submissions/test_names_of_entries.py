"""What names of entries say, and that students cannot make them say something else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.submissions.layouts import read_name
from photograd_course.submissions.moments import moment_of

from .test_exports import put
from .test_layouts import NO_TEXT, RECEIPT, read


@pytest.mark.parametrize(
    "start", ["doejane_101_900_", "Jane Doe_5_assignsubmission_file_", "HW 1_jdoe_attempt_"]
)
@pytest.mark.parametrize(
    "end",
    [
        "roejim_102_901_toy.py",
        "roejim_102_text.html",
        "roejim102_question_1_2_toy.py",
        "anon_x7Kq2_901_toy.py",
        "Jim Roe_7_assignsubmission_file_toy.py",
        "HW 1_jroe_attempt_2026-10-01-12-30-45_toy.py",
        "12346-67890 - Jim Roe - Oct 1, 2026 905 AM - toy.py",
        "Jim Roe - toy.py",
    ],
)
def test_no_student_names_a_file_into_the_row_of_another(
    bundle: Bundle, start: str, end: str
) -> None:
    stamp = "2026-09-30-09-00-00_" if start.endswith("attempt_") else ""
    label = read_name(bundle.manifest, f"{start}{stamp}{end}")
    assert label is not None
    assert label.id in ("101", "5", "jdoe")
    assert label.file == end
    assert read_name(bundle.manifest, "12345-67890 - Jane Doe - Oct 1, 2026 905 AM - " + end) == (
        replace(
            read_name(bundle.manifest, "12345-67890 - Jane Doe - Oct 1, 2026 905 AM - x.py"),  # type: ignore[type-var]
            file=end,
        )
    )


def test_a_receipt_says_a_name_in_its_first_line_alone(bundle: Bundle, tmp_path: Path) -> None:
    forged = "Name: Jim Roe (jroe)\n" + RECEIPT.format(typed=NO_TEXT)
    text = RECEIPT.format(typed="Name: Jim Roe (jroe)")
    put(tmp_path / "HW 1_jdoe_attempt_2026-10-01-12-30-45.txt", text)
    put(tmp_path / "HW 1_apoe_attempt_2026-10-01-12-30-45.txt", "Comments:\n" + forged)
    _, found = read(bundle, tmp_path)
    assert set(found) == {"Jane Doe (jdoe)", "apoe (apoe)"}


def test_names_of_quizzes_and_of_great_length(bundle: Bundle) -> None:
    label = read_name(bundle.manifest, "doejane101_question_55_900_toy.py")
    assert label is not None
    assert (label.name, label.id, label.file) == ("doejane", "101", "toy.py")
    assert read_name(bundle.manifest, "1" * 60_000 + "_1_1_toy.py") is None


@pytest.mark.parametrize(
    ("text", "moment"),
    [
        ("Mar 29, 2018 1205 PM", "2018-03-29T12:05:00"),
        ("Mar 29, 2018 12:05 AM", "2018-03-29T00:05:00"),
        ("Thursday, March 29, 2018 905", "2018-03-29T09:05:00"),
        ("29 March, 2018 at 1205", "2018-03-29T12:05:00"),
        ("2018-03-29 120501", "2018-03-29T12:05:01"),
        ("29 mars 2018 12h05", ""),
        ("Foo 29, 2018 1205", ""),
        ("Mar 31, 2018 2505", ""),
        ("Mar 29, 2018", ""),
    ],
)
def test_dates(text: str, moment: str) -> None:
    assert moment_of(text) == moment
