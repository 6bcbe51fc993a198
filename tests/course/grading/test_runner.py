"""Verdicts: three values for the student, one for us, and none is ever missing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.grading import Check, CheckFailed, Outcome, Status, StudentFailure, check
from photograd_course.grading.hints import hint_key
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.runner import Setting, _general_advice, run_checks

TOY = Path(__file__).parents[1] / "fixture_course" / "90_toy"
GOOD = (TOY / "toy.py").read_text(encoding="utf-8")


@pytest.fixture
def bundle() -> Bundle:
    return read_folder(TOY, secret=b"secret of the tests")


def run(
    bundle: Bundle, text: str, setting: Callable[[Check], Setting] | None = None
) -> dict[str, Outcome]:
    outcomes = run_checks(
        bundle.checks, setting or bundle.setting, lambda given: LocalStudent({"toy": text}, given)
    )
    assert [o.id for o in outcomes] == [c.id for c in bundle.checks]
    return {o.id: o for o in outcomes}


def student_setting(_check: Check) -> Setting:
    return Setting("toy", (1, 2))


def test_the_solution_passes_everything(bundle: Bundle) -> None:
    found = run(bundle, GOOD)
    assert {o.status for o in found.values()} == {Status.PASSED}
    assert sum(o.points for o in found.values()) == sum(o.max for o in found.values()) == 15


def test_a_failed_check_earns_nothing_and_says_why(bundle: Bundle) -> None:
    found = run(bundle, GOOD.replace("-d_s * w * falling", "d_s * w * falling"))
    failed = found["90.2.differences"]
    assert (failed.status, failed.points, failed.reason) == (Status.FAILED, 0.0, "wrong")
    assert failed.details["error"] == pytest.approx(2.0)
    assert failed.details["tolerance"] == 1e-6
    assert found["90.1.value"].status is Status.PASSED


def test_a_hidden_check_shows_no_exception_text(bundle: Bundle) -> None:
    found = run(bundle, GOOD.replace("    return float(", "    raise ValueError(x[0])\n    float("))
    assert "exception" in found["90.1.value"].details
    assert "exception" not in found["90.1.hidden"].details
    assert found["90.1.hidden"].reason == "raised"


BROKEN_SUM = GOOD.replace("return float(np.sum(w * np.exp(-x)))", "return float('nan')")


def test_without_the_reference_what_builds_on_a_failure_is_blocked(bundle: Bundle) -> None:
    public = [c for c in bundle.checks if c.visibility == "public"]
    outcomes = run_checks(public, student_setting, lambda s: LocalStudent({"toy": BROKEN_SUM}, s))
    found = {o.id: o for o in outcomes}
    assert found["90.2.differences"].status is Status.BLOCKED
    assert "90.1.value" in found["90.2.differences"].text
    assert found["90.3.services"].status is Status.PASSED


def test_with_the_reference_it_is_judged_on_its_own(bundle: Bundle) -> None:
    found = run(bundle, BROKEN_SUM)
    assert found["90.1.value"].status is Status.FAILED
    later = found["90.2.differences"]
    assert (later.status, later.points) == (Status.PASSED, 3.0)
    assert "reference's weighted_sum" in later.text


def test_not_implemented_is_said_also_where_an_earlier_task_lacks(bundle: Bundle) -> None:
    text = GOOD
    for line in ("return float(", "return d_s", "return np.stack("):
        text = text.replace(line, f"raise NotImplementedError('90.x')\n    {line}")
    outcomes = run_checks(bundle.checks, student_setting, lambda s: LocalStudent({"toy": text}, s))
    public = [o for o in outcomes if o.visibility == "public"]
    assert {o.reason for o in public} == {"not implemented"}


def _one(body: Any) -> Check:
    return check("1.x", points=1, calls=("weighted_sum",))(body)


def verdict(body: Any, text: str = GOOD) -> Outcome:
    return run_checks([_one(body)], student_setting, lambda s: LocalStudent({"toy": text}, s))[0]


def test_our_own_mistakes_are_ours() -> None:
    def crash(_t: Any) -> None:
        """It crashes."""
        raise KeyError("ours")

    def compares_nothing(t: Any) -> None:
        """It asks nothing."""

    def uses_the_reference(t: Any) -> None:
        """It needs what is not here."""
        t.require(t.reference is not None, "")

    for body in (crash, compares_nothing, uses_the_reference):
        assert verdict(body).status is Status.ERROR_OURS


@pytest.mark.parametrize("error", [StudentFailure("timeout", "late"), CheckFailed("wrong")])
def test_what_the_student_does_is_not(error: Exception) -> None:
    def body(_t: Any) -> None:
        """It fails."""
        raise error

    assert verdict(body).status is Status.FAILED


def test_a_submission_that_does_not_import_fails_every_check(bundle: Bundle) -> None:
    found = run(bundle, "import numpy as np\nx = 1 / 0\n")
    assert {(o.status, o.reason) for o in found.values()} == {(Status.FAILED, "broken")}


def test_a_known_mistake_gets_its_own_hint(bundle: Bundle) -> None:
    text = GOOD.replace("-d_s * w * falling", "d_s * w * falling")
    first = run(bundle, text)["90.2.differences"]
    salt = "salt"
    known = {hint_key(salt, first.id, first.details["fingerprint"]): "your sign is wrong"}

    def with_hints(check: Check) -> Setting:
        given = bundle.setting(check)
        return Setting(given.module, given.seed, given.reference, known, salt)

    assert run(bundle, text, with_hints)["90.2.differences"].hint == "your sign is wrong"


def test_public_checks_are_the_same_for_student_and_grader(bundle: Bundle) -> None:
    other = read_folder(TOY, secret=b"another secret")
    by_id = {c.id: c for c in bundle.checks}
    assert bundle.setting(by_id["90.1.value"]).seed == other.setting(by_id["90.1.value"]).seed
    assert bundle.setting(by_id["90.1.hidden"]).seed != other.setting(by_id["90.1.hidden"]).seed


def test_outcomes_become_plain_json(bundle: Bundle) -> None:
    import json

    found = run(bundle, GOOD.replace("-d_s * w * falling", "d_s * w * falling"))
    text = json.dumps([o.to_json() for o in found.values()])
    assert '"status": "failed"' in text
    assert "arrays" not in text


def test_an_answer_of_another_shape_gets_no_hint_about_values(bundle: Bundle) -> None:
    advised = replace(bundle, checks=tuple(replace(c, hint="mind the sign") for c in bundle.checks))
    size = run(advised, GOOD.replace("-d_s * w * falling", "-1.37 * d_s * w * falling"))
    assert size["90.2.differences"].hint == "mind the sign"
    for wrong in ("(-d_s * w * falling)[:-1]", "None", "1.0", "(-d_s * w * falling).astype('f4')"):
        found = run(advised, GOOD.replace("-d_s * w * falling", wrong))["90.2.differences"]
        assert found.status is Status.FAILED
        assert found.hint == ""
        assert "expected" in found.text


def test_advice_is_not_given_where_it_could_only_lead_away(bundle: Bundle) -> None:
    advised = replace(bundle, checks=tuple(replace(c, hint="mind the sum") for c in bundle.checks))
    reversed_ = run(advised, GOOD.replace("-d_s * w * falling", "d_s * w * falling"))
    told = reversed_["90.2.differences"]
    words = "All of yours are -1 times what is expected (your sign is reversed)"
    assert told.text.endswith(words)
    assert "mind the sum" not in told.hint  # that of a known mistake may stand there
    for bad in ("np.nan", "np.inf", "np.where(np.arange(len(w)) == 0, np.nan, 1.0)"):
        told = run(advised, GOOD.replace("-d_s * w * falling", f"w * {bad}"))["90.2.differences"]
        assert "not finite" in told.text
        assert told.hint == ""


def test_where_an_earlier_check_fails_too_it_is_named_instead_of_advice(bundle: Bundle) -> None:
    advised = replace(bundle, checks=tuple(replace(c, hint="mind the sum") for c in bundle.checks))
    found = run(advised, GOOD.replace("-d_s * w * falling", "-1.37 * d_s * w * falling + w**3"))
    failed = [o for o in found.values() if o.status is Status.FAILED and o.reason == "wrong"]
    assert failed[0].hint == "mind the sum"
    later = [o for o in failed[1:] if o.task == failed[0].task]
    assert later
    assert {o.hint for o in later} == {f"{failed[0].id} fails as well: begin there"}


def test_what_a_check_needs_besides_is_not_to_blame(bundle: Bundle) -> None:
    """It is blocked, or has failed with the reference's function in its place as well."""
    first = replace(bundle.checks[0], calls=("g",), needs=("f",), hint="mind the sum")
    assert _general_advice(first, {"f": "1.1.a"}) == "mind the sum"
    assert _general_advice(first, {"f": "1.1.a", "g": "1.2.b"}) == (
        "1.2.b fails as well: begin there"
    )
