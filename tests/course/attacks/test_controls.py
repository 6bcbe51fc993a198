"""Each attack is one: it succeeds against the naive grader, or must leave a token in its worker."""

from __future__ import annotations

from pathlib import Path

import pytest

from course.attacks.attack import ASSIGNMENT, MODULE, Attack, read_attacks
from course.attacks.controls import has_naive_control, run_control
from course.naive_grader.cage import FULL, bubblewrap, grade_naively

NAIVE = [attack for attack in read_attacks() if has_naive_control(attack)]


@pytest.mark.parametrize("attack", NAIVE, ids=lambda attack: attack.name)
def test_the_attack_is_one(attack: Attack) -> None:
    if bubblewrap() is None:
        pytest.skip("attacks are let loose on the naive grader only under bubblewrap")
    succeeded, found = run_control(attack)
    assert succeeded, found


def test_the_naive_grader_is_fair_to_the_honest(tmp_path: Path) -> None:
    if bubblewrap() is None:
        pytest.skip("no bubblewrap")
    solution = ASSIGNMENT / MODULE
    empty, full = tmp_path / "empty", tmp_path / "full"
    for folder, upload, score in ((empty, b"", 0.0), (full, solution.read_bytes(), FULL)):
        folder.mkdir()
        found = grade_naively(upload, folder, solution)
        assert (found.score, found.report["innocent"], found.next_score) == (score, FULL, FULL)
        assert not found.strays
