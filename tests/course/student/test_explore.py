"""Explorations: options, threads, steps, and what their scripts state."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest
from photograd_course import explore
from photograd_course.errors import RangeError
from photograd_course.explore.options import parse
from photograd_course.one_thread import ONE_THREAD

from course.student.explored import FOLDERS, NUMBERS, finished_kit, stated_options
from course.student.explored import explore as run
from support.tree import ROOT

KNOWN = {
    "steps": explore.at_least(60, 1),
    "tv": explore.at_least(0.5, 0),
    "rough": explore.between(0.35, 0.045, 1),
    "max-count": explore.at_least(7, 1),
    "image": explore.existing(),
    "letters": explore.Option(""),
}
CLOCKS = {"time", "datetime", "timeit", "sched", "signal", "threading", "resource", "asyncio"}


def text_of(number: str) -> str:
    return (FOLDERS[number] / "explore.py").read_text("utf-8")


def test_an_option_has_the_type_of_its_default() -> None:
    words = ["--steps", "7", "--tv=2", "--max-count", "9", "--letters", "-AB", "--image", "."]
    assert parse(words, KNOWN) == {
        "steps": 7,
        "tv": 2.0,
        "max-count": 9,
        "letters": "-AB",
        "image": ".",
    }
    assert parse([], KNOWN) == {}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--stepz", "7"], "(did you mean '--steps'?)"),
        (["--steps7"], "(did you mean '--steps'?)"),
        (["-s", "7"], "one of --steps, --tv, --rough, --max-count, --image, --letters, got '-s'"),
        (["-steps", "7"], "did you mean '--steps'?"),
        (["steps=7"], "did you mean '--steps'?"),
        (["--steps", "7", "8"], "option: expected one of --steps"),
        (["7"], "option: expected one of --steps"),
        (["--"], "option: expected one of --steps"),
        (["--max_count", "3"], "did you mean '--max-count'?"),
        (["--steps"], "--steps: expected a whole number of 1 or more, got nothing"),
        (["--steps", "--tv", "3"], "--steps: expected a whole number of 1 or more, got nothing"),
        (["--steps", "many"], "--steps: expected a whole number of 1 or more, got 'many'"),
        (["--steps", "0"], "--steps: expected a whole number of 1 or more, got '0'"),
        (["--steps", "-3"], "--steps: expected a whole number of 1 or more, got '-3'"),
        (["--steps", "1.5"], "--steps: expected a whole number of 1 or more, got '1.5'"),
        (["--steps", ""], "--steps: expected a whole number of 1 or more, got ''"),
        (["--steps="], "--steps: expected a whole number of 1 or more, got ''"),
        (["--tv", "nan"], "--tv: expected a number of 0 or more, got 'nan'"),
        (["--tv", "inf"], "--tv: expected a number of 0 or more, got 'inf'"),
        (["--tv", "-1e-9"], "--tv: expected a number of 0 or more, got '-1e-9'"),
        (["--rough", "0.01"], "--rough: expected a number from 0.045 to 1, got '0.01'"),
        (["--image", "no.png"], "--image: expected a file or folder that exists, got 'no.png'"),
    ],
)
def test_a_wrong_option_is_refused_in_one_sentence(words: list[str], said: str) -> None:
    with pytest.raises(RangeError) as refused:
        parse(words, KNOWN)
    assert str(refused.value).startswith("explore.py: ")
    assert said in str(refused.value)


def test_an_option_may_take_the_value_of_another(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["explore.py", "--metal", "0.5"])
    stated = {"metal": explore.between(0.0, 0, 1), "start": explore.same_as("metal", 0.0, 1)}
    assert vars(explore.options(**stated)) == {"metal": 0.5, "start": 0.5}
    monkeypatch.setattr("sys.argv", ["explore.py", "--metal", "0.5", "--start", "0"])
    assert explore.options(**stated).start == 0.0


@pytest.mark.parametrize("number", NUMBERS)
def test_each_exploration_refuses_an_unknown_option(number: str, tmp_path: Path) -> None:
    """Before it loads NumPy or the student's module, and without a traceback."""
    script = tmp_path / "explore.py"
    script.write_text(text_of(number), encoding="utf-8")
    done = run(tmp_path, "--unknown", "1")
    assert done.returncode == 1
    assert done.stderr.startswith("explore.py: option: expected one of ")
    assert done.stderr.count("\n") == 1
    assert all(
        f"--{name}".replace("_", "-") in done.stderr for name in stated_options(text_of(number))
    )
    assert not done.stdout


