"""What each test costs, written where tools/pools.py asks for it: processor time and seconds."""

from __future__ import annotations

import json
import resource
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tools.pools import COUNTED

KEY = "processor seconds"


def processor_seconds() -> float:
    """Of this process and of those that it started and waited for."""
    found = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in found)


class Costs:
    """A plugin: measures in the processes that run tests, adds up in the one that reports."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._started = 0.0
        self._tests: dict[str, list[float]] = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logstart(self) -> None:
        self._started = processor_seconds()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, call: pytest.CallInfo[None]) -> Iterator[Any]:
        report = yield
        if call.when == "teardown":
            report.user_properties.append((KEY, processor_seconds() - self._started))
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        row = self._tests.setdefault(report.nodeid, [0.0, 0.0])
        row[0] += dict(report.user_properties).get(KEY, 0.0) if report.when == "teardown" else 0.0
        row[1] += report.duration

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        stats = terminalreporter.stats
        counts = {name: len(stats.get(name.removesuffix("s"), [])) for name in COUNTED}
        found = {"counts": counts, "tests": self._tests}
        self._file.write_text(json.dumps(found), encoding="utf-8")
