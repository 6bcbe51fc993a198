"""Gradebooks of learning systems, filled and read back with their documented columns."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.errors import IoError, SceneError
from photograd_course.submissions.command import with_late_marks
from photograd_course.submissions.exports import read_export
from photograd_course.submissions.gradebook import Score, read_gradebook
from photograd_course.submissions.source import Person

from .test_exports import put

CANVAS = (
    "Student,ID,SIS User ID,SIS Login ID,Section,HW 0 (11),A weighted sum and its derivative (12),"
    "Current Score,Final Score\n"
    "    Points Possible,,,,,10,21,(read only),(read only)\n"
    '"Doe, Jane",101,S1,jdoe,Lab 1,9,,90,90\n'
    '"Roe, Jim",102,S2,jroe,Lab 1,8,3,80,80\n'
    '"Poe, Ann",103,S3,apoe,Lab 2,7,,70,70\n'
    '"Poe, Ann",104,S4,apoe2,Lab 2,7,,70,70\n'
)
WORKSHEET = (
    "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,"
    "Last modified (submission),Last modified (grade),Feedback comments\n"
    'Participant 5,Jane Doe,jane@example.edu,Submitted for grading,,"75,00",Yes,-,-,\n'
    'Participant 6,José Roe,jose@example.edu,Submitted for grading,,"75,00",Yes,-,-,\n'
)
MOODLE = (
    "First name\tLast name\tID number\tEmail address\t"
    "Assignment: A weighted sum and its derivative (Real)\tCourse total (Real)\n"
    "Jane\tDoe\t42\tjane@example.edu\t-\t-\n"
    "Jim\tRoe\t43\tjim@example.edu\t-\t-\n"
)


def score(points: float | None, *people: Person, student: str = "") -> Score:
    return Score(student or people[0].name, people, points)


def write(folder: Path, text: str) -> Path:
    path = folder / "book.csv"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    return path


def rows_of(data: bytes, delimiter: str = ",") -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode()), delimiter=delimiter))


def test_canvas_by_number_and_by_name(bundle: Bundle, tmp_path: Path) -> None:
    book = read_gradebook(write(tmp_path, CANVAS), bundle.manifest)
    assert book.max_score == 21
    filled = book.fill(
        [
            score(12.5, Person("doejane", "101")),
            score(None, Person("roejim", "102")),
            score(3, Person("nobody", "999")),
            score(4, Person("Team_1", "55")),
        ]
    )
    column = "A weighted sum and its derivative (12)"
    head, jane, jim, *others = rows_of(filled.data)
    # What Canvas asks for, and no column whose grades may be newer there by now.
    assert list(head) == ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", column]
    assert (head["Student"], head[column]) == ("    Points Possible", "21")
    assert (jane["Student"], jane["ID"], jane[column]) == ("Doe, Jane", "101", "12.5")
    assert jim[column] == "3"  # what was there
    assert [row[column] for row in others] == ["", ""]
    assert filled.count == 1
    assert filled.unmatched == (
        ("roejim", "has no score, since the grader failed"),
        ("nobody", "the number 999 is not in the gradebook"),
        ("Team_1", "the number 55 is not in the gradebook"),
    )


def test_canvas_by_names_from_elsewhere(bundle: Bundle, tmp_path: Path) -> None:
    book = read_gradebook(write(tmp_path, CANVAS), bundle.manifest, "hw 0")
    pair = (Person("Jane Doe", "G7"), Person("Jim Roe", "G8", "JROE"))
    filled = book.fill(
        [score(20, *pair, student="Jane Doe & Jim Roe"), score(5, Person("Ann Poe"))]
    )
    points = [row["HW 0 (11)"] for row in rows_of(filled.data)]
    assert points == ["10", "20", "20", "7", "7"]
    assert filled.unmatched == (("Ann Poe", "the name Ann Poe is in 2 rows of the gradebook"),)


def test_two_submissions_for_one_row_fill_none(bundle: Bundle, tmp_path: Path) -> None:
    book = read_gradebook(write(tmp_path, CANVAS), bundle.manifest)
    filled = book.fill(
        [score(5, Person("Jane Doe")), score(7, Person("x", "", "jdoe"), student="both")]
    )
    assert filled.count == 0
    assert {student for student, _ in filled.unmatched} == {"Jane Doe", "both"}
    assert all("one row of the gradebook" in why for _, why in filled.unmatched)


def test_the_grading_worksheet_of_moodle(bundle: Bundle, tmp_path: Path) -> None:
    book = read_gradebook(write(tmp_path, WORKSHEET), bundle.manifest)
    assert book.max_score == 75
    filled = book.fill([score(12.5, Person("Jane Doe", "5")), score(75, Person("Jose\u0301 Roe"))])
    jane, jose = rows_of(filled.data)
    assert list(jane) == WORKSHEET.partition("\n")[0].split(",")
    assert (jane["Identifier"], jane["Grade"], jose["Grade"]) == ("Participant 5", "12,5", "75")
    assert jane["Maximum Grade"] == "75,00"
    assert filled.unmatched == ()


def test_the_worksheet_of_moodle_says_who_is_late(bundle: Bundle, tmp_path: Path) -> None:
    late = WORKSHEET.replace("Submitted for grading", "Submitted for grading - 2 hours late", 1)
    book = read_gradebook(write(tmp_path, late), bundle.manifest)
    put(tmp_path / "in" / "Jane Doe_5_assignsubmission_file_toy.py")
    put(tmp_path / "in" / "José Roe_6_assignsubmission_file_toy.py")
    export = with_late_marks(read_export(bundle.manifest, tmp_path / "in"), book)
    assert [(each.name, each.is_late) for each in export.sources] == [
        ("Jane Doe", True),
        ("José Roe", False),
    ]


def test_the_gradebook_of_moodle(bundle: Bundle, tmp_path: Path) -> None:
    book = read_gradebook(write(tmp_path, MOODLE), bundle.manifest)
    filled = book.fill(
        [score(1, Person("J. Doe", "", "Jane@example.edu")), score(2, Person("Roe, Jim"))]
    )
    found = rows_of(filled.data, "\t")
    name = "Assignment: A weighted sum and its derivative (Real)"
    assert [row[name] for row in found] == ["1", "2"]
    assert [row["Course total (Real)"] for row in found] == ["-", "-"]


def test_brightspace_and_blackboard_numbers(bundle: Bundle, tmp_path: Path) -> None:
    points = "Toy Points Grade <Numeric MaxPoints:21>"
    text = f"OrgDefinedId,Last Name,First Name,{points},End-of-Line Indicator\n#N01,Doe,Jane,,#\n"
    book = read_gradebook(write(tmp_path, text), bundle.manifest, "Toy")
    (row,) = rows_of(book.fill([score(7, Person("Someone", "N01"))]).data)
    assert (row["OrgDefinedId"], row[points]) == ("#N01", "7")
    text = (
        "Last Name,First Name,Username,Student ID,HW [Total Pts: 21 Score] |9\nDoe,Jane,jdoe,7,\n"
    )
    book = read_gradebook(write(tmp_path, text), bundle.manifest, "HW")
    (row,) = rows_of(book.fill([score(7, Person("Jane Doe", "jdoe"))]).data)
    assert row["HW [Total Pts: 21 Score] |9"] == "7"


def test_gradebooks_that_cannot_be_filled(bundle: Bundle, tmp_path: Path) -> None:
    for text, column, says in (
        ("a,b\n1,2\n", None, "expected a gradebook with a column such as ID"),
        (CANVAS.replace("A weighted sum", "Another"), None, "name it with --gradebook-column"),
        (CANVAS, "Section", "expected one column for Section"),
        (CANVAS, "Current Score", "expected one column for Current Score"),
        ("Student,Homework 1,Homework 2\n", "Homework", "got Homework 1, Homework 2"),
        ("", None, "expected a gradebook"),
    ):
        with pytest.raises(SceneError, match=says):
            read_gradebook(write(tmp_path, text), bundle.manifest, column)
    (tmp_path / "latin.csv").write_bytes(b"Student,\xe9\n")
    for name in ("latin.csv", "none.csv"):
        with pytest.raises(IoError):
            read_gradebook(tmp_path / name, bundle.manifest)
