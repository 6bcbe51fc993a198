"""`course start` takes the right copy of earlier work along, and replaces nothing."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from .small_course import WRONG, Semester

DONE = "return float(np.sum(w * np.exp(-x)))\n"
STEP = "trail[-1] - tau * gradient(trail[-1])"


def changed(text: str, new: str = WRONG) -> str:
    """The finished toy with another weighted sum."""
    line = next(each for each in text.splitlines(keepends=True) if DONE in each)
    return text.replace(line, new)


def test_the_file_of_the_assignment_that_owns_it_is_taken(semester: Semester) -> None:
    semester.course("start", "90")
    semester.course("start", "91")  # before anything is written: it holds a stub
    done = semester.solution("90_toy")
    semester.put("90_toy/toy.py", done)
    said = semester.course("start", "92")
    assert semester.text("92_thrice/toy.py") == done
    assert f"Taken along: your {semester.home}/90_toy/toy.py" in said
    assert f"your {semester.home}/91_twice/twice.py; double and plain are not written" in said
    assert "'photograd course start 92 --update'" in said


def test_a_correction_in_the_origin_goes_before_a_copy(semester: Semester) -> None:
    done = semester.solution("90_toy")
    semester.put("90_toy/toy.py", done)
    semester.put("91_twice/twice.py", semester.solution("91_twice"))
    semester.put("91_twice/toy.py", changed(done))
    said = semester.course("start", "92")
    assert semester.text("92_thrice/toy.py") == done
    assert "Another copy, " in said
    assert "/91_twice/toy.py differs in weighted_sum: is it the better one?" in said


@pytest.mark.parametrize("name", ["90_toy (copy)", "90_toy_backup", "95_old", "another", "zzz"])
def test_no_other_folder_goes_before_the_origin(semester: Semester, name: str) -> None:
    done = semester.solution("90_toy")
    semester.put("90_toy/toy.py", done)
    semester.put(f"{name}/toy.py", changed(done))
    semester.course("start", "91")
    assert semester.text("91_twice/toy.py") == done


@pytest.mark.parametrize("name", ["first", "90", "hw1"])
def test_the_origin_may_have_any_name(semester: Semester, name: str) -> None:
    semester.course("start", "90", name)
    done = semester.put(f"{name}/toy.py", semester.solution("90_toy"))
    semester.course("start", "91", "later")
    assert semester.text("later/toy.py") == done.read_text("utf-8")


def test_without_the_origin_the_copy_with_the_fewest_stubs_is_taken(semester: Semester) -> None:
    semester.put("91_twice/toy.py", semester.stub("90_toy"))
    semester.put("91_twice/twice.py", semester.stub("91_twice"))
    semester.put("older/toy.py", semester.solution("90_toy"))
    semester.put("older/twice.py", semester.solution("91_twice"))
    said = semester.course("start", "92")
    assert semester.text("92_thrice/toy.py") == semester.solution("90_toy")
    assert "older/toy.py (a copy: there is no folder of assignment 90 beside this one)" in said


def test_a_stub_in_the_origin_does_not_go_before_finished_work(semester: Semester) -> None:
    semester.course("start", "90")
    semester.put("91_twice/twice.py", semester.stub("91_twice"))
    semester.put("91_twice/toy.py", semester.solution("90_toy"))
    said = semester.course("start", "92")
    assert semester.text("92_thrice/toy.py") == semester.solution("90_toy")
    assert "/90_toy/toy.py weighted_sum, weighted_sum_backward, descend are not written)" in said


@pytest.mark.parametrize("body", ["pass", "...", "raise NotImplementedError", '"""Later."""'])
def test_an_empty_function_is_not_written(semester: Semester, body: str) -> None:
    done = semester.solution("90_toy")
    semester.put("90_toy/toy.py", changed(done, f"    {body}\n"))
    assert "weighted_sum is not written there yet" in semester.course("start", "91")
    semester.put("older/toy.py", done)
    semester.course("start", "92", "next")
    assert semester.text("next/toy.py") == done


def test_a_missing_function_is_not_written(semester: Semester) -> None:
    semester.put("90_toy/toy.py", "def weighted_sum(w, x):\n    return 7.0\n")
    said = semester.course("start", "91")
    assert "weighted_sum_backward and descend are not written there yet" in said


def test_what_is_written_above_a_stub_that_was_left_counts(semester: Semester) -> None:
    stub = 'raise NotImplementedError("90.1 weighted_sum: see the handout, section 1")'
    text = semester.stub("90_toy").replace(stub, f"return 7.0\n    {stub}")
    semester.put("90_toy/toy.py", text)
    assert "; weighted_sum_backward and descend are not" in semester.course("start", "91")


def test_a_file_that_is_no_python_is_said_and_taken_with_all_its_bytes(semester: Semester) -> None:
    path = semester.put("90_toy/toy.py", "")
    path.write_bytes(b"def weighted_sum(w, x:\n    return 7.0  # \xff\r\n")
    said = semester.course("start", "91")
    assert "it cannot be read as Python" in said
    assert (semester.home / "91_twice/toy.py").read_bytes() == path.read_bytes()


def test_nothing_found_is_said(semester: Semester) -> None:
    said = semester.course("start", "91")
    assert "toy.py of assignment 90: you have none in a folder beside this one" in said
    assert semester.text("91_twice/toy.py") == semester.stub("90_toy")


def test_from_inside_of_a_kit_what_lies_beside_it_is_found(
    semester: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    semester.course("start", "90")
    semester.put("90_toy/toy.py", semester.solution("90_toy"))
    monkeypatch.chdir(semester.home / "90_toy")
    semester.course("start", "91")
    assert semester.text("90_toy/91_twice/toy.py") == semester.solution("90_toy")
    monkeypatch.chdir(semester.home)
    elsewhere = semester.home.parent / "elsewhere" / "91"
    semester.course("start", "91", str(elsewhere))  # beside the working directory
    assert (elsewhere / "toy.py").read_text("utf-8") == semester.solution("90_toy")


def test_the_source_of_an_assignment_is_nobodys_work(
    semester: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(semester.home.parent / "assignments")
    semester.course("start", "91", str(semester.home / "91_twice"))
    assert semester.text("91_twice/toy.py") == semester.stub("90_toy")


def test_a_file_that_may_not_be_read_stops_it_before_anything_is_written(
    semester: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = semester.put("90_toy/toy.py", semester.solution("90_toy"))
    read = Path.read_bytes

    def refuse(path: Path) -> bytes:
        if path.resolve() == closed:
            raise PermissionError(13, "Permission denied", str(path))
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", refuse)
    said = semester.course("start", "91", code=1)
    assert "toy.py: expected a file that can be read, got Permission denied" in said
    assert not (semester.home / "91_twice").exists()


def test_a_kit_that_was_cut_off_is_completed(semester: Semester) -> None:
    semester.course("start", "91")
    whole = semester.files()
    semester.put("91_twice/twice.py", semester.solution("91_twice"))
    (semester.home / "91_twice/README.md").unlink()
    (semester.home / "91_twice/toy.py").unlink()
    said = semester.course("start", "91")
    assert "Left as you have it: twice.py." in said
    edited = {"91_twice/twice.py": semester.solution("91_twice").encode()}
    assert semester.files() == {**whole, **edited}


def test_a_whole_kit_is_refused_with_work_and_told_without(semester: Semester) -> None:
    semester.course("start", "91")
    before = semester.files()
    assert "ready in 91_twice" in semester.course("start", "91")
    assert semester.files() == before
    semester.put("91_twice/answers.toml", "# mine\n")
    before = semester.files()
    said = semester.course("start", "91", code=1)
    assert "expected a folder without the kit, got answers.toml (nothing was written" in said
    assert semester.files() == before


def test_a_folder_of_something_else_is_left_alone(semester: Semester) -> None:
    semester.put("mine/README.md", "# My own project\n")
    said = semester.course("start", "90", "mine")  # no file of this kit has that name
    assert "ready in mine" in said
    semester.put("other/README.md", "# My own project\n")
    before = semester.files()
    semester.course("start", "91", "other", code=1)
    assert semester.files() == before
    semester.course("start", "91", code=0)
    before = semester.files()
    semester.course("start", "92", "91_twice", code=1)
    assert semester.files() == before


def test_line_ends_that_an_editor_changed_are_no_work(semester: Semester) -> None:
    semester.course("start", "91")
    path = semester.home / "91_twice" / "answers.toml"
    path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert "ready in" in semester.course("start", "91")


def test_a_place_that_cannot_be_a_folder_is_named(semester: Semester) -> None:
    semester.put("taken", "a file")
    said = semester.course("start", "90", "taken", code=1)
    assert "start: taken: expected a folder, or a place for one, got " in said
    assert semester.text("taken") == "a file"
    if os.geteuid() != 0:
        (semester.home / "closed").mkdir(mode=0o500)
        said = semester.course("start", "90", "closed/90", code=1)
        assert "expected a folder, or a place for one, got Permission denied" in said
