"""Nothing that a student may have edited is replaced without a copy beside it."""

from __future__ import annotations

import io
import sys
import zipfile
from pathlib import Path

import pytest
from photograd_course.build.products import write_tree
from photograd_course.errors import IoError
from photograd_course.student.kept import keep_copy, write_keeping
from photograd_course.student.predictions import write_lock

from .small_course import Semester

ARCHIVE = "91_twice/91_twice_submission.zip"
ANSWERS = "91_twice/answers.toml"


@pytest.fixture
def started(semester: Semester) -> Semester:
    """91 is begun, with its one prediction made."""
    semester.put("90_toy/toy.py", semester.solution("90_toy"))
    semester.course("start", "91")
    semester.put(ANSWERS, 'student = "Ada"  # me\n\n[answers]\n"91.p1" = "a"  # my guess\n')
    return semester


def test_copies_are_numbered_and_none_is_made_twice(tmp_path: Path) -> None:
    path = tmp_path / "a.tar.gz"
    path.write_bytes(b"1")
    assert keep_copy(path) == keep_copy(path) == tmp_path / "a.tar.kept-1.gz"
    assert write_keeping(path, b"1") is None
    assert write_keeping(path, b"2") == tmp_path / "a.tar.kept-1.gz"
    assert write_keeping(path, b"3") == tmp_path / "a.tar.kept-2.gz"
    assert [each.read_bytes() for each in sorted(tmp_path.iterdir())] == [b"3", b"1", b"2"]
    with pytest.raises(IoError, match="expected a file that can be read"):
        keep_copy(tmp_path / "none")


def test_an_earlier_archive_is_kept(started: Semester) -> None:
    started.course("submit", "91", "--dir", "91_twice")
    first = (started.home / ARCHIVE).read_bytes()
    said = started.course("submit", "91", "--dir", "91_twice")
    assert "is kept" not in said  # the same files
    started.put("91_twice/twice.py", started.solution("91_twice"))
    said = started.course("submit", "91", "--dir", "91_twice")
    assert "your earlier archive is kept as 91_twice_submission.kept-1.zip" in said
    assert (started.home / "91_twice/91_twice_submission.kept-1.zip").read_bytes() == first
    with zipfile.ZipFile(started.home / ARCHIVE) as archive:
        assert archive.read("twice.py").decode() == started.solution("91_twice")


@pytest.mark.parametrize("out", ["91_twice/twice.py", ANSWERS, "91_twice", "notes.txt"])
def test_an_archive_replaces_nothing_but_archives(started: Semester, out: str) -> None:
    started.put("notes.txt", "PK, but no archive")
    before = started.files()
    said = started.course("submit", "91", "--dir", "91_twice", "--out", out, code=1)
    assert "expected a new file, or a zip archive to replace, got a f" in said
    assert started.files() == before


def test_answers_that_cannot_be_read_leave_no_archive(started: Semester) -> None:
    started.put(ANSWERS, "[answers\n")
    before = started.files()
    started.course("submit", "91", "--dir", "91_twice", code=1)
    assert started.files() == before


def test_a_lock_that_earns_nothing_is_said_before_it_is_handed_in(started: Semester) -> None:
    write_lock(started.home / "91_twice", "91", {"91.p1": "a"})
    assert "damaged" not in started.course("submit", "91", "--dir", "91_twice")
    lock = started.home / "91_twice/predictions.lock.json"
    text = lock.read_text("utf-8")
    for broken in ("", text.replace('"a"', '"b"'), text.replace('"91"', '"92"')):
        lock.write_text(broken, "utf-8")
        said = started.course("submit", "91", "--dir", "91_twice")
        assert "predictions.lock.json: damaged or of another assignment" in said
        assert lock.read_text("utf-8") == broken


