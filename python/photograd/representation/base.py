"""The protocol that every scene representation speaks, and the registry of those that exist."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np
from photograd_course.optim import Gradient
from photograd_course.row_map import RowMap

from photograd.errors import RangeError, message
from photograd.representation.batches import Outputs, RenderOptions
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
    """What an optimizer, a picture and a proof must know about one group of parameters."""

    shape: tuple[int, ...]
    unit: str  # "1" for pure numbers
    range: tuple[float, float]  # values that make sense; proofs draw from its inside
    learning_rate: float  # for Adam
    frame: str  # where positions live: "world", "grid", "canvas", "none"


class Representation(ABC):
    """A scene as arrays of parameters, rendered and differentiated."""

    name: ClassVar[str]
    capabilities: ClassVar[frozenset[str]]  # of "rays", "image", "canvas2d", "path"
    color_space: ClassVar[str] = "linear"
    teaching_example: ClassVar[str] = ""
    """Why no capture can be fitted with it; empty for what is a `Fittable`."""
    no_camera_adjoint: ClassVar[str] = ""
    """Why `render` refuses `camera_adjoint`; empty where it does not."""
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
        """Regularizers that make sense for this representation."""
        return ()

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """Change the number of rows of `params`; None if nothing changed.

        The optimizer applies the returned map (rows kept, cloned, split, added) to its own state.
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
    """A regularizer of one group: `value(parameter)` and its derivative.

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
