"""The tables of docs/results_differences.md."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tests.transport.difference_refusals import refused
from tests.transport.difference_rows import cases
from tests.transport.differences import SPP, TOLERANCE

BEGIN, END = "<!-- differences -->", "<!-- end of differences -->"
CLEAR = 0.003  # relative standard error of the two estimates together
CHANCE = 5.0  # standard errors, known from 8 batches at least: one row in 700 by chance
TITLES = {
    "model": "Reflectance",
    "alpha": "Coverage (`alpha`), of every model",
    "light": "Lights",
    "medium": "Media",
    "texture": "Textures",
}
Row = dict[str, Any]


def difference(row: Row) -> float:
    """D(h) and its cut."""
    return float(row["differences"][0] + row["cut"][0])


def gap(row: Row) -> float:
    """Adjoint minus differences, as a part of the latter."""
    return (float(row["adjoint"][0]) - difference(row)) / abs(difference(row))


def error(row: Row) -> float:
    """Standard error of `gap`."""
    parts = [row[name][1] for name in ("adjoint", "differences", "cut")]
    return float(np.sqrt(np.square(parts).sum())) / abs(difference(row))


def holds(row: Row) -> bool:
    """Whether a row says that both agree, and would have said it if they did not."""
    return abs(gap(row)) <= TOLERANCE and error(row) <= CLEAR


def fails(row: Row) -> bool:
    """Whether the two differ by more than is allowed, and by more than chance explains."""
    return abs(gap(row)) > TOLERANCE and abs(gap(row)) > CHANCE * error(row)


def verdict(row: Row) -> str:
    """In a word; open: both agree as far as chance lets us see, more paths would tell."""
    return "holds" if holds(row) else "FAILS" if fails(row) else "open"


def line(name: str, row: Row) -> str:
    """A row of a table."""
    thing, _, parameter = name.partition(".")
    paths = (row["adjoint"][2] + 2 * row["differences"][2]) * SPP * 16 / 1e6
    return (
        f"| {thing} | {parameter} | {row['adjoint'][0]:.5g} | {difference(row):.5g} "
        f"| {100 * gap(row):+.2f} | {100 * error(row):.2f} "
        f"| {100 * row['cut'][0] / abs(difference(row)):+.1f} | {paths:.1f} | {verdict(row)} |"
    )


def table(names: Iterable[str], rows: dict[str, Row]) -> list[str]:
    """Header and rows."""
    head = "| of | with respect to | adjoint | differences | apart, % | error, % | cut, % "
    head += "| paths, 1e6 | says |"
    return [head, "|---" * 9 + "|", *(line(name, rows[name]) for name in names)]


def tables(rows: dict[str, Row]) -> list[str]:
    """Everything between the markers."""
    known = [(case, row.name) for case in cases() for row in case.rows if row.name in rows]
    incomplete = [case for case in cases() if case.refused]
    refused_rows = [name for case, name in known if case.refused]
    good = [name for _, name in known if holds(rows[name])]
    wrong = [name for _, name in known if fails(rows[name])]
    left = len(known) - len(good) - len(wrong)
    lines = [
        f"{len(known)} rows: {len(good)} hold, {len(wrong)} fail, {left} are open.",
        f"{len({*wrong} & {*refused_rows})} of those that fail are known to be incomplete, and are"
        " refused: the last section.",
    ]
    if good:
        name = max(good, key=lambda name: abs(gap(rows[name])))
        lines += [f"Farthest apart of those that hold is `{name}`, {100 * gap(rows[name]):+.2f} %."]
    for kind, title in TITLES.items():
        names = [name for case, name in known if case.kind == kind]
        lines += ["", f"## {title}", "", *table(names, rows)]
    lines += [
        "",
        "## Refused",
        "",
        "Paths are held fixed: neither do refracted rays of smooth glass turn, nor do edges of",
        "masks, shadows and silhouettes move. What that leaves of a derivative is incomplete, as",
        "these rows show, where it is handed out on request (`PathTracer(allow_incomplete=True)`):",
        "",
        *table(refused_rows, rows),
        "",
        "All else refuses, whatever the scene, and says why:",
        "",
        "| of | with respect to | what is said |",
        "|---|---|---|",
        *(f"| {thing} | {name} | {said} |" for thing, name, said in refused(incomplete)),
    ]
    return lines
