"""What every assignment owes, as tests that an assignment's own test file inherits.

    class TestTextureRecovery(AssignmentTests):
        folder = ASSIGNMENTS / "03_texture_recovery"

A figure returns facts, `{"claim": Fact(...)}`. Each names the mutant that turns it red, or says why
none does; or `figures.py` names for each figure a mutant that turns at least one red (RED).

What is read or drawn from an assignment's folder is kept for the tests that follow: nothing writes
there meanwhile, and one bundle judges many submissions at a grader's desk as well.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Collection
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from photograd_course.assignment.bundle import Bundle, read_folder
from photograd_course.assignment.checks import load_check_modules
from photograd_course.assignment.load import load_beside, load_figure_script
from photograd_course.assignment.manifest import read_manifest
from photograd_course.build.course_files import build_of
from photograd_course.build.named import NamedMutant, read_alternatives, read_mutants
from photograd_course.build.regions import strip_solution
from photograd_course.build.rules import reading_findings
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.viz.handout import Facts
from photograd_course.viz.style import HANDOUT_DPI

from course.assignments.kept import course_digest, decides_figure, kept, verdict_on
from course.assignments.pictures import difference, pixels
from support.tree import ROOT

ASSIGNMENTS = ROOT / "assignments"
SECRET = b"seeds of the hidden checks, in tests"
PICTURE_BYTES = 500_000
# Mean difference of two drawings of one figure, in gray levels; 0 here, text moves elsewhere.
PICTURE_DIFFERENCE = 3.0


def names(folder: Path, kind: str) -> list[str]:
    """Names of the mutants or alternatives of an assignment."""
    return sorted(mutants_of(folder) if kind == "mutants" else read_alternatives(folder))


@functools.cache
def mutants_of(folder: Path) -> dict[str, NamedMutant]:
    """The named mutants of an assignment, by name."""
    return {each.name: each for each in read_mutants(folder)}


@functools.cache
def bundle_of(folder: Path, secret: bytes = SECRET) -> Bundle:
    """What judges submissions of an assignment."""
    return read_folder(folder, secret=secret)


def source(folder: Path) -> str:
    """The instructor source."""
    module = bundle_of(folder).manifest.module
    return (folder / f"{module}.py").read_text("utf-8")


def apply_mutant(folder: Path, name: str) -> str:
    """The instructor source with a mutant's replacements."""
    return mutants_of(folder)[name].apply(source(folder))


def judge(
    folder: Path,
    source_text: str | None = None,
    *,
    secret: bytes = SECRET,
    tasks: Collection[str] = (),
) -> list[Outcome]:
    """The outcome of every check, or of those of some tasks; by default for the solution.

    Each by itself: what the price of a derivative takes from the others is `points_by_task`'s. With
    another secret than that of the tests of hidden checks alone: no other seeds depend on it.
    """
    return _run(folder, source_text or source(folder), secret, frozenset(tasks))[0]


def points_by_task(folder: Path, source_text: str, tasks: Collection[str]) -> dict[str, float]:
    """What a text earns in some tasks, after the price of derivatives has been asked."""
    earned = dict.fromkeys(tasks, 0.0)
    for outcome in _run(folder, source_text, SECRET, frozenset(tasks))[1]:
        earned[outcome.task] += outcome.points
    return earned


@functools.cache
def _run(
    folder: Path, text: str, secret: bytes, tasks: frozenset[str]
) -> tuple[list[Outcome], list[Outcome]]:
    """Outcomes of checks by themselves, and in the end."""
    bundle = bundle_of(folder, secret)
    seeded = [each for each in bundle.checks if secret == SECRET or each.visibility != "public"]
    checks = [each for each in seeded if not tasks or each.task in tasks]
    return verdict_on(text, folder, bundle, checks)


def lost(outcomes: list[Outcome]) -> set[str]:
    """Ids of the checks not passed; our own faults are ours."""
    ours = [f"{each.id}: {each.text}" for each in outcomes if each.status is Status.ERROR_OURS]
    assert ours == []
    return {each.id for each in outcomes if each.status is not Status.PASSED}


@functools.cache
def load_checks_of(folder: Path) -> ModuleType:
    """Everything that the files of an assignment's checks define, as one module."""
    merged = ModuleType("checks")
    for module in load_check_modules(read_manifest(folder)).values():
        merged.__dict__.update(vars(module))
    return merged


