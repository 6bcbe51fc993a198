"""Learning systems' exports: whose an entry is, which attempt counts, and who was late."""

from __future__ import annotations

import io
import tarfile
import unicodedata
import zipfile
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.submissions.exports import Export, read_export
from photograd_course.submissions.source import Source

from .test_exports import put, put_zip

RECEIPT = """Name: Jane Doe (jdoe)
Assignment: HW 1
Date Submitted: Thursday, October 1, 2026 12:30:45 PM EDT
Current Grade: Needs Grading

Submission Field:
{typed}

Comments:
There are no student comments for this assignment.

Files:
\tOriginal filename: toy.py
\tFilename: HW 1_jdoe_attempt_2026-10-01-12-30-45_toy_py.py
"""
NO_TEXT = "There is no student submission text data for this assignment."


def read(bundle: Bundle, folder: Path) -> tuple[Export, dict[str, Source]]:
    export = read_export(bundle.manifest, folder)
    return export, {source.student: source for source in export.sources}


def text_of(bundle: Bundle, source: Source) -> str:
    taken = source.take(bundle.manifest)
    assert not taken.problem, taken.problem
    return taken.files["toy.py"].decode()


def problem_of(bundle: Bundle, source: Source) -> str:
    taken = source.take(bundle.manifest)
    assert "toy.py" not in taken.files
    return taken.problem


def test_canvas_names_ids_late_marks_and_newer_files(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "doejane_101_900_toy.py", "old = 1\n")
    put(tmp_path / "doejane_101_950_toy-1.py", "new = 1\n")
    put(tmp_path / "roejim_LATE_102_901_toy.py", "b = 1\n")
    put(tmp_path / "anon_x7Kq2_LATE_903_toy.py", "c = 1\n")
    put(tmp_path / "anon_y8Lr3_text.html", "<p>x = 1</p>")
    put(tmp_path / "Team_1_LATE_55_904_toy.py", "d = 1\n")
    put(tmp_path / "poeann_103_text.html", "<p>x = 1</p>")
    put_zip(tmp_path / "koelee_104_905_work.zip", "e = 1\n")
    put(tmp_path / "koelee_104_text.html", "<p>see the file</p>")
    export, found = read(bundle, tmp_path)
    assert not export.ignored
    assert {(s.name, s.id, s.is_late) for s in found.values()} == {
        ("doejane", "101", False),
        ("roejim", "102", True),
        ("anon", "x7Kq2", True),
        ("anon", "y8Lr3", False),
        ("Team_1", "55", True),
        ("poeann", "103", False),
        ("koelee", "104", False),
    }
    jane = found["doejane (101)"]
    assert text_of(bundle, jane) == "new = 1\n"
    (note,) = jane.take(bundle.manifest).warnings[:1]
    assert "doejane_101_950_toy-1.py; not graded: doejane_101_900_toy.py" in note
    assert text_of(bundle, found["Team_1 (55)"]) == "d = 1\n"
    assert "typed online" in problem_of(bundle, found["poeann (103)"])
    assert text_of(bundle, found["koelee (104)"]) == "e = 1\n"
    assert "typed online" in found["koelee (104)"].notes[0]


def test_canvas_files_without_an_order_are_not_guessed(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "doejane_101_950_toy.py", "a = 1\n")
    put(
        tmp_path / "doejane_101_900_toy-1.py", "b = 1\n"
    )  # the names say one order, the numbers another
    put_zip(tmp_path / "roejim_102_901_one.zip", "a = 1\n")
    put_zip(tmp_path / "roejim_102_902_two.zip", "b = 1\n")
    _, found = read(bundle, tmp_path)
    for source in found.values():
        assert "no order: keep one" in problem_of(bundle, source)


