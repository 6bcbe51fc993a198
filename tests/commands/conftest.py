"""A tiny capture, a model fitted to it by the command itself, and a way to call commands."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from photograd._compiled import _core
from photograd_course.cli.entry import run

from tests.fit import scene

FIT = ("--steps", "40", "--resolution", "16", "--rays", "512", "--seed", "1")


@dataclass(frozen=True)
class Outcome:
    """What a command left: exit code, stdout, stderr."""

    code: int
    out: str
    err: str

    def result(self) -> dict[str, Any]:
        """The machine-readable last line."""
        found: dict[str, Any] = json.loads(self.out.splitlines()[-1])
        return found


Photograd = Callable[..., Outcome]


@pytest.fixture
def photograd(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Photograd:
    """Run one command line in this process, on a terminal of 100 columns."""
    monkeypatch.setenv("COLUMNS", "100")

    def call(*words: object) -> Outcome:
        capsys.readouterr()
        code = run([str(word) for word in words])
        return Outcome(code, *capsys.readouterr())

    return call


@pytest.fixture(autouse=True)
def _all_threads_again() -> Iterator[None]:
    yield
    _core.set_thread_count(0)


@pytest.fixture(scope="session")
def capture_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return scene.write(tmp_path_factory.mktemp("capture") / "balls")


@pytest.fixture(scope="session")
def model_folder(capture_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Fitted once; tests only read it."""
    folder = tmp_path_factory.mktemp("model")
    assert run(["fit", str(capture_folder), "--out", str(folder), *FIT]) == 0
    return folder