@functools.cache
def load_figures(folder: Path) -> ModuleType:
    return load_figure_script(folder)


@functools.cache
def draw(folder: Path, figure: str, text: str) -> tuple[Any, Facts]:
    """A figure, None of a mutant, and its facts, computed from the text of a module."""
    bundle = bundle_of(folder)
    module = load_beside(bundle.manifest.module, text, bundle.brought)
    right = text == source(folder)
    with np.errstate(all="warn" if right else "ignore"):
        drawn, facts = load_figures(folder).FIGURES[figure](module)
    return drawn if right else None, facts


def figure_facts(folder: Path, figure: str, mutant: str | None = None) -> Facts:
    """The facts behind a caption, computed from the solution or from a mutant."""
    text = source(folder) if mutant is None else apply_mutant(folder, mutant)
    decides = ["facts", *decides_figure(folder, figure, text)]
    return kept(folder, decides, lambda: draw(folder, figure, text)[1])


def picture_difference(folder: Path, figure: str) -> float:
    """By how much a picture differs from the one that its script draws, in gray levels."""

    def find() -> float:
        drawn, _ = draw(folder, figure, source(folder))
        dpi = getattr(load_figures(folder), "DPI", HANDOUT_DPI)
        return difference(folder / "figures" / f"{figure}.png", drawn, dpi)

    return kept(folder, ["picture", *decides_figure(folder, figure, source(folder))], find)


def red(facts: Facts) -> Facts:
    """Those that do not hold."""
    return {claim: fact for claim, fact in facts.items() if not fact.holds}


