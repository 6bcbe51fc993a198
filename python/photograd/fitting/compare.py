"""Different representations of the same scene, side by side: quality, bytes and seconds.

No representation is best for every scene: leaves, smooth curves, fur and flat walls ask for
different ones. Here that is measured: each candidate is fitted to the same photographs with the
same number of steps, scored on the same held-out views, and drawn at the same camera. (A step of a
grid draws rays at random, a step of Gaussians a whole view; the seconds of both are in the table.)
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from photograd_course.atomic_io import atomic_write

from photograd._checkpoint import FILE_NAME, make_folder
from photograd._compiled import _core
from photograd._fit_options import FitOptions
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.fields import fittable
from photograd.fitting.checks import require_startable
from photograd.fitting.evaluate import Evaluation, ViewScore, display_image, evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model, load_model
from photograd.fitting.options import FitResult

FRAMES = 5
"""Frames that are timed; the median counts."""

_SECONDS = "seconds.json"
_START = "start_from.json"

Run = Callable[[Fit, Path], FitResult]
"""Runs a fit in a folder, usually under a progress bar."""


@dataclass(frozen=True)
class Candidate:
    """A representation at a resolution, written `sparse_sh:128`, or so many `gaussians:20000`."""

    representation: str
    resolution: int

    def options(self, shared: FitOptions) -> FitOptions:
        """Its own options, with what `shared` says on the rest."""
        kind = fittable()[self.representation]
        own = {name: value for name, value in kind.fit_defaults.items() if name != "steps"}
        own[kind.size_option] = self.resolution
        return replace(shared, representation=self.representation, **own)

    @property
    def label(self) -> str:
        """As it is written on a command line."""
        return f"{self.representation}:{self.resolution}"


@dataclass(frozen=True)
class Score:
    """One line of the table."""

    capture: str
    candidate: str
    psnr: float  # dB, mean over held-out views
    ssim: float
    parameter_bytes: int  # of all parameter arrays and what state they need beside them
    train_seconds: float
    frame_ms: float  # median, at the size of the first held-out view
    threads: int
    protocol: str


def parse_candidates(text: str, start_from: Model | None = None) -> list[Candidate]:
    """The candidates of "dense_grid:64,sparse_sh:128".

    Raises RangeError for another form, a resolution below 8, one that is given twice, a
    representation that a capture cannot start, or one without the model that it starts from: an
    octree without a grid before it, a textured mesh without `start_from`. Or a `start_from` that
    none of them starts from.

    Args:
        text: names with a resolution or a number, separated by commas.
        start_from: the model that some of them start from.
    """
    candidates = []
    for word in text.split(","):
        name, colon, size = word.strip().partition(":")
        if not (colon and size.isdecimal() and int(size) >= 8):
            raise RangeError(
                message(
                    "compare",
                    "candidates",
                    "NAME:RESOLUTION with a resolution of 8 or more",
                    repr(word.strip()),
                    "for example dense_grid:128,sparse_sh:128",
                )
            )
        require_startable(name)
        candidates.append(Candidate(name, int(size)))
    if len(set(candidates)) < len(candidates):
        raise RangeError(message("compare", "candidates", "each only once", text))
    sources = [source_of(candidate, candidates, start_from) for candidate in candidates]
    if start_from is not None and start_from not in sources:
        expected = f"a candidate that starts from a {start_from.field.name}"
        raise RangeError(message("compare", "candidates", expected, text))
    return candidates


def source_of(
    candidate: Candidate, candidates: Sequence[Candidate], start_from: Model | None = None
) -> Candidate | Model | None:
    """The model that a candidate starts from; None for what starts by itself.

    It is `start_from` where that is of a kind to start from, or the model of the nearest candidate
    before it, of the same resolution where that means the same. Raises RangeError if there is none.

    Args:
        candidate: one of `candidates`.
        candidates: of the comparison, in order.
        start_from: the model that was given to start from.
    """
    kind = fittable()[candidate.representation]
    if kind.first_model != "required":
        return None
    if start_from is not None and start_from.field.name in kind.first_model_kinds:
        return start_from
    before = candidates[: candidates.index(candidate)]
    for other in reversed(before):
        if other.representation not in kind.first_model_kinds:
            continue
        if other.resolution == candidate.resolution or not kind.same_resolution:
            return other
    raise RangeError(
        message(
            "compare",
            "candidates",
            f"the model that {candidate.label} starts from before it",
            f"none of {' or '.join(kind.first_model_kinds)} with {candidate.resolution}",
            kind.first_model_help,
        )
    )


def compare_one(
    name: str,
    capture: Capture,
    candidate: Candidate,
    folder: Path,
    options: FitOptions,
    run: Run,
    *,
    source: Path | Model | None = None,
    source_name: str = "",
) -> tuple[Score, Evaluation] | None:
    """Fit `candidate` to `capture` in `folder`, or continue there, and score it.

    Args:
        name: what the table calls the capture.
        capture: the photographs.
        candidate: a representation and its size.
        folder: of the fit; what it holds is continued.
        options: of the fit, those that all candidates share included.
        run: runs the fit in its folder.
        source: the model that the fit starts from, or its folder; then its seconds count, too.
        source_name: what errors call a model, such as its file.

    Returns:
        The line of the table and what it comes from, or None if `run` ended before the fit did: the
        same call continues it, and its seconds add up.

    Raises:
        RangeError: a folder of other options, or of a fit that started from another model.
    """
    first = load_model(source) if isinstance(source, Path) else source
    start = _description(first, source.name if isinstance(source, Path) else source_name)
    if (folder / FILE_NAME).exists():
        job = Fit.resume(capture, folder)
        wanted = asdict(options)
        if asdict(job.options) != wanted:
            raise RangeError(
                message(
                    "compare",
                    "out",
                    "a folder of the same options",
                    f"{folder}",
                    "choose another folder, or give the options that it was made with",
                )
            )
        _require_start(folder, start)
    else:
        job = Fit.start(capture, options, start_from=first)
        make_folder(folder)
        atomic_write(folder / _START, json.dumps({"start_from": start}).encode())
    spent = _spent(folder)
    if job.step_number < options.steps:
        result = run(job, folder)
        spent += result.seconds
        atomic_write(folder / _SECONDS, json.dumps({"seconds": spent}).encode())
        if not result.finished:
            return None
    model = load_model(folder)
    evaluation = evaluate(model, capture.test)
    if isinstance(source, Path):
        spent += _spent(source)
    score = Score(
        name,
        candidate.label,
        evaluation.psnr,
        evaluation.ssim,
        stored_bytes(model),
        spent,
        1000 * frame_seconds(model, capture),
        max(1, _core.thread_count()),
        evaluation.protocol,
    )
    return score, evaluation


def stored_bytes(model: Model) -> int:
    """Bytes of a model's parameters and of the arrays that say where they belong."""
    return sum(array.nbytes for array in model.field.stored().values())


