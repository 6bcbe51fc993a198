"""What holds under bubblewrap holds without it, and without the capabilities that it needs."""

from __future__ import annotations

import os
from collections.abc import Callable

import pytest

from course.attacks.attack import Attack, read_attacks
from course.attacks.privileges import run_like_a_container
from course.attacks.suite import STRICT, Results, strongest
from support.missing import missing

pytestmark = pytest.mark.slow
# Mode C runs always: it is what a container has.
WEAKER = [
    mode if mode == "C" else pytest.param(mode, marks=pytest.mark.exhaustive)
    for mode in STRICT
    if mode != strongest()
]


@pytest.mark.parametrize("mode", WEAKER)
@pytest.mark.parametrize("attack", read_attacks(), ids=lambda attack: attack.name)
def test_the_grader_survives(attack: Attack, mode: str, results: Callable[[str], Results]) -> None:
    result = results(mode)[attack.name]
    assert result["violations"] == []
    assert result["score"] <= attack.max_points


def test_mode_c_is_tried_without_capabilities() -> None:
    if os.geteuid() != 0:
        missing("needs root", by_choice=True)
    with pytest.raises(RuntimeError, match="unshare"):
        run_like_a_container(["--mode", "B", "--attacks", "32"])
