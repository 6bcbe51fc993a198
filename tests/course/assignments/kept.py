"""What earlier runs found, kept by content; `./run test --with mutants` begins without any."""

from __future__ import annotations

import functools
import hashlib
import pickle
from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

from photograd_course import viz
from photograd_course.assignment.bundle import Bundle
from photograd_course.atomic_io import atomic_write
from photograd_course.build.course_files import default_cache
from photograd_course.build.judging import what_decides
from photograd_course.grading.check import Check
from photograd_course.grading.local import LocalStudent
from photograd_course.grading.outcome import Outcome, Status
from photograd_course.grading.runner import run_checks

from support.tree import ROOT

T = TypeVar("T")
Verdict = tuple[list[Outcome], list[Outcome]]


def kept(
    folder: Path,
    decides: Iterable[str],
    find: Callable[[], T],
    worth: Callable[[T], bool] = lambda _: True,
) -> T:
    """What ``find`` returns, from an earlier run where all that decides it was the same.

    Args:
        folder: an assignment, whose checks, reference and package always decide.
        decides: what else does.
        find: asked where nothing is known.
        worth: whether it may be kept.
    """
    name = hashlib.sha256("|".join([what_decides(folder), *decides]).encode()).hexdigest()
    place = default_cache(folder.parent) / "tests" / name
    if place.exists():
        known: T = pickle.loads(place.read_bytes())
        return known
    found = find()
    if worth(found):
        place.parent.mkdir(parents=True, exist_ok=True)
        atomic_write(place, pickle.dumps(found))
    return found


def verdict_on(text: str, folder: Path, bundle: Bundle, checks: Sequence[Check]) -> Verdict:
    """Outcomes of checks of an assignment by themselves, and in the end."""
    hints = folder / "hints.json"
    decides = [hints.read_text("utf-8") if hints.exists() else "", text]
    decides += [bundle.secret.hex(), *(check.id for check in checks)]
    return kept(folder, decides, lambda: _run(text, bundle, checks), _not_ours)


def decides_figure(folder: Path, figure: str, text: str) -> list[str]:
    """What decides a figure that is computed from a text, its facts and its picture."""
    beside = [*folder.glob("figure*.py"), folder / "figures" / f"{figure}.png"]
    data, drawing = (folder / "data").glob("*.*"), Path(viz.__file__).parent.glob("*.py")
    files = [hashlib.sha256(path.read_bytes()).hexdigest() for path in (*beside, *data, *drawing)]
    return [figure, text, version("matplotlib"), *sorted(files)]


@functools.cache
def course_digest() -> str:
    """What the rules that read may look at: all assignments, and the package that students get."""
    digest = hashlib.sha256()
    for place in (ROOT / "assignments", ROOT / "python" / "photograd_course" / "src"):
        for path in sorted(each for each in place.rglob("*") if each.is_file()):
            if "__pycache__" not in path.parts:
                digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def _not_ours(verdict: Verdict) -> bool:
    """Whether no check of either part failed by a fault of the grader."""
    return all(each.status is not Status.ERROR_OURS for part in verdict for each in part)


def _run(text: str, bundle: Bundle, checks: Sequence[Check]) -> Verdict:
    sources = bundle.hand(bundle.solution_files(text)).sources
    alone: list[Outcome] = []
    end = run_checks(
        checks, bundle.setting, lambda given: LocalStudent(sources, given), on_outcome=alone.append
    )
    return alone, end