def test_help_prints_the_head_and_the_defaults_and_ends_the_script(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "explore.py"
    script.write_text("# %% [markdown]\n# # A title\n# `--steps` says more.\n\n# %%\n1 / 0\n")
    monkeypatch.setattr("sys.argv", [str(script), "--help"])
    with pytest.raises(SystemExit) as ended:
        explore.options(max_steps=1)
    assert not ended.value.code
    said = capsys.readouterr().out
    assert said == "A title\n`--steps` says more.\nDefaults:\n  --max-steps 1\n"


@pytest.mark.parametrize("number", NUMBERS)
def test_the_head_of_a_script_names_all_its_options(number: str) -> None:
    told = explore.introduction(text_of(number))
    stated = [name.replace("_", "-") for name in stated_options(text_of(number))]
    assert [name for name in stated if f"--{name}`" not in told and f"--{name} " not in told] == []


@pytest.mark.parametrize("number", NUMBERS)
def test_linear_algebra_is_limited_before_numpy_is_loaded(number: str) -> None:
    """The first import that is none of the standard library is the one that limits it."""
    imports = [
        node
        for node in ast.parse(text_of(number)).body
        if isinstance(node, (ast.Import, ast.ImportFrom))
    ]
    names = [
        node.module if isinstance(node, ast.ImportFrom) else node.names[0].name for node in imports
    ]
    foreign = [name for name in names if str(name).split(".")[0] not in sys.stdlib_module_names]
    assert foreign[0] == "photograd_course"
    assert [each.name for each in imports[names.index(foreign[0])].names] == ["explore"]


@pytest.mark.parametrize("start", ["explore.py", "-m explore", "before.py"])
def test_an_exploration_has_one_thread_however_it_is_started(tmp_path: Path, start: str) -> None:
    """Also where another program has loaded NumPy and runs the script then."""
    finished_kit("00", tmp_path)
    own = tmp_path / "first_gradient.py"
    told = "print('threads', [each['num_threads'] for each in threadpoolctl.threadpool_info()])"
    ending = f"\nimport atexit, threadpoolctl\natexit.register(lambda: {told})\n"
    own.write_text(own.read_text("utf-8") + ending, encoding="utf-8")
    before = "import runpy, sys, numpy\nsys.argv[0] = 'explore.py'\nrunpy.run_path('explore.py')\n"
    (tmp_path / "before.py").write_text(before, encoding="utf-8")
    many = dict.fromkeys(ONE_THREAD, "2")
    done = subprocess.run(
        [sys.executable, *start.split()],
        cwd=tmp_path,
        env={**os.environ, **many},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    threads = ast.literal_eval(done.stdout.rpartition("threads ")[2])
    assert threads
    assert set(threads) == {1}


def test_where_numpy_cannot_be_limited_any_more_a_line_says_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "threadpoolctl", None)
    assert not explore.one_thread.use_one_thread()
    assert "restart the kernel" in capsys.readouterr().out


@pytest.mark.parametrize("path", sorted(ROOT.glob("assignments/*/explore.py")), ids=str)
def test_no_exploration_can_be_stopped_by_a_clock(path: Path) -> None:
    """None loads a clock; a stopwatch of the package gives texts, which decide nothing."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [each.name for each in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [str(node.module)]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            names = [str(getattr(node.args[0], "value", ""))]
        assert not CLOCKS & {name.split(".")[0] for name in names}, ast.unparse(node)


def test_a_stopwatch_gives_no_number() -> None:
    watch = explore.Stopwatch()
    assert str(watch).endswith("s")
    assert watch.times(explore.Stopwatch()).endswith("times")
    for read in (float, int, round, lambda w: w < 3, lambda w: w - w, range):
        with pytest.raises(TypeError):
            read(watch)


@pytest.mark.parametrize("number", ["00", "02"])
def test_the_same_seed_gives_the_same_pictures(number: str, tmp_path: Path) -> None:
    pictures = []
    for name in ("once", "again"):
        folder = finished_kit(number, tmp_path / name)
        assert run(folder).returncode == 0
        pictures.append([path.read_bytes() for path in sorted(folder.glob("*.png"))])
    assert pictures[0]
    assert pictures[0] == pictures[1]
