"""No attack gets more than it may, hangs, leaves anything behind or touches another hand-in."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from photograd_course.grade.similarity import similar_pairs
from photograd_course.worker.self_test import self_test

from course.attacks.attack import ASSIGNMENT, MODULE, Attack, read_attacks
from course.attacks.suite import STRICT, run_suite
from course.naive_grader.cage import bubblewrap

ATTACKS = read_attacks()
NUMBERS = range(1, 71)
UNSTAGED = 4  # at most so many attacks may lack a control
Results = Mapping[str, Mapping[str, Any]]


def strongest() -> str:
    """The best mode, judged by what is installed, since collecting tests must be quick."""
    return "A" if bubblewrap() else "C"


def modes() -> list[Any]:
    """The strongest mode always; the others take their time."""
    best = strongest()
    return [mode if mode == best else pytest.param(mode, marks=pytest.mark.slow) for mode in STRICT]


@pytest.fixture(scope="module")
def results(request: pytest.FixtureRequest) -> Callable[[str], Results]:
    """The suite's results in a mode, for those attacks that are asked for."""
    wanted = {item.callspec.params["attack"].number for item in _attacked(request)}

    @cache
    def run(mode: str) -> Results:
        if reason := self_test(mode):
            pytest.skip(f"mode {mode}: {reason}")
        chosen = [attack for attack in ATTACKS if attack.number in wanted]
        found: Results = run_suite([mode], chosen)[mode]["results"]
        return found

    return run


def _attacked(request: pytest.FixtureRequest) -> list[Any]:
    return [item for item in request.session.items if item.name.startswith("test_the_grader")]


@pytest.mark.parametrize("mode", modes())
@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.name)
def test_the_grader_survives(attack: Attack, mode: str, results: Callable[[str], Results]) -> None:
    result = results(mode)[attack.name]
    assert result["violations"] == []
    assert result["score"] <= attack.max_points


def test_each_number_has_its_attack_and_each_attack_its_control() -> None:
    assert [attack.number for attack in ATTACKS] == list(NUMBERS)
    assert all(attack.name.startswith(f"{attack.number:02}_") for attack in ATTACKS)
    kinds = [attack.control["kind"] for attack in ATTACKS]
    assert set(kinds) <= {"naive", "token", "unstaged"}
    assert kinds.count("unstaged") <= UNSTAGED
    generous = [attack for attack in ATTACKS if attack.max_points > 0]
    assert all(attack.note or "public" in attack.tries for attack in generous)


def test_uploads_are_the_same_bytes_every_time() -> None:
    for attack in ATTACKS:
        assert attack.variants() == attack.variants(), attack.name


def test_a_disguised_copy_is_named_in_the_report_on_similarity() -> None:
    copy = next(attack for attack in ATTACKS if attack.name == "60_disguised_copy")
    solution = (ASSIGNMENT / MODULE).read_text(encoding="utf-8")
    other = next(attack for attack in ATTACKS if attack.name == "45_symmetric_luck")
    sources = {
        "author": solution,
        "copier": copy.controlled().decode(),
        "other": other.controlled().decode(),
    }
    assert [pair[:2] for pair in similar_pairs(sources)] == [("author", "copier")]


def test_the_suite_sees_what_it_looks_for(tmp_path: Path) -> None:
    """An attack with a lower cap, a shorter budget and no token breaks exactly those rules."""
    honest = next(attack for attack in ATTACKS if attack.name == "60_disguised_copy")
    folder = shutil.copytree(honest.folder, tmp_path / honest.name)
    text = (folder / MODULE).read_text(encoding="utf-8").replace("token 60", "escape: on purpose")
    (folder / MODULE).write_text(text, encoding="utf-8")
    planted = Attack(
        folder, 60, "planted", "", 1.0, 0.0, ("91.1.value",), {"kind": "token"}
    )  # fmt: skip
    found = run_suite([strongest()], [planted])[strongest()]
    said = sorted(text.split(" ")[0] for text in found["results"][honest.name]["violations"])
    assert said == ["earned", "escape:", "left", "took"]
    assert (found["attacks"], found["survived"]) == (1, 0)


@pytest.mark.slow
def test_mode_c_is_tried_without_capabilities() -> None:
    if os.geteuid() != 0:
        pytest.skip("needs root")
    from course.attacks.privileges import run_like_a_container

    with pytest.raises(RuntimeError, match="unshare"):
        run_like_a_container(["--mode", "B", "--attacks", "32"])
