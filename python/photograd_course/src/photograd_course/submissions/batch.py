"""Judge many submissions at once, survive being killed, and compare with the time before."""

from __future__ import annotations

import contextlib
import queue
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass

from ..assignment.bundle import Bundle
from ..printable import csv_cell
from .exports import Ignored
from .grades_csv import Change, changes, changes_table, grades_table, ignored_table
from .load import Loaded
from .one import Case, grade_guarded, grade_one
from .report import Report
from .run_folder import RunFolder
from .similarity import similar_pairs
from .source import Source
from .submission import Submission
from .workers import Workers

OnReport = Callable[[int, Report], None]


@dataclass(frozen=True)
class Batch:
    """What a batch needs.

    Attributes:
        sources: the submissions.
        loaded: the bundle.
        workers: where to run them; None where no isolation mode is good enough.
        unavailable: why not; for staff.
        jobs: how many at the same time.
        ignored: what lies beside the submissions and is none.
    """

    sources: Sequence[Source]
    loaded: Loaded
    workers: Workers | None
    unavailable: str = ""
    jobs: int = 1
    ignored: Sequence[Ignored] = ()


def run_batch(
    batch: Batch, folder: RunFolder, *, resume: bool = False, on_report: OnReport | None = None
) -> tuple[list[Report], list[Change] | None]:
    """Grade all submissions and write the tables.

    Args:
        batch: what is to be done.
        folder: for records, pages and tables.
        resume: keep the records of a run that was cut off, if submission and bundle are the same.
        on_report: called in this thread after each submission with how many are done.

    Returns:
        Reports in the order of the sources, and the differences from an earlier run, if any.
    """
    bundle = batch.loaded.read()
    mode = batch.workers.mode if batch.workers is not None else "none"
    facts = {"assignment": bundle.manifest.id, "bundle": batch.loaded.digest, "mode": mode}
    folder.begin(facts, resume=resume)
    reports = _grade_all(batch, folder, on_report)
    earlier = folder.earlier()
    differences = changes(reports, earlier) if earlier else None
    if differences is not None:
        folder.write("changes.csv", changes_table(differences))
    folder.write("similarity.csv", _similarity(batch, bundle))
    folder.write("ignored.csv", ignored_table(batch.ignored))
    folder.write("grades.csv", grades_table(reports, earlier, batch.sources))
    folder.mark(facts, "done")
    return reports, differences


def _grade_all(batch: Batch, folder: RunFolder, on_report: OnReport | None) -> list[Report]:
    slots: queue.SimpleQueue[tuple[int, Bundle]] = queue.SimpleQueue()
    for slot in range(batch.jobs):
        slots.put((slot, batch.loaded.read()))
    stop = threading.Event()

    def grade(source: Source) -> Report | None:
        if stop.is_set():
            return None
        slot, bundle = slots.get()
        try:
            return _grade(batch, folder, source, slot, bundle)
        finally:
            slots.put((slot, bundle))

    found: dict[Future[Report | None], int] = {}
    reports: dict[int, Report] = {}
    with ThreadPoolExecutor(batch.jobs) as pool:
        found = {pool.submit(grade, source): k for k, source in enumerate(batch.sources)}
        waiting = set(found)
        try:
            while waiting:
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    if (report := future.result()) is not None:
                        reports[found[future]] = report
                        if on_report is not None:
                            on_report(len(reports), report)
        finally:
            stop.set()  # what has not begun never will, if we leave early
    return [reports[k] for k in range(len(batch.sources))]


def _grade(batch: Batch, folder: RunFolder, source: Source, slot: int, bundle: Bundle) -> Report:
    """The report on one submission, kept on disk."""
    case = Case(source.student, Submission({}), bundle, batch.loaded.digest)
    report = grade_guarded(
        case, batch.workers, lambda: _judged(batch, folder, source, slot, bundle)
    )
    if not report.is_sound:
        folder.keep(report)  # once more, where it is the guard's
    return report


def _judged(batch: Batch, folder: RunFolder, source: Source, slot: int, bundle: Bundle) -> Report:
    submission = source.take(bundle.manifest)
    kept = folder.kept(source.student)
    if (
        kept is not None
        and kept.is_sound  # our own failures are worth another try
        and (kept.submission, kept.bundle) == (submission.digest, batch.loaded.digest)
        and kept.problem == submission.problem
    ):
        return kept
    case = Case(source.student, submission, bundle, batch.loaded.digest)
    report = grade_one(case, batch.workers, slot=slot, unavailable=batch.unavailable)
    folder.keep(report)
    return report


def _similarity(batch: Batch, bundle: Bundle) -> bytes:
    module = f"{bundle.manifest.module}.py"
    texts: dict[str, str] = {}
    for source in batch.sources:
        with contextlib.suppress(Exception):  # its report says what is wrong with it
            texts[source.student] = source.take(bundle.manifest).files[module].decode("utf-8")
    rows = ["student,student,share"]
    rows += [
        ",".join((_quoted(one), _quoted(two), f"{share:.2f}"))
        for one, two, share in similar_pairs(texts, batch.loaded.starter)
    ]
    return ("\n".join(rows) + "\n").encode("utf-8", errors="replace")


def _quoted(text: str) -> str:
    return '"' + csv_cell(text).replace('"', '""') + '"'
