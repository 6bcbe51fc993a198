"""No attack gets more than it may, hangs, leaves anything behind or touches another submission."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from photograd_course.submissions.similarity import similar_pairs

from course.attacks.attack import ASSIGNMENT, MODULE, Attack, read_attacks
from course.attacks.suite import Results, run_suite, strongest

ATTACKS = read_attacks()
UNSTAGED = 4  # at most so many attacks may lack a control


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.name)
def test_the_grader_survives(attack: Attack, results: Callable[[str], Results]) -> None:
    result = results(strongest())[attack.name]
    assert result["violations"] == []
    assert result["score"] <= attack.max_points


def test_each_attack_has_a_number_and_a_control() -> None:
    numbers = [attack.number for attack in ATTACKS]
    assert numbers == sorted(set(numbers))
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
    planted = Attack(folder, 60, "planted", "", 1.0, 0.0, ("91.1.value",), {"kind": "token"})
    found = run_suite([strongest()], [planted])[strongest()]
    said = sorted(text.split(" ")[0] for text in found["results"][honest.name]["violations"])
    assert said == ["earned", "escape:", "left", "took"]
    assert (found["attacks"], found["survived"]) == (1, 0)
