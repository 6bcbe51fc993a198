"""Where the cameras of `photograd render` stand: around a scene, at its photographs, in a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, get_args

import numpy as np
import typer
from photograd_course.cli import note

from photograd._checks import typed
from photograd.capture import Capture, load_capture
from photograd.capture.camera import Camera
from photograd.capture.orbit import helix_cameras, orbit_cameras
from photograd.capture.paths import interpolate_cameras, read_camera_path, resized_camera
from photograd.capture.view import View
from photograd.commands.render_subjects import Subject
from photograd.errors import IoError, RangeError, message

ORBIT, SPIRAL, VIEWS, BETWEEN = "orbit", "spiral", "views", "between"
FILE = ".json"
FRAMES, SIZE = 60, 256
ELEVATIONS = {ORBIT: 25.0, SPIRAL: 60.0}
Split = Literal["all", "train", "val", "test"]

PathOption = Annotated[
    str,
    typer.Option(
        "--path",
        metavar="PATH",
        help=f"Of the cameras: {ORBIT}, a circle; {SPIRAL}, two turns that rise from the horizon; "
        f"{VIEWS}, the photographs' own; {BETWEEN}, from one photograph to the next by name; or a "
        "file: transforms.json, or a camera path of nerfstudio's viewer.",
    ),
]
FramesOption = Annotated[
    int | None,
    typer.Option(
        "--frames",
        min=1,
        help=f"Pictures along the path; by default {FRAMES}, or as many as there are cameras.",
    ),
]
CaptureOption = Annotated[
    Path | None,
    typer.Option(
        "--capture",
        help=f"Folder of the photographs for --path {VIEWS} and {BETWEEN}; by default what the "
        "model was fitted to.",
    ),
]
SplitOption = Annotated[
    str, typer.Option("--split", help=f"Of the photographs: {', '.join(get_args(Split))}.")
]
RenderSizeOption = Annotated[
    int | None,
    typer.Option(
        "--size",
        min=8,
        help=f"Pixels along both edges; by default {SIZE}, or as the cameras of a path have it.",
    ),
]
WidthOption = Annotated[
    int | None, typer.Option("--width", min=8, help="Pixels across, in place of --size.")
]
HeightOption = Annotated[
    int | None, typer.Option("--height", min=8, help="Pixels down, in place of --size.")
]
ElevationOption = Annotated[
    float | None,
    typer.Option(
        "--elevation",
        min=-89.0,
        max=89.0,
        help="Degrees above the horizon: of the circle, by default 25; or at the end of the "
        "spiral, by default 60.",
    ),
]


def chosen_size(size: int | None, width: int | None, height: int | None) -> tuple[int, int] | None:
    """(width, height) that the options say; None if they say nothing.

    Raises:
        RangeError: one edge without the other.
    """
    across, down = width or size, height or size
    if across is None and down is None:
        return None
    if across is None or down is None:
        got = f"only --{'width' if width else 'height'} {width or height}"
        raise RangeError(message("render", "--width, --height", "both, or --size", got))
    return across, down


@dataclass(frozen=True)
class PathChoice:
    """A path, before it is known what is looked at.

    Attributes:
        name: one of the four words, or the name of a file.
        frames: None for the default.
        size: (width, height), or None for the default.
        elevation: in degrees, or None for the default.
        split: of the photographs.
        folder: of the photographs; None for those of the model.
    """

    name: str
    frames: int | None
    size: tuple[int, int] | None
    elevation: float | None
    split: Split
    folder: Path | None

    @classmethod
    def checked(
        cls,
        name: str,
        frames: int | None,
        size: tuple[int, int] | None,
        elevation: float | None,
        split: str,
        folder: Path | None,
    ) -> PathChoice:
        """The options, if they mean something together.

        Raises:
            RangeError: an unknown word, or an option that this path does not have.
        """
        words = (ORBIT, SPIRAL, VIEWS, BETWEEN)
        if name not in words and Path(name).suffix.lower() != FILE:
            expected = f"one of {', '.join(words)}, or a file {FILE}"
            raise RangeError(message("render", "--path", expected, repr(name)))
        for option, given, paths in (
            ("--elevation", elevation is not None, (ORBIT, SPIRAL)),
            ("--capture", folder is not None, (VIEWS, BETWEEN)),
            ("--split", split != "all", (VIEWS, BETWEEN)),
        ):
            if given and name not in paths:
                expected = f"--path {' or '.join(paths)} with it"
                raise RangeError(message("render", option, expected, name, "leave it out"))
        chosen = typed("render", "--split", Split, split)
        return cls(name, frames, size, elevation, chosen, folder)

    def cameras(self, subject: Subject) -> list[Camera]:
        """The cameras of the path, in the frame of the subject.

        Raises:
            IoError: no photographs, or a file that cannot be read.
            RangeError: a split without photographs.
        """
        if self.name in (ORBIT, SPIRAL):
            size, count = self.size or (SIZE, SIZE), self.frames or FRAMES
            elevation = ELEVATIONS[self.name] if self.elevation is None else self.elevation
            around = orbit_cameras if self.name == ORBIT else helix_cameras
            return around(subject.box, count, size=size, elevation=elevation)
        if self.name not in (VIEWS, BETWEEN):
            found = read_camera_path(Path(self.name), self.size or (SIZE, SIZE))
            return self._sized(interpolate_cameras(found, self.frames) if self.frames else found)
        capture = self._capture(subject)
        views = sorted(_views(capture, self.split), key=lambda view: view.name)
        found = [subject.from_capture(view.camera, capture.world_from_source) for view in views]
        if self.name == BETWEEN:
            return self._sized(interpolate_cameras(found, self.frames or FRAMES))
        if self.frames is not None and self.frames < len(found):
            kept = np.linspace(0, len(found) - 1, self.frames).round().astype(int).tolist()
            found = [found[k] for k in kept]
        return self._sized(found)

    def _sized(self, cameras: list[Camera]) -> list[Camera]:
        if self.size is None:
            return cameras
        return [resized_camera(camera, *self.size) for camera in cameras]

    def _capture(self, subject: Subject) -> Capture:
        folder = self.folder or (Path(subject.capture) if subject.capture else None)
        if folder is None:
            expected = f"the folder of the photographs for --path {self.name}"
            raise IoError(message("render", "--capture", expected, "none"))
        capture = load_capture(folder)
        for line in capture.conversions:
            note(line)
        return capture


def _views(capture: Capture, split: Split) -> Sequence[View]:
    splits = {"train": capture.train, "val": capture.val, "test": capture.test}
    views = capture.views if split == "all" else splits[split]
    if not views:
        held = ", ".join(f"{len(found)} {name}" for name, found in splits.items())
        raise RangeError(message("render", "--split", "a split with photographs", held))
    return views
