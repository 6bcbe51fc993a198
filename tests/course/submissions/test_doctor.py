"""The doctor runs what it counts, and one broken part turns its verdict."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from photograd_course.cli import run
from photograd_course.submissions import doctor
from photograd_course.submissions.attack_evidence import attack_evidence, summary

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"

SOUND = {
    "assignment": "90_toy",
    "ok": True,
    "findings": [],
    "checks": 5,
    "named_mutants": 8,
    "named_mutants_as_listed": 8,
    "automatic_mutants": 36,
    "automatic_mutants_killed": 36,
    "equivalent": 0,
    "alternatives": 3,
    "alternatives_accepted": 3,
    "margin_right": 1e-4,
    "margin_wrong": 1e4,
}


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A course of the toy assignment alone."""
    folder = tmp_path / "course" / "assignments"
    shutil.copytree(TOY, folder / "90_toy", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", str(folder))
    return folder


@pytest.fixture
def diagnose(capsys: pytest.CaptureFixture[str]) -> Callable[[], tuple[int, dict[str, Any]]]:
    def called() -> tuple[int, dict[str, Any]]:
        code = run(["course", "doctor", "--quick", "--json"])
        return code, json.loads(capsys.readouterr().out.splitlines()[-1])

    return called


def swap(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert text.count(old) >= 1
    path.write_text(text.replace(old, new))


@pytest.mark.slow
def test_a_sound_course_and_then_a_broken_mutant(
    root: Path, diagnose: Callable[[], tuple[int, dict[str, Any]]]
) -> None:
    code, result = diagnose()
    (toy,) = result["assignments"]
    assert (code, result["ok"], result["complete"]) == (0, True, False)
    assert toy["ok"]
    assert toy["findings"] == []
    assert toy["checks"] == 5
    assert toy["named_mutants"] == toy["named_mutants_as_listed"] == 8
    assert toy["automatic_mutants_killed"] == toy["automatic_mutants"] == 36
    assert toy["alternatives_accepted"] == toy["alternatives"] == 3
    assert toy["code_points"] == toy["code_points_max"] == 15
    assert toy["margin_right"] < 0.1
    assert toy["margin_wrong"] > 10
    assert toy["grading_seconds"] > 0

    rows = root / "90_toy" / "mutants.toml"
    swap(rows, 'differences = ["', 'differences = ["90.3.services ')  # a check that it passes
    code, result = diagnose()
    assert (code, result["ok"]) == (1, False)
    assert any("differences survives 90.3.services" in finding for finding in result["findings"])


def test_a_broken_manifest_turns_the_verdict(
    root: Path, diagnose: Callable[[], tuple[int, dict[str, Any]]]
) -> None:
    swap(root / "90_toy" / "assignment.toml", "code = 15", "code = 16")
    code, result = diagnose()
    assert (code, result["ok"]) == (1, False)
    assert any("90_toy" in finding for finding in result["findings"])


def test_unreadable_sources_turn_the_verdict_and_stop_nothing(
    root: Path, diagnose: Callable[[], tuple[int, dict[str, Any]]]
) -> None:
    (root / "90_toy" / "checks" / "task_1.py").write_text("def (:\n")
    code, result = diagnose()
    assert (code, result["ok"]) == (1, False)
    assert result["modes"]["E"] == "works"


def test_no_assignment_is_not_all_well(
    root: Path, diagnose: Callable[[], tuple[int, dict[str, Any]]]
) -> None:
    shutil.rmtree(root / "90_toy")
    code, result = diagnose()
    assert (code, result["ok"]) == (1, False)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({}, None),
        ({"ok": False, "findings": ["mutant sign survives"]}, "mutant sign survives"),
        ({"alternatives": 0, "alternatives_accepted": 0}, "alternatives: none"),
        ({"automatic_mutants": 0}, "automatic_mutants: none"),
        ({"margin_wrong": None}, "margin_wrong: not measured"),
        ({"margin_right": float("nan")}, "margin_right: not measured"),
    ],
)
def test_each_missing_part_is_a_finding(
    changes: dict[str, Any], says: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    graded = {"grading_mode": "A", "grading_seconds": 1.0, "findings": []}
    monkeypatch.setattr(doctor, "evidence", lambda *_, **__: {**SOUND, **changes})
    monkeypatch.setattr(doctor, "grade_solution", lambda _: dict(graded))
    found = doctor.examine_assignment(Path("90_toy"))
    assert found["ok"] is (says is None)
    assert (says is None) == (found["findings"] == [])
    assert says is None or any(says in finding for finding in found["findings"])


@pytest.mark.exhaustive
def test_a_folder_of_ones_own_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["course", "new", "17", "light_fields", "--root", "mine"]) == 0
    monkeypatch.setenv("PHOTOGRAD_ASSIGNMENTS", "mine")
    code = run(["course", "doctor"])
    said = capsys.readouterr()
    assert code == 0, said.out + said.err
    assert "17_light_fields: ok" in said.out
    assert "all is well" in said.out


def test_a_solution_that_fails_as_a_submission_is_a_finding(toy: Path, tmp_path: Path) -> None:
    broken = tmp_path / "90_toy"
    shutil.copytree(toy, broken)
    swap(broken / "toy.py", "import numpy as np\n", "import numpy as np\nimport json\n")
    swap(broken / "toy.py", "    return float(np.sum", "    json.dumps(1)\n    return float(np.sum")
    found = doctor.grade_solution(broken)
    assert found["code_points"] < 15
    assert "90.1.value" in " ".join(found["findings"])
    assert "uses a module that it may not import" in found["findings"][0]


def suite(**changes: Any) -> dict[str, Any]:
    results = {f"{k:02}_x": {"ran": True} for k in range(10)}
    mode = {"attacks": 10, "survived": 10, "violations": [], "results": results}
    naive = {f"{k:02}_x": True for k in range(8)}
    return {
        "attacks": list(results),
        "naive": naive,
        "tokens": ["08_x", "09_x"],
        "modes": {"A": mode},
        **changes,
    }


def test_attacks_are_counted_with_their_controls() -> None:
    sound = summary(suite())
    assert (sound["ok"], sound["attacks"], sound["with_positive_control"]) == (True, 10, 10)
    lost = {**suite()["modes"]["A"], "survived": 9, "violations": ["03_x: earned 5"]}
    assert summary(suite(modes={"A": lost}))["findings"] == ["attacks, mode A: 03_x: earned 5"]
    dead = {f"{k:02}_x": k > 4 for k in range(8)}
    assert not summary(suite(naive=dead))["ok"]  # five without a positive control
    assert not summary(suite(modes={}))["ok"]
    silent = {**suite()["modes"]["A"], "results": {}}
    assert summary(suite(modes={"A": silent}))["unstaged"] == ["08_x", "09_x"]


def test_without_a_checkout_the_attacks_are_not_run(tmp_path: Path) -> None:
    found = attack_evidence(tmp_path)
    assert (found["ok"], found["state"]) == (False, "not run: no checkout")
