"""Fields of networks at full size: `python docs/results_networks.py CAPTURE`.

A hash grid and a NeRF with the defaults of `photograd fit`, PlenOctrees from the hash grid, and
one hash grid fitted again and again with other numbers of threads. Each fit is a process of its
own, whose processor seconds count, summed over threads, so that other programs on the machine do
not change them much. Models that lie in OUT already are not fitted again. Frames of these models
are timed beside those of the NeRF's function in layers of the size of [Mildenhall2020]. Rewrites
three sections of docs/results.md; `--only fits`, `--only frames` or `--only threads` takes one.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from photograd.capture.camera import Camera
from photograd.capture.load import load_capture
from photograd.fields import Nerf
from photograd.fitting.compare import stored_bytes
from photograd.fitting.evaluate import display_image
from photograd.fitting.model import Model, load_model
from photograd.network import Perceptron
from photograd.types import Array
from results import RESULTS, ROOT, command

FITS = (  # representation, what it starts from, resolution unless that of the defaults
    ("hash_grid", None, None),
    ("nerf", None, None),
    ("plenoctree", "hash_grid", None),
    ("plenoctree", "hash_grid", 128),
    ("plenoctree", "hash_grid", 256),
)
THREADS = (1, 2, 3, 2, 1)
THREAD_STEPS = 300
FILE = "cost.json"
LARGE = (256, 8)
"""Width and hidden layers of the density network of [Mildenhall2020]."""
FRAMES, FEWEST, PATIENCE = 60, 3, 5.0
"""So many frames are timed, or fewer, but no less than the second, after so many seconds."""


def fitted(
    capture: Path, name: str, source: str | None, resolution: int | None, out: Path
) -> tuple[Path, float, float]:
    """Fit in OUT, unless it is there: the folder, processor seconds, GiB at the peak."""
    folder = out / (name if resolution is None else f"{name}_{resolution}")
    if not (folder / FILE).exists():
        words = ["fit", str(capture), "--representation", name, "--out", str(folder)]
        if source is not None:
            words += ["--start-from", str(out / source)]
        if resolution is not None:
            words += ["--resolution", str(resolution)]
        cost = command(*words)
        (folder / FILE).write_text(json.dumps([cost["processor"], cost["gib"]]))
    seconds, gib = json.loads((folder / FILE).read_text())
    return folder, seconds, gib


def fit_row(capture: Path, name: str, source: str | None, resolution: int | None, out: Path) -> str:
    """A representation's line of the table."""
    folder, seconds, gib = fitted(capture, name, source, resolution, out)
    found = command("evaluate", str(folder), str(capture), "--out", str(folder / "views.png"))
    model = load_model(folder)
    size = stored_bytes(model) / 2**20
    start = "" if source is None else f" from {source}, {model.options.resolution}³ cells"
    return (
        f"| {name}{start} | {len(model.history):,} | {seconds:.0f} | {gib:.2f} "
        f"| {size:.1f} | {found['psnr']:.2f} | {found['ssim']:.3f} | {len(found['views'])} |"
    )


def copied(source: Perceptron, values: Array, to: Perceptron, places: Sequence[int]) -> Array:
    """Parameters of a larger perceptron of the same function; layer l of `source` is places[l].

    Rows and columns that `source` lacks are zero, and a layer that it lacks passes its numbers on:
    they come from a ReLU, which changes none of them again.
    """
    parameters = np.zeros(to.count, values.dtype)
    layers = to.layers(parameters)
    for W, _ in layers:
        np.fill_diagonal(W[: source.widths[0], : source.widths[0]], 1.0)
    for layer, (W, b) in enumerate(source.layers(values)):
        wide, bias = layers[places[layer]]
        own = source.widths[layer - 1] if layer else source.inputs
        room = to.widths[places[layer] - 1] if layer else source.inputs
        wide[:] = 0.0
        wide[: len(W), :own] = W[:, :own]
        wide[: len(W), room : room + W.shape[1] - own] = W[:, own:]  # a skip connection's columns
        bias[: len(b)] = b
    return parameters


