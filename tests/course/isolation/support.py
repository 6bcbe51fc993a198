"""What the tests of isolation share: a home, short limits, and submissions made of a few lines."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from photograd_course.assignment.bundle import read_folder
from photograd_course.assignment.manifest import Limits
from photograd_course.grading.outcome import Outcome
from photograd_course.grading.remote import Hand, RemoteStudent
from photograd_course.grading.runner import run_checks
from photograd_course.worker.home import WorkerHome
from photograd_course.worker.launch import open_worker

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
SOLUTION = (TOY / "toy.py").read_text(encoding="utf-8")
# A start takes 0.2 s on a quiet machine, and up to 2 s on one that is busy with other tests.
LIMITS = Limits(seconds=20.0, cpu_seconds=2.0, memory_mb=512, output_kb=64)
PATIENT = Limits(seconds=60.0, cpu_seconds=30.0, memory_mb=768, output_kb=64)
CALL_SECONDS = 1.0


def submission(text: str, home: WorkerHome, mode: str, limits: Limits = LIMITS) -> RemoteStudent:
    """A started worker with `text` as its only module; what that imports is not screened."""
    hand = Hand({"toy": textwrap.dedent(text)}, (), ())
    return RemoteStudent(open_worker(home, mode, limits), hand)


def outcomes_of(text: str, home: WorkerHome, mode: str) -> list[Outcome]:
    """The toy assignment's verdict on a submission."""
    bundle = read_folder(TOY, secret=b"secret of the tests")
    hand = bundle.hand({"toy.py": text.encode()})

    def open_student(substitutes: Mapping[str, Any]) -> RemoteStudent:
        return RemoteStudent(
            open_worker(home, mode, PATIENT), replace(hand, substitutes=dict(substitutes))
        )

    return run_checks(bundle.checks, bundle.setting, open_student)


def essence(outcomes: list[Outcome]) -> list[list[Any]]:
    """What must not depend on the mode. Numbers of the check of cost are times, left out."""
    found = []
    for each in outcomes:
        numbers = {k: each.details[k] for k in ("margin", "error") if k in each.details}
        if each.id.endswith(".cost"):
            numbers = {}
        found.append([each.id, each.status.value, each.points, each.reason, each.text, numbers])
    plain: list[list[Any]] = json.loads(json.dumps(found))
    return plain


WRONG = SOLUTION.replace("-d_s * w * falling", "d_s * w * falling")
TEXTS = {"right": SOLUTION, "wrong": WRONG}