def test_moodle_folders_online_texts_feedback_and_blind_marking(
    bundle: Bundle, tmp_path: Path
) -> None:
    put(tmp_path / "Jane Doe_5_assignsubmission_file" / "sub" / "toy.py", "a = 1\n")
    put(tmp_path / "Jane Doe_5_assignsubmission_onlinetext" / "onlinetext.html", "<p>hi</p>")
    put(tmp_path / "Jim Roe_7_assignsubmission_onlinetext_onlinetext.html", "<p>hi</p>")
    put(tmp_path / "Jim Roe_7_assignfeedback_comments.html", "<p>hi</p>")
    put(tmp_path / "Group A-Ann Poe_8_assignsubmission_file_toy.py", "b = 1\n")
    put(tmp_path / "Participant_9_assignsubmission_file_toy.py", "c = 1\n")
    put(tmp_path / "src" / "Lee Koe_10_assignsubmission_file_toy.py", "d = 1\n")
    (tmp_path / "Max Noe_11_assignsubmission_file_").mkdir()
    export, found = read(bundle, tmp_path)
    assert [each.name for each in export.ignored] == ["Jim Roe_7_assignfeedback_comments.html"]
    texts = {"Jane Doe (5)": "a", "Group A-Ann Poe (8)": "b", "Participant (9)": "c"}
    for student, name in {**texts, "Lee Koe (10)": "d"}.items():
        assert text_of(bundle, found[student]) == f"{name} = 1\n"
    assert "typed online" in problem_of(bundle, found["Jim Roe (7)"])
    assert "empty" in problem_of(bundle, found["Max Noe (11)"])
    assert len(found) == 6


def test_blackboard_receipts_attempts_and_texts(bundle: Bundle, tmp_path: Path) -> None:
    start = "HW 1_jdoe_attempt_"
    put(tmp_path / f"{start}2026-09-30-09-00-00.txt", RECEIPT.format(typed=NO_TEXT))
    put(tmp_path / f"{start}2026-09-30-09-00-00_toy.py", "old = 1\n")
    put(tmp_path / f"{start}2026-10-01-12-30-45.txt", RECEIPT.format(typed=NO_TEXT))
    put(tmp_path / f"{start}2026-10-01-12-30-45_toy_py.py", "new = 1\n")
    typed = RECEIPT.format(typed="x = 1").replace("Jane Doe (jdoe)", "Jim Roe (jroe)")
    put(tmp_path / "HW 1_jroe_attempt_2026-10-01-10-00-00.txt", typed.partition("Files:")[0])
    put(tmp_path / "HW 1_apoe_attempt_2026-10-01-10-00-00_toy.py", "b = 1\n")
    export, found = read(bundle, tmp_path)
    assert not export.ignored
    jane = found["Jane Doe (jdoe)"]
    assert (jane.name, jane.id, len(jane.entries)) == ("Jane Doe", "jdoe", 4)
    assert text_of(bundle, jane) == "new = 1\n"
    assert "2026-10-01-12-30-45; not graded: 2026-09-30-09-00-00" in jane.notes[0]
    assert "typed online" in problem_of(bundle, found["Jim Roe (jroe)"])
    assert text_of(bundle, found["apoe (apoe)"]) == "b = 1\n"


@pytest.mark.parametrize("as_folder", [False, True])
def test_brightspace(bundle: Bundle, tmp_path: Path, as_folder: bool) -> None:
    def hand_in(head: str, text: str) -> None:
        put(tmp_path / (f"{head}/toy.py" if as_folder else f"{head} - toy.py"), text)

    hand_in("12345-67890 - Jane Doe - Oct 1, 2026 905 AM", "old = 1\n")
    hand_in("12345-67890 - Jane Doe - Oct 1, 2026 1205 PM", "new = 1\n")
    hand_in("12346-67890 - N0123456 - Jim Roe - 2 October, 2026 1205", "b = 1\n")
    hand_in("12347-67890 - Ann Poe - 1 octobre 2026 12h05", "c = 1\n")
    hand_in("12348-67890 - Lee Koe - 1 octobre 2026 12h05", "d = 1\n")
    hand_in("12348-67890 - Lee Koe - 2 octobre 2026 12h05", "e = 1\n")
    put(tmp_path / "index.html", "<html></html>")
    export, found = read(bundle, tmp_path)
    assert [each.name for each in export.ignored] == ["index.html"]
    assert text_of(bundle, found["Jane Doe (12345)"]) == "new = 1\n"
    assert "Oct 1, 2026 905 AM" in found["Jane Doe (12345)"].notes[0]
    assert text_of(bundle, found["Jim Roe (N0123456)"]) == "b = 1\n"
    assert text_of(bundle, found["Ann Poe (12347)"]) == "c = 1\n"
    assert "several attempts" in problem_of(bundle, found["Lee Koe (12348)"])


def test_classroom_names_and_converted_files(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "Jane Doe - toy.py", "a = 1\n")
    put(tmp_path / "Jane Doe - answers.toml", "student = 'Jane'\n")
    put(tmp_path / "Jim Roe - toy.py.docx", "PK")
    put(tmp_path / "Ann Poe - toy.gdoc", "{}")
    put_zip(tmp_path / "hw1 - lee.zip", "b = 1\n")
    export, found = read(bundle, tmp_path)
    assert not export.ignored
    jane = found["Jane Doe"].take(bundle.manifest)
    assert set(jane.files) == {"toy.py", "answers.toml"}
    for student in ("Jim Roe", "Ann Poe - toy"):
        assert "not converted" in problem_of(bundle, found[student])
    assert text_of(bundle, found["hw1 - lee"]) == "b = 1\n"


