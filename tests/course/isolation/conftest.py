from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from photograd_course.worker import processes
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.self_test import self_test

from course.isolation.support import TEXTS, essence, outcomes_of
from support.missing import missing


def need(mode: str) -> str:
    """The mode, or skip the test with the reason that the self-test gives."""
    if reason := self_test(mode):
        missing(f"mode {mode}: {reason}", by_choice=True)
    return mode


def modes(names: str) -> list[Any]:
    """A and C run always, the others with --exhaustive."""
    marks = {name: () if name in "AC" else (pytest.mark.exhaustive,) for name in names}
    return [pytest.param(name, marks=found) for name, found in marks.items()]


@pytest.fixture(params=modes("ABCDE"))
def mode(request: pytest.FixtureRequest) -> str:
    """Every mode that this machine has."""
    return need(request.param)


@pytest.fixture(params=modes("ABCD"))
def strict(request: pytest.FixtureRequest) -> str:
    """Every mode that enforces something."""
    return need(request.param)


@pytest.fixture(scope="session")
def expected() -> dict[str, list[list[Any]]]:
    """What mode E says to both submissions: the others must agree."""
    with WorkerHome() as made:
        return {key: essence(outcomes_of(text, made, "E")) for key, text in TEXTS.items()}


@pytest.fixture
def home() -> Iterator[WorkerHome]:
    """Of one test; whatever it did, no process of its users and none of its folders is left."""
    with WorkerHome() as made:
        yield made
        users = [made.uid(slot) for slot in range(4)] if made.has_users else []
        assert [processes.of_user(uid) for uid in users] == [[]] * len(users)
        assert list(made.folder.glob("room-*")) == []
    assert not made.folder.exists()
