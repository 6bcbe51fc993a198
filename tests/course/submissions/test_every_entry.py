"""Every entry of a folder is taken for exactly one thing, and every submission gets a verdict."""

from __future__ import annotations

import csv
import os
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from photograd_course.assignment.bundle import Bundle
from photograd_course.submissions.containers import list_folder
from photograd_course.submissions.exports import find_sources, read_export, sort_entries
from photograd_course.submissions.grades_csv import grades_table
from photograd_course.submissions.listing import Entry

from .test_exports import put, put_zip
from .test_reports import report

STUDENTS = st.sampled_from(
    ["doejane", "Jane Doe", "José", "Jose\u0301", "O'Neil, Pat", "anon", "a_b"]
)
NUMBERS = st.sampled_from(["1", "42", "103297"])
FILES = st.sampled_from(
    ["toy.py", "toy-1.py", "Toy.PY", "work.zip", "w.tar.gz", "w.7z", "n.ipynb", "answers.toml"]
)
DATES = st.sampled_from(["Oct 1, 2026 905 AM", "2 October, 2026 1205", "1 octobre 2026 12h05"])
STAMPS = st.sampled_from(["2026-10-01-12-30-45", "2026-10-02-00-00-00"])
ODD = st.sampled_from(
    [".DS_Store", "__MACOSX", "._toy.py", "index.html", "submission_metadata.yml", ".hidden"]
)
LATE = st.sampled_from(["", "LATE_"])
PARTS = ("file_", "file", "onlinetext", "comments")
NAMES = st.one_of(
    st.builds("{}_{}{}_{}_{}".format, STUDENTS, LATE, NUMBERS, NUMBERS, FILES),
    st.builds("{}_{}{}_text.html".format, STUDENTS, LATE, NUMBERS),
    st.builds("{}_{}_assignsubmission_{}".format, STUDENTS, NUMBERS, st.sampled_from(PARTS)),
    st.builds("{}_{}_assignsubmission_file_{}".format, STUDENTS, NUMBERS, FILES),
    st.builds("{}_{}_assignfeedback_comments.html".format, STUDENTS, NUMBERS),
    st.builds("HW 1_{}_attempt_{}_{}".format, STUDENTS, STAMPS, FILES),
    st.builds("HW 1_{}_attempt_{}.txt".format, STUDENTS, STAMPS),
    st.builds("{0}-{0} - {1} - {2} - {3}".format, NUMBERS, STUDENTS, DATES, FILES),
    st.builds("{0}-{0} - {1} - {2}".format, NUMBERS, STUDENTS, DATES),
    st.builds("{} - {}".format, STUDENTS, FILES),
    st.builds("{}{}".format, STUDENTS, st.sampled_from(["", ".zip", ".rar", ".docx", ".csv"])),
    FILES,
    ODD,
    st.text(min_size=1, max_size=12).filter(lambda name: "/" not in name and "\0" not in name),
)
KINDS = st.sampled_from(["file", "file", "folder", "link", "device"])


def entry_of(name: str, kind: str) -> Entry:
    inside = [Entry("toy.py", "file", 6, lambda limit: b"x = 1\n"[:limit])]
    below = (lambda: inside) if kind == "folder" else None
    return Entry(name, kind, 6, lambda limit: b"x = 1\n"[:limit], below)


def names_of(entry: Entry) -> Entry:
    return Entry(entry.name, "file", 2, lambda limit: b"{}"[:limit])


@given(st.dictionaries(NAMES, KINDS, max_size=12))
@settings(max_examples=400, deadline=None)
def test_the_entries_are_partitioned(bundle: Bundle, listed: dict[str, str]) -> None:
    entries = [entry_of(name, kind) for name, kind in listed.items()]
    entries = [names_of(e) if e.name == "submission_metadata.yml" else e for e in entries]
    export = sort_entries(bundle.manifest, Path("nowhere"), entries)
    taken = [name for source in export.sources for name in source.entries]
    named = [each.name for each in export.ignored]
    assert Counter(taken + named) == Counter(entry.name for entry in entries)
    assert all(each.reason for each in export.ignored)
    students = [source.student for source in export.sources]
    assert len(students) == len(set(students))
    for source in export.sources:
        submission = source.take(bundle.manifest)
        assert submission.problem or "toy.py" in submission.files


def test_a_flat_folder_gives_a_row_or_a_reason_for_everything(
    bundle: Bundle, tmp_path: Path
) -> None:
    put_zip(tmp_path / "jane.zip")
    for name in ("john.tar.gz", "kim.7z", "lee.rar", "mary.ipynb", "ada.docx", "bob.py.txt"):
        put(tmp_path / name, "{}")
    put(tmp_path / "LOU.PY")
    put(tmp_path / "toy (1).py")  # as a browser names the second download
    (tmp_path / "empty").mkdir()
    (tmp_path / "linked").symlink_to(tmp_path / "empty")
    put(tmp_path / "grades.csv", "a,b\n")
    put(tmp_path / "README.txt")
    put(tmp_path / ".DS_Store")
    export = read_export(bundle.manifest, tmp_path)
    said = {source.student: source.take(bundle.manifest).problem for source in export.sources}
    expected = {
        "jane": "",
        "john": "no readable tar archive",
        "kim": "hand in a zip",
        "lee": "hand in a zip",
        "mary": "is a notebook, hand in toy.py itself",
        "ada": "not converted",
        "bob": "rename it to toy.py",
        "LOU": "rename it to toy.py",
        "toy (1)": "",
        "empty": "empty",
        "linked": "is a link",
    }
    assert set(said) == set(expected)
    for student, words in expected.items():
        assert words in said[student], student
    assert {each.name for each in export.ignored} == {"grades.csv", "README.txt", ".DS_Store"}
    assert [each.name for each in export.ignored if each.is_noise] == [".DS_Store"]
    listed = {entry.name for entry in list_folder(tmp_path)}
    taken = {name for source in export.sources for name in source.entries}
    assert taken | {each.name for each in export.ignored} == listed


def test_a_folder_of_what_is_no_submission_says_so(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "notes.csv")
    with pytest.raises(OSError, match=r"expected submissions, got nothing but notes\.csv"):
        read_export(bundle.manifest, tmp_path)


def test_rows_of_one_name_without_a_number_are_told_apart(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "ada.zip")
    put(tmp_path / "ada" / "toy.py")
    put(tmp_path / "Jo_5_assignsubmission_file_toy.py")
    put(tmp_path / "Jo_6_assignsubmission_file_toy.py")
    sources = read_export(bundle.manifest, tmp_path).sources
    table = grades_table([report(student=source.student) for source in sources], {}, sources)
    rows = [(row["student"], row["id"]) for row in csv.DictReader(table.decode().splitlines())]
    assert rows == [("Jo", "5"), ("Jo", "6"), ("ada (ada)", ""), ("ada (ada.zip)", "")]


def test_names_without_access_cost_their_own_row_alone(
    bundle: Bundle, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(tmp_path / "ada" / "toy.py")
    put(tmp_path / "bo" / "toy.py")
    real = Path.lstat

    def lstat(path: Path) -> os.stat_result:
        if path.parent.name == "bo":
            raise PermissionError(13, "Permission denied", str(path))
        return real(path)

    monkeypatch.setattr(Path, "lstat", lstat)
    found = {s.student: s.take(bundle.manifest) for s in find_sources(bundle.manifest, tmp_path)}
    assert set(found) == {"ada", "bo"}
    assert not found["ada"].problem
    assert "without access" in found["bo"].problem
