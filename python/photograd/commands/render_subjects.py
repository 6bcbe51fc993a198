"""What `photograd render` draws: a model, a volume or a file of Gaussians, seen by a camera."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from dataclasses import field as dataclass_field
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from photograd_course.cli import note
from photograd_course.color import srgb_decode
from photograd_course.metrics import round_to_8_bits

from photograd._checks import typed
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.commands.drawable import is_volume
from photograd.errors import RangeError, message
from photograd.fitting.drawing import Picture, draw_field, mean_depth
from photograd.fitting.fog import Ramp, load_fog
from photograd.fitting.model import Model, load_model
from photograd.representation import Fittable
from photograd.splats.files import GaussianFile, holds_gaussians, read_gaussians
from photograd.splats.frames import UP_AXES, USUAL_UP, file_from_upright
from photograd.splats.model import GaussianScene
from photograd.splats.orbit import draw_splats, upright_box
from photograd.splats.splatting import SplatOptions
from photograd.types import Array, FloatArray

AUTO = "auto"
UpOption = Annotated[
    str,
    typer.Option(
        "--up",
        help=f"What is up in a file of Gaussians: {', '.join(UP_AXES)}; by default what its header "
        f"says, else {USUAL_UP}.",
    ),
]


@dataclass(frozen=True, eq=False)
class Subject:
    """Something to look at, in a frame with +Y up.

    Attributes:
        box: (2, 3) around it.
        draw: what a camera in that frame sees.
        capture: folder of the photographs that it was fitted to, if it says so.
        from_capture: camera of a capture, and the capture's (4, 4) world_from_source -> the camera
            in that frame.
        background: linear (3,) that was learned with a model, or None.
        field: makes what is drawn, as a representation.
        field_from_upright: (3, 3) rotation into the frame of that field.
    """

    box: Array
    draw: Callable[[Camera], Picture]
    field: Callable[[], Fittable]
    capture: str | None = None
    from_capture: Callable[[Camera, FloatArray], Camera] = lambda camera, _: camera
    background: Array | None = None
    field_from_upright: Array = dataclass_field(default_factory=lambda: np.eye(3))


def check_up(up: str) -> None:
    """Refuse an axis that is none.

    Raises:
        RangeError: neither `auto` nor one of `UP_AXES`.
    """
    if up not in (AUTO, *UP_AXES):
        raise RangeError(message("render", "--up", f"{AUTO} or one of {', '.join(UP_AXES)}", up))


def subject_of(path: Path, up: str, volume: Mapping[str, Any]) -> Subject:
    """What a file or folder holds.

    Args:
        path: of a model, a volume or Gaussians.
        up: of `UP_AXES`, or "auto".
        volume: "ramp", "sigma_t", "resolution" and "window" of a volume.

    Raises:
        IoError, RangeError: what its reader raises.
    """
    if holds_gaussians(path):
        found = read_gaussians(path)
        for line in found.conversions:
            note(line)
        return _splats(found, up)
    if is_volume(path):
        ramp = typed("render", "--ramp", Ramp, volume["ramp"])
        return _model(load_fog(path, **{**volume, "ramp": ramp}))
    return _model(load_model(path))


def _model(model: Model) -> Subject:
    captured = model.meta.get("capture")
    return Subject(
        model.field.box,
        lambda camera: draw_field(model.field, model.background, camera),
        lambda: model.field,
        str(captured) if captured else None,
        background=model.background,
    )


def _splats(found: GaussianFile, up: str) -> Subject:
    told = found.presentation
    shown = told if up == AUTO else replace(told, up=up)
    box = upright_box(found.gaussians, shown)

    def draw(camera: Camera) -> Picture:
        picture = draw_splats(found.gaussians, camera, box=box, presentation=shown)
        color = round_to_8_bits(np.clip(picture.color.astype(np.float64), 0, 1))
        return Picture(color, picture.opacity, mean_depth(picture.depth, picture.opacity))

    def from_capture(camera: Camera, world_from_source: FloatArray) -> Camera:
        if told.up is not None:  # written by this project, in its world, turned upright again
            return camera
        upright_from_file = np.eye(4)
        upright_from_file[:3, :3] = file_from_upright(shown.up or USUAL_UP).T
        # Gaussians that others fitted lie in the frame of the capture's own files.
        pose = upright_from_file @ invert_rigid(world_from_source) @ camera.world_from_camera
        return replace(camera, world_from_camera=pose)

    @cache
    def field() -> Fittable:
        extent = max(float(np.linalg.norm(box[1] - box[0])), 1e-9)
        policy = SplatOptions(antialiased=shown.antialiased is not False)
        return GaussianScene(found.gaussians, extent=extent, policy=policy)

    behind = None if shown.background is None else srgb_decode(np.array(shown.background))
    turn = file_from_upright(shown.up or USUAL_UP)
    return Subject(box, draw, field, None, from_capture, behind, turn)
