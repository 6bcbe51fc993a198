"""Measures the fits on real captures and writes docs/results.md: `python docs/results.py DATA`.

DATA is a folder with nerf_synthetic_chair, banana and opensfm_berlin. Every row is one run of the
command line in a process of its own, so that the peak memory is the run's.
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
RESOLUTIONS = (64, 128, 192)


def command(*words: str) -> dict[str, Any]:
    """Run `photograd ...

    --json`; the last line, with wall seconds and peak memory of the process.
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
    return {**result, "wall": os.times().elapsed - before.elapsed, "gib": usage.ru_maxrss / 2**20}


def measure(data: Path, out: Path, name: str, resolution: int) -> str:
    """One row of the table."""
    capture, downscale = str(data / name), str(CAPTURES[name])
    model = out / f"{name}_{resolution}"
    fit = command(
        "fit",
        capture,
        "--out",
        str(model),
        "--resolution",
        str(resolution),
        "--downscale",
        downscale,
    )
    picture = model / "comparison.png"
    score = command(
        "evaluate", str(model), capture, "--downscale", downscale, "--out", str(picture)
    )
    return (
        f"| {name} | {resolution} | {fit['step']} | {fit['seconds']:.0f} | {fit['gib']:.2f} "
        f"| {score['psnr']:.2f} | {score['ssim']:.3f} | {len(score['views'])} |"
    )


def main() -> None:
    """Measure and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "results")
    parser.add_argument("--captures", nargs="*", default=list(CAPTURES))
    parser.add_argument("--resolutions", nargs="*", type=int, default=list(RESOLUTIONS))
    given = parser.parse_args()
    rows = [
        measure(given.data, given.out, name, size)
        for name in given.captures
        for size in given.resolutions
    ]
    text = RESULTS.read_text() if RESULTS.exists() else "<!-- table -->\n<!-- end -->\n"
    head, rest = text.split("<!-- table -->", 1)
    tail = rest.split("<!-- end -->", 1)[1]
    table = [
        "", f"Measured on {platform.machine()}, {os.cpu_count()} cores.", "",
        "| capture | voxels | steps | fit, s | peak, GiB | PSNR, dB | SSIM | test views |",
        "|---|---|---|---|---|---|---|---|", *rows, "",
    ]  # fmt: skip
    RESULTS.write_text(head + "<!-- table -->" + "\n".join(table) + "<!-- end -->" + tail)


if __name__ == "__main__":
    main()