class AssignmentTests:
    """Inherit, and set `folder`.

    A mutant runs through the checks of its own task alone, in a fifth of the time: those of other
    tasks count with the solution's functions anyway. `photograd course build` runs them all.
    """

    folder: Path
    long_figures: frozenset[str] = frozenset()  # that train for a minute

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        wanted = metafunc.fixturenames
        if "mutant" in wanted:
            metafunc.parametrize("mutant", names(self.folder, "mutants"))
        if "alternative" in wanted:
            metafunc.parametrize("alternative", names(self.folder, "alternatives"))
        if "figure" in wanted:
            marks = dict.fromkeys(self.long_figures, pytest.mark.exhaustive)
            drawn = load_figures(self.folder).FIGURES
            metafunc.parametrize("figure", [pytest.param(k, marks=marks.get(k, ())) for k in drawn])

    @property
    def bundle(self) -> Bundle:
        return bundle_of(self.folder)

    def test_the_rules_that_read_find_nothing(self) -> None:
        def find() -> list[str]:
            return [str(each) for each in reading_findings(build_of(self.folder))]

        assert kept(self.folder, ["rules", course_digest()], find) == []

    def test_points_and_tasks_add_up(self) -> None:
        bundle = self.bundle
        assert sum(check.points for check in bundle.checks) == bundle.manifest.points["code"]
        asked = sum(question.points for question in bundle.questions)
        assert asked == bundle.manifest.points["questions"]
        assert {check.task for check in bundle.checks} == {t.id for t in bundle.manifest.tasks}
        # Methods of one class in one task, a line or two each, count as one function.
        written = [(task.id, name) for task in bundle.manifest.tasks for name in task.functions]
        assert len({(task, name.partition(".")[0]) for task, name in written}) <= 6

    @pytest.mark.parametrize("secret", [SECRET, b"another", b"a third"])
    def test_the_solution_earns_everything(self, secret: bytes) -> None:
        assert_everything(judge(self.folder, secret=secret))

    def test_the_starter_earns_nothing(self) -> None:
        outcomes = judge(self.folder, strip_solution(source(self.folder)))
        assert {each.reason for each in outcomes} == {"not implemented"}
        assert sum(each.points for each in outcomes) == 0.0

    def test_a_mutant_loses_exactly_what_it_says(self, mutant: str) -> None:
        told = mutants_of(self.folder)[mutant]
        outcomes = judge(self.folder, apply_mutant(self.folder, mutant), tasks=told.tasks)
        assert lost(outcomes) == set(told.loses)
        assert told.loses
        assert told.tasks == tuple(sorted({e.task for e in outcomes if e.id in told.loses}))
        # It fails by ten times the tolerance, wherever a tolerance decides.
        errors = [e.details for e in outcomes if e.id in told.loses and "tolerance" in e.details]
        assert [each for each in errors if not each["error"] > 10 * each["tolerance"]] == []

    def test_a_check_kills_a_mutant_alone_or_says_why_it_stays(self) -> None:
        losses = [each.loses for each in mutants_of(self.folder).values()]
        alone = {ids[0] for ids in losses if len(ids) == 1}
        idle = {each.id for each in self.bundle.checks if not each.sole} - alone
        # Automatic mutants may do it too; then `sole` says so.
        assert idle == set()

    def test_a_derivative_that_costs_too_much_earns_nothing(self) -> None:
        prices = {each.id for each in self.bundle.checks if each.is_price}
        for name, told in mutants_of(self.folder).items():
            if set(told.loses) <= prices and "differences" in name:
                text = apply_mutant(self.folder, name)
                assert set(points_by_task(self.folder, text, told.tasks).values()) == {0.0}, name

    @pytest.mark.parametrize("secret", [SECRET, b"another"])
    def test_an_alternative_earns_everything(self, alternative: str, secret: bytes) -> None:
        text = read_alternatives(self.folder)[alternative]
        assert_everything(judge(self.folder, text, secret=secret))

    def test_there_are_enough_mutants_and_alternatives(self) -> None:
        assert len(names(self.folder, "mutants")) >= 10
        assert len(names(self.folder, "alternatives")) >= 3

    def test_a_figure_says_what_its_picture_shows(self, figure: str) -> None:
        assert (facts := figure_facts(self.folder, figure))
        assert red(facts) == {}

    def test_a_figure_turns_red_under_its_mutant(self, figure: str) -> None:
        facts = figure_facts(self.folder, figure)
        named: dict[str, str] = getattr(load_figures(self.folder), "RED", {})
        if figure in named:
            assert red(figure_facts(self.folder, figure, named[figure]))
        else:
            assert [claim for claim, fact in facts.items() if not fact.red + fact.held] == []
            assert any(fact.red for fact in facts.values())
        for claim, fact in facts.items():
            if fact.red:
                assert claim in red(figure_facts(self.folder, figure, fact.red)), (claim, fact.red)

    def test_a_picture_is_the_one_that_its_script_draws(self, figure: str) -> None:
        path = self.folder / "figures" / f"{figure}.png"
        assert path.stat().st_size < PICTURE_BYTES
        assert picture_difference(self.folder, figure) < PICTURE_DIFFERENCE
        stored = pixels(path)
        assert stored.shape[1] >= 600
        assert stored.std() > 5.0

    def test_the_handout_shows_every_figure_and_numbers_its_equations(self) -> None:
        text = (self.folder / "handout.md").read_text("utf-8")
        shown = set(re.findall(r"\(figures/(\w+)\.png\)", text))
        assert shown == set(load_figures(self.folder).FIGURES)
        assert len(shown) >= 4
        for task in self.bundle.manifest.tasks:
            number = task.id.rpartition(".")[2]
            assert re.search(rf"^## {number}[. ]", text, re.MULTILINE), f"no section {number}"
            for function in task.functions:
                assert f"`{function}" in text
        assert re.search(r"\\tag\{1\}", text)

    def test_papers_are_cited_by_a_key_of_the_bibliography(self) -> None:
        text = (self.folder / "handout.md").read_text("utf-8")
        bibliography = (ROOT / "cpp" / "references.bib").read_text("utf-8")
        known = set(re.findall(r"^@\w+\{([^,\s]+),", bibliography, re.MULTILINE))
        keys = set(re.findall(r"\[([A-Z][A-Za-z]*\d{4}[a-z]?)[^\]]*\]", text))
        assert set() < keys <= known


def assert_everything(outcomes: list[Outcome]) -> None:
    """All points; and tolerances stand ten times above the worst correct answer."""
    assert {each.id: each.text for each in outcomes if each.points < each.max} == {}
    margins = {each.id: each.details.get("margin", 0.0) for each in outcomes}
    assert {id: value for id, value in margins.items() if value > 0.1} == {}
