"""Whose submission is whose, in the layouts of Gradescope, Canvas, Moodle, and in a table."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from photograd_course.assignment.bundle import Bundle
from photograd_course.errors import IoError, SceneError
from photograd_course.submissions import gradescope_names
from photograd_course.submissions.exports import find_sources, is_batch

MODULE = "x = 1\n"


def put(path: Path, text: str = MODULE) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def put_zip(path: Path, text: str = MODULE) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("90_toy/toy.py", text)


def taken(bundle: Bundle, path: Path) -> dict[str, str]:
    """Student to the module's text."""
    sources = find_sources(bundle.manifest, path)
    submissions = {source.student: source.take(bundle.manifest) for source in sources}
    assert len(submissions) == len(sources)
    assert not any(submission.problem for submission in submissions.values())
    return {student: h.files["toy.py"].decode() for student, h in submissions.items()}


def test_gradescope(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "submission_11" / "toy.py", "a = 1\n")
    put(tmp_path / "submission_12" / "90_toy" / "toy.py", "b = 1\n")
    put(tmp_path / "submission_13" / "toy.py", "c = 1\n")
    names = "submission_11:\n  :submitters:\n  - :name: Ada Lovelace\n    :sid: '7'\n"
    names += "submission_12:\n  :submitters:\n  - :name: Bo\n  - :name: Cy\n"
    put(tmp_path / "submission_metadata.yml", names)
    assert is_batch(bundle.manifest, tmp_path)
    assert taken(bundle, tmp_path) == {
        "Ada Lovelace": "a = 1\n",
        "Bo & Cy": "b = 1\n",
        "submission_13": "c = 1\n",
    }


YAML = r"""
submission_11:
  :submitters:
  - :name: "J\u00fcrgen"
    :sid: '007'
  :created_at: !ruby/object:ActiveSupport::TimeWithZone 2026-01-01 00:00:00.0 Z
  :results:
    :tests:
    - :name: secret
submission_12: {":submitters": [{":name": 'O''Brien, A'}, &a {":name": Yes}, *a]}
submission_13:
  :submitters: [{":name": ""}, {":sid": 3}, 7]
submission_14: 3
"""


def test_names_are_read_as_yaml(bundle: Bundle, tmp_path: Path) -> None:
    for number in (11, 12, 13, 14):
        put(tmp_path / f"submission_{number}" / "toy.py", f"a = {number}\n")
    put(tmp_path / "submission_metadata.yml", YAML)
    assert taken(bundle, tmp_path) == {
        "Jürgen": "a = 11\n",
        "O'Brien, A & Yes & Yes": "a = 12\n",
        "submission_13": "a = 13\n",
        "submission_14": "a = 14\n",
    }


def test_yaml_that_grows_or_is_none(
    bundle: Bundle, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(tmp_path / "submission_11" / "toy.py")
    place = tmp_path / "submission_metadata.yml"
    bomb = "a0: &a0 [x]\n" + "".join(f"a{k + 1}: &a{k + 1} [*a{k}, *a{k}]\n" for k in range(60))
    put(place, bomb + "m: &m {<<: [*a60, *a60], ':submitters': *a60}\nsubmission_11: *m\n")
    assert taken(bundle, tmp_path) == {"submission_11": MODULE}
    for text in ("a: [", "- " * 3000 + "a", "a: \x00", "? [b]\n: c\n"):
        put(place, text)
        with pytest.raises(IoError, match=r"expected YAML, got .*remove it, and folders"):
            find_sources(bundle.manifest, tmp_path)
    monkeypatch.setattr(gradescope_names, "LARGEST_NAMES", 8)
    with pytest.raises(IoError, match="at most 0 MB"):
        find_sources(bundle.manifest, tmp_path)


def test_canvas(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "doejane_101_900_submission.zip", "a = 1\n")
    put(tmp_path / "roejim_LATE_102_901_toy-2.py", "b = 1\n")
    put(tmp_path / "roejim_LATE_102_902_answers.toml", "student = 'Jim'\n")
    assert taken(bundle, tmp_path) == {"doejane (101)": "a = 1\n", "roejim (102)": "b = 1\n"}
    (jim,) = [s for s in find_sources(bundle.manifest, tmp_path) if s.student == "roejim (102)"]
    assert set(jim.take(bundle.manifest).files) == {"toy.py", "answers.toml"}


def test_moodle(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "Jane Doe_5_assignsubmission_file_" / "work.zip", "a = 1\n")
    put(tmp_path / "Jane Doe_6_assignsubmission_file" / "toy.py", "b = 1\n")
    put_zip(tmp_path / "Jim Roe_7_assignsubmission_file_work.zip", "c = 1\n")
    assert taken(bundle, tmp_path) == {
        "Jane Doe (5)": "a = 1\n",
        "Jane Doe (6)": "b = 1\n",
        "Jim Roe (7)": "c = 1\n",
    }


def test_zips_and_folders(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "ada.zip", "a = 1\n")
    put(tmp_path / "bob" / "toy.py", "b = 1\n")
    put(tmp_path / ".hidden" / "toy.py")
    assert taken(bundle, tmp_path) == {"ada": "a = 1\n", "bob": "b = 1\n"}


def test_same_names_are_told_apart(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "ada.zip", "a = 1\n")
    put(tmp_path / "ada" / "toy.py", "b = 1\n")
    assert sorted(taken(bundle, tmp_path)) == ["ada (ada)", "ada (ada.zip)"]


def test_a_table(bundle: Bundle, tmp_path: Path) -> None:
    put_zip(tmp_path / "in" / "1.zip", "a = 1\n")
    put(tmp_path / "table.csv", "student,path\n=Ada,in/1.zip\nBob,in/none.zip\n")
    sources = find_sources(bundle.manifest, tmp_path / "table.csv")
    assert [source.student for source in sources] == ["=Ada", "Bob"]
    assert sources[0].take(bundle.manifest).files
    assert "nothing at none.zip" in sources[1].take(bundle.manifest).problem


def test_bad_tables_and_empty_folders(bundle: Bundle, tmp_path: Path) -> None:
    put(tmp_path / "columns.csv", "name,file\nA,b\n")
    put(tmp_path / "twice.csv", "student,path\nA,b\nA,c\n")
    (tmp_path / "empty").mkdir()
    for name, kind in (
        ("columns.csv", SceneError),
        ("twice.csv", SceneError),
        ("empty", IoError),
        ("absent", IoError),
    ):
        with pytest.raises(kind):
            find_sources(bundle.manifest, tmp_path / name)
