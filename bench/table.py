"""Turns the JSON lines of a measurement into a page of Markdown.

    python bench/table.py run.jsonl [more.jsonl ...] [--out docs/results_bench.md]

All files together count as one run: give only what was measured in one go. A row of ours may hold a
breakdown (w4_volume.py --breakdown).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from _runs import BUSY, Row, Runs, comparison, group, read_rows

HEAD = "# Measured\n\nHow this was taken, and what it means, is said in `docs/bench.md`."
UNITS = {
    "load_L2": "loads from L2",
    "load_L3": "loads from L3",
    "rmw_L2": "additions in L2",
    "rmw_L3": "additions in L3",
}


def markdown_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"


def program_row(runs: Runs, line: Row | None) -> list[str]:
    """One program: its seconds, and how many times ours they are."""
    cells = [f"{runs.name} {runs.rows[0].get('version', '')}".strip(), str(runs.rows[0]["threads"])]
    for key in ("seconds_fwd", "seconds_fwdbwd"):
        ratio = line["times"].get(key, {}).get("ratio", "-") if line else ""
        cells += [number(runs.seconds(key)), ratio if isinstance(ratio, str) else f"{ratio:.2f}"]
    load = runs.foreign()
    return [*cells, f"{load:.2f}" + (" (too much)" if load > BUSY else "")]


def part_table(lines: Sequence[Row]) -> str | None:
    """Parts of the forward time, such as primary and bounce rays."""
    rows = [
        [
            key,
            line["peer"],
            number(time["ours"]),
            number(time["theirs"]),
            time["ratio"] if isinstance(time["ratio"], str) else f"{time['ratio']:.2f}",
        ]
        for line in lines
        for key, time in line["times"].items()
        if not key.startswith("seconds")
    ]
    head = ["part", "program", "ours s", "theirs s", "times ours"]
    return markdown_table(head, rows) if rows else None


def bound_text(ours: Runs) -> str | None:
    """The distance to what the machine allows."""
    bound = ours.rows[0].get("bound")
    if not bound:
        return None
    said = []
    for key, by, what in (
        ("seconds_fwd", "fwd_by", "forward"),
        ("seconds_fwdbwd", "fwdbwd_by", "forward and backward"),
    ):
        seconds, limit = ours.seconds(key), bound.get(key)
        if seconds and limit:
            resource = UNITS.get(bound[by], bound[by])
            far = f"{seconds / limit:.1f} times that"
            said.append(f"{what} {limit:.3g} s (by {resource}), photograd takes {far}")
    return f"Bound: {'; '.join(said)}." if said else None


def unit_text(ours: Runs) -> str | None:
    """Nanoseconds for each of what the work is made of, and what the machine allows."""
    row = ours.rows[0]
    if "unit" not in row:
        return None
    said = []
    for key, what in (("seconds_fwd", "forward"), ("seconds_fwdbwd", "forward and backward")):
        seconds, limit = ours.seconds(key), row["bound"].get(key)
        if seconds and limit:
            each, least = (1e9 * t / row["unit"]["count"] for t in (seconds, limit))
            said.append(f"{each:.1f} ns {what} (bound {least:.2f})")
    return f"A {row['unit']['name']}: {', '.join(said)}."


def breakdown_table(ours: Runs) -> str | None:
    """Seconds by stage, from the last row that has them."""
    stages = next((r["breakdown"] for r in reversed(ours.rows) if "breakdown" in r), None)
    if stages is None:
        return None
    rows = [[name.replace("_", " "), number(value)] for name, value in stages.items()]
    return markdown_table(["stage", "seconds (foreign: cores)"], rows)


def section(workload: str, programs: Sequence[Runs]) -> str | None:
    ours = next((runs for runs in programs if runs.name == "photograd"), None)
    if ours is None:
        return None
    others = [runs for runs in programs if runs is not ours]
    lines = [comparison(ours, runs) for runs in others]
    head = ["program", "threads", "fwd s", "times ours", "fwd+bwd s", "times ours", "others' load"]
    pairs = [(ours, None), *zip(others, lines, strict=True)]
    size = ", ".join(f"{name} {value}" for name, value in ours.rows[0]["size"].items())
    notes = [f"{x['peer']} is not comparable: {'; '.join(x['why'])}." for x in lines if x["why"]]
    parts = [
        f"## {workload}: {size}",
        markdown_table(head, [program_row(runs, line) for runs, line in pairs]),
        part_table(lines),
        bound_text(ours),
        unit_text(ours),
        breakdown_table(ours),
        *notes,
    ]
    return "\n\n".join(text for text in parts if text)


def by_size(rows: Sequence[Row]) -> list[list[Row]]:
    """The rows of a workload, apart for each size that we measured."""
    sizes: list[Row] = []
    for row in rows:
        if row["peer"] == "photograd" and row["size"] not in sizes:
            sizes.append(row["size"])
    if len(sizes) < 2:
        return [list(rows)]
    return [[r for r in rows if all(r["size"].get(k) == v for k, v in s.items())] for s in sizes]


def page(files: Sequence[Path]) -> str:
    """The page for the rows of all files."""
    rows = [row for path in files for row in read_rows(path)]
    workloads = sorted({row["workload"] for row in rows if "workload" in row})
    machines = {
        f"{m['cpu']}, {m['cores']} processors, kernels {m['instruction_set']}"
        for m in (row["machine"] for row in rows if "machine" in row)
    }
    sections = [
        section(name, group(part, name, same_run=True))
        for name in workloads
        for part in by_size([row for row in rows if row.get("workload") == name])
    ]
    parts = [HEAD, *(f"Machine: {text}." for text in sorted(machines)), *filter(None, sections)]
    return "\n\n".join(parts) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description="Markdown from the lines of bench/compare.py")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    text = page(args.files)
    if args.out:
        args.out.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
