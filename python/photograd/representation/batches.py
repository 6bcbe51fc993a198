"""What a representation renders, how, and what comes out: batches, options, outputs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photograd._arrays import Arguments
from photograd._checks import require_finite
from photograd.capture.camera import Camera
from photograd.types import Array


@dataclass(frozen=True)
class RayBatch:
    """Rays: world origins (R, 3) in meters, unit directions (R, 3), pixel numbers (R,).

    `pixel` feeds the random numbers (jitter), so that a ray's numbers do not depend on its batch.
    """

    origins: Array
    directions: Array
    pixel: NDArray[np.uint32]

    def __post_init__(self) -> None:
        call = Arguments("RayBatch")
        pixel = call.array("pixel", self.pixel, ("R",), dtype=np.uint32)
        object.__setattr__(self, "pixel", pixel)
        for name in ("origins", "directions"):
            rows = call.array(name, getattr(self, name), ("R", 3), finite=False)
            object.__setattr__(self, name, rows)


@dataclass(frozen=True)
class CanvasBatch:
    """Points (N, 2) on a 2D canvas, x to the right and y down, both in [0, 1]."""

    points: Array

    def __post_init__(self) -> None:
        points = Arguments("CanvasBatch").array("points", self.points, ("N", 2), finite=False)
        object.__setattr__(self, "points", points)


@dataclass(frozen=True, eq=False)
class ImageBatch:
    """All pixels of a camera, row by row: for what is drawn a picture at a time.

    `camera_from_world` (3, 4) stands in for the camera's pose where a proof moves it.
    """

    camera: Camera
    camera_from_world: Array | None = None

    def __post_init__(self) -> None:
        if self.camera_from_world is not None:
            call = Arguments("ImageBatch")
            pose = call.array("camera_from_world", self.camera_from_world, (3, 4), finite=False)
            object.__setattr__(self, "camera_from_world", pose)


@dataclass(frozen=True)
class RenderOptions:
    """Policies of one rendering. The defaults are those of proofs: no early stop, no jitter."""

    stop: float = 0.0  # transmittance below which a ray ends; 0 is off
    jitter: bool = False  # move each ray's lattice by a random fraction of a step
    camera_adjoint: bool = False  # also dL/d "origins" and "directions", "points" of a canvas, or
    # "camera_from_world" of a picture
    keep_samples: bool = False  # for a backward pass that follows: networks keep what they found at
    # the samples, up to 256 MiB, instead of evaluating it again; the same bits

    def __post_init__(self) -> None:
        """Raises RangeError for a `stop` that is no transmittance below 1."""
        Arguments("RenderOptions").number("stop", self.stop, low=0, below=1)


@dataclass(frozen=True)
class Outputs:
    """One rendering of R rays, pixels or points. `color` (R, 3) is premultiplied, without
    background.

    opacity (R,); depth (R,) is the sum of weight * distance in meters, along the ray or, of
    pictures, along the viewing axis: divide by opacity for a mean distance. Both are None where the
    representation has no such thing, as on a canvas.
    """

    color: Array
    opacity: Array | None = None
    depth: Array | None = None

    def checked(self, function: str, batch: RayBatch | CanvasBatch | ImageBatch) -> Outputs:
        """These outputs, as `function` returns them for `batch`.

        Raises Error, naming the first pixel or point, if one is not finite.
        """

        def name_of(at: tuple[int, ...]) -> str:
            if isinstance(batch, ImageBatch):
                row, column = divmod(at[0], batch.camera.width)
                return f"pixel ({column}, {row})"
            return (
                f"pixel {int(batch.pixel[at[0]])}"
                if isinstance(batch, RayBatch)
                else f"point {at[0]}"
            )

        require_finite(function, vars(self), name_of)
        return self
