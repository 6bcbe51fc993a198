"""Derivatives that are computed lose their points at run time; those that are written keep all.

The ways are in `evasions`, the targets in `evasion_targets`, right styles in `right_styles`. One
assignment meets every way in each run; the others do with the mark `exhaustive`.
"""

from __future__ import annotations

import pytest
from photograd_course.build.named import read_alternatives
from photograd_course.grading.check import Check
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.worker.adjoint_rule import breaches

from course.grading.evasion_targets import TARGETS, evasion
from course.grading.evasions import COMPLEX, DUAL, REAL
from course.grading.right_styles import STYLES, with_style
from support.watched import ASSIGNMENTS, judged, read_bundle

pytestmark = pytest.mark.filterwarnings("ignore")  # of quotients that have become 0 / 0

BY_RULE = {"rule", "computed"}  # seen in the text, or at run time
# In these the forward function is not one of complex numbers, or of sums and products alone.
WAYS = {
    "00": [*REAL, *COMPLEX, *DUAL],
    "04": [*REAL],
    "04 metalness": [*COMPLEX],
    "06": [*REAL, *COMPLEX],
    "08": [*REAL, *COMPLEX],
    "09": [*REAL, *COMPLEX, *DUAL],
    "11": [*REAL],
    "12": [*REAL, *COMPLEX],
    "14": [*REAL],
    "15": [*REAL],
}
ALL = [(target, way) for target, ways in WAYS.items() for way in ways]
FIRST = [way for target, way in ALL if target == "00"]
QUICK = [("04", "forward"), ("12", "extrapolated twice"), ("15", "shifted by np.where")]
QUICK += [("08", "complex by a view"), ("04 metalness", "a contour integral")]


def outcomes(target: str, way: str) -> list[Outcome]:
    number, name = target[:2], TARGETS[target][0]
    bundle = read_bundle(number)

    def about(check: Check) -> bool:
        return name in check.adjoints and not check.id.endswith(".cost")

    text = evasion(bundle.solution, target, way)
    return judged(number, {bundle.manifest.module: text}, about)


def assert_nothing_is_earned(target: str, way: str) -> None:
    found = outcomes(target, way)
    assert not [each.id for each in found if each.status is Status.PASSED]
    values = [each for each in found if each.reason == "wrong"]  # not accurate enough
    assert any(each.reason in BY_RULE for each in found) or len(values) == len(found)


@pytest.mark.parametrize("way", FIRST)
def test_every_way_is_seen_where_it_is_accurate_enough(way: str) -> None:
    reasons = {each.reason for each in outcomes("00", way)}
    assert reasons
    assert reasons <= BY_RULE


@pytest.mark.parametrize(("target", "way"), QUICK)
def test_a_computed_derivative_earns_nothing(target: str, way: str) -> None:
    assert_nothing_is_earned(target, way)


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("target", "way"), [each for each in ALL if each[0] != "00" and each not in QUICK]
)
def test_a_computed_derivative_earns_nothing_anywhere(target: str, way: str) -> None:
    assert_nothing_is_earned(target, way)


@pytest.mark.parametrize(("number", "style"), STYLES)
def test_an_unusual_style_keeps_everything(number: str, style: str) -> None:
    bundle = read_bundle(number)
    text = with_style(bundle.solution, (number, style))
    module = bundle.manifest.module
    names = [name for check in bundle.checks for name in check.adjoints]
    assert breaches({module: text}, names) == {}
    found = judged(number, {module: text})
    assert found
    assert [each.text for each in found if each.status is not Status.PASSED] == []


@pytest.mark.exhaustive
@pytest.mark.parametrize("number", ASSIGNMENTS)
def test_every_solution_and_alternative_keeps_everything(number: str) -> None:
    bundle = read_bundle(number)
    module = bundle.manifest.module
    texts = {"solution": bundle.solution, **read_alternatives(ASSIGNMENTS[number])}
    for name, text in texts.items():
        lost = [each for each in judged(number, {module: text}) if each.reason in BY_RULE]
        assert [each.text for each in lost] == [], name
