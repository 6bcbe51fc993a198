"""Each class of mistakes catches its wrong functions and lets right ones pass, in a worker too."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from photograd_course.errors import RangeError
from photograd_course.grading import Array, CheckFailed, Status, Tolerance, Trial, check
from photograd_course.grading.battery import (
    COTANGENT_SCALES,
    Subject,
    bad_values,
    left_unchanged,
    require_repeatable,
    require_sizes,
    rows_independent,
    scaled_values,
)
from photograd_course.grading.failures import GraderFault, StudentFailure
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.remote import Hand, RemoteStudent
from photograd_course.grading.runner import Setting, run_checks
from photograd_course.grading.trial import Student
from photograd_course.worker.process import WorkerProcess, install_program, plain_command

HEAD = "import numpy as np\nSEEN = []\ndef blend(a, w):\n"
RIGHT = HEAD + "    return a * w[:, None]\n"
WRONG = {
    "one weight for all": HEAD + "    return a * w[0]\n",
    "writes into its argument": HEAD + "    a *= w[:, None]\n    return a\n",
    "sets its weights to zero": HEAD + "    b = a * w[:, None]\n    w[:] = 0\n    return b\n",
    "remembers the first call": HEAD
    + "    SEEN.append(w[0])\n    return a * w[:, None] / SEEN[0]\n",
    "counts its calls": HEAD + "    SEEN.append(1)\n    return a * w[:, None] * len(SEEN)\n",
    "reads memory": HEAD + "    flat = np.lib.stride_tricks.as_strided(a, a.shape, "
    "(8 * a.shape[1], 8))\n    return flat * w[:, None]\n",
    "stops at 32 rows": HEAD + "    b = np.zeros_like(a)\n    b[:32] = (a * w[:, None])[:32]\n"
    "    return b\n",
    "knows few rows": HEAD + "    return a * w[:, None] * (len(a) <= 500)\n",
    "remembers by shape": HEAD
    + "    SEEN.append(a * w[:, None])\n"
    + "    return next(each for each in SEEN if each.shape == a.shape)\n",
    "drops large values": HEAD + "    return a * w[:, None] * (abs(a) < 1e3)\n",
    "drops small values": HEAD + "    return a * w[:, None] * (abs(a) > 1e-3)\n",
    "squeezes one row": HEAD + "    return np.squeeze(a * w[:, None])\n",
    "NaN becomes zero": HEAD + "    return np.nan_to_num(a * w[:, None])\n",
}
Open = Callable[[str], Trial]


def make(t: Trial, n: int) -> tuple[Any, ...]:
    return t.rng.uniform(1.0, 2.0, (n, 3)), t.rng.uniform(1.0, 2.0, n)


BLEND = Subject(
    "blend",
    make,
    lambda n: Array((n, 3), finite=False),
    sizes=(0, 1, 2, 64),
    scales={0: (1e-6, 1e6)},
    rows=(0, 1),
    special={0: (np.nan, np.inf, -np.inf)},
)


@pytest.fixture(params=["local", "worker"])
def open_trial(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Open]:
    """A trial of a text, in this process or in another."""
    opened: list[Student] = []
    program = install_program(tmp_path) if request.param == "worker" else tmp_path

    def body(t: Trial) -> None:
        """Something holds."""

    made = check("1.x", points=1, calls=("blend",), tolerance=Tolerance(1e-12, "sums"))

    def open_one(text: str) -> Trial:
        student: Student = LocalStudent({"m": text})
        if request.param == "worker":
            worker = WorkerProcess(plain_command(program), environment={}, cwd=tmp_path)
            worker.request("start", {}, seconds=60.0)
            student = RemoteStudent(worker, Hand({"m": text}, ("m",), ("numpy",)))
        opened.append(student)
        reference = SimpleNamespace(blend=lambda a, w: a * w[:, None])
        return Trial(made(body), student, seed=(1,), module="m", reference=reference)

    yield open_one
    for each in opened:
        each.close()


def caught(open_trial: Open, text: str) -> set[str]:
    """The classes by which a text is caught."""
    classes: dict[str, Callable[[Trial, Subject], None]] = {
        "sizes": require_sizes,
        "layouts": left_unchanged,
        "repeatable": require_repeatable,
        "rows": rows_independent,
        "special": bad_values,
        "scales": scaled_values,
    }
    found = set()
    for name, run in classes.items():
        trial = open_trial(text)
        try:
            run(trial, BLEND)
        except (CheckFailed, StudentFailure):
            found.add(name)
        assert name in found or trial.margins or trial.asked
    return found


def test_right_code_passes_every_class(open_trial: Open) -> None:
    assert caught(open_trial, RIGHT) == set()


@pytest.mark.parametrize(
    ("mistake", "classes"),
    [
        ("one weight for all", {"sizes", "rows"}),
        ("writes into its argument", {"layouts"}),
        ("sets its weights to zero", {"layouts"}),
        ("counts its calls", {"repeatable", "layouts"}),
        ("remembers the first call", {"sizes"}),
        ("reads memory", {"layouts"}),
        ("stops at 32 rows", {"sizes"}),
        ("knows few rows", {"sizes"}),
        ("remembers by shape", {"repeatable"}),
        ("drops large values", {"scales"}),
        ("drops small values", {"scales"}),
        ("squeezes one row", {"sizes", "rows"}),
        ("NaN becomes zero", {"special"}),
    ],
)
def test_a_mistake_is_caught_by_its_class(
    open_trial: Open, mistake: str, classes: set[str]
) -> None:
    assert classes <= caught(open_trial, WRONG[mistake])


@pytest.mark.parametrize(
    ("body", "case"),
    [
        ("return a * w[0]", ""),
        ("return np.squeeze(a * w[:, None])", "for one row"),
        ("return (a + (len(a) == 1)) * w[:, None]", "for one row"),
        ("return 1.0 / len(a) * len(a) * a * w[:, None]", "for no rows"),
        ("return (a + (len(a) > 100)) * w[:, None]", "for many rows"),
    ],
)
def test_a_failure_says_for_which_class_of_sizes(open_trial: Open, body: str, case: str) -> None:
    subject = replace(BLEND, sizes=(7, 1, 0, 200))
    with pytest.raises((CheckFailed, StudentFailure)) as caught:
        require_sizes(open_trial(HEAD + f"    {body}\n"), subject)
    failure = caught.value
    said = failure.case if isinstance(failure, StudentFailure) else failure.details["case"]
    assert said == case


@pytest.mark.parametrize(
    ("mistake", "run", "said"),
    [
        ("knows few rows", require_sizes, "among 1000"),
        ("remembers by shape", require_repeatable, "the same answer again"),
    ],
)
def test_functions_without_a_right_answer_must_agree_with_themselves(
    open_trial: Open, mistake: str, run: Callable[[Trial, Subject], None], said: str
) -> None:
    with pytest.raises(CheckFailed, match=said):
        run(open_trial(WRONG[mistake]), replace(BLEND, has_right=False))


def test_only_what_right_answers_have_in_common_is_compared(open_trial: Open) -> None:
    """Rows in any order are right where the text leaves it open."""
    turned = HEAD + "    return (a * w[:, None])[::-1]\n"
    ordered = replace(BLEND, rows=(), common=lambda _t, _args, got: np.sort(got, axis=0))
    for run in (require_sizes, require_repeatable, scaled_values):
        run(open_trial(turned), ordered)
        with pytest.raises(CheckFailed, match="relative error"):
            run(open_trial(turned), BLEND)


def test_a_cotangent_is_scaled_without_being_asked(open_trial: Open) -> None:
    trial = open_trial(RIGHT)
    reference = SimpleNamespace(blend=lambda a, d_w: a * d_w[:, None])
    trial = Trial(trial.check, trial._student, seed=(1,), module="m", reference=reference)
    assert replace(BLEND, scales={}).factors(trial) == {1: COTANGENT_SCALES}


def test_rows_that_are_all_equal_prove_nothing(open_trial: Open) -> None:
    same = replace(BLEND, make=lambda _, n: (np.ones((n, 3)), np.ones(n)))
    with pytest.raises(GraderFault, match="are equal"):
        rows_independent(open_trial(RIGHT), same)


def test_a_check_runs_its_battery_after_its_body() -> None:
    def body(t: Trial) -> None:
        """Something holds."""
        t.require(True, "it does")

    reference = SimpleNamespace(blend=lambda a, w: a * w[:, None])
    made = check(
        "1.x",
        points=1,
        calls=("blend",),
        visibility="hidden",
        tolerance=Tolerance(1e-12, "sums"),
        battery=[BLEND],
    )(body)
    for text, status in ((RIGHT, Status.PASSED), (WRONG["one weight for all"], Status.FAILED)):
        (found,) = run_checks(
            [made],
            lambda _: Setting("m", (1,), reference),
            lambda _, text=text: LocalStudent({"m": text}),
        )
        assert found.status is status, found.text
    with pytest.raises(RangeError, match="a hidden check"):
        check("1.x", points=1, calls=(), battery=[BLEND])