def test_notes_in_a_page_are_kept(
    started: Semester, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    started.course("read", "91", "--no-open")
    page = elsewhere / "91_twice.html"
    made = page.read_bytes()
    started.course("read", "91", "--no-open")
    assert [path.name for path in elsewhere.iterdir()] == ["91_twice.html"]
    page.write_bytes(made + b"<!-- mine -->")
    started.course("read", "91", "--no-open")
    assert page.read_bytes() == made
    assert (elsewhere / "91_twice.kept-1.html").read_bytes() == made + b"<!-- mine -->"
    mine = started.put("91_twice/handout.html", "mine")
    started.course("read", "91", "--no-open", "--dir", str(mine.parent))
    assert mine.read_text("utf-8") == "mine"


def test_what_was_written_instead_of_a_letter_is_kept(
    started: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = started.text(ANSWERS).replace('"a"', '"up, for it grows"')
    started.put(ANSWERS, before)
    monkeypatch.setattr(sys, "stdin", io.StringIO("c\nb\n"))  # no option, then one
    said = started.course("predict", "91", "--dir", "91_twice")
    assert "What you wrote for 91.p1 is no letter; it is kept in answers.kept-1.toml." in said
    assert started.text("91_twice/answers.kept-1.toml") == before
    assert started.text(ANSWERS) == before.replace("up, for it grows", "b")
    assert "1 predictions locked" in said


@pytest.mark.parametrize("command", ["predict", "check"])
@pytest.mark.parametrize("variable", ["", "JPY_PARENT_PID", "JPY_SESSION_NAME"])
def test_where_nothing_can_be_typed_the_other_way_is_said(
    started: Semester, monkeypatch: pytest.MonkeyPatch, command: str, variable: str
) -> None:
    started.put(ANSWERS, started.text(ANSWERS).replace('"a"', '""'))
    before = started.files()
    stdin = io.StringIO("")
    if variable:
        monkeypatch.setenv(variable, "1")
        monkeypatch.setattr(stdin, "isatty", lambda: True)  # a notebook's own terminal
    monkeypatch.setattr(sys, "stdin", stdin)
    said = started.course(command, "91", "--dir", "91_twice", code=1)
    assert (
        "none for 91.p1 (write a letter for each into answers.toml, save it, and run this" in said
    )
    assert "'photograd course predict 91' in a terminal" in said
    if command == "predict":
        assert "91.p1 Up or down? a) up b) down" in said
    assert started.files() == before
    started.put(ANSWERS, started.text(ANSWERS).replace('""', '"b"'))
    assert "1 predictions locked" in started.course("predict", "91", "--dir", "91_twice")


def test_a_build_replaces_what_a_build_has_written(tmp_path: Path) -> None:
    files = {"kit/a.py": b"1", "hidden.zip": b"2"}
    write_tree(tmp_path / "00_x", files)
    write_tree(tmp_path / "00_x", {"kit/b.py": b"3"})
    assert not (tmp_path / "00_x/kit/a.py").exists()
    assert (tmp_path / "00_x/kit/b.py").read_bytes() == b"3"
    (tmp_path / "empty").mkdir()
    write_tree(tmp_path / "empty", files)


@pytest.mark.parametrize(
    ("there", "found"),
    [
        ({"toy.py": "mine"}, "toy.py"),
        ({"kit/a.py": "x", "notes.md": "mine"}, "kit"),
        ({"assignment.toml": "", "kit/a.py": ""}, "assignment.toml"),
    ],
)
def test_a_build_replaces_nothing_else(tmp_path: Path, there: dict[str, str], found: str) -> None:
    for path, text in there.items():
        place = tmp_path / "00_x" / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
    with pytest.raises(
        IoError, match=f"one that an earlier build has written, got one with {found}"
    ):
        write_tree(tmp_path / "00_x", {"kit/a.py": b"1"})
    assert {
        path.relative_to(tmp_path / "00_x").as_posix(): path.read_text("utf-8")
        for path in (tmp_path / "00_x").rglob("*")
        if path.is_file()
    } == there
