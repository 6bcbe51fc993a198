"""What `photograd render` writes: which quantity, and as what kind of file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import typer

from photograd._checkpoint import write_npz
from photograd._memory import require_room
from photograd.capture.camera import Camera
from photograd.commands.shared import hold_output, out_option
from photograd.errors import IoError, RangeError, message
from photograd.fitting.drawing import Picture
from photograd.images.video import VIDEOS, require_even, require_video_writer, write_video
from photograd.images.write import write_png
from photograd.types import Array

SHOWN = Literal["color", "depth", "opacity"]
GIF, STILL, NUMBERS = ".gif", ".png", ".npz"
GIF_FPS = 50
DEPTH_MAP = "viridis_r"
"""Near is yellow, far is purple."""

RenderOutOption = Annotated[
    Path,
    out_option(
        "A .gif, .mp4 or .webm file; a name without a suffix: a folder for PNG frames; an .npz "
        "file for color, opacity, depth and cameras as numbers; or, with --frames 1, a .png file."
    ),
]
ShowOption = Annotated[
    str,
    typer.Option(
        "--show",
        help="What pictures show: color; depth, near in yellow, far in purple, nothing in white; "
        "or opacity.",
    ),
]
FpsOption = Annotated[
    float, typer.Option("--fps", min=1.0, max=240.0, help="Frames a second of a GIF or a video.")
]
RangeOption = Annotated[
    tuple[float, float] | None,
    typer.Option(
        "--depth-range",
        metavar="NEAR FAR",
        help="Depths in meters of the two ends of the colors; by default between which 98 % of all "
        "pixels lie.",
    ),
]


@dataclass(frozen=True)
class Output:
    """Where pictures go.

    Attributes:
        out: the file or folder.
        show: the quantity.
        fps: of what moves.
        depth_range: nearest and farthest depth of the colors, or None.
    """

    out: Path
    show: SHOWN
    fps: float
    depth_range: tuple[float, float] | None

    @classmethod
    def checked(
        cls,
        context: typer.Context,
        out: Path,
        show: SHOWN,
        fps: float,
        depth_range: tuple[float, float] | None,
    ) -> Output:
        """The options, if they mean something together, and the place, held for this run.

        Raises:
            IoError: a name that cannot be written, or a video without imageio-ffmpeg.
            RangeError: a rate that a GIF cannot have, or depths that are no range.
        """
        output = cls(out, show, fps, depth_range)
        if output.suffix == GIF and fps > GIF_FPS:
            expected = f"at most {GIF_FPS} frames a second in a GIF"
            raise RangeError(message("render", "--fps", expected, fps, "write a video"))
        if output.suffix in VIDEOS:
            require_video_writer("render")
        if depth_range is not None:
            if show != "depth":
                remedy = "leave the option out"
                raise RangeError(message("render", "--depth-range", "--show depth", show, remedy))
            if not 0 <= depth_range[0] < depth_range[1] < np.inf:
                expected = "two depths from 0, the nearer first"
                raise RangeError(message("render", "--depth-range", expected, depth_range))
        kinds = (GIF, *VIDEOS, NUMBERS, STILL)
        hold_output(context, "render", out, kinds, folder="PNG frames")
        return output

    @property
    def suffix(self) -> str:
        """Of the file, in small letters; "" of a folder."""
        return self.out.suffix.lower()

    def check_cameras(self, cameras: Sequence[Camera]) -> None:
        """Refuse cameras whose pictures one file cannot hold, before they are drawn.

        Raises:
            RangeError: several for a still, several sizes for one file, odd sizes for a video, or
                numbers beyond memory.
        """
        if self.suffix == STILL and len(cameras) > 1:
            expected = f"--frames 1 for one picture {self.out.name}"
            remedy = "for all of them name a .gif, .mp4 or .webm file, or a folder"
            raise RangeError(message("render", "--frames", expected, len(cameras), remedy))
        sizes = sorted({(camera.width, camera.height) for camera in cameras})
        if self.suffix and len(sizes) > 1:
            got = ", ".join(f"{width} x {height}" for width, height in sizes[:4])
            remedy = "give --width and --height, or name a folder"
            raise RangeError(message("render", "--out", "pictures of one size", got, remedy))
        if self.suffix in VIDEOS:
            require_even("render", "--width, --height", *sizes[0])
        if self.suffix in (GIF, NUMBERS) or self.show == "depth":
            pixels = sum(camera.width * camera.height for camera in cameras)
            remedy = "render fewer or smaller frames, or write a video or a folder"
            require_room("render", "the frames", 80 * pixels, argument="--out", remedy=remedy)

    def write(self, pictures: Iterable[Picture], cameras: Sequence[Camera]) -> dict[str, Any]:
        """Draw and write all pictures; returns what the command reports beside their number.

        Raises:
            IoError: it cannot be written.
            RangeError: depths of nothing at all.
        """
        if self.suffix == NUMBERS:
            write_npz(self.out, _numbers(list(pictures), cameras))
            return {}
        told: dict[str, Any] = {}
        if self.show == "color":
            frames = (picture.color for picture in pictures)
        elif self.show == "opacity":
            frames = (np.repeat(_clipped(each.opacity)[..., None], 3, axis=2) for each in pictures)
        else:
            depths = [picture.depth for picture in pictures]
            near, far = self.depth_range or depth_range(depths)
            told = {"near_m": near, "far_m": far}
            frames = (depth_colors(depth, near, far) for depth in depths)
        self._save(frames)
        return told

    def _save(self, frames: Iterator[Array]) -> None:
        from photograd_course.viz import write_gif

        if self.suffix in VIDEOS:
            write_video(self.out, frames, frames_per_second=self.fps)
        elif self.suffix == GIF:
            write_gif(list(frames), self.out, frames_per_second=self.fps)
        elif self.suffix == STILL:
            write_png(self.out, next(frames))
            for _ in frames:  # there is none; the progress bar ends
                pass
        else:
            _write_folder(self.out, frames)


def _write_folder(folder: Path, frames: Iterable[Array]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as failure:
        got = f"{folder}: {failure.strerror}"
        raise IoError(message("render", "--out", "a folder to write in", got)) from failure
    for number, frame in enumerate(frames):
        write_png(folder / f"frame_{number:04d}.png", frame)


def _numbers(pictures: Sequence[Picture], cameras: Sequence[Camera]) -> dict[str, Array]:
    """Arrays of all frames; cameras as world_from_camera and (fx, fy, cx, cy)."""
    return {
        "color": np.stack([picture.color for picture in pictures]).astype(np.float32),
        "opacity": np.stack([picture.opacity for picture in pictures]).astype(np.float32),
        "depth": np.stack([picture.depth for picture in pictures]).astype(np.float32),
        "world_from_camera": np.stack([camera.world_from_camera for camera in cameras]),
        "intrinsics": np.array([(c.fx, c.fy, c.cx, c.cy) for c in cameras]),
    }


def _clipped(values: Array) -> Array:
    return np.clip(values.astype(np.float64), 0.0, 1.0)


def depth_range(depths: Sequence[Array]) -> tuple[float, float]:
    """Between which 98 % of all depths lie."""
    visible = np.concatenate([depth[np.isfinite(depth)].ravel() for depth in depths])
    if not visible.size:
        expected = "something that the cameras see"
        raise RangeError(message("render", "--show depth", expected, "nothing", "name other ones"))
    near, far = np.percentile(visible.astype(np.float64), [1, 99]).tolist()
    return near, max(far, near * (1 + 1e-6) + 1e-12)


def depth_colors(depth: Array, near: float, far: float) -> Array:
    """Depths (H, W) as display colors (H, W, 3); white where there is none."""
    from matplotlib import colormaps

    share = np.clip((depth.astype(np.float64) - near) / (far - near), 0.0, 1.0)
    colors = np.asarray(colormaps[DEPTH_MAP](np.nan_to_num(share)))[..., :3]
    return np.where(np.isfinite(depth)[..., None], colors, 1.0)
