"""What holds under bubblewrap holds without it, and without the capabilities that it needs."""

from __future__ import annotations

import os
from collections.abc import Callable

import pytest
from photograd_course.worker import launch

from course.attacks.attack import Attack, read_attacks
from course.attacks.privileges import run_like_a_container
from course.attacks.session import Session
from course.attacks.suite import STRICT, Results, strongest
from course.naive_grader.cage import bubblewrap
from support.missing import missing

pytestmark = pytest.mark.slow
# Attacks by nothing but answers, archives or texts: they meet the same code of the grader in every
# mode. Under the strongest mode they run always, in the weaker ones where modes are asked for.
ANSWERS = {9, 14, *range(32, 46), 51, 54, 56, 57, 60, 62, 69, 70, 72, 73, 74}
# Mode C runs always against what a worker does to its machine: it is what a container has.
WEAKER = [
    pytest.param(
        attack,
        mode,
        marks=() if mode == "C" and attack.number not in ANSWERS else pytest.mark.exhaustive,
        id=f"{attack.name}-{mode}",
    )
    for attack in read_attacks()
    for mode in STRICT
    if mode != strongest()
]


@pytest.mark.parametrize(("attack", "mode"), WEAKER)
def test_the_grader_survives(attack: Attack, mode: str, results: Callable[[str], Results]) -> None:
    result = results(mode)[attack.name]
    assert result["violations"] == []
    assert result["score"] <= attack.max_points


@pytest.mark.parametrize("number", [80, 81, 82, 83, 84, 87])
def test_attacks_on_system_calls_tell_where_nothing_filters_them(
    number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their control: under bubblewrap alone, where nothing can be written to, calls go through."""
    if bubblewrap() is None:
        missing("no bubblewrap")
    monkeypatch.setattr(launch, "_filter", lambda **_: None)
    attack = next(each for each in read_attacks() if each.number == number)
    with Session("A") as session:
        session.grade(attack.controlled(), attack.checks)
        log = session.workers.take_log(attack.token)
    assert attack.token in log
    assert "escape: " in log


def test_mode_c_is_tried_without_capabilities() -> None:
    if os.geteuid() != 0:
        missing("needs root", by_choice=True)
    with pytest.raises(RuntimeError, match="unshare"):
        run_like_a_container(["--mode", "B", "--attacks", "32"])
