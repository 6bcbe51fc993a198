"""Codes, small networks and one network at equal bytes: `python docs/results_codes.py CAPTURE`.

Leaf codes, decoded per sample and per ray, a network a cell, and one network for the whole scene.
Each gets the same bytes, the same rays in a step, the same seconds, and the same choice of learning
rates, tried over a part of these seconds. What starts from another model has that model's seconds
in its curve. Seconds are those of the processor, summed over threads, so that other programs on
the machine do not change them. Rewrites a section of docs/results.md and draws
docs/images/leaf_codes_curves.png.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from photograd._compiled import _core
from photograd.capture.capture import Capture
from photograd.capture.load import load_capture
from photograd.fields import HashGrid, LeafCodes, LeafMlps, Nerf, SparseSh
from photograd.fitting.compare import stored_bytes
from photograd.fitting.evaluate import display_image, evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model
from photograd.fitting.options import options_for
from photograd.representation import Fittable
from photograd_course.viz import save_figure, style

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
PICTURE = ROOT / "docs" / "images" / "leaf_codes_curves.png"
BEGIN, END = "<!-- codes -->", "<!-- end of codes -->"
RATES = (0.5, 1.0, 2.0)
"""Factors on each representation's own learning rates."""
TUNING = 0.15
"""Share of the seconds over which each of them is tried."""
MOMENTS = (0.0, 0.2, 1.0)
"""Of the seconds, after which a fit is scored."""
PACE_STEPS = 4
VIEWS = 2


@dataclass(frozen=True)
class Contender:
    """What is compared: a name, the field it begins with, and the seconds before that."""

    name: str
    make: Callable[[], Fittable]
    before: float
    color: str


@dataclass(frozen=True)
class Curve:
    """PSNR over seconds of a fit, and what its end is worth."""

    contender: Contender
    rate: float
    seconds: list[float]
    psnr: list[float]
    steps: int
    megabytes: float
    frame_ms: float


def as_model(fit: Fit) -> Model:
    """The field of a fit as it is now."""
    return Model(fit.model, None, fit.options, {}, np.zeros((0, 3)))


def begin(capture: Capture, field: Fittable, rays: int, steps: int, rate: float) -> Fit:
    """A fit of a field that was made elsewhere."""
    options = options_for(field.name, steps=steps, rays=rays, learning_rate=rate)
    return Fit(capture, options, field, None)


def pace(capture: Capture, contender: Contender, rays: int) -> float:
    """Seconds of a step."""
    fit = begin(capture, contender.make(), rays, 100, 1.0)
    fit.step()
    start = time.process_time()
    for _ in range(PACE_STEPS):
        fit.step()
    return (time.process_time() - start) / PACE_STEPS


def run(capture: Capture, contender: Contender, rays: int, steps: int, rate: float) -> Curve:
    """Fit, and score at `MOMENTS`; the scoring takes none of the seconds."""
    fit = begin(capture, contender.make(), rays, steps, rate)
    seconds, found, spent = [], [], 0.0
    for moment in MOMENTS:
        start = time.process_time()
        while fit.step_number < round(moment * steps):
            fit.step()
        spent += time.process_time() - start
        if not contender.before and not moment:
            continue  # random weights
        seconds.append(contender.before + spent)
        found.append(evaluate(as_model(fit), capture.test).psnr)
    model = as_model(fit)
    size, frame = stored_bytes(model) / 2**20, frame_ms(model, capture)
    scores = ", ".join(f"{s:.0f} s {p:.2f} dB" for s, p in zip(seconds, found, strict=True))
    sys.stderr.write(f"{contender.name}: {scores}\n")
    return Curve(contender, rate, seconds, found, steps, size, frame)


def frame_ms(model: Model, capture: Capture) -> float:
    """Processor time to draw the first held-out view, the least of three."""
    found = []
    for _ in range(3):
        start = time.process_time()
        display_image(model, capture.test[0].camera)
        found.append(time.process_time() - start)
    return 1000 * min(found)


def tuned(capture: Capture, contender: Contender, rays: int, seconds: float) -> Curve:
    """The fit at the learning rate that is best over a part of the seconds."""
    each = pace(capture, contender, rays)
    short = max(4, round(TUNING * seconds / each))
    scores = {}
    for rate in RATES:
        fit = begin(capture, contender.make(), rays, short, rate)
        while fit.step_number < short:
            fit.step()
        scores[rate] = evaluate(as_model(fit), capture.test[:1]).psnr
    best = max(scores, key=lambda rate: scores[rate])
    return run(capture, contender, rays, max(8, round(seconds / each)), best)


def first_model(capture: Capture, name: str, seconds: float, **options: Any) -> tuple[Fit, float]:
    """A fit of about so many seconds, and how many it took."""
    probe = Fit.start(capture, options_for(name, steps=100, **options))
    start = time.process_time()
    for _ in range(PACE_STEPS):
        probe.step()
    each = (time.process_time() - start) / PACE_STEPS
    fit = Fit.start(capture, options_for(name, steps=max(8, round(seconds / each)), **options))
    start = time.process_time()
    while fit.step_number < fit.steps and time.process_time() - start < 1.5 * seconds:
        fit.step()
    return fit, time.process_time() - start


