"""From a folder of photographs to a capture, stage by stage, going on where it was interrupted.

OUT/images/       the photographs, upright
OUT/database.db   features and matches, as they are found
OUT/sparse/0/     cameras, poses and points, a COLMAP model; further unconnected ones beside it
OUT/capture.json  what went in, how it went, and which files are ours
OUT/cameras.png   where the cameras stand
"""

from __future__ import annotations

import json
import os
import shutil
from collections import defaultdict
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from photograd_course.atomic_io import atomic_write
from photograd_course.cli import Column, Progress

from photograd.capture import Capture, load_capture
from photograd.capture.sfm.engine import Engine, Reconstructed, Settings, open_engine
from photograd.capture.sfm.photographs import (
    MIN_IMAGES,
    PARTIAL,
    Photograph,
    copy_photographs,
    find_photographs,
)
from photograd.capture.sfm.picture import draw_cameras
from photograd.capture.write import MANIFEST, left_alone, remove_written, require_free
from photograd.errors import IoError, SceneError, message

MAX_EXHAUSTIVE = 60
"""Photographs up to which every pair is compared; the work grows with the square of it."""

NEIGHBORS = 10
KEYS = 30


def choose_pairs(count: int, *, exhaustive: bool | None = None) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, of photographs 0 to count - 1 in the order of their names.

    All of them for at most 60 photographs. For more, which are taken for a walk in the order of the
    names: each with the ten that follow and with those 16, 32, 64 ... further on, the end with
    the start, as of a walk around something, and 30 key photographs, evenly spread, all with
    each other, so that places are found again.

    Args:
        count: number of photographs.
        exhaustive: all pairs, or the walk, whatever the number.
    """
    if count <= MAX_EXHAUSTIVE if exhaustive is None else exhaustive:
        return [(i, j) for i in range(count) for j in range(i + 1, count)]
    gaps = [*range(1, NEIGHBORS + 1)]
    gap = 16
    while gap < count:
        gaps.append(gap)
        gap *= 2
    found = {(i, i + gap) for gap in gaps for i in range(count - gap)}
    found |= {(i, count - gap + i) for gap in gaps[:NEIGHBORS] for i in range(gap) if gap < count}
    keys = sorted({k * count // KEYS for k in range(KEYS)})
    found |= {(i, j) for i in keys for j in keys if i < j}
    return sorted(pair for pair in found if pair[0] < pair[1])


# From a folder of photographs to a capture, stage by stage, going on where it was interrupted.


STATE, PICTURE = MANIFEST, "cameras.png"
_OURS = (
    "sparse",
    ".sparse.partial",
    ".sparse_again",
    "..sparse_again.partial",
    PICTURE,
    "database.db",
    "database.db-journal",
    "database.db-shm",
    "database.db-wal",
    "pairs.txt",
)
PAIRS_AT_ONCE = 24
AGREEING = (30, 15)
"""Points that must agree about the pose of a photograph, at first and when some got none."""
_NAME = "capture"
Note = Callable[[str], None]
OpenEngine = Callable[[Path, Path, Settings, int], Engine]


@dataclass(frozen=True)
class Report:
    """How it went.

    Attributes:
        photographs, registered: how many there are, and how many have got a pose.
        left_out: names of the others.
        cameras: number of different cameras.
        models: unconnected parts; the largest is the capture.
        points: in the largest part.
        error: mean reprojection error in pixels of the photographs.
    """

    photographs: int
    registered: int
    left_out: tuple[str, ...]
    cameras: int
    models: int
    points: int
    error: float


def reconstruct(
    photographs: Path,
    out: Path,
    settings: Settings,
    *,
    threads: int = 0,
    exhaustive: bool | None = None,
    overwrite: bool = False,
    note: Note,
    engine: OpenEngine | None = None,
) -> tuple[Capture, Report]:
    """Recover cameras and points; `out` becomes a folder that `load_capture` reads.

    The same photographs and settings give the same bits, on any number of threads, but for large
    scenes: with more than 50,000 observations, pycolmap adds up in several threads, and only
    `threads` = 1 repeats them to the bit.

    Args:
        photographs: folder of .jpg and .png files.
        out: folder to make, or to go on with.
        settings: what the result depends on.
        threads: 0 for all cores.
        exhaustive: compare all pairs, or as if they were taken on a walk; None by their number.
        overwrite: remove the capture that photograd wrote to `out`, and begin anew; other files
            stay.
        note: told what happens, a sentence at a time.
        engine: makes what does the work; pycolmap by default.

    Raises:
        IoError: a bad folder or photograph, no pycolmap, or `out` holds something else.
        SceneError: too few photographs, or none whose pose could be found.
    """
    worker = (engine or open_engine)(out, out / "images", settings, threads)
    found, lines = find_photographs(photographs)
    for line in lines:
        note(line)
    _prepare(found, photographs, out, settings, overwrite=overwrite, note=note)
    state = json.loads((out / STATE).read_text(encoding="utf-8"))
    if "models" not in state:
        _extract(worker, found, threads)
        _match(worker, found, exhaustive)
        state["models"] = [asdict(model) for model in _map(worker, found, out, note)]
        _save_state(out, state)
    models = [Reconstructed(**{**m, "names": tuple(m["names"])}) for m in state["models"]]
    report = _report(found, models)
    capture = load_capture(out)
    heading = f"{report.registered} of {report.photographs} photographs, {report.points} points"
    draw_cameras(capture, out / PICTURE, f"{heading}, {report.error:.2f} px")
    return capture, report


def _prepare(
    found: list[Photograph],
    source: Path,
    out: Path,
    settings: Settings,
    *,
    overwrite: bool,
    note: Note,
) -> None:
    """The folder, its state and the copies of the photographs."""
    if out.resolve() in (source.resolve(), *source.resolve().parents):
        expected = "a folder that does not hold the photographs"
        raise IoError(message(_NAME, f"--out {out}", expected, "one that does"))
    wanted = {
        "settings": asdict(settings),
        "photographs": {photograph.name: photograph.checksum for photograph in found},
    }
    if not overwrite and (out / STATE).is_file():
        _require_same(out, wanted)
        note(f"going on with what {out} holds")
    else:
        names = [photograph.name for photograph in found]
        copies = [f"images/{start}{name}" for name in names for start in ("", PARTIAL)]
        files = [*copies, *_OURS, STATE]
        require_free(_NAME, f"--out {out}", out, files, overwrite=overwrite)
        if overwrite:
            remove_written(out)
        out.mkdir(parents=True, exist_ok=True)
        _save_state(out, wanted | {"files": files})
    if others := left_alone(out):
        note(f"not ours, left as it is: {', '.join(others)}")
    copy_photographs(found, out / "images")


def _require_same(out: Path, wanted: dict[str, Any]) -> None:
    try:
        state = json.loads((out / STATE).read_text(encoding="utf-8"))
        same = all(state[key] == value for key, value in wanted.items())
    except (OSError, ValueError, KeyError, TypeError):
        same = False
    if not same:
        expected = "a capture of the same photographs with the same settings"
        remedy = "--overwrite begins anew; or choose another folder"
        raise IoError(message(_NAME, f"--out {out}", expected, "another", remedy))


def _save_state(out: Path, state: dict[str, Any]) -> None:
    atomic_write(out / STATE, json.dumps(state, indent=1).encode())


def _extract(worker: Engine, found: list[Photograph], threads: int) -> None:
    """Features, a few photographs at a time."""
    groups: dict[Any, list[str]] = defaultdict(list)
    for photograph in found:
        groups[photograph.camera_key].append(photograph.name)
    worker.enter(list(groups.values()))
    known = worker.extracted()
    names = [photograph.name for photograph in found if photograph.name not in known]
    at_once = threads or os.cpu_count() or 1
    with Progress("features", len(found), start=len(known)) as bar:
        for first in range(0, len(names), at_once):
            worker.extract(names[first : first + at_once])
            bar.update(len(known) + min(first + at_once, len(names)))


def _match(worker: Engine, found: list[Photograph], exhaustive: bool | None) -> None:
    """Pairs, a few at a time."""
    names = [photograph.name for photograph in found]
    pairs = [(names[i], names[j]) for i, j in choose_pairs(len(names), exhaustive=exhaustive)]
    pending = worker.pending(pairs)
    done = len(pairs) - len(pending)
    with Progress("matches", len(pairs), start=done) as bar:
        for first in range(0, len(pending), PAIRS_AT_ONCE):
            batch = pending[first : first + PAIRS_AT_ONCE]
            worker.match(batch)
            done += len(batch)
            bar.update(done)


def _map(worker: Engine, found: list[Photograph], out: Path, note: Note) -> list[Reconstructed]:
    """The better of two attempts: pycolmap's own strictness, then half of it where some have no
    pose. The second replaces the first where it places more photographs in one part.
    """
    folder, again = out / "sparse", out / ".sparse_again"
    models = _attempt(worker, found, folder, AGREEING[0])
    placed = len(models[0].names) if models else 0
    if placed < len(found):
        note(f"{placed} of {len(found)} photographs placed; a second attempt asks for half as much")
        lenient = _attempt(worker, found, again, AGREEING[1])
        if lenient and len(lenient[0].names) > placed:
            shutil.rmtree(folder, ignore_errors=True)
            again.replace(folder)
            models = lenient
        shutil.rmtree(again, ignore_errors=True)
    if not models:
        expected = "photographs that show the same things from different places"
        got = f"{len(found)} of which no three could be placed"
        remedy = (
            "overlap neighbors by two thirds, walk instead of turning on the spot, "
            "avoid blur and bare or shiny surfaces"
        )
        raise SceneError(message(_NAME, "--photos", expected, got, remedy))
    return models


def _attempt(
    worker: Engine, found: list[Photograph], folder: Path, agreeing: int
) -> list[Reconstructed]:
    placed = 0
    with Progress("cameras", len(found), [Column("placed", "{:.0f}".format)]) as bar:

        def count() -> None:
            nonlocal placed
            placed += 1  # of all parts: a photograph that belongs to two counts twice
            bar.update(min(placed, len(found)), placed=placed)

        models = worker.map(folder, agreeing, count)
    # Two photographs are a pair, and no reconstruction.
    return [model for model in models if len(model.names) >= MIN_IMAGES]


def _report(found: list[Photograph], models: list[Reconstructed]) -> Report:
    best = models[0]
    return Report(
        photographs=len(found),
        registered=len(best.names),
        left_out=tuple(x.name for x in found if x.name not in best.names),
        cameras=len({x.camera_key for x in found if x.name in best.names}),
        models=len(models),
        points=best.points,
        error=best.error,
    )
