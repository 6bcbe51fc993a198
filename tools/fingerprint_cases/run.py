"""Many cases at once: hashes of all, and arrays kept in files."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from fnmatch import fnmatchcase
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from photograd import bsdf
from photograd._compiled import _core
from photograd_course.cli.progress import Progress

from fingerprint_cases.case import Array, Arrays, Case, computed, fingerprint
from fingerprint_cases.catalog import all_cases

BEFORE, AFTER = 1000, 2000
"""First of the seeds whose estimates are kept, and of those that are compared with them."""
BATCH = 16  # neighbors share the scene


def prime() -> bool:
    """Run a parallel loop before any scene is built, and say whether it keeps tiny numbers.

    The loops of a process keep the floating-point mode that its first one began with. If Embree
    comes first, that mode takes numbers below 2e-308 for 0.
    """
    row, up = np.full((1, 3), 1e-308), np.tile([0.0, 0.0, 1.0], (64, 1))
    return bool(bsdf.registry()["lambert"].core.f(row, up, up).all())


def compute_all(
    cases: Mapping[str, Case],
    *,
    jobs: int = 1,
    threads: int = 0,
    save: Path | None = None,
    title: str = "results",
) -> dict[str, str]:
    """{name: hash, or `FAILED` and a message} of all cases, in their order.

    Args:
        cases: what to compute.
        jobs: processes; 1 stays in this one.
        threads: of the core in each; 0 takes all.
        save: folder that keeps the arrays, or None.
        title: of the progress bar.
    """
    if save is not None:
        save.mkdir(parents=True, exist_ok=True)
    if not prime():
        print("note: this process takes numbers below 2e-308 for 0", file=sys.stderr)
    work = partial(_hash_one, save=save)
    return dict(_mapped(work, cases, jobs, threads, title))


def save_seeds(
    cases: Mapping[str, Case], folder: Path, *, seeds: int, jobs: int = 1, threads: int = 0
) -> None:
    """Keep beside the saved arrays what `seeds` other seeds estimate."""
    random = {name: case for name, case in cases.items() if case.estimates}
    if random and seeds > 1:
        work = partial(_save_one, folder=folder, seeds=seeds)
        dict(_mapped(work, random, jobs, threads, "seeds"))


def file_of(folder: Path, case: Case) -> Path:
    """The .npz file that keeps the arrays of a case."""
    return folder / f"{case.name.replace('/', '__')}.npz"


def seeds_file_of(folder: Path, case: Case) -> Path:
    """The .npz file that keeps what other seeds estimate."""
    return file_of(folder, case).with_suffix(".seeds.npz")


def estimates(case: Case, first: int, count: int) -> Arrays:
    """{name: (count, ...)} of the arrays that estimate a mean, of `count` seeds."""
    runs = [case.run(first + k) for k in range(count)]
    names = [n for n in runs[0] if any(fnmatchcase(n, pattern) for pattern in case.estimates)]
    return {name: np.stack([run[name] for run in runs]) for name in names}


def load(path: Path) -> list[tuple[str, Array]]:
    """All (name, array) of a file that `_keep` wrote, in their order."""
    with np.load(path) as kept:
        return [(name[4:], kept[name]) for name in kept.files]


def _keep(path: Path, arrays: Arrays) -> None:
    numbered: dict[str, Any] = {f"{k:03d} {name}": arrays[name] for k, name in enumerate(arrays)}
    np.savez_compressed(path, **numbered)


Work = Callable[[Case], str]
FAILED = "failed: "


def _hash_one(case: Case, save: Path | None) -> str:
    try:
        arrays = computed(case)
    except Exception as failure:  # the other results still count
        return f"{FAILED}{type(failure).__name__}: {failure}"
    if save is not None:
        _keep(file_of(save, case), arrays)
    return fingerprint(arrays)


def _save_one(case: Case, folder: Path, seeds: int) -> str:
    _keep(seeds_file_of(folder, case), estimates(case, BEFORE, seeds))
    return ""


def _mapped(
    work: Work, cases: Mapping[str, Case], jobs: int, threads: int, title: str
) -> Iterator[tuple[str, str]]:
    """(name, result) of each case; the core's number of threads is put back at the end."""
    with Progress(title, len(cases)) as bar:
        results: Iterable[tuple[str, str]]
        if jobs == 1:
            before = _core.thread_count()
            _core.set_thread_count(threads)
            try:
                for step, (name, case) in enumerate(cases.items(), 1):
                    yield name, work(case)
                    bar.update(step)
            finally:
                _core.set_thread_count(0 if threads == 0 else before)
            return
        pool = ProcessPoolExecutor(jobs, get_context("spawn"), _begin, (threads or 1,))
        with pool:
            results = pool.map(partial(_by_name, work), cases, chunksize=BATCH)
            for step, result in enumerate(results, 1):
                yield result
                bar.update(step)


def _begin(threads: int) -> None:
    _core.set_thread_count(threads)
    prime()


def _by_name(work: Work, name: str) -> tuple[str, str]:
    return name, work(_case(name))


_known: dict[str, Case] = {}


def _case(name: str) -> Case:
    if not _known:
        _known.update(all_cases())
    return _known[name]