def contenders(capture: Capture, resolution: int, rays: int, seconds: float) -> list[Contender]:
    """All four, of equal bytes: those of the networks a cell."""
    grid, grid_took = first_model(capture, "sparse_sh", seconds, resolution=resolution, rays=rays)
    teacher, took = first_model(capture, "hash_grid", seconds, resolution=128, rays=rays)
    assert isinstance(grid.model, SparseSh)
    assert isinstance(teacher.model, HashGrid)
    voxels, field = grid.model, teacher.model
    start = time.process_time()
    cells = LeafMlps.from_field(field, resolution)
    took += time.process_time() - start
    size = stored_bytes(Model.of(cells))
    numbers = max(1, round(size / 4 / len(voxels.active)) - 1)

    def codes(decode: Any) -> LeafCodes:
        return LeafCodes.from_sparse_sh(voxels, decode=decode, features=numbers)

    bare = Fit.start(capture, options_for("nerf", resolution=8, steps=2, rays=16)).model
    assert isinstance(bare, Nerf)

    def nerf(width: int) -> Nerf:
        return Nerf.initial(replace(bare.policy, width=width), seed=0)

    counts = {n: sum(a.nbytes for a in nerf(n).params.values()) for n in range(16, 385, 8)}
    width = min(counts, key=lambda n: abs(counts[n] - size))

    def copied() -> LeafMlps:
        params = {name: values.copy() for name, values in cells.params.items()}
        return LeafMlps(cells.active, params, cells.policy)

    return [
        Contender(
            f"codes of {numbers}, per sample", lambda: codes("sample"), grid_took, style.BLUE
        ),
        Contender(f"codes of {numbers}, per ray", lambda: codes("ray"), grid_took, style.INK),
        Contender(f"{len(cells.active.origins)} networks", copied, took, style.ORANGE),
        Contender(f"one network, width {width}", lambda: nerf(width), 0.0, style.RED),
    ]


def draw(curves: list[Curve]) -> None:
    """PSNR over seconds, a line each."""
    with style.house_style():
        figure = style.new_figure(6.4, 4.2)
        axes = style.place_axes(figure, 0.7, 0.95, 5.4, 2.95)
        for curve in curves:
            axes.plot(
                curve.seconds,
                curve.psnr,
                "o-",
                color=curve.contender.color,
                label=curve.contender.name,
            )
        axes.set(
            xlabel="processor seconds, those of the model it starts from included",
            ylabel="PSNR, dB",
        )
        axes.legend(loc="lower right")
        style.write_caption(
            figure,
            "Held-out views over the seconds of the fit, at equal bytes. A curve begins where the "
            "model that it starts from was finished.",
        )
        save_figure(figure, PICTURE, dpi=100)


def table(name: str, curves: list[Curve]) -> str:
    """The section between the marks."""
    lines = [
        f"{_core.thread_count()} threads; {name}.",
        "",
        "| representation | MiB | PSNR at the start | after a fifth | at the end, dB "
        "| seconds before, fit | steps | learning rate | frame, ms |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for curve in curves:
        *start, fifth, end = curve.psnr
        before = curve.contender.before
        at_start = f"{start[0]:.2f}" if start else "-"
        lines.append(
            f"| {curve.contender.name} | {curve.megabytes:.2f} | {at_start} | {fifth:.2f} "
            f"| {end:.2f} | {before:.0f}, {curve.seconds[-1] - before:.0f} | {curve.steps} "
            f"| x {curve.rate:g} | {curve.frame_ms:.0f} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Measure, draw, and rewrite the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("capture", type=Path)
    parser.add_argument("--downscale", type=int, default=1)
    parser.add_argument("--resolution", type=int, help="Of the grid and the cells.", default=64)
    parser.add_argument("--rays", type=int, default=2048)
    parser.add_argument("--seconds", type=float, help="Of each fit.", default=120.0)
    args = parser.parse_args()
    whole = load_capture(args.capture, downscale=args.downscale)
    views = whole.test[:: max(1, len(whole.test) // VIEWS)][:VIEWS]
    capture = replace(whole, test=views)
    curves = [
        tuned(capture, contender, args.rays, args.seconds)
        for contender in contenders(capture, args.resolution, args.rays, args.seconds / 2)
    ]
    draw(curves)
    size = f"{views[0].camera.width} x {views[0].camera.height} pixels"
    text = RESULTS.read_text()
    start, stop = text.index(BEGIN) + len(BEGIN), text.index(END)
    section = table(f"{args.capture.name}, {size}, {VIEWS} held-out views", curves)
    RESULTS.write_text(f"{text[:start]}\n{section}\n{text[stop:]}")


if __name__ == "__main__":
    main()