def enlarged(field: Nerf, width: int, depth: int) -> Nerf:
    """The same function in larger layers, twice as many hidden ones: it costs what those cost."""
    large = Nerf(replace(field.policy, width=width, depth=depth))
    large.reached = field.reached
    half, last = field.policy.depth // 2, field.policy.depth
    places = [*range(half), *range(depth // 2, depth // 2 + last - half), depth]
    params = field.params
    large.params["density"] = copied(field.density, params["density"], large.density, places)
    large.params["color"] = copied(field.color, params["color"], large.color, [0, 1])
    return large


def frame_cost(model: Model, camera: Camera) -> tuple[float, float, Array]:
    """Milliseconds of a frame, the least of all; of the processor, the middle; and the picture."""
    wall: list[float] = []
    processor: list[float] = []
    while len(wall) < FEWEST or (len(wall) < FRAMES and sum(wall) < PATIENCE):
        before = time.perf_counter(), time.process_time()
        picture = display_image(model, camera)
        wall.append(time.perf_counter() - before[0])
        processor.append(time.process_time() - before[1])
    return 1000 * min(wall), 1000 * float(np.median(processor)), picture


def frame_rows(capture: Path, out: Path) -> list[str]:
    """A line for each field, the PlenOctree first: the others are compared with it."""
    camera = load_capture(capture).test[0].camera
    models = {name: load_model(out / name) for name in ("plenoctree", "hash_grid", "nerf")}
    small = models["nerf"].field
    assert isinstance(small, Nerf)
    label = f"nerf, {small.policy.depth} layers of {small.policy.width}"
    models[label] = models.pop("nerf")
    width, depth = LARGE
    same = f"the same function in {depth} layers of {width}"
    models[same] = replace(models[label], field=enlarged(small, width, depth))
    rows, pictures, first = [], {}, 0.0
    for name, model in models.items():
        wall, processor, pictures[name] = frame_cost(model, camera)
        first = first or processor
        rows.append(f"| {name} | {wall:.0f} | {processor:.0f} | {processor / first:.1f} |")
        print(rows[-1], flush=True)  # noqa: T201  a long run says what it has
    assert np.abs(pictures[label] - pictures[same]).max() <= 1 / 255
    return rows


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


def replace_section(marker: str, lines: list[str]) -> None:
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
    parser.add_argument("--only", choices=("fits", "frames", "threads"))
    given = parser.parse_args()
    if given.only in (None, "fits"):
        rows = []
        for name, source, resolution in FITS:
            rows.append(fit_row(given.capture, name, source, resolution, given.out))
            print(rows[-1], flush=True)  # noqa: T201  a long run says what it has
        head = [
            f"{given.capture.name}; processor seconds of the fit, on {os.cpu_count()} cores.",
            "",
            "| representation | steps | fit, processor s | peak, GiB | stored, MiB | PSNR, dB "
            "| SSIM | test views |",
            "|---|---|---|---|---|---|---|---|",
        ]
        replace_section("networks", head + rows)
    if given.only in (None, "frames"):
        head = [
            f"The first held-out view of {given.capture.name}, {os.cpu_count()} cores; "
            f"the fastest of up to {FRAMES} frames, and the median of their processor time.",
            "",
            "| field | frame, ms | processor time, ms | times the PlenOctree's |",
            "|---|---|---|---|",
        ]
        replace_section("frames", head + frame_rows(given.capture, given.out))
    if given.only in (None, "threads"):
        head = [
            f"A hash grid on {given.capture.name}, {THREAD_STEPS} steps, one seed.",
            "",
            "| run | threads | SHA-256 of all parameters, first 16 digits | PSNR, dB |",
            "|---|---|---|---|",
        ]
        replace_section("threads", head + thread_rows(given.capture, given.out))


if __name__ == "__main__":
    main()
