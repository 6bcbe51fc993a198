"""The suite is run once a mode, for the attacks that are asked for; tests look their result up."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from photograd_course.worker.self_test import self_test

from course.attacks.attack import read_attacks
from course.attacks.suite import Results, run_suite


@pytest.fixture(scope="module")
def results(request: pytest.FixtureRequest) -> Callable[[str], Results]:
    """The suite's results in a mode, by name of the attack."""
    items: list[Any] = [item for item in request.session.items if "results" in item.fixturenames]
    wanted = {item.callspec.params["attack"].number for item in items}

    @cache
    def run(mode: str) -> Results:
        if reason := self_test(mode):
            pytest.skip(f"mode {mode}: {reason}")
        chosen = [attack for attack in read_attacks() if attack.number in wanted]
        found: Results = run_suite([mode], chosen)[mode]["results"]
        return found

    return run
