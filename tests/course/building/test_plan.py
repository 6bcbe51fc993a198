"""The plan of the course, the syllabus, and new assignments."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from photograd_course.build import kits
from photograd_course.build.course_file import course_findings, plan_without, read_course
from photograd_course.build.kits import ENVIRONMENT, source_folders
from photograd_course.build.new import new_assignment
from photograd_course.build.syllabus import syllabus
from photograd_course.cli import run
from photograd_course.errors import RangeError, SceneError

from support.tree import ROOT

PLAN = """
[[assignment]]
id = "01"
title = "One"
hours = 8
prerequisites = []

[[assignment]]
id = "02"
title = "Two"
hours = 4
prerequisites = ["01"]

[track.short]
title = "Two weeks"
weeks = [["01"], ["02"]]
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "course.toml").write_text(PLAN, "utf-8")
    return tmp_path


@pytest.mark.parametrize("track", ["quarter", "semester"])
def test_the_course_of_this_repository_has_all_that_it_needs(track: str) -> None:
    table = syllabus(track, ROOT / "assignments")
    ready = {row["assignment"] for row in table["weeks"] if row["state"] == "ready"}
    assert ready == {name[:2] for name in source_folders(ROOT / "assignments")} & {
        row["assignment"] for row in table["weeks"]
    }
    assert "00" in ready
    assert table["planned"] == len(table["weeks"]) - len(ready)


def test_weeks_hours_and_prerequisites(root: Path) -> None:
    table = syllabus("short", root)
    assert table["estimated_hours"] == 12
    assert table["ready"] == 0
    assert [(row["week"], row["needs"], row["state"]) for row in table["weeks"]] == [
        (1, "nothing", "planned"),
        (2, "01", "planned"),
    ]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            '[["01"], ["02"]]',
            '[["02"], ["01"]]',
            "track short: 02 needs 01, which comes not before",
        ),
        ('[["01"], ["02"]]', '[["02"]]', "track short: 02 needs 01, which comes not before"),
        ('[["01"], ["02"]]', '[["01"], ["03"]]', "track short names 03"),
        ('prerequisites = ["01"]', 'prerequisites = ["00"]', "02 needs 00, which the course does"),
    ],
)
def test_a_missing_prerequisite_is_found(root: Path, old: str, new: str, said: str) -> None:
    (root / "course.toml").write_text(PLAN.replace(old, new), "utf-8")
    assert said in " ".join(course_findings(read_course(root)))
    with pytest.raises(SceneError, match=said):
        syllabus("short", root)


def test_a_missing_prerequisite_fails_the_build(
    root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (root / "course.toml").write_text(PLAN.replace('[["01"], ["02"]]', '[["02"]]'), "utf-8")
    new_assignment("17", "light", root)
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(root))
    command = ["course", "build", "--no-answers", "--out", str(root / "out"), "--json"]
    assert run(command, plugins=[]) == 1
    captured = capsys.readouterr()
    assert json.loads(captured.out)["findings"] == 1
    assert "track short: 02 needs 01" in captured.err
    assert not (root / "out").exists()


def test_what_a_manifest_says_is_not_said_twice(root: Path) -> None:
    """Two places differ in the end: the plan names an assignment that has a folder, no more."""
    new_assignment("01", "light", root)
    found = course_findings(read_course(root))
    twice = "has title, hours, prerequisites in its manifest: remove them here"
    assert f"assignment 01 {twice}" in found
    facts = 'id = "01"\ntitle = "One"\nhours = 8\nprerequisites = []\n'
    assert facts in PLAN
    (root / "course.toml").write_text(PLAN.replace(facts, 'id = "01"\n'), "utf-8")
    course = read_course(root)
    assert course_findings(course) == []
    assert (course.entries["01"].title, course.entries["01"].ready) == ("light", True)
    assert course_findings(read_course(ROOT / "assignments")) == []
    # Where its folder is left out, the plan has to say what its manifest said.
    text = plan_without(root, []).decode()
    elsewhere = root / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "course.toml").write_text(text, "utf-8")
    assert read_course(elsewhere).entries["01"].title == "light"
    assert plan_without(root, ["01_light"]).decode() == PLAN.replace(facts, 'id = "01"\n')


def test_a_track_is_a_word_or_an_option(
    root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(ENVIRONMENT, str(root))
    for words in (["short"], ["--track", "short"], ["short", "--track", "short"]):
        assert run(["course", "syllabus", *words, "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["track"] == "short"
    assert run(["course", "syllabus", "short", "--track", "quarter"]) == 2
    assert "give one of them" in " ".join(capsys.readouterr().err.split())


def test_a_track_that_does_not_exist(root: Path) -> None:
    with pytest.raises(RangeError, match="short"):
        syllabus("long", root)


@pytest.mark.parametrize("text", ["", "[[assignment]]\nid = 3\n", '[track]\nx = "y"\n'])
def test_a_plan_of_another_form_is_refused(root: Path, text: str) -> None:
    (root / "course.toml").write_text(text, "utf-8")
    with pytest.raises(SceneError, match=r"course\.toml"):
        read_course(root)


@pytest.mark.parametrize(
    ("number", "name"),
    [("1", "light"), ("xx", "light"), ("17", "Light"), ("17", "class"), ("17", "two words")],
)
def test_new_refuses_what_is_no_number_or_name(tmp_path: Path, number: str, name: str) -> None:
    with pytest.raises(RangeError):
        new_assignment(number, name, tmp_path)
    assert not list(tmp_path.iterdir())


def test_new_refuses_a_taken_number(scaffold: Path) -> None:
    with pytest.raises(RangeError, match="17_light has it"):
        new_assignment("17", "other", scaffold.parent)


def test_what_was_scaffolded_can_be_built_as_the_note_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In an install that is no checkout, where the folder has to be named."""
    monkeypatch.setattr(kits, "PACKAGE", tmp_path / "site-packages" / "photograd_course")
    monkeypatch.delenv(ENVIRONMENT, raising=False)
    monkeypatch.chdir(tmp_path)
    for command in (["course", "grade", "77", "."], ["course", "build", "77"]):
        assert run(command) == 1
        assert f"set {ENVIRONMENT} to their folder" in " ".join(capsys.readouterr().err.split())
    assert run(["course", "new", "77", "tiny"]) == 0
    noted = "".join(capsys.readouterr().err.split())
    assert f"{ENVIRONMENT}={tmp_path / 'assignments'}photogradcoursebuild77" in noted
    monkeypatch.setenv(ENVIRONMENT, str(tmp_path / "assignments"))
    assert list(source_folders()) == ["77_tiny"]
