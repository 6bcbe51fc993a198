"""All that the rules look at, of one assignment: its texts, and what became of each variant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from ..assignment.checks import load_checks
from ..assignment.manifest import Manifest, read_manifest
from ..assignment.questions import Question, read_questions
from ..grading.check import Check
from .automatic import AutoMutant, automatic_mutants
from .equivalents import Equivalent, read_equivalents
from .judging import RULES_SECRET, Job, Judge, Verdict
from .named import NamedMutant, read_alternatives, read_mutants
from .public import wheel_kits
from .reach import changed_functions, function_names
from .regions import SolutionPart, solution_parts, strip_solution

Bar = Callable[[str, int], AbstractContextManager[Callable[[int], None]]]

# Of processor time, at least: for one check of an automatic mutant, and of what may be slower.
LEAST_SECONDS, LEAST_PATIENT = 3.0, 8.0
PATIENCE = 10.0  # times the solution's own seconds


@contextmanager
def no_bar(title: str, total: int) -> Iterator[Callable[[int], None]]:
    """Shows nothing."""
    del title, total
    yield _ignore


def _ignore(done: int) -> None:
    del done


@dataclass
class AssignmentBuild:
    """One assignment, with everything worked out when first asked for, and kept.

    Attributes:
        folder: its source.
        secret: seeds of the hidden checks.
        cache: where verdicts are kept, or None.
        bar: shows how far a long computation has come.
        haystacks: name to text of what students can see besides this kit: the wheels.
        siblings: ids of the assignments beside it.
        public_from: a build of this folder with another secret; its verdicts on public checks count
            here too, since no secret decides their seeds. Or None.
    """

    folder: Path
    secret: bytes = RULES_SECRET
    cache: Path | None = None
    bar: Bar = no_bar
    haystacks: Mapping[str, str] = field(default_factory=dict)
    siblings: frozenset[str] = frozenset()
    public_from: AssignmentBuild | None = None

    @cached_property
    def manifest(self) -> Manifest:
        """The parsed `assignment.toml`."""
        return read_manifest(self.folder)

    @property
    def module_file(self) -> str:
        """Name of the graded module's file."""
        return f"{self.manifest.module}.py"

    @cached_property
    def source(self) -> str:
        """The instructor source."""
        return (self.folder / self.module_file).read_text(encoding="utf-8")

    @cached_property
    def starter(self) -> str:
        """What students get of it."""
        return strip_solution(self.source, self.module_file)

    @cached_property
    def parts(self) -> tuple[SolutionPart, ...]:
        """The solution regions."""
        return solution_parts(self.source, self.module_file)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """All checks, hidden ones too."""
        return tuple(load_checks(self.manifest))

    @cached_property
    def questions(self) -> tuple[Question, ...]:
        """All questions, with keys."""
        return read_questions(self.folder)

    @cached_property
    def mutants(self) -> tuple[NamedMutant, ...]:
        """The named mutants."""
        return read_mutants(self.folder)

    @cached_property
    def alternatives(self) -> dict[str, str]:
        """Name to text of other right solutions."""
        return read_alternatives(self.folder)

    @cached_property
    def automatic(self) -> list[AutoMutant]:
        """The automatic mutants."""
        return automatic_mutants(self.source, self.module_file)

    @cached_property
    def equivalents(self) -> tuple[Equivalent, ...]:
        """Automatic mutants that are known to be no mistakes."""
        return read_equivalents(self.folder)

    @cached_property
    def visible(self) -> dict[str, bytes]:
        """What students get of this assignment, by path."""
        return wheel_kits(self.folder)

    @cached_property
    def judge(self) -> Judge:
        """Runs texts, as long as `PATIENCE` allows."""
        first = Judge(self.folder, self.secret, self.cache, seconds=600.0)
        solution = first.judge(Job(self.source))
        spent = {each["id"]: PATIENCE * float(each["cpu"]) for each in solution.outcomes}
        seconds = max(LEAST_PATIENT, sum(spent.values()))
        seconds_of = {name: max(LEAST_SECONDS, each) for name, each in spent.items()}
        return Judge(self.folder, self.secret, self.cache, seconds, seconds_of, first.ran)

    @cached_property
    def entered(self) -> dict[str, frozenset[str]]:
        """The solution's functions that each check enters, by the check's id."""
        verdict = self.judge.judge(Job(self.source, trace=True, patient=True))
        return {each["id"]: frozenset(each["entered"]) for each in verdict.outcomes}

    def unreached(self, text: str) -> tuple[str, ...]:
        """Checks that enter no function in which a text differs from the solution.

        What such a check runs is the solution, so that it passes.
        """
        changed = changed_functions(self.source, text)
        return () if changed is None else self._not_entering(changed)

    def unreached_by(self, mutant: AutoMutant) -> tuple[str, ...]:
        """The same for an automatic mutant, whose function is known."""
        names = mutant.function.split(".")
        around = {".".join(names[:count]) for count in range(1, len(names) + 1)}
        changed = self._functions & around  # of a function in a function, the outer one
        return self._not_entering(changed) if changed else ()

    @cached_property
    def _functions(self) -> frozenset[str]:
        return function_names(self.source)

    def _not_entering(self, changed: Set[str]) -> tuple[str, ...]:
        return tuple(check for check, entered in self.entered.items() if not entered & changed)

    @cached_property
    def solution_verdict(self) -> Verdict:
        """What becomes of the solution."""
        return self.judge.judge(Job(self.source))

    @cached_property
    def starter_verdict(self) -> Verdict:
        """What becomes of the starter."""
        return self.judge.judge(Job(self.starter))

    @cached_property
    def mutant_verdicts(self) -> dict[str, Verdict]:
        """What becomes of each named mutant that can be applied."""
        texts = {m.name: m.apply(self.source) for m in self.mutants}
        known = self.public_from.mutant_verdicts if self.public_from else {}
        return self._judge_all("mutants", texts, known)

    @cached_property
    def alternative_verdicts(self) -> dict[str, Verdict]:
        """What becomes of each alternative."""
        known = self.public_from.alternative_verdicts if self.public_from else {}
        return self._judge_all("alternatives", self.alternatives, known)

    @cached_property
    def automatic_verdicts(self) -> list[Verdict]:
        """What becomes of each automatic mutant, up to the first check that notices it."""
        jobs = [
            Job(each.text, first=True, task=each.task, passed=self.unreached_by(each))
            for each in self.automatic
        ]
        return self.judge_jobs("automatic mutants", jobs)

    def judge_jobs(self, title: str, jobs: Sequence[Job]) -> list[Verdict]:
        """Verdicts on jobs, with a bar."""
        if not jobs:
            return []
        with self.bar(f"{self.manifest.id} {title}", len(jobs)) as done:
            return self.judge.judge_all(jobs, done)

    def _judge_all(
        self, title: str, texts: Mapping[str, str], known: Mapping[str, Verdict]
    ) -> dict[str, Verdict]:
        """The verdicts; outcomes of public checks from ``known``, where it is not empty."""
        public = {check.id for check in self.checks if check.visibility == "public"}
        before = {name: known.get(name, Verdict(())).of(public) for name in texts}
        jobs = [
            Job(
                text,
                passed=(*before[name].passed, *self.unreached(text)),
                failed=before[name].lost,
                patient=True,
            )
            for name, text in texts.items()
        ]
        verdicts = dict(zip(texts, self.judge_jobs(title, jobs), strict=True))
        return {name: before[name].followed_by(verdict) for name, verdict in verdicts.items()}
