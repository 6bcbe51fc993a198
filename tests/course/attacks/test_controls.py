"""Each attack is one: it succeeds against the naive grader, or must leave a token in its worker."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from course.attacks.attack import ASSIGNMENT, MODULE, Attack, read_attacks
from course.attacks.controls import has_naive_control, run_control
from course.naive_grader.cage import FULL, Naive, bubblewrap, grade_naively
from support.missing import missing

NAIVE = [attack for attack in read_attacks() if has_naive_control(attack)]
AT_ONCE = 3  # of those that hang
Control = tuple[bool, Naive]


@pytest.fixture(scope="module")
def control(request: pytest.FixtureRequest) -> Iterator[Callable[[Attack], Control]]:
    """Runs an attack's control; those that hang run beside each other, from the first one on.

    Each has a cage to itself, and its time is always used up: it is waited for, not measured.
    """
    here: list[Any] = [item for item in request.session.items if item.parent is request.node]
    items = [item for item in here if "control" in item.fixturenames]
    asked: list[Attack] = [item.callspec.params["attack"] for item in items]

    with ThreadPoolExecutor(AT_ONCE) as pool:

        @cache
        def hanging() -> dict[str, Future[Control]]:
            hang = [attack for attack in asked if attack.control["gain"] == "hang"]
            return {attack.name: pool.submit(run_control, attack) for attack in hang}

        def run(attack: Attack) -> Control:
            if attack.control["gain"] == "hang":
                return hanging()[attack.name].result()
            return run_control(attack)

        yield run


@pytest.mark.parametrize("attack", NAIVE, ids=lambda attack: attack.name)
def test_the_attack_is_one(attack: Attack, control: Callable[[Attack], Control]) -> None:
    if bubblewrap() is None:
        missing("attacks are let loose on the naive grader only under bubblewrap")
    succeeded, found = control(attack)
    assert succeeded, found


def test_the_naive_grader_is_fair_to_the_honest(tmp_path: Path) -> None:
    if bubblewrap() is None:
        missing("no bubblewrap")
    solution = ASSIGNMENT / MODULE
    empty, full = tmp_path / "empty", tmp_path / "full"
    for folder, upload, score in ((empty, b"", 0.0), (full, solution.read_bytes(), FULL)):
        folder.mkdir()
        found = grade_naively(upload, folder, solution)
        assert (found.score, found.report["innocent"], found.next_score) == (score, FULL, FULL)
        assert not found.strays
