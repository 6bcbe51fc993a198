"""A check that enters no changed function is not run again, and every other one is."""

from __future__ import annotations

import pytest
from photograd_course.build.course_files import build_of
from photograd_course.build.judging import Job
from photograd_course.build.reach import changed_functions

from .support import TOY

SOURCE = """
LIMIT = 3

def f(a, b=1):
    def inner():
        return a
    return inner() + b

class Value:
    def exp(self):
        return 1.0
"""


@pytest.mark.parametrize(
    ("old", "new", "changed"),
    [
        ("return inner() + b", "return inner() - b", {"f"}),
        ("return a", "return -a", {"f"}),
        ("return 1.0", "return 2.0", {"Value.exp"}),
        ("return a", "return a  # a comment", set()),
        ("b=1", "b=2", None),
        ("LIMIT = 3", "LIMIT = 4", None),
        ("class Value:", "class Value:\n    kind = 1", None),
        ("def exp", "def log", None),
        ("return 1.0", "return (", None),
    ],
)
def test_which_functions_differ(old: str, new: str, changed: set[str] | None) -> None:
    assert changed_functions(SOURCE, SOURCE.replace(old, new)) == changed


def test_a_check_is_left_out_only_where_it_passes_for_every_mutant() -> None:
    build = build_of(TOY)
    left_out = {m.name: build.unreached(m.apply(build.source)) for m in build.mutants}
    assert any(left_out.values())
    for mutant in build.mutants:
        assert not set(left_out[mutant.name]) & set(mutant.loses)
        whole = build.judge.judge_all([Job(mutant.apply(build.source))])[0]
        assert set(whole.lost) == set(mutant.loses)


def test_of_automatic_mutants_the_function_is_known() -> None:
    build = build_of(TOY)
    for mutant in build.automatic:
        assert build.unreached_by(mutant) == build.unreached(mutant.text)
