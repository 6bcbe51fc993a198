"""Whatever ends a command, and wherever: nothing is lost, and the same command can be run again."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from photograd_course.student.record import RECORD_NAME

from support.tree import ROOT

from .interrupted import FULL, INTERRUPTED, KILLED, MORE_THAN_ANY, Ending, run_until
from .small_course import WRONG, Semester

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork")

OURS = {RECORD_NAME, "questions.shown.json"}  # notes of the commands, no work
PREDICTED = 'student = "Ada"  # me\n\n[answers]\n"91.p1" = "a"  # my guess\n'
Files = Mapping[str, bytes]


def finished(semester: Semester) -> None:
    """91 laid out with a finished 90 beside it, and its prediction made."""
    semester.put("90_toy/toy.py", semester.solution("90_toy"))
    semester.course("start", "91")
    semester.put("91_twice/twice.py", semester.solution("91_twice"))
    semester.put("91_twice/answers.toml", PREDICTED)


def nothing_yet(semester: Semester) -> None:
    semester.put("90_toy/toy.py", semester.solution("90_toy"))


def corrected(semester: Semester) -> None:
    """90 was corrected after 91 had taken it along, and the copy was edited."""
    finished(semester)
    line = "    return float(np.sum(w * np.exp(-x)))\n"
    done = semester.solution("90_toy")
    semester.put("90_toy/toy.py", done.replace(line, f"    1 + 1\n{line}"))
    semester.put("91_twice/toy.py", done.replace(line, WRONG))


def handed_in(semester: Semester) -> None:
    """An archive of earlier work lies there."""
    finished(semester)
    semester.course("submit", "91", "--dir", "91_twice")
    semester.put("91_twice/twice.py", semester.solution("91_twice") + "# better\n")


def annotated(semester: Semester) -> None:
    """A page with notes lies where it will be written."""
    semester.put("91_twice.html", "my notes")


def red(semester: Semester) -> None:
    """00 with a wrong line, and the picture of an earlier run."""
    semester.course("start", "00")
    module = semester.home / "00_setup" / "first_gradient.py"
    text = module.read_text("utf-8")
    (line,) = [each for each in text.splitlines() if "raise NotImplementedError" in each]
    module.write_text(text.replace(line, "    return 2 * (photograph - picture) / picture.size"))
    semester.course("check", "00", "--dir", "00_setup", code=1)


IN = ("--dir", "91_twice")
CASES: dict[str, tuple[Callable[[Semester], None], list[str], int]] = {
    "start": (nothing_yet, ["start", "91"], 0),
    "update": (corrected, ["start", "91", "91_twice", "--update"], 0),
    "predict": (finished, ["predict", "91", *IN], 0),
    "check": (finished, ["check", "91", *IN], 0),
    "pictures": (red, ["check", "00", "--dir", "00_setup"], 1),
    "questions": (finished, ["questions", "91", *IN], 0),
    "submit": (handed_in, ["submit", "91", *IN], 0),
    "read": (annotated, ["read", "91", "--no-open"], 0),
}


@pytest.fixture
def with_first(semester: Semester) -> Semester:
    """The small course has assignment 00 as well, whose checks draw pictures."""
    source = ROOT / "assignments" / "00_setup"
    shutil.copytree(source, semester.home.parent / "assignments" / "00_setup")
    return semester


def reset(semester: Semester, files: Files) -> None:
    """Put the student's folder back as it was."""
    for path in semester.home.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()
    for name, content in files.items():
        place = semester.home / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)


def steady(files: Files) -> Files:
    """Without the time that stands in a lock."""
    found = dict(files)
    for name in [each for each in found if each.endswith("lock.json")]:
        lock = json.loads(found[name])
        lock["locked_at"] = ""
        found[name] = json.dumps(lock).encode()
    return found


def nothing_is_lost(before: Files, now: Files) -> None:
    """Every file has its old content, at its place or in a copy beside it, or was ours."""
    for name, content in before.items():
        path = Path(name)
        if path.name not in OURS and not path.name.startswith("check_"):
            kept = [
                each
                for place, each in now.items()
                if Path(place).parent == path.parent and Path(place).name.startswith(path.stem)
            ]
            assert content in kept, name


@pytest.mark.slow
@pytest.mark.parametrize("ending", [KILLED, INTERRUPTED, FULL], ids=str)
@pytest.mark.parametrize("case", CASES)
def test_a_command_that_was_cut_off_can_be_run_again(
    with_first: Semester, case: str, ending: Ending
) -> None:
    """At its first and its last write, and at some between them."""
    most = 2 if ending is not KILLED else 3 if case in ("check", "pictures") else 7
    prepare, words, expected = CASES[case]
    words = ["course", *words]
    prepare(with_first)
    before = dict(with_first.files())
    code, count = run_until(words, with_first.home, MORE_THAN_ANY, ending)
    assert (code, count > 0) == (expected, True)
    whole = steady(with_first.files())
    for event in sorted({k * (count - 1) // (most - 1) for k in range(most)}):
        reset(with_first, before)
        code, _ = run_until(words, with_first.home, event, ending)
        assert code in {KILLED: {-signal.SIGKILL}, INTERRUPTED: {130}, FULL: {0, 1}}[ending]
        nothing_is_lost(before, with_first.files())
        assert run_until(words, with_first.home, MORE_THAN_ANY, ending)[0] == expected
        now = with_first.files()
        nothing_is_lost(before, now)
        assert steady(now) == whole, (event, sorted({*now} ^ {*whole}))


@pytest.mark.parametrize("files", [1, 3, 5])
def test_a_kit_that_a_real_kill_has_cut_off_is_completed(semester: Semester, files: int) -> None:
    """At whatever moment it comes, once so many files are there."""
    nothing_yet(semester)
    command = [sys.executable, "-m", "photograd_course", "course", "start", "91"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None and len(list(semester.home.rglob("*"))) < files + 3:
            pass
        process.kill()
    semester.course("start", "91")
    now = semester.files()
    shutil.rmtree(semester.home / "91_twice")
    semester.course("start", "91")
    assert now == semester.files()


def test_a_folder_that_may_not_be_written_stays_as_it_is(
    semester: Semester, monkeypatch: pytest.MonkeyPatch
) -> None:
    finished(semester)
    before = semester.files()

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("photograd_course.atomic_io.open_locked", refuse)
    for words in (["predict"], ["check"], ["submit"]):
        said = semester.course(*words, "91", *IN, code=1)
        assert "expected a file that can be written in an existing folder" in said
    said = semester.course("start", "92", code=1)
    assert "Permission denied" in said
    assert {name: data for name, data in semester.files().items() if "92" not in name} == before
