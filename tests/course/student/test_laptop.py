"""The student's side works without the core, a compiler, root, or anything only POSIX has."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest
from photograd_course.assignment.toml import read_toml

from course.student.laptop import Laptop, make_laptop
from support.tree import ROOT


@pytest.fixture(scope="module")
def laptop(tmp_path_factory: pytest.TempPathFactory) -> Laptop:
    return make_laptop(tmp_path_factory.mktemp("laptop"))


def test_the_laptop_is_as_poor_as_it_should_be(laptop: Laptop, tmp_path: Path) -> None:
    for line in (
        "import photograd",
        "import resource",
        "import os; os.fork()",
        "import signal; signal.SIGALRM",
        "import subprocess, sys; subprocess.Popen([sys.executable], pass_fds=(0,))",
    ):
        assert laptop.call([str(laptop.python), "-c", line], tmp_path).returncode != 0, line
    good = laptop.call([str(laptop.python), "-c", "import numpy, photograd_course"], tmp_path)
    assert good.returncode == 0, good.stderr


def test_from_start_to_submission(laptop: Laptop, tmp_path: Path) -> None:
    assert "first gradient" in laptop.run("course", "list", cwd=tmp_path).stdout
    started = laptop.run("course", "start", "00", cwd=tmp_path)
    assert started.returncode == 0, started.stderr
    work = tmp_path / "00_setup"
    laid_out = {path.relative_to(work).as_posix() for path in work.rglob("*") if path.is_file()}
    assert laid_out == {
        "README.md",
        "answers.toml",
        "data/figure_1.py",
        "explore.ipynb",
        "explore.py",
        "figures/fig1_gradient.png",
        "first_gradient.py",
        "handout.html",
    }

    red = laptop.run("course", "check", "00", "--json", cwd=work)
    assert red.returncode == 1, red.stderr
    result = json.loads(red.stdout.splitlines()[-1])
    assert result["score"] == 0
    assert {each["status"] for each in result["checks"]} == {"failed"}
    assert "not implemented" in red.stderr

    module = work / "first_gradient.py"
    text = module.read_text("utf-8")
    (line,) = [each for each in text.splitlines() if "raise NotImplementedError" in each]
    module.write_text(text.replace(line, "    return 2.0 * (picture - photograph) / picture.size"))
    green = laptop.run("course", "check", "00", "--json", cwd=work)
    assert green.returncode == 0, green.stderr
    result = json.loads(green.stdout.splitlines()[-1])
    assert result["score"] == result["max_score"] == 1.5  # the rest is a hidden check's

    explored = laptop.call([str(laptop.python), "explore.py"], work)
    assert explored.returncode == 0, explored.stderr
    assert (work / "gradient.png").stat().st_size > 5000

    packed = laptop.run("course", "submit", "00", cwd=work)
    assert packed.returncode == 0, packed.stderr
    with zipfile.ZipFile(work / "00_setup_submission.zip") as archive:
        assert set(archive.namelist()) == {"first_gradient.py", "answers.toml"}


def test_a_handout_is_read_where_nothing_can_make_one(laptop: Laptop, tmp_path: Path) -> None:
    makes = "import latex2mathml"
    assert laptop.call([str(laptop.python), "-c", makes], tmp_path).returncode != 0
    assert laptop.run("course", "start", "00", cwd=tmp_path).returncode == 0
    for number, name in (("00", "00_setup/handout.html"), ("01", "01_gradient_descent.html")):
        told = laptop.run("course", "read", number, cwd=tmp_path)
        assert told.returncode == 0, told.stderr
        assert Path(told.stdout.strip()) == tmp_path / name
        page = (tmp_path / name).read_text("utf-8")
        assert "<math" in page
        assert 'src="data:image/png;base64,' in page
        assert 'src="figures/' not in page


def test_a_planned_assignment_is_known_without_a_checkout(laptop: Laptop, tmp_path: Path) -> None:
    plan = read_toml(ROOT / "assignments" / "course.toml")["assignment"]
    ready = {path.name[:2] for path in (ROOT / "assignments").glob("[0-9]*_*")}
    planned = [entry for entry in plan if entry["id"] not in ready]
    for entry in planned[:1]:
        told = laptop.run("course", "start", entry["id"], cwd=tmp_path)
        assert told.returncode == 1
        assert f"{entry['title']}, which is planned" in " ".join(told.stderr.split())


def test_the_plan_of_the_course_is_known_without_a_checkout(laptop: Laptop, tmp_path: Path) -> None:
    told = laptop.run("course", "syllabus", "quarter", "--json", cwd=tmp_path)
    assert told.returncode == 0, told.stderr
    weeks = json.loads(told.stdout.splitlines()[-1])["weeks"]
    assert {"00", "01", "02", "15"} <= {week["assignment"] for week in weeks}
    assert all(week["state"] == "ready" and week["title"] for week in weeks)


def test_the_core_is_said_to_be_missing_and_costs_nothing(laptop: Laptop, tmp_path: Path) -> None:
    told = laptop.run("fit", "x", cwd=tmp_path)
    assert told.returncode == 2
    assert "core not installed" in told.stderr


def test_a_wrong_line_is_answered_with_sign_size_and_picture(
    laptop: Laptop, tmp_path: Path
) -> None:
    assert laptop.run("course", "start", "00", "here", cwd=tmp_path).returncode == 0
    module = tmp_path / "here" / "first_gradient.py"
    text = module.read_text("utf-8")
    (line,) = [each for each in text.splitlines() if "raise NotImplementedError" in each]
    module.write_text(text.replace(line, "    return 2.0 * (photograph - picture) / picture.size"))
    told = laptop.run("course", "check", "00", cwd=tmp_path / "here")
    assert told.returncode == 1
    assert "expected something" in told.stdout
    assert "negative of the derivative" in told.stdout  # the mistake is recognized
    assert (tmp_path / "here" / "check_00.1.differences.png").exists()


@pytest.mark.slow
@pytest.mark.parametrize("number", ["01", "02", "03"])
def test_a_kit_starts_red_and_asks_for_predictions_first(
    laptop: Laptop, tmp_path: Path, number: str
) -> None:
    assert laptop.run("course", "start", number, "w", cwd=tmp_path).returncode == 0
    work = tmp_path / "w"
    told = laptop.run("course", "check", number, cwd=work)
    assert told.returncode == 1
    assert f"photograd course predict {number}" in told.stderr

    answers = work / "answers.toml"
    text = answers.read_text("utf-8")
    for k in range(1, 9):
        text = text.replace(f'"{number}.p{k}" = ""', f'"{number}.p{k}" = "a"')
    answers.write_text(text, "utf-8")
    red = laptop.run("course", "check", number, "--json", "--no-pictures", cwd=work)
    assert (work / "predictions.lock.json").exists()
    result = json.loads(red.stdout.splitlines()[-1])
    assert result["score"] == 0
    assert len(result["checks"]) >= 6
    assert "not implemented" in red.stderr
    asked = laptop.run("course", "questions", number, cwd=work)
    assert asked.returncode == 0, asked.stderr
    assert f"{number}.p1" in asked.stdout
