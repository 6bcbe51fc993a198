"""The five products, the publishable tree, and wheels: the same bytes, and no stray answer."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from photograd_course.build.course_files import build_of
from photograd_course.build.gradescope_run import main as run_gradescope
from photograd_course.build.hint_table import public_hints, read_hints
from photograd_course.build.products import make_products, publishable
from photograd_course.build.public import wheel_kits
from photograd_course.build.seal import open_bundle
from photograd_course.build.wheel import course_wheel
from photograd_course.cli import run
from photograd_course.grading.hints import hint_key

from support.missing import need_module
from support.tree import ROOT

from .support import SECRET, TOY, Broken

COURSE = ROOT / "python" / "photograd_course"


def products(folder: Path, cache: Path) -> dict[str, bytes]:
    return make_products(build_of(folder, secret=SECRET, cache=cache)).files()


@pytest.fixture(scope="module")
def made(scaffold: Path, cache: Path) -> dict[str, bytes]:
    return products(scaffold, cache)


def test_there_are_five_products(made: dict[str, bytes]) -> None:
    tops = {path.partition("/")[0] for path in made}
    assert tops == {"kit", "public", "solution", "hidden.zip", "gradescope.zip"}
    assert b"return 2.0 * x" in made["solution/light.py"]
    assert {"solution/mutants.toml", "solution/kills.png"} < set(made)
    assert "squared        x  x\n" in made["solution/kills.txt"].decode()


def test_the_same_input_gives_the_same_bytes(
    made: dict[str, bytes], scaffold: Path, tmp_path: Path
) -> None:
    elsewhere = tmp_path / "other place" / scaffold.name
    shutil.copytree(scaffold, elsewhere, copy_function=shutil.copyfile)  # other times and modes
    again = products(elsewhere, tmp_path / "no verdict is known here")
    assert set(again) == set(made)
    assert [path for path in made if made[path] != again[path]] == []


def test_the_sealed_bundle_knows_mistakes_in_hidden_checks(made: dict[str, bytes]) -> None:
    bundle = open_bundle(made["hidden.zip"], SECRET)
    public = json.loads(made["public/hints.json"])
    assert public.items() < dict(bundle.hints).items()
    assert "Your result equals x itself: it is not doubled." in bundle.hints.values()


def test_public_hints_tell_nothing_without_the_wrong_answer(scaffold: Path, cache: Path) -> None:
    build = build_of(scaffold, cache=cache)
    table = public_hints(build)
    assert sorted(table.values()) == sorted(mutant.diagnosis for mutant in build.mutants)
    outcome = build.mutant_verdicts["squared"].outcomes[0]
    key = hint_key(b"public".hex(), "17.1.known", outcome["details"]["fingerprint"])
    assert table[key].startswith("Your result is the square")


@pytest.mark.parametrize("name", ["00_setup"])
def test_committed_hints_are_those_of_today(name: str, cache: Path) -> None:
    folder = ROOT / "assignments" / name
    assert read_hints(folder) == public_hints(build_of(folder, cache=cache)) != {}


def test_the_publishable_tree_holds_no_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(TOY.parent))
    assert run(["course", "build", "--no-answers", "--out", str(tmp_path)], plugins=[]) == 0
    tree = tmp_path / "assignments" / "90_toy"
    names = {path.relative_to(tree).as_posix() for path in tree.rglob("*")}
    assert names == {
        "assignment.toml",
        "checks",
        *(f"checks/{name}.py" for name in ("__init__", "common", "task_1", "task_2", "task_3")),
        "hints.json",
        "toy.py",
    }
    everything = b"".join(path.read_bytes() for path in tree.rglob("*") if path.is_file())
    for answer in (
        b"np.exp(-x)",
        b"falling",
        b"90.1.hidden",
        b"t.reference",
        b"grows with x",
        b">>>",
    ):
        assert answer not in everything


def test_the_publishable_tree_of_questions_and_handout(broken: Broken) -> None:
    files = publishable(broken.folder)
    assert {"handout.md", "questions.toml", "explore.py", "light.py"} < set(files)
    assert not {"answers.py", "figures.py", "mutants.toml"} & set(files)
    assert b"answer =" not in files["questions.toml"]
    assert b"because" not in files["questions.toml"]


@pytest.mark.slow
def test_a_whole_build_and_a_build_that_fails(
    broken: Broken,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(broken.folder.parent))
    out = tmp_path / "out"
    command = ["course", "build", "17", "--out", str(out)]
    assert run(command, plugins=[]) == 0
    sealed = (out / "17_light" / "hidden.zip").read_bytes()
    secret = (tmp_path / "out.secret" / "secret.txt").read_bytes().strip()
    assert open_bundle(sealed, secret).manifest.id == "17"
    broken.change("checks/hidden/task_1.py", "points=35", "points=34")
    assert run(command, plugins=[]) == 1
    assert "the manifest promises 75 points, the parts add up to 74" in capsys.readouterr().err
    assert (out / "17_light" / "hidden.zip").read_bytes() == sealed


def test_the_gradescope_zip_grades(made: dict[str, bytes], scaffold: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(io.BytesIO(made["gradescope.zip"])) as archive:
        modes = {info.filename: info.external_attr >> 16 & 0o777 for info in archive.infolist()}
        archive.extractall(tmp_path)
    assert modes["setup.sh"] == modes["run_autograder"] == 0o755
    assert any(name.startswith("wheels/photograd_course-") for name in modes)
    submission = tmp_path / "submission"
    submission.mkdir()
    shutil.copyfile(scaffold / "light.py", submission / "light.py")
    words = ["17"]
    for option, file in {
        "bundle": "hidden.zip",
        "secret-file": "secret.txt",
        "submission": "submission",
        "metadata": "none.json",
        "results": "results.json",
    }.items():
        words += [f"--{option}", str(tmp_path / file)]
    code = run_gradescope(words)
    results = json.loads((tmp_path / "results.json").read_text("utf-8"))
    shown = {test["name"].split()[0]: test["visibility"] for test in results["tests"]}
    assert shown["17.1.known"] == "visible"
    assert shown["17.1.random"] == "after_published"
    if results["extra_data"]["mode"] in {"A", "B", "C"}:
        assert code == 0
        assert results["score"] == 75  # no answers to questions were handed in
    else:  # no such isolation here: staff is told, and no zero is given for good
        assert code == 3
        assert results["extra_data"]["needs_staff"]


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script")
def test_the_scripts_are_scripts(made: dict[str, bytes], tmp_path: Path) -> None:
    with zipfile.ZipFile(io.BytesIO(made["gradescope.zip"])) as archive:
        for name in ("setup.sh", "run_autograder"):
            (tmp_path / name).write_bytes(archive.read(name))
            subprocess.run(["bash", "-n", str(tmp_path / name)], check=True)


INSTALLED = """
import sys
sys.path.insert(0, sys.argv[1])
from photograd_course.build.kits import PACKAGE, find_kit, list_kits, source_folders
assert str(PACKAGE).startswith(sys.argv[1]), PACKAGE
assert not source_folders()
print(list_kits())
kit = find_kit("00")
print(kit.bundle.is_public, "NotImplementedError" in kit.files["first_gradient.py"].decode())
"""


def read_back(wheel: bytes, folder: Path) -> list[str]:
    """What an interpreter says that sees only the unpacked wheel."""
    with zipfile.ZipFile(io.BytesIO(wheel)) as archive:
        archive.extractall(folder)
    command = [sys.executable, "-I", "-c", INSTALLED, str(folder)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def solutions() -> list[bytes]:
    """The solution line of assignment 00, and the marker of all."""
    return [b"2.0 * (picture - photograph) / picture.size", b"# <<< solution\n"]


def kits_in(wheel: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(wheel)) as archive:
        return {
            name.removeprefix("photograd_course/kits/"): archive.read(name)
            for name in archive.namelist()
            if name.startswith("photograd_course/kits/")
        }


def test_the_vendored_wheel_holds_stripped_kits(tmp_path: Path) -> None:
    name, wheel = course_wheel()
    assert course_wheel() == (name, wheel)
    said = read_back(wheel, tmp_path)
    assert "00_setup" in said[0]
    assert said[1] == "True True"
    for path, data in kits_in(wheel).items():
        assert not any(line in data for line in solutions()), path


def test_the_built_wheel_holds_stripped_kits(tmp_path: Path) -> None:
    need_module("hatchling")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(command, cwd=COURSE, check=True, capture_output=True)
    (path,) = tmp_path.glob("*.whl")
    kits = kits_in(path.read_bytes())
    wanted = wheel_kits(ROOT / "assignments" / "00_setup", pages=True)
    assert "kit/handout.html" in wanted
    assert {p: d for p, d in kits.items() if p.startswith("00_")} == {
        f"00_setup/{inside}": data for inside, data in wanted.items()
    }
    for inside, data in kits.items():
        assert not any(line in data for line in solutions()), inside
        assert "mutants" not in inside
    assert read_back(path.read_bytes(), tmp_path / "site")[1] == "True True"


def test_the_hook_is_declared() -> None:
    table = tomllib.loads((COURSE / "pyproject.toml").read_text("utf-8"))
    assert "custom" in table["tool"]["hatch"]["build"]["hooks"]
