"""Measures the fits on real captures and writes docs/results.md: `python docs/results.py DATA`.

DATA is a folder with nerf_synthetic_chair, banana and opensfm_berlin. Every row is one run of the
command line in a process of its own, so that the peak memory is the run's. `--score` scores models
that are in OUT already, and leaves steps, seconds and memory of their rows as they stand.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
CAPTURES = {"nerf_synthetic_chair": 1, "banana": 2, "opensfm_berlin": 8}  # name -> downscale
CANDIDATES = (
    "dense_grid:64",
    "dense_grid:128",
    "dense_grid:192",
    "sparse_sh:128",
    "sparse_sh:192",
    "sparse_sh:256",
    "gaussians:30000",
)
"""Representations with their voxels along the longest edge, or their number of Gaussians."""


def command(*words: str) -> dict[str, Any]:
    """The last line of `photograd ... --json`, with what the process took.

    wall: seconds; processor: seconds of all threads; gib: memory at its peak.
    """
    before = os.times()
    done = subprocess.Popen(
        [sys.executable, "-m", "photograd_course", *words, "--json"],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert done.stdout is not None
    text = done.stdout.read()
    _, status, usage = os.wait4(done.pid, 0)
    if status:
        raise SystemExit(f"photograd {' '.join(words)} failed")
    result: dict[str, Any] = json.loads(text.strip().splitlines()[-1])
    processor = usage.ru_utime + usage.ru_stime
    wall = os.times().elapsed - before.elapsed
    return {**result, "wall": wall, "processor": processor, "gib": usage.ru_maxrss / 2**20}


def model_folder(out: Path, name: str, candidate: str) -> Path:
    """Where the model of a row lies."""
    return out / f"{name}_{candidate.replace(':', '_')}"


def fit_row(data: Path, out: Path, name: str, candidate: str) -> str:
    """Fit a row's model; the row as far as its memory."""
    representation, size = candidate.split(":")
    option = "--gaussians" if representation == "gaussians" else "--resolution"
    fit = command(
        "fit",
        str(data / name),
        "--out",
        str(model_folder(out, name, candidate)),
        "--downscale",
        str(CAPTURES[name]),
        "--representation",
        representation,
        option,
        size,
    )
    return (
        f"| {name} | {representation} | {int(size):,} | {fit['step']} | {fit['seconds']:.0f} "
        f"| {fit['gib']:.2f} |"
    )


def score(data: Path, out: Path, name: str, candidate: str) -> str:
    """The rest of the row."""
    model = model_folder(out, name, candidate)
    found = command(
        "evaluate",
        str(model),
        str(data / name),
        "--downscale",
        str(CAPTURES[name]),
        "--out",
        str(model / "comparison.png"),
    )
    return f" {found['psnr']:.2f} | {found['ssim']:.3f} | {len(found['views'])} |"


def stored_rows(text: str) -> dict[tuple[str, str, str], str]:
    """The rows of the table that stands in the page, by capture, representation and size."""
    rows = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("| ").split("|")]
        if line.startswith("| ") and len(cells) == 9 and cells[0] != "capture":
            rows[cells[0], cells[1], cells[2]] = line
    return rows


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "results")
    parser.add_argument("--captures", nargs="*", default=list(CAPTURES))
    parser.add_argument("--candidates", nargs="*", default=list(CANDIDATES))
    parser.add_argument("--score", action="store_true", help="score the models in OUT again")
    given = parser.parse_args()
    text = RESULTS.read_text() if RESULTS.exists() else "<!-- table -->\n<!-- end -->\n"
    head, rest = text.split("<!-- table -->", 1)
    table, tail = rest.split("<!-- end -->", 1)
    rows = stored_rows(table)
    for name in given.captures:
        for candidate in given.candidates:
            place = given.data, given.out, name, candidate
            if given.score:
                representation, size = candidate.split(":")
                known = rows[name, representation, f"{int(size):,}"]
                fit = "|".join(known.split("|")[:7]) + "|"
            else:
                fit = fit_row(*place)
            row = fit + score(*place)
            rows |= stored_rows(row)
            print(row, flush=True)  # noqa: T201  a long run says what it has
    lines = [
        "",
        f"Measured on {platform.machine()}, {os.cpu_count()} cores.",
        "",
        "| capture | representation | voxels, or number | steps | fit, s | peak, GiB | PSNR, dB "
        "| SSIM | test views |",
        "|---|---|---|---|---|---|---|---|---|",
        *(row for name in CAPTURES for key, row in rows.items() if key[0] == name),
        "",
    ]
    RESULTS.write_text(head + "<!-- table -->" + "\n".join(lines) + "<!-- end -->" + tail)


if __name__ == "__main__":
    main()
