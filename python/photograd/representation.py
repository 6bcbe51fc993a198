"""The protocol that every scene representation speaks, and the registry of those that exist.

One optimiser loop (`photograd.fitting.loop`), one gradient viewer and one set of proofs serve
everything that is registered here. Parameters are NumPy arrays; what is expensive to rebuild lives
in C++ objects.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray
from photograd_course.optim import Gradient
from photograd_course.row_map import RowMap

from photograd._checks import require_finite
from photograd.capture.camera import Camera
from photograd.errors import RangeError, ShapeError, message
from photograd.types import Array

Gradients: TypeAlias = Mapping[str, Gradient]
"""dL/d parameter by group: an array of the parameter's shape, or (rows, values): rows (M,) int64
strictly increasing, values (M, ...), for parameters of which only some rows were touched."""


def dense_gradient(gradient: Gradient, parameter: Array) -> Array:
    """A gradient in the shape of its parameter, whichever form it has; untouched rows are 0."""
    if not isinstance(gradient, tuple):
        return gradient
    rows, values = gradient
    dense = np.zeros_like(parameter)
    dense[rows] = values
    return dense


@dataclass(frozen=True)
class ParamSpec:
    """What an optimiser, a picture and a proof must know about one group of parameters."""

    shape: tuple[int, ...]
    unit: str  # "1" for pure numbers
    range: tuple[float, float]  # values that make sense; proofs draw from its inside
    learning_rate: float  # for Adam
    frame: str  # where positions live: "world", "grid", "canvas", "none"


@dataclass(frozen=True)
class RayBatch:
    """Rays: world origins (R, 3) in metres, unit directions (R, 3), pixel numbers (R,).

    `pixel` feeds the random numbers (jitter), so that a ray's numbers do not depend on its batch.
    """

    origins: Array
    directions: Array
    pixel: NDArray[np.uint32]

    def __post_init__(self) -> None:
        count = len(self.pixel)
        for name, array in (("origins", self.origins), ("directions", self.directions)):
            if array.shape != (count, 3):
                raise ShapeError(message("RayBatch", name, f"shape ({count}, 3)", f"{array.shape}"))


@dataclass(frozen=True)
class CanvasBatch:
    """Points (N, 2) on a 2D canvas, x to the right and y down, both in [0, 1]."""

    points: Array

    def __post_init__(self) -> None:
        if self.points.ndim != 2 or self.points.shape[1] != 2:
            raise ShapeError(
                message("CanvasBatch", "points", "shape (N, 2)", f"{self.points.shape}")
            )


@dataclass(frozen=True, eq=False)
class ImageBatch:
    """All pixels of a camera, row by row: for what is drawn a picture at a time.

    `camera_from_world` (3, 4) stands in for the camera's pose where a proof moves it.
    """

    camera: Camera
    camera_from_world: Array | None = None

    def __post_init__(self) -> None:
        if self.camera_from_world is not None and self.camera_from_world.shape != (3, 4):
            found = f"{self.camera_from_world.shape}"
            raise ShapeError(message("ImageBatch", "camera_from_world", "shape (3, 4)", found))


@dataclass(frozen=True)
class RenderOptions:
    """Policies of one rendering. The defaults are those of proofs: no early stop, no jitter."""

    stop: float = 0.0  # transmittance below which a ray ends; 0 is off
    jitter: bool = False  # move each ray's lattice by a random fraction of a step
    camera_adjoint: bool = False  # also dL/d "origins" and "directions", "points" of a canvas, or
    # "camera_from_world" of a picture

    def __post_init__(self) -> None:
        """Raises RangeError for a `stop` that is no transmittance below 1."""
        if not 0 <= self.stop < 1:
            expected = "a transmittance of at least 0 and below 1"
            raise RangeError(message("RenderOptions", "stop", expected, self.stop))


@dataclass(frozen=True)
class Outputs:
    """One rendering of R rays, pixels or points. `color` (R, 3) is premultiplied, without
    background.

    opacity (R,); depth (R,) is the sum of weight * distance in metres, along the ray or, of
    pictures, along the viewing axis: divide by opacity for a mean distance. Both are None where the
    representation has no such thing, as on a canvas.
    """

    color: Array
    opacity: Array | None = None
    depth: Array | None = None

    def checked(self, function: str, batch: RayBatch | CanvasBatch) -> Outputs:
        """These outputs, as `function` returns them for `batch`.

        Raises Error, naming the first pixel or point, if one is not finite.
        """
        pixel = batch.pixel if isinstance(batch, RayBatch) else None
        require_finite(
            function,
            vars(self),
            lambda at: f"point {at[0]}" if pixel is None else f"pixel {int(pixel[at[0]])}",
        )
        return self


class Representation(ABC):
    """A scene as arrays of parameters, rendered and differentiated."""

    name: ClassVar[str]
    capabilities: ClassVar[frozenset[str]]  # of "rays", "image", "canvas2d", "path"
    color_space: ClassVar[str] = "linear"
    params: dict[str, Array]

    @classmethod
    @abstractmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Representation:
        """A small instance with lively values, for proofs and pictures."""

    @abstractmethod
    def example_batch(self, *, seed: int) -> Any:
        """A batch that sees something of `example`."""

    @abstractmethod
    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Every group of parameters, by name."""

    @abstractmethod
    def render(
        self, batch: Any, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, Any]:
        """Outputs for the batch, and the context that `render_backward` needs."""

    @abstractmethod
    def render_backward(self, context: Any, d_outputs: Outputs) -> Gradients:
        """dL/d parameters for the rendering that left `context`, given dL/d outputs."""

    def priors(self) -> Sequence[Prior]:
        """Regularisers that make sense for this representation."""
        return ()

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """Change the number of rows of `params`; None if nothing changed.

        The optimiser applies the returned map (rows kept, cloned, split, added) to its own state.
        Contexts of earlier renderings keep the parameters that they were made with.
        """
        del step, statistics
        return None

    def state(self) -> dict[str, Array]:
        """What is neither a parameter nor derived from them, for checkpoints."""
        return {}

    def load_state(self, state: Mapping[str, Array]) -> None:
        """Restore what `state` returned."""
        if state:
            raise RangeError(
                message(f"{self.name}.load_state", "state", "no entries", f"{sorted(state)}")
            )


@dataclass(frozen=True)
class Prior:
    """A regulariser of one group: `value(parameter)` and its derivative.

    `gradient(parameter, d_value)` returns dL/d parameter for dL/d value, the weight of the prior.
    """

    name: str
    group: str
    value: Callable[[Array], float]
    gradient: Callable[..., Array]


REGISTERED: dict[str, type[Representation]] = {}
"""By name; `photograd.fields.representations` fills it, by importing them all."""


def register(cls: type[Representation]) -> type[Representation]:
    """Class decorator: makes a representation known to fit, viewers and proofs under `cls.name`."""
    REGISTERED[cls.name] = cls
    return cls
