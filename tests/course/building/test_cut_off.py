"""A command for instructors that was cut off can be run again, and gives the same in the end."""

from __future__ import annotations

import shutil
from collections.abc import Collection, Mapping
from pathlib import Path

import pytest
from photograd_course.build.kits import ENVIRONMENT
from photograd_course.build.secret import course_secret
from photograd_course.cli import run

from course.student.interrupted import FULL, INTERRUPTED, KILLED, MORE_THAN_ANY, Ending, run_until

from .support import TOY

SECRET = "a secret of this test, 32 bytes!"


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with sources, a secret, one submission, and verdicts of an earlier build."""
    shutil.copytree(TOY, tmp_path / "assignments" / "90_toy")
    (tmp_path / "secret.txt").write_text(SECRET, encoding="utf-8")
    (tmp_path / "class" / "ada").mkdir(parents=True)
    shutil.copy(TOY / "toy.py", tmp_path / "class" / "ada")
    monkeypatch.setenv(ENVIRONMENT, str(tmp_path / "assignments"))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def tree(top: Path) -> Mapping[str, bytes]:
    """The files below, without the cache of verdicts and what is rewritten by every run."""
    paths = [path for path in top.rglob("*") if path.is_file() and ".cache" not in path.parts]
    return {path.relative_to(top).as_posix(): path.read_bytes() for path in paths}


COMMANDS = {
    "new": ["new", "17", "light", "--root", "assignments"],
    "build": ["build", "90", "--out", "out", "--secret-file", "secret.txt"],
    "public": ["build", "--no-answers", "--out", "out"],
    "bundle": ["bundle", "hidden", "90", "--out", "b.zip", "--secret-file", "secret.txt"],
}


@pytest.mark.slow
@pytest.mark.parametrize("ending", [KILLED, INTERRUPTED, FULL], ids=str)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_that_was_cut_off_can_be_run_again(
    home: Path, command: str, ending: Ending
) -> None:
    words = ["course", *COMMANDS[command]]
    before = set(home.rglob("*"))
    assert run_until(words, home, MORE_THAN_ANY, ending)[0] == 0  # fills the cache of verdicts
    clean(home, before)
    code, count = run_until(words, home, MORE_THAN_ANY, ending)
    assert (code, count > 1) == (0, True)
    whole = tree(home)
    for event in (0, count // 2, count - 1):
        clean(home, before)
        if run_until(words, home, event, ending)[0] != 0:
            assert run_until(words, home, MORE_THAN_ANY, ending)[0] == 0
        assert tree(home) == whole, (event, sorted({*tree(home)} ^ {*whole}))


def clean(home: Path, before: Collection[Path]) -> None:
    """Remove what a command has written, but for the cache."""
    for path in sorted(set(home.rglob("*")) - set(before), reverse=True):
        if ".cache" not in path.parts:
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def test_half_a_secret_is_never_read(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PHOTOGRAD_COURSE_SECRET", raising=False)
    words = ["course", "bundle", "hidden", "90", "--out", "b.zip"]
    place = home / "build" / "course.secret" / "secret.txt"
    for event in range(6):
        code, _ = run_until(words, home, event, KILLED)
        assert code != 0
        assert not place.exists() or len(course_secret(place, home)[0]) >= 16
    assert run(words) == 0


@pytest.mark.parametrize("out", [".", "assignments"])
def test_a_build_does_not_replace_the_sources(
    home: Path, out: str, capsys: pytest.CaptureFixture[str]
) -> None:
    before = tree(home)
    command = ["course", "build", "90", "--out", out, "--secret-file", "secret.txt"]
    if out == ".":
        command = ["course", "build", "--no-answers", "--out", out]
    assert run(command) == 1
    assert "one that an earlier build has written, got one with" in " ".join(
        capsys.readouterr().err.split()
    )
    assert tree(home) == before


def test_a_bundle_replaces_nothing_but_archives(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = tree(home)
    assert run(["course", "bundle", "hidden", "90", "--out", "class/ada/toy.py"]) == 1
    assert "got a file of another kind" in " ".join(capsys.readouterr().err.split())
    assert tree(home) == before
