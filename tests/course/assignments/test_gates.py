"""No cheat that holds only as far as few checks look keeps a hidden check: for each function."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from photograd_course.grading.battery import Subject
from photograd_course.grading.check import Check
from photograd_course.grading.cost import agree
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Status
from photograd_course.grading.runner import run_checks
from photograd_course.grading.trial import Student, Trial

from course.assignments import gates
from course.assignments.kept import kept
from course.assignments.support import ASSIGNMENTS, bundle_of, source

FOLDERS = sorted(path.parent for path in ASSIGNMENTS.glob("*/assignment.toml"))
TEXT = Path(gates.__file__).read_text("utf-8")


@dataclass(frozen=True)
class Case:
    """A subject of a check's battery."""

    folder: Path
    check: Check
    place: int

    @property
    def subject(self) -> Subject:
        return self.check.battery[self.place]

    @property
    def name(self) -> str:
        return f"{self.check.id}-{self.place}-{self.subject.function}"


def cases() -> Iterator[Case]:
    for folder in FOLDERS:
        for check in bundle_of(folder).checks:
            for place in range(len(check.battery)):
                yield Case(folder, check, place)


CASES = list(cases())
each_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_every_graded_function_is_asked_for_every_class(folder: Path) -> None:
    graded = {name for task in bundle_of(folder).manifest.tasks for name in task.functions}
    asked = {name for check in bundle_of(folder).checks if check.battery for name in check.calls}
    assert asked == graded


@each_case
def test_zeros_for_what_is_large_are_found(case: Case) -> None:
    limits = limits_of(case)
    if limits:
        found(case, "zeros beyond", gates.zeros_beyond(limits))
    else:  # what grows is no size: the length of a step that is halved again and again
        small, large = arguments(case)
        sizes = [(gates.largest(a), gates.largest(b)) for a, b in zip(small, large, strict=True)]
        place = next(k for k, (a, b) in enumerate(sizes) if b > 1e3 * a)
        gate = gates.zeros_of_large_values(place, 10 * sizes[place][0])
        found(case, "zeros beyond", gate)


@each_case
@pytest.mark.parametrize("seed_matters", [True, False])
def test_answers_remembered_by_shape_are_found(case: Case, seed_matters: bool) -> None:
    gate = gates.remembers_shapes(seed_matters)
    found(case, f"remembers shapes, {seed_matters}", gate)


@each_case
@pytest.mark.parametrize("more", [0, 10])
def test_another_number_of_steps_is_found(case: Case, more: int) -> None:
    for key, limit in limits_of(case).items():
        gate = gates.other_steps(int(key), limit, more) if key.isdigit() else None
        if gate is not None and not (more and has_converged(case, gate)):
            found(case, f"{more} more steps", gate)


def has_converged(case: Case, gate: Callable[[gates.Function], gates.Function]) -> bool:
    """Whether more steps than the large case asks for change nothing: an iteration at its end."""
    module, _, name = place_of(case).rpartition(".")
    function = getattr(trial_student(case).modules[module], name)
    args = arguments(case)[1]
    try:
        return agree(gate(function)(*args), function(*args))
    except (IndexError, ValueError):  # no function of steps
        return False


@each_case
def test_there_are_no_rows_only_where_the_text_says_so(case: Case) -> None:
    if 0 in case.subject.sizes:
        module = bundle_of(case.folder).reference
        (text,) = {getattr(module, name).__doc__ for name in case.check.calls}
        assert re.search(r"may\s+be 0|0 or more|>= 0", text)


@each_case
def test_zeros_for_large_values_are_found(case: Case) -> None:
    trial = trial_of(case)
    for place, factors in case.subject.factors(trial).items():
        if max(factors) > 1:
            usual = gates.largest(case.subject.make(trial, 7)[place])
            gate = gates.zeros_of_large_values(place, 10 * usual)
            found(case, f"zeros of large values, {place}", gate)


def trial_of(case: Case) -> Trial:
    bundle = bundle_of(case.folder)
    setting = bundle.setting(case.check)
    return Trial(
        case.check,
        trial_student(case),
        seed=(1,),
        module=setting.module,
        reference=setting.reference,
    )


def trial_student(case: Case) -> LocalStudent:
    """The solution."""
    bundle = bundle_of(case.folder)
    return LocalStudent(bundle.hand(bundle.solution_files(source(case.folder))).sources)


def place_of(case: Case) -> str:
    """Module and name of the function."""
    function = case.subject.function
    return function if "." in function else f"{bundle_of(case.folder).manifest.module}.{function}"


def limits_of(case: Case) -> dict[str, int]:
    """Sizes of arguments that the large case alone exceeds."""
    return gates.growing(*arguments(case))


def arguments(case: Case) -> tuple[Sequence[Any], Sequence[Any]]:
    """Those of the largest other case, and of the large one."""
    trial, subject = trial_of(case), case.subject
    return subject.make(trial, max(subject.sizes)), subject.make(trial, subject.large)


def found(case: Case, kind: str, gate: Callable[[gates.Function], gates.Function]) -> None:
    """The check fails where its function goes through the gate."""
    bundle = bundle_of(case.folder)
    sources = bundle.hand(bundle.solution_files(source(case.folder))).sources
    module, _, name = place_of(case).rpartition(".")

    def open_student(given: dict[str, gates.Function]) -> Student:
        student = LocalStudent(sources, given)
        setattr(student.modules[module], name, gate(getattr(student.modules[module], name)))
        return student

    def run() -> tuple[Status, str]:
        (outcome,) = run_checks([case.check], bundle.setting, open_student)
        return outcome.status, outcome.text

    status, text = kept(case.folder, ["gates", TEXT, case.name, kind], run)
    assert status is Status.FAILED, text or "the check is passed"
