"""Derivatives of traced pictures against finite differences: `python docs/results_differences.py`.

Every continuous parameter of every reflectance model, light and medium, by the adjoint and by
finite differences of pictures; what is compared, and how, is in
tests/transport/difference_rows.py and differences.py. Each row is kept in docs/differences.json, so
a run that was stopped goes on; then the tables of docs/results_differences.md are written. `--only
THING` measures the rows of a model, light or medium anew, `--pages` writes the tables alone.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import re
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
from photograd._compiled import _core  # noqa: E402
from tests.transport import difference_page as page  # noqa: E402
from tests.transport import differences  # noqa: E402
from tests.transport.difference_rows import cases  # noqa: E402
from tests.transport.differences import Bench, Estimate  # noqa: E402

KNOWN = ROOT / "docs" / "differences.json"
PAGE = ROOT / "docs" / "results_differences.md"
WAYS = differences.WAYS[:3]
PASSES = (float("inf"), 0.05, 0.002)
"""Relative errors of the estimates; in each pass, what takes fewest paths comes first."""
ROUGHLY = 0.05  # is enough for what is known to differ
CASES = cases()
PLACES = {row.name: (case, row) for case in CASES for row in case.rows}
Rows = dict[str, dict[str, Any]]


def rounded(estimate: Estimate) -> list[float]:
    """As it is kept: mean, error, batches."""
    return [float(f"{estimate.mean:.8g}"), float(f"{estimate.error:.4g}"), estimate.batches]


def measure(task: tuple[str, dict[str, Any], float, int]) -> tuple[str, dict[str, Any], float]:
    """A row, its figures so far taken on until both errors are at most `enough`; and seconds."""
    name, known, enough, most = task
    began = time.process_time()
    _core.set_thread_count(1)  # pictures of sixteen pixels
    bench = Bench(*PLACES[name])
    so_far = {way: Estimate(*known.get(way, (0.0, 0.0, 0))) for way in WAYS}
    adjoint = bench.adjoint(so_far["adjoint"], enough, most)
    other = bench.differences(so_far["differences"], enough, most)
    cut = bench.cut(so_far["cut"], 0.4 * enough, most, abs(other.mean))
    found = dict(zip(WAYS, map(rounded, (adjoint, other, cut)), strict=True))
    return name, {**found, "step": bench.row.step}, time.process_time() - began


def paths_left(row: dict[str, Any], enough: float, most: int) -> float:
    """How many batches are wanted still, about; 0 for a row that has enough."""
    size = abs(row["differences"][0])
    limits = {
        "adjoint": enough * abs(row["adjoint"][0]),
        "differences": enough * size,
        "cut": 0.4 * enough * size,
    }
    left = {
        way: min(most, row[way][2] * (row[way][1] / limit) ** 2) - row[way][2]
        for way, limit in limits.items()
        if row[way][1] > 0  # a derivative that is always 0 is known
    }
    return sum(max(0.0, more) for more in left.values())


def save(rows: Rows) -> None:
    """Write all rows, in the order of the cases, at once or not at all."""
    lines = [f"  {json.dumps(name)}: {json.dumps(rows[name])}" for name in PLACES if name in rows]
    scratch = KNOWN.with_suffix(".part")
    scratch.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    scratch.replace(KNOWN)


def write_page(rows: Rows) -> None:
    """Put the tables between their markers."""
    text = PAGE.read_text(encoding="utf-8")
    pattern = re.compile(re.escape(page.BEGIN) + ".*?" + re.escape(page.END), re.DOTALL)
    if len(pattern.findall(text)) != 1:
        raise SystemExit(f"{PAGE.name} needs one line {page.BEGIN} and one {page.END}")
    whole = "\n".join([page.BEGIN, *page.tables(rows), page.END])
    PAGE.write_text(pattern.sub(lambda _: whole, text), encoding="utf-8")


def main() -> None:
    """Measure what is missing and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", action="append", metavar="THING")
    parser.add_argument("--pages", action="store_true", help="write the tables, measure nothing")
    parser.add_argument("--most", type=int, default=4096, help="batches of an estimate")
    parser.add_argument("--jobs", type=int, default=1, help="rows measured at a time")
    given = parser.parse_args()
    found: Rows = json.loads(KNOWN.read_text("utf-8")) if KNOWN.exists() else {}
    rows = {  # another step is another row
        name: row
        for name, row in found.items()
        if name in PLACES and row["step"] == PLACES[name][1].step
    }
    wanted = [case for case in CASES if not given.only or case.thing in given.only]
    if not wanted:
        parser.error(f"--only: expected one of {sorted({case.thing for case in CASES})}")
    if given.only:
        gone = {row.name for case in wanted for row in case.rows}
        rows = {name: row for name, row in rows.items() if name not in gone}
    names = [] if given.pages else [row.name for case in wanted for row in case.rows]
    with multiprocessing.get_context("fork").Pool(given.jobs) as pool:
        for enough in PASSES:
            goals = {name: max(enough, ROUGHLY * PLACES[name][0].refused) for name in names}
            left = {
                name: paths_left(rows[name], goal, given.most) if name in rows else 1.0
                for name, goal in goals.items()
            }
            tasks = [
                (name, rows.get(name, {}), goals[name], given.most)
                for name in sorted(left, key=lambda name: left[name])
                if left[name] > 0
            ]
            for name, row, seconds in pool.imap_unordered(measure, tasks):
                rows[name] = row
                save(rows)
                print(page.line(name, row), f"{seconds:.1f} s", flush=True)  # noqa: T201
    write_page(rows)


if __name__ == "__main__":
    main()
