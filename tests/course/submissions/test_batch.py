"""A folder of submissions: resumed after a kill, graded again, compared."""

from __future__ import annotations

import csv
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from photograd_course.errors import IoError, SceneError
from photograd_course.submissions.batch import Batch, run_batch
from photograd_course.submissions.exports import find_sources
from photograd_course.submissions.grades_csv import Change
from photograd_course.submissions.load import load
from photograd_course.submissions.report import Report
from photograd_course.submissions.run_folder import RunFolder
from photograd_course.submissions.workers import isolated_workers

Run = Callable[..., tuple[list[Report], list[Change] | None]]
STUDENTS = ("Ada", "Bo", "Cy", "=Di")


@pytest.fixture
def submissions(tmp_path: Path, solution: str) -> Path:
    """Right, wrong, missing, and one whose student's name is a formula."""
    texts = (solution, solution.replace("np.exp(-x))", "np.exp(x))"), None, solution)
    for student, text in zip(STUDENTS, texts, strict=True):
        folder = tmp_path / "in" / student
        folder.mkdir(parents=True)
        if text is None:
            (folder / "readme.txt").write_text("where is it?")
        else:
            (folder / "toy.py").write_text(text)
    return tmp_path / "in"


@pytest.fixture
def run(quick: Path, submissions: Path, tmp_path: Path) -> Run:
    def graded(
        *, resume: bool = False, bundle: Path = quick
    ) -> tuple[list[Report], list[Change] | None]:
        loaded = load("90", bundle)
        manifest = loaded.read().manifest
        folder = RunFolder(tmp_path / "out", loaded.secret)
        with isolated_workers(manifest, "E") as workers:
            batch = Batch(find_sources(manifest, submissions), loaded, workers, "", 2)
            return run_batch(batch, folder, resume=resume)

    return graded


def rows(path: Path) -> dict[str, dict[str, str]]:
    with path.open(newline="") as file:
        return {row["student"]: row for row in csv.DictReader(file)}


def test_tables_pages_and_records(run: Run, tmp_path: Path) -> None:
    reports, differences = run()
    assert differences is None
    assert sorted(report.student for report in reports) == sorted(STUDENTS)
    table = rows(tmp_path / "out" / "grades.csv")
    assert {name: row["score"] for name, row in table.items()} == {
        "Ada": "3",
        "Bo": "0",
        "Cy": "0",
        "'=Di": "3",
    }
    assert table["Cy"]["status"] == "submission refused"
    assert "there is no toy.py" in table["Cy"]["notes"]
    for row in table.values():
        assert (tmp_path / "out" / "pages" / row["page"]).read_text().startswith("<!DOCTYPE")
    similar = (tmp_path / "out" / "similarity.csv").read_text()
    assert "Ada" in similar  # with Di, whose file is the same


def test_grading_again_changes_nothing(run: Run, tmp_path: Path) -> None:
    run()
    first = (tmp_path / "out" / "grades.csv").read_bytes()
    _, differences = run()
    assert differences == []
    assert (tmp_path / "out" / "grades.csv").read_bytes() == first
    assert (tmp_path / "out" / "changes.csv").read_text().splitlines() == [
        "student,before,after,checks"
    ]


def test_a_changed_bundle_shows_who_changes_and_by_what(
    run: Run, quick: Path, tmp_path: Path
) -> None:
    run()
    changed = tmp_path / "changed" / "90_toy"
    shutil.copytree(quick, changed)
    checks = changed / "checks" / "task_1.py"
    checks.write_text(checks.read_text().replace("w.sum() / 2", "w.sum() / 3"))
    _, differences = run(bundle=changed)
    assert differences is not None
    assert {change.student for change in differences} == {"Ada", "=Di"}
    assert differences[0].checks == ("90.1.value: passed 3 -> failed 0",)
    with pytest.raises(SceneError, match="same bundle"):
        run(resume=True)


def test_resume_believes_sealed_records_of_the_same_files_only(
    run: Run, submissions: Path, tmp_path: Path, solution: str
) -> None:
    run()
    records = {p.name[:2]: p for p in (tmp_path / "out" / "records").glob("*.json")}
    before = {name: path.stat().st_mtime_ns for name, path in records.items()}
    bo = records["Bo"].read_bytes()
    records["Bo"].write_bytes(bo.replace(b'"points":0.0', b'"points":3.0'))
    assert records["Bo"].read_bytes() != bo
    (submissions / "Ada" / "toy.py").write_text(solution + "# changed\n")
    run(resume=True)
    after = {name: path.stat().st_mtime_ns for name, path in records.items()}
    assert {name for name in records if after[name] != before[name]} == {"Ad", "Bo"}
    assert rows(tmp_path / "out" / "grades.csv")["Bo"]["score"] == "0"


def test_a_folder_of_something_else_is_left_alone(run: Run, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("years of work")
    with pytest.raises(IoError, match="a folder of grades"):
        run()
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["thesis.tex"]


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
def test_killed_and_resumed_gives_the_same_table(
    quick: Path, submissions: Path, tmp_path: Path
) -> None:
    def command(out: str, *more: str) -> list[str]:
        return [
            sys.executable,
            "-m",
            "photograd_course",
            "course",
            "grade",
            "90",
            str(submissions),
            "--bundle",
            str(quick),
            "--mode",
            "E",
            "--out",
            str(tmp_path / out),
            *more,
        ]

    subprocess.run(command("whole"), check=True, capture_output=True)
    process = subprocess.Popen(
        command("killed"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    records = tmp_path / "killed" / "records"
    while not list(records.glob("*.json")) and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    done = {path: path.stat().st_mtime_ns for path in records.glob("*.json")}
    assert 0 < len(done) < len(STUDENTS)
    assert not (tmp_path / "killed" / "grades.csv").exists()
    subprocess.run(command("killed", "--resume"), check=True, capture_output=True)
    assert all(path.stat().st_mtime_ns == when for path, when in done.items())
    for name in ("grades.csv", "similarity.csv"):
        whole, resumed = tmp_path / "whole" / name, tmp_path / "killed" / name
        assert whole.read_bytes() == resumed.read_bytes()