def test_gradescope_ids_late_marks_and_who_is_absent(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "assignment_9_export" / "submission_11" / "toy.py", "a = 1\n")
    names = (
        "submission_11:\n  :submitters:\n"
        "  - :name: Jane Doe\n    :sid: '007'\n    :email: jane@example.edu\n"
        "  - :name: Jim Roe\n    :sid: '008'\n  :late: true\n"
        "submission_12:\n  :submitters:\n  - :name: Ann Poe\n"
    )
    put(tmp_path / "assignment_9_export" / "submission_metadata.yml", names)
    export, found = read(bundle, tmp_path)
    assert [each.name for each in export.ignored] == ["assignment_9_export/submission_metadata.yml"]
    both = found["Jane Doe & Jim Roe"]
    assert (both.id, both.email, both.is_late) == ("007; 008", "jane@example.edu", True)
    assert text_of(bundle, both) == "a = 1\n"
    assert "not in the export" in problem_of(bundle, found["Ann Poe"])


def test_a_table_may_have_ids_and_late_marks(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "1.zip")
    put(tmp_path / "table.csv", "student,path,id,late\nAda,1.zip,042,yes\nBo,,,no\n")
    _, found = read(bundle, tmp_path / "table.csv")
    assert (found["Ada"].id, found["Ada"].is_late, found["Bo"].is_late) == ("042", True, False)
    assert "no path" in problem_of(bundle, found["Bo"])


def test_names_in_either_normal_form_are_one_name(bundle: Bundle, tmp_path: Path) -> None:
    name = unicodedata.normalize("NFD", "Jürgen Müller")
    put(tmp_path / f"{name}_5_assignsubmission_file_toy.py")
    put(tmp_path / f"{name} B" / "toy.py")
    _, found = read(bundle, tmp_path)
    assert set(found) == {"Jürgen Müller (5)", "Jürgen Müller B"}


def test_a_module_beside_an_export_makes_it_no_single_submission(
    bundle: Bundle, tmp_path: Path
) -> None:
    put(tmp_path / "toy.py", "a = 1\n")
    put(tmp_path / "doejane_101_900_toy.py", "b = 1\n")
    export, found = read(bundle, tmp_path)
    assert export.is_batch
    assert set(found) == {"doejane (101)", "toy"}


def test_copies_beside_a_single_submission_are_named(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "toy.py")
    put(tmp_path / "toy (1).py")
    put(tmp_path / "toy_test.py")
    export, _ = read(bundle, tmp_path)
    assert not export.is_batch
    assert [each.name for each in export.ignored] == ["toy (1).py"]
    assert "give each a folder" in export.ignored[0].reason


def test_a_zip_of_a_whole_export_is_read_as_it_is(bundle: Bundle, tmp_path: Path) -> None:
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("90_toy/toy.py", "b = 1\n")
    with zipfile.ZipFile(tmp_path / "submissions.zip", "w") as archive:
        archive.writestr("doejane_LATE_101_900_toy.py", "a = 1\n")
        archive.writestr("roejim_102_901_work.zip", inner.getvalue())
        archive.writestr("notes.html", "x")
        archive.writestr("../doepat_103_902_toy.py", "c = 1\n")
    before = sorted(tmp_path.rglob("*"))
    export, found = read(bundle, tmp_path / "submissions.zip")
    assert {text_of(bundle, source) for source in found.values()} == {"a = 1\n", "b = 1\n"}
    assert found["doejane (101)"].is_late
    assert {each.name for each in export.ignored} == {"notes.html", "../doepat_103_902_toy.py"}
    assert sorted(tmp_path.rglob("*")) == before, "something was unpacked"
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        archive.writestr("ada/toy.py", "a = 1\n")
        archive.writestr("bo/90_toy/toy.py", "b = 1\n")
    assert set(read(bundle, tmp_path / "class.zip")[1]) == {"ada", "bo"}
    with tarfile.open(tmp_path / "class.tar.gz", "w:gz") as packed:
        for name in ("ada", "bo"):
            put(tmp_path / name / "toy.py")
            packed.add(tmp_path / name, name)
    assert set(read(bundle, tmp_path / "class.tar.gz")[1]) == {"ada", "bo"}
