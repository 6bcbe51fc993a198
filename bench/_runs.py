"""Rows that programs reported, and the ratio of two programs' medians."""

from __future__ import annotations

import json
import statistics
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import _agreement

Row = dict[str, Any]
EQUAL_ERROR = {
    "mse x seconds": "seconds_x_mse",
    "gradient error^2 x seconds": "seconds_x_rel_error_sq",
}
"""Seconds times squared error, of estimates; and where a quality row has it."""
BUSY = 0.3  # cores used by others, above which a figure must not be quoted


@dataclass
class Runs:
    """All rows of one program for one workload. `same_run` is False for rows from a file."""

    workload: str
    name: str
    same_run: bool = True
    rows: list[Row] = field(default_factory=list)
    error: str | None = None

    def seconds(self, key: str) -> float | None:
        """Median over the rows of "seconds_fwd", "seconds_fwdbwd", a part, or an equal error."""
        values = [row[key] if key in row else parts(row).get(key) for row in self.rows]
        if key in EQUAL_ERROR:
            values = [row["quality"].get(EQUAL_ERROR[key]) for row in self.rows]
        known = [value for value in values if value is not None]
        return statistics.median(known) if known else None

    def foreign(self) -> float:
        """The most cores that others used during any run that counts."""
        timings = [row.get(f"timings_{kind}") for row in self.rows for kind in ("fwd", "fwdbwd")]
        return max((load for timing in timings if timing for load in loads(timing)), default=0.0)


def loads(timing: Mapping[str, Any]) -> Iterable[float]:
    """The "foreign" figures of a timing and of its parts."""
    yield from timing.get("foreign") or ()
    for part in (timing.get("parts") or {}).values():
        yield from loads(part)


def parts(row: Row) -> dict[str, float]:
    """Seconds of the parts of the forward time that were measured on their own."""
    found = (row.get("timings_fwd") or {}).get("parts") or {}
    return {name: timing["median"] for name, timing in found.items()}


def read_rows(path: Path) -> list[Row]:
    """Rows in a file: JSON lines, or one object with a list "runs"."""
    text = path.read_text(encoding="utf-8")
    try:
        rows: list[Row] = json.loads(text)["runs"]
    except (json.JSONDecodeError, KeyError):
        rows = [json.loads(line) for line in text.splitlines() if line.strip()]
    return rows


def group(rows: Iterable[Row], workload: str, *, same_run: bool) -> list[Runs]:
    """The timed rows of a workload by program, in the order of their first rows."""
    found: dict[str, Runs] = {}
    for row in rows:
        if row.get("workload") == workload and row.get("seconds_fwd"):
            name = row["peer"]
            found.setdefault(name, Runs(workload, name, same_run)).rows.append(row)
    return list(found.values())


def comparison(ours: Runs, theirs: Runs) -> Row:
    """One line: times as long as ours that the other program takes, if both did the same work."""
    found = {d: None for a in ours.rows for b in theirs.rows for d in _agreement.differences(a, b)}
    valid = not found
    row: Row = {
        "compare": ours.workload,
        "peer": theirs.name,
        "same_run": theirs.same_run,
        "valid": valid,
        "why": list(found),
        "threads": [ours.rows[0]["threads"], theirs.rows[0]["threads"]],
        "foreign": [ours.foreign(), theirs.foreign()],
        "times": {},
    }
    for key in ("seconds_fwd", "seconds_fwdbwd", *parts(ours.rows[0]), *EQUAL_ERROR):
        mine, other = ours.seconds(key), theirs.seconds(key)
        if mine and other:
            ratio = other / mine if valid else "INVALID"
            row["times"][key] = {"ours": mine, "theirs": other, "ratio": ratio}
    return row
