"""`photograd course grade`, from its options to its output."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.console import Console

from ..assignment.manifest import Manifest
from ..cli.output import note, print_json
from ..cli.progress import Progress
from ..grading.failures import GraderFault
from ..printable import printable
from .batch import Batch, run_batch
from .batch_text import print_summary, say_gradebook, say_ignored
from .exports import Export, read_export
from .gradebook import Filled, Gradebook, Score, read_gradebook
from .grades_csv import Change, counted, csv_table
from .load import Loaded, load
from .one import Case, grade_one
from .report import Report
from .report_json import canonical
from .report_text import print_report
from .run_folder import RunFolder
from .source import Person, Source
from .workers import Workers, isolated_workers


@dataclass(frozen=True)
class Request:
    """The command's options; see `photograd course grade --help`."""

    assignment: str
    submission: Path
    bundle: Path | None = None
    secret_file: Path | None = None
    jobs: int = 1
    resume: bool = False
    out: Path | None = None
    mode: str | None = None
    as_json: bool = False
    closed: bool = False
    gradebook: Path | None = None
    gradebook_column: str | None = None


def grade_command(request: Request) -> bool:
    """Grade what was asked for; whether nothing went wrong on our side.

    Raises:
        IoError, SceneError, RangeError: submissions, bundle or folder cannot be used.
    """
    loaded = load(request.assignment, request.bundle, request.secret_file)
    if request.closed:
        loaded = closed_for_good(loaded)
    bundle = loaded.read()
    export = read_export(bundle.manifest, request.submission)
    book = None
    if request.gradebook is not None:
        book = read_gradebook(request.gradebook, bundle.manifest, request.gradebook_column)
        export = with_late_marks(export, book)
    sources = export.sources
    places = (loaded.place, request.secret_file, request.submission, request.out)
    secrets = tuple(path.resolve() for path in places if path is not None and path.exists())
    console = Console(stderr=request.as_json, highlight=False)
    say_ignored(export.ignored)
    with _workers(bundle.manifest, request, secrets) as (workers, unavailable):
        if request.out is None and book is None and not export.is_batch:
            source = sources[0]
            submission = source.take(bundle.manifest)
            case = Case(source.student, submission, bundle, loaded.digest)
            report = grade_one(case, workers, unavailable=unavailable)
            print_report(report, console)
            _say_json(request, report.to_json())
            return report.is_sound
        out = request.out or Path(f"grades_{bundle.manifest.id}")
        folder = RunFolder(out, loaded.secret)
        if unavailable:
            said = f"nothing can be graded on this machine: {unavailable}"
            note(printable(said, 2000), style="magenta")
        jobs = min(request.jobs, len(sources))
        batch = Batch(sources, loaded, workers, unavailable, jobs, export.ignored)
        with Progress("grade", len(sources)) as bar:
            reports, changed = run_batch(
                batch,
                folder,
                resume=request.resume,
                on_report=lambda done, _report: bar.update(done),
            )
    print_summary(reports, changed, folder, console, unavailable)
    result = _batch_json(reports, changed, folder, export)
    if book is not None:
        filled = fill_gradebook(book, reports, export.sources, folder)
        say_gradebook(book, filled, reports[0].max_score, folder, console)
        unmatched = [{"student": who, "reason": why} for who, why in filled.unmatched]
        result["gradebook"] = {"rows": filled.count, "unmatched": unmatched}
    _say_json(request, result)
    return all(report.is_sound for report in reports)


def closed_for_good(loaded: Loaded) -> Loaded:
    """The same bundle after the due date: its reports answer every question."""
    digest = hashlib.sha256(f"{loaded.digest} closed".encode()).hexdigest()
    return replace(loaded, read=lambda: replace(loaded.read(), closed=True), digest=digest)


@contextlib.contextmanager
def _workers(
    manifest: Manifest, request: Request, secrets: Sequence[Path]
) -> Iterator[tuple[Workers | None, str]]:
    """Workers, or None and what staff should know."""
    with contextlib.ExitStack() as stack:
        try:
            workers = stack.enter_context(isolated_workers(manifest, request.mode, secrets))
        except GraderFault as fault:
            yield None, fault.text
        else:
            yield workers, ""


def with_late_marks(export: Export, book: Gradebook) -> Export:
    """The `export` with the late marks of a `book` as well."""
    late = book.late(person for source in export.sources for person in source.people)
    sources = (
        replace(source, is_late=source.is_late or any(each in late for each in source.people))
        for source in export.sources
    )
    return replace(export, sources=tuple(sources))


def fill_gradebook(
    book: Gradebook, reports: Sequence[Report], sources: Sequence[Source], folder: RunFolder
) -> Filled:
    """Write the gradebook with the scores that count, and whose found no place in it.

    Args:
        book: the gradebook that was exported.
        reports: of all submissions.
        sources: the submissions, which know whose they are.
        folder: for gradebook.csv and unmatched.csv.
    """
    earlier = folder.earlier()
    people = {source.student: source.people or (Person(source.name),) for source in sources}
    filled = book.fill(
        Score(each.student, people[each.student], counted(each, earlier.get(each.student))[0])
        for each in reports
    )
    folder.write("gradebook.csv", filled.data)
    folder.write("unmatched.csv", csv_table([["student", "reason"], *filled.unmatched]))
    return filled


def _batch_json(
    reports: Sequence[Report], changed: Sequence[Change] | None, folder: RunFolder, export: Export
) -> dict[str, Any]:
    earlier = folder.earlier()
    known = {source.student: source for source in export.sources}
    grades = []
    for report in reports:
        score, status = counted(report, earlier.get(report.student))
        grades.append(
            {
                "student": report.student,
                "id": known[report.student].id,
                "late": known[report.student].is_late,
                "score": score,
                "max_score": report.max_score,
                "status": status,
            }
        )
    differing = None if changed is None else [change.student for change in changed]
    return {
        "out": str(folder.path),
        "submissions": len(reports),
        "needs_staff": [report.student for report in reports if not report.is_sound],
        "changed": differing,
        "grades": grades,
        "ignored": [{"entry": each.name, "reason": each.reason} for each in export.ignored],
    }


def _say_json(request: Request, result: dict[str, Any]) -> None:
    if request.as_json:
        print_json(canonical(result).decode())
