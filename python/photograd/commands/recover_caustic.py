"""`photograd recover --parameter shapes.NAME.heights`: a lens whose caustic is the target."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.atomic_io import atomic_write
from photograd_course.cli import note

from photograd._checks import typed
from photograd._descend import progress_bar
from photograd._signals import StopRequest
from photograd.caustics import CausticDesign, CausticOptions, CausticResult
from photograd.caustics.from_scene import height_shape, lens_of, light_of_scene, receiver_of
from photograd.caustics.options import Start
from photograd.errors import RangeError, message
from photograd.images.write import write_exr
from photograd.transport.mesh_files import write_stl
from photograd.transport.scene import Scene
from photograd.types import Array

FINEST = 257  # vertices of a lens along an edge, at most
MILLIMETERS = 1000.0  # of a meter


def lens_name(parameters: list[str]) -> str | None:
    """The shape whose heights are to be found; None where no heights are.

    Args:
        parameters: as the command line has them.

    Raises:
        RangeError: heights beside other parameters.
    """
    found = [height_shape(text) for text in parameters]
    if not any(found):
        return None
    if len(found) > 1:
        expected = "heights of one shape, and nothing else"
        raise RangeError(message("recover", "--parameter", expected, ", ".join(parameters)))
    return found[0]


def recover_lens(
    scene: Scene,
    lens: str,
    receiver: str | None,
    targets: list[Array],
    options: CausticOptions,
    out: Path,
    *,
    resume: bool,
    stopping: StopRequest,
) -> dict[str, Any]:
    """Design a lens, and write it with its pictures; what the last line says.

    Args:
        scene: with the slab, a light and the receiver.
        lens: name of the slab.
        receiver: name of the rectangle.
        targets: (H, W, C) light on it, one picture.
        options: of the design.
        out: folder, held by the caller.
        resume: go on with the design in `out`.
        stopping: ends the run when it is set.

    Raises:
        RangeError, SceneError, Error: parts that are not there or make no caustic.
        IoError: files that cannot be written.
    """
    if receiver is None:
        expected, remedy = "the name of a rectangle", "heights need what is lit: --receiver NAME"
        raise RangeError(message("recover", "--receiver", expected, "none", remedy))
    if len(targets) > 1:
        raise RangeError(message("recover", "--target", "one, of heights", len(targets)))
    height, width = targets[0].shape[:2]
    wall = receiver_of(scene, receiver, height, width)
    vertices = (min(FINEST, 2 * height + 1), min(FINEST, 2 * width + 1))
    plate = lens_of(scene, lens, wall, vertices)
    job = CausticDesign(plate, light_of_scene(scene), wall, targets[0], options)
    if resume:
        job.load(out)
        note(f"resumed at step {job.step_number} of {job.steps}")
    with progress_bar("recover", job) as on_step:
        result = job.run(out, on_step=on_step, should_stop=stopping)
    return _write(result, out)


def options_of(*, start: str, steps: int, learning_rate: float | None, seed: int) -> CausticOptions:
    """Options of a design from those of the command line.

    Args:
        start: as of `CausticOptions`.
        steps: of the descent.
        learning_rate: of Adam, or None.
        seed: of the places of rays.

    Raises:
        DtypeError, RangeError: another start, or numbers out of bounds.
    """
    chosen = typed("recover", "--start", Start, start)
    return CausticOptions(start=chosen, steps=steps, learning_rate=learning_rate, seed=seed)


def _write(result: CausticResult, out: Path) -> dict[str, Any]:
    """lens.stl, heights.exr, pictures and found.json; what the last line says."""
    from photograd_course.viz import save_figure

    from photograd.transport.inverse.pictures import comparison_figure

    lens, light = result.lenses[0], result.caustic
    vertices, faces = lens.closed_mesh()
    write_stl(out / "lens.stl", MILLIMETERS * vertices, faces)
    heights = np.repeat(lens.heights[..., None], 3, axis=2).astype(np.float32)
    write_exr(out / "heights.exr", heights)
    scale = float(np.quantile(result.target, 0.99)) or 1.0
    pictures = (np.repeat(p[..., None], 3, axis=2) for p in (result.target, light.irradiance))
    target, found = (picture / scale for picture in pictures)
    save_figure(comparison_figure(target, found), out / "comparison.png")
    numbers = {
        "step": len(result.history),
        "correlation": round(result.correlation, 6),
        "emitted": light.emitted,
        "transmitted": light.transmitted,
        "received": light.received,
        "trapped": light.trapped,
    }
    atomic_write(out / "found.json", json.dumps(numbers, indent=1).encode())
    return {"out": out, "seconds": round(result.seconds, 3), **numbers}
