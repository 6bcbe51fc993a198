"""Every rule that runs goes red on a copy that breaks it, and says which check and which text.

That the toy assignment keeps them all, and in which numbers, is proved by the doctor's test.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd_course.build.course_files import build_of
from photograd_course.build.evidence import evidence
from photograd_course.build.matrix import cells, kills
from photograd_course.build.rules import findings, seed_findings

from .support import SECRET, Broken


def test_the_scaffold_keeps_every_rule_for_any_secret(scaffold: Path, cache: Path) -> None:
    assert findings(build_of(scaffold, cache=cache)) == []
    assert seed_findings(build_of(scaffold, secret=SECRET, cache=cache)) == []


def test_solution(broken: Broken) -> None:
    broken.change("checks/task_1.py", "[2.0, 4.0, 10.0]", "[2.0, 4.0, 11.0]")
    assert broken.broken_rules() == {"solution"}
    assert "does not pass 17.1.known" in broken.says("solution")[0]


def test_starter(broken: Broken) -> None:
    broken.change(
        "checks/task_1.py", "    known = np", '    t.require(True, "")\n    return\n    known = np'
    )
    assert broken.says("starter") == ["the starter passes 17.1.known"]


def test_starter_that_crashes(broken: Broken) -> None:
    broken.change(
        "checks/task_1.py", "    known = np", '    t.require(False, "no")\n    known = np'
    )
    assert (
        "17.1.known should say of the starter that it is not implemented"
        in broken.says("starter")[0]
    )


def test_mutants(broken: Broken) -> None:
    broken.change("mutants.toml", 'squared = ["known random"', 'squared = ["none random"')
    assert broken.says("mutants") == [
        "squared should lose 17.1.none, which is no check",
        "squared loses 17.1.known, which its row does not list",
    ]
    broken.change("mutants.toml", "return x * x", "return x + x")
    assert "squared survives 17.1.random, which it should lose" in broken.says("mutants")


def test_mutants_that_no_longer_apply(broken: Broken) -> None:
    broken.change("light.py", "2.0 * x", "x * 2.0")
    assert any(
        "'return 2.0 * x' once in the solution, got 0" in str(f) for f in findings(broken.build)
    )


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ('bad = ["known", "", "2", "3"]', "4 texts, the second ['']"),
        ('bad = ["known", "It is wrong.", "2"]', "3 texts"),
        ('bad = ["known", "It is wrong.", "2", 3]', "'2', 3]"),
        ('["17.2"]\nsquared = ["known", "It is wrong.", "2", "3"]', "it occurs twice"),
    ],
)
def test_rows_of_another_form(broken: Broken, row: str, what: str) -> None:
    path = broken.folder / "mutants.toml"
    path.write_text(f"{path.read_text('utf-8')}{row}\n", "utf-8")
    assert what in str(findings(broken.build)[0])


def test_which_checks_kill_a_mutant_comes_from_the_run(broken: Broken) -> None:
    assert kills(broken.build) == {
        "17.1.known": ("not_doubled", "squared"),
        "17.1.random": ("not_doubled", "squared"),
    }
    broken.change("mutants.toml", "return x * x", "return np.abs(2.0 * x)")
    assert (known := kills(broken.build))["17.1.known"] == ("not_doubled",)
    # The picture shows in another color what a single check kills.
    assert cells(["not_doubled", "squared"], known).tolist() == [[1, 1], [0, 2]]


def test_alternatives(broken: Broken) -> None:
    broken.change("alternatives/vectorized.py", "x + x", "x + x * x")
    said = broken.says("alternatives")
    assert [text.partition(":")[0] for text in said] == [
        f"vectorized is right and does not pass {check}" for check in ("17.1.known", "17.1.random")
    ]


def test_margins_of_right_answers(broken: Broken) -> None:
    broken.change("alternatives/vectorized.py", "x + x", "(x + x) * (1 + 5e-13)")
    said = broken.says("margins")
    assert "17.1.known: vectorized is right and uses 0.5 of the tolerance" in said[0]


def test_margins_of_wrong_answers(broken: Broken) -> None:
    broken.change("mutants.toml", "return x * x", "return (2.0 + 4e-12) * x")
    assert "17.1.known: squared is wrong by only 2 times the tolerance" in broken.says("margins")[0]


def test_automatic(broken: Broken) -> None:
    dead = "2.0 * x\n    spare = 3.0\n    return y"
    broken.change("light.py", "return 2.0 * x", f"y = {dead}")
    said = broken.says("automatic")
    assert "less than 95%" in said[0]
    assert [text.partition("the change ")[2] for text in said[1:]] == [
        "'3.0 -> 6.0'",
        "'3.0 -> -3.0'",
    ]
    entry = '[[equivalent]]\nfunction = "twice"\nline = "spare = 3.0"\nreason = "never read"\n'
    both = [f'{entry}mutation = "3.0 -> {value}"\n' for value in ("6.0", "-3.0", "0.0")]
    broken.add("equivalent.toml", "".join(both))
    assert "equivalent.toml lists '3.0 -> 0.0' in 'spare = 3.0'" in broken.says("automatic")[1]
    assert len(broken.says("automatic")) == 2


def test_sole(broken: Broken) -> None:
    broken.change("checks/hidden/task_1.py", 'sole="random', 'hint="random')
    assert "17.1.random is never the only check to notice a mutant" in broken.says("sole")[0]
    # A mistake that shows at negative values only: the public check has none.
    path = broken.folder / "mutants.toml"
    folded = 'folded = ["random", "It is positive.", "return 2.0 * x", "return np.abs(2.0 * x)"]'
    path.write_text(f"{path.read_text('utf-8')}{folded}\n", "utf-8")
    assert broken.says("sole") == []


def test_sole_by_an_automatic_mutant(broken: Broken) -> None:
    broken.change("checks/hidden/task_1.py", 'sole="random', 'hint="random')
    broken.change("light.py", "return 2.0 * x", "return 2.0 * x if x[0] >= 1.0 else x * 2.0")
    # "x * 2.0 -> x" shows only where x[0] < 1, and the public check has x[0] = 1.
    assert broken.says("sole") == []


def test_hints(broken: Broken) -> None:
    assert broken.says("hints") == []
    broken.change("mutants.toml", "Your result is the square", "Your result is a square")
    assert broken.says("hints") == [
        "hints.json is not up to date: run 'photograd course build --update-hints'"
    ]


def test_a_check_that_falters_is_reported(broken: Broken) -> None:
    broken.change(
        "checks/task_1.py",
        "    t.close",
        "    assert t.call('twice', known, returns=Array((3,)))[0] == 2.0\n    t.close",
    )
    assert any("17.1.known falters on not_doubled" in text for text in broken.says("mutants"))


def test_a_broken_fixture_is_not_ok(broken: Broken) -> None:
    broken.change("alternatives/vectorized.py", "x + x", "x + x * x")
    known = evidence(broken.folder, cache=broken.cache)
    assert not known["ok"]
    assert known["alternatives_accepted"] == 2