def frame_seconds(model: Model, capture: Capture) -> float:
    """Median time to draw the first held-out view.

    Args:
        model: that is drawn.
        capture: whose first held-out view has the camera.
    """
    camera = capture.test[0].camera
    times = []
    for _ in range(FRAMES):
        before = time.perf_counter()
        display_image(model, camera)
        times.append(time.perf_counter() - before)
    return float(np.median(times))


def worst_view(evaluations: Sequence[Evaluation]) -> list[ViewScore]:
    """What each evaluation says of the view with the lowest mean PSNR over all of them.

    Args:
        evaluations: of several models on the same views.
    """
    scores = np.array([[view.psnr for view in e.views] for e in evaluations])
    index = int(scores.mean(axis=0).argmin())
    return [e.views[index] for e in evaluations]


def markdown(scores: Sequence[Score]) -> str:
    """The table as text, best PSNR of each capture in bold, and the protocols below it.

    Args:
        scores: lines of the table.
    """
    best = {s.capture: max(t.psnr for t in scores if t.capture == s.capture) for s in scores}
    lines = [
        "| capture | representation | PSNR, dB | SSIM | MiB | training, s | frame, ms |",
        "|---|---|---|---|---|---|---|",
    ]
    for s in scores:
        psnr = f"{s.psnr:.2f}" if s.psnr < best[s.capture] else f"**{s.psnr:.2f}**"
        lines.append(
            f"| {s.capture} | {s.candidate} | {psnr} | {s.ssim:.3f} "
            f"| {s.parameter_bytes / 2**20:.1f} | {s.train_seconds:.0f} | {s.frame_ms:.0f} |"
        )
    threads = ", ".join(str(n) for n in sorted({s.threads for s in scores}))
    lines += ["", f"{threads} threads."]
    lines += [f"{text}." for text in sorted({s.protocol for s in scores})]
    return "\n".join(lines) + "\n"


def _spent(folder: Path) -> float:
    path = folder / _SECONDS
    return float(json.loads(path.read_text())["seconds"]) if path.exists() else 0.0


def _description(model: Model | None, name: str) -> str:
    """The model that a fit starts from: its name, and a digest of its arrays."""
    if model is None:
        return "no model"
    digest = hashlib.blake2b(digest_size=4)
    for key, array in sorted(model.field.stored().items()):
        digest.update(f"{key} {array.dtype} {array.shape}".encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return f"{name} ({digest.hexdigest()})"


def _require_start(folder: Path, start: str) -> None:
    """Raise RangeError if the fit in a folder started from another model."""
    path = folder / _START
    before = json.loads(path.read_text())["start_from"] if path.exists() else "no model"
    if before.rpartition("(")[2] != start.rpartition("(")[2]:
        expected = f"{before}, from which the fit in {folder} started"
        remedy = "give the same model, or choose another --out"
        raise RangeError(message("compare", "start_from", expected, start, remedy))
