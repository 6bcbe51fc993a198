"""The suite is run once a mode, for the attacks that are asked for; tests look their result up.

Attacks mostly wait for limits of time. Mode C has a process of its own: it runs beside another.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import pytest
from photograd_course.worker.self_test import self_test

from course.attacks.attack import read_attacks
from course.attacks.suite import Results, run_suite
from support.missing import missing


@pytest.fixture(scope="module")
def results(request: pytest.FixtureRequest) -> Iterator[Callable[[str], Results]]:
    """The suite's results in a mode, by name of the attack."""
    items: list[Any] = [item for item in request.session.items if "results" in item.fixturenames]
    items = [item for item in items if item.module is request.module]
    wanted = {item.callspec.params["attack"].number for item in items}
    chosen = [attack for attack in read_attacks() if attack.number in wanted]

    @cache
    def run(mode: str) -> Results:
        if reason := self_test(mode):
            missing(f"mode {mode}: {reason}", by_choice=True)
        found: Results = run_suite([mode], chosen)[mode]["results"]
        return found

    if not any(item.callspec.params.get("mode") == "C" for item in items) or self_test("C"):
        yield run
        return
    with ThreadPoolExecutor(max_workers=1) as beside:
        apart = beside.submit(run, "C")
        yield lambda mode: apart.result() if mode == "C" else run(mode)
