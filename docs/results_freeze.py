"""Find what is there, freeze its structure, go on: `python docs/results_freeze.py CAPTURE`.

The same three steps for each representation whose structure is discrete: a fit finds which voxels
matter, the structure stays as it is from then on, and the numbers in it are refined. Rewrites a
section of docs/results.md.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from photograd._compiled import _core
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.fit import run_with_bar
from photograd.fields.voxel_field import PRUNE_AT
from photograd.fitting.compare import frame_seconds, stored_bytes
from photograd.fitting.evaluate import evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import options_for

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
BEGIN, END = "<!-- freeze -->", "<!-- end of freeze -->"


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    representation: str
    moment: str
    psnr: float
    megabytes: float
    frame_ms: float
    seconds: float  # of the fit, from the start or from the moment before


def scored(representation: str, moment: str, model: Model, capture: Capture, seconds: float) -> Row:
    """What a model is worth on the held-out views."""
    return Row(
        representation,
        moment,
        evaluate(model, capture.test).psnr,
        stored_bytes(model) / 2**20,
        1000 * frame_seconds(model, capture),
        seconds,
    )


def here(fit: Fit) -> Model:
    """The model of a fit as it is now."""
    return Model(fit.model, None, fit.options, {}, np.zeros((0, 3)))


def sparse_rows(capture: Capture, resolution: int, folder: Path) -> list[Row]:
    """A sparse grid when its voxels are frozen, after the last pruning, and at its end."""
    fit = Fit.start(capture, options_for("sparse_sh", resolution=resolution))
    frozen = int(PRUNE_AT * fit.options.steps) + 1
    name = f"sparse_sh:{resolution}"
    before = run(fit, folder, lambda: fit.step_number >= frozen)
    rows = [scored(name, f"frozen, step {frozen}", here(fit), capture, before)]
    after = run(fit, folder, lambda: False)
    return [*rows, scored(name, "refined", load_model(folder), capture, after)]


def octree_rows(capture: Capture, first: Path, folder: Path) -> list[Row]:
    """An octree cut from the model in `first`: as it is cut, and at the end of its own fit."""
    source = load_model(first)
    fit = Fit.start(capture, options_for("octree_sh"), start_from=source)
    name = f"octree_sh:{source.field.resolution}"
    rows = [scored(name, "cut from it, frozen", here(fit), capture, 0.0)]
    after = run(fit, folder, lambda: False)
    return [*rows, scored(name, "refined", load_model(folder), capture, after)]


def run(fit: Fit, folder: Path, enough: Callable[[], bool]) -> float:
    """Seconds that the fit took to its end, or until there is enough of it."""
    return run_with_bar(fit, folder, enough).seconds


def table(name: str, rows: list[Row]) -> str:
    """The section between the marks."""
    lines = [
        f"{_core.thread_count()} threads; {name}.",
        "",
        "| representation | moment | PSNR, dB | MiB | frame, ms | fit, s |",
        "|---|---|---|---|---|---|",
        *(
            f"| {row.representation} | {row.moment} | {row.psnr:.2f} | {row.megabytes:.1f} "
            f"| {row.frame_ms:.0f} | {row.seconds:.0f} |"
            for row in rows
        ),
    ]
    return "\n".join(lines)


def main() -> None:
    """Measure, and rewrite the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("capture", type=Path)
    parser.add_argument("--resolution", type=int, default=128)
    args = parser.parse_args()
    capture = load_capture(args.capture)
    with tempfile.TemporaryDirectory() as folder:
        sparse, tree = Path(folder) / "sparse", Path(folder) / "tree"
        rows = sparse_rows(capture, args.resolution, sparse)
        rows += octree_rows(capture, sparse, tree)
    text = RESULTS.read_text()
    start, stop = text.index(BEGIN) + len(BEGIN), text.index(END)
    section = table(args.capture.name, rows)
    RESULTS.write_text(f"{text[:start]}\n{section}\n{text[stop:]}")


if __name__ == "__main__":
    main()
