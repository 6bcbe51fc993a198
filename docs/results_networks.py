"""Fields of networks at full size: `python docs/results_networks.py CAPTURE`.

A hash grid and a NeRF with the defaults of `photograd fit`, a PlenOctree from the hash grid, and
one hash grid fitted again and again with other numbers of threads. Each fit is a process of its
own, whose processor seconds count, summed over threads, so that other programs on the machine do
not change them much. Models that lie in OUT already are not fitted again. Rewrites two sections of
docs/results.md; `--only threads` or `--only fits` takes one.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
from pathlib import Path

import numpy as np
from photograd.fitting.compare import stored_bytes
from photograd.fitting.model import load_model
from results import RESULTS, ROOT, command

FITS = (  # representation, what it starts from
    ("hash_grid", None),
    ("nerf", None),
    ("plenoctree", "hash_grid"),
)
THREADS = (1, 2, 3, 2, 1)
THREAD_STEPS = 300
FILE = "cost.json"


def fitted(capture: Path, name: str, source: str | None, out: Path) -> tuple[float, float]:
    """Fit into OUT/name, unless it is there: processor seconds, GiB at the peak."""
    folder = out / name
    if not (folder / FILE).exists():
        words = ["fit", str(capture), "--representation", name, "--out", str(folder)]
        if source is not None:
            words += ["--start-from", str(out / source)]
        cost = command(*words)
        (folder / FILE).write_text(json.dumps([cost["processor"], cost["gib"]]))
    seconds, gib = json.loads((folder / FILE).read_text())
    return seconds, gib


def fit_row(capture: Path, name: str, source: str | None, out: Path) -> str:
    """A representation's line of the table."""
    seconds, gib = fitted(capture, name, source, out)
    folder = out / name
    found = command("evaluate", str(folder), str(capture), "--out", str(folder / "views.png"))
    model = load_model(folder)
    size = stored_bytes(model) / 2**20
    start = "" if source is None else f" from {source}"
    return (
        f"| {name}{start} | {len(model.history):,} | {seconds:.0f} | {gib:.2f} "
        f"| {size:.1f} | {found['psnr']:.2f} | {found['ssim']:.3f} | {len(found['views'])} |"
    )


def digest(folder: Path) -> str:
    """Of all parameters of a model, by name."""
    found = hashlib.sha256()
    params = load_model(folder).field.params
    for name in sorted(params):
        found.update(name.encode() + np.ascontiguousarray(params[name]).tobytes())
    return found.hexdigest()[:16]


def thread_rows(capture: Path, out: Path) -> list[str]:
    """A line for each run of one seed."""
    rows = []
    for k, threads in enumerate(THREADS):
        folder = out / f"threads_{k}_{threads}"
        if not (folder / "model.npz").exists():
            words = ["fit", str(capture), "--representation", "hash_grid", "--seed", "7"]
            words += ["--steps", str(THREAD_STEPS), "--threads", str(threads)]
            command(*words, "--out", str(folder))
        found = command("evaluate", str(folder), str(capture), "--out", str(folder / "v.png"))
        rows.append(f"| {k + 1} | {threads} | `{digest(folder)}` | {found['psnr']:.6f} |")
        print(rows[-1], flush=True)  # noqa: T201  a long run says what it has
    return rows


def replace(marker: str, lines: list[str]) -> None:
    """Rewrite a section of the page."""
    begin, end = f"<!-- {marker} -->", f"<!-- end of {marker} -->"
    text = RESULTS.read_text()
    head, rest = text.split(begin, 1)
    RESULTS.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end, 1)[1])


def main() -> None:
    """Measure, and rewrite the sections."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("capture", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "networks")
    parser.add_argument("--only", choices=("fits", "threads"))
    given = parser.parse_args()
    if given.only != "threads":
        rows = []
        for name, source in FITS:
            rows.append(fit_row(given.capture, name, source, given.out))
            print(rows[-1], flush=True)  # noqa: T201  a long run says what it has
        head = [
            f"{given.capture.name}; processor seconds of the fit, on {os.cpu_count()} cores.",
            "",
            "| representation | steps | fit, processor s | peak, GiB | parameters, MiB | PSNR, dB "
            "| SSIM | test views |",
            "|---|---|---|---|---|---|---|---|",
        ]
        replace("networks", head + rows)
    if given.only != "fits":
        head = [
            f"A hash grid on {given.capture.name}, {THREAD_STEPS} steps, one seed.",
            "",
            "| run | threads | SHA-256 of all parameters, first 16 digits | PSNR, dB |",
            "|---|---|---|---|",
        ]
        replace("threads", head + thread_rows(given.capture, given.out))


if __name__ == "__main__":
    main()
