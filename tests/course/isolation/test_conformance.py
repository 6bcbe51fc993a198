"""The verdict does not depend on the mode: same status, points, words and margins."""

from __future__ import annotations

from typing import Any

import pytest
from photograd_course.grading import Status
from photograd_course.worker.home import WorkerHome

from course.isolation.support import TEXTS, essence, outcomes_of

Essence = dict[str, list[list[Any]]]


def test_the_measure_is_no_empty_one(expected: Essence) -> None:
    right, wrong = expected["right"], expected["wrong"]
    assert {line[1] for line in right} == {Status.PASSED.value}
    assert sum(line[2] for line in right) == 15
    failed = [line[0] for line in wrong if line[1] == Status.FAILED.value]
    assert failed == ["90.2.differences", "90.2.cost"]


@pytest.mark.parametrize("key", TEXTS)
def test_every_mode_says_the_same(
    strict: str, home: WorkerHome, key: str, expected: Essence
) -> None:
    assert essence(outcomes_of(TEXTS[key], home, strict)) == expected[key]
