"""Learn, freeze the structure, refine: `python docs/results_freeze.py CAPTURE`.

The same driver for each representation whose structure is discrete: a sparse grid and what takes
its voxels, a field of networks and what is tabulated or distilled from it, Gaussians and what takes
them. Rewrites a section of docs/results.md.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

from photograd._compiled import _core
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.commands.fit import run_with_bar
from photograd.fitting.freeze import Moment, learn_freeze_refine
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model
from photograd.fitting.options import options_for

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
BEGIN, END = "<!-- freeze -->", "<!-- end of freeze -->"
STEPS = (  # representation, what it starts from
    ("sparse_sh", None),
    ("octree_sh", "sparse_sh"),
    ("leaf_codes", "sparse_sh"),
    ("hash_grid", None),
    ("plenoctree", "hash_grid"),
    ("leaf_mlps", "hash_grid"),
    ("gaussians", None),
    ("gaussian_codes", "gaussians"),
)


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    representation: str
    moment: str
    psnr: float
    megabytes: float
    frame_ms: float
    seconds: float  # of the fit, from the start or from the moment before


def rows_of(
    capture: Capture, name: str, source: Path | None, folder: Path, **changes: int | None
) -> list[Row]:
    """Both moments of a fit in `folder`, which starts from the model in `source`."""
    first = None if source is None else load_model(source)
    fit = Fit.start(capture, options_for(name, **changes), start_from=first)
    moments: list[tuple[str, Moment]]
    if fit.model.frozen_at(fit.options) is None:
        result = run_with_bar(fit, folder, lambda: False)
        moments = [("fitted", Moment.of_fit(fit, result.seconds))]
    else:
        found = learn_freeze_refine(fit, folder, run=run_with_bar)
        assert found is not None
        moments = [(f"frozen, step {found.frozen.step}", found.frozen), ("refined", found.refined)]
    return [
        Row(name, moment, at.psnr, at.bytes / 2**20, at.frame_ms, at.seconds)
        for moment, at in moments
    ]


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
    parser.add_argument("--downscale", type=int, default=1)
    parser.add_argument("--resolution", type=int, help="Of grids and trees.", default=128)
    parser.add_argument("--steps", type=int, help="Of each fit; default: its own.")
    parser.add_argument("--rays", type=int, help="In a step; default: its own.")
    parser.add_argument("--gaussians", type=int, help="At most so many; default: their own.")
    parser.add_argument("--views", type=int, help="Held-out views; default: all.")
    args = parser.parse_args()
    capture = load_capture(args.capture, downscale=args.downscale)
    views = capture.test[:: max(1, len(capture.test) // (args.views or len(capture.test)))]
    capture = replace(capture, test=views[: args.views])
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as folder:
        for name, source in STEPS:
            size = None if name == "hash_grid" else args.resolution
            changes = {"resolution": size, "steps": args.steps, "rays": args.rays}
            changes["gaussians"] = args.gaussians if name == "gaussians" else None
            before = None if source is None else Path(folder) / source
            rows += rows_of(capture, name, before, Path(folder) / name, **changes)
    text = RESULTS.read_text()
    start, stop = text.index(BEGIN) + len(BEGIN), text.index(END)
    camera = views[0].camera
    size = f"{camera.width} x {camera.height} pixels, {len(capture.test)} held-out views"
    section = table(f"{args.capture.name}, {size}", rows)
    RESULTS.write_text(f"{text[:start]}\n{section}\n{text[stop:]}")


if __name__ == "__main__":
    main()
