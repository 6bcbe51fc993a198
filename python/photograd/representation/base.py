"""The protocol that every scene representation speaks, and the registry of those that exist."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np
from photograd_course.optim import Gradient
from photograd_course.row_map import RowMap

from photograd.errors import DtypeError, RangeError, message
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


FRAMES = ("world", "grid", "canvas", "none")
"""Where positions among parameters may live."""


@dataclass(frozen=True)
class ParamSpec:
    """What an optimizer, a picture and a proof must know about one group of parameters.

    Attributes:
        shape: of the group's array.
        unit: "1" for pure numbers, else as in "1/m".
        range: values that make sense.
        learning_rate: for Adam.
        frame: where positions live: "world", "grid", "canvas", or "none".
    """

    shape: tuple[int, ...]
    unit: str
    range: tuple[float, float]
    learning_rate: float
    frame: str


class Representation(ABC):
    """A scene as arrays of parameters, rendered and differentiated.

    A class of its own sets `name` and `capabilities`, and each instance sets `params`;
    docs/five_tasks.md shows a whole one. `photograd.check_gradients` proves its adjoint, with
    `example` and `example_batch`. To be fitted to a capture it has to be a `Fittable`.

    Attributes:
        name: what options, files and the registry call it.
        capabilities: what `render` takes, of `CAPABILITIES`: "rays" (`RayBatch`), "image"
            (`ImageBatch`), "canvas2d" (`CanvasBatch`), "path".
        color_space: of the colors it renders, "linear" or "display".
        teaching_example: why no capture can be fitted with it; empty for what is a `Fittable`.
        no_camera_adjoint: why `render` refuses `camera_adjoint`; empty where it does not.
        params: the arrays that are optimized, by the names of `param_groups`.
    """

    name: ClassVar[str]
    capabilities: ClassVar[frozenset[str]]
    color_space: ClassVar[str] = "linear"
    teaching_example: ClassVar[str] = ""
    no_camera_adjoint: ClassVar[str] = ""
    params: dict[str, Array]

    @classmethod
    @abstractmethod
    def example(cls, *, seed: int, dtype: type[np.floating[Any]] = np.float64) -> Representation:
        """A small instance with lively values, for proofs and pictures.

        Args:
            seed: other seeds, other values.
            dtype: of the parameters.
        """

    @abstractmethod
    def example_batch(self, *, seed: int) -> Any:
        """A batch that sees something of `example`.

        Args:
            seed: other seeds, other rays or points.
        """

    @abstractmethod
    def param_groups(self) -> Mapping[str, ParamSpec]:
        """Every group of parameters, by name."""

    @abstractmethod
    def render(
        self, batch: Any, *, seed: int, step: int, options: RenderOptions
    ) -> tuple[Outputs, Any]:
        """Outputs for the batch, and the context that `render_backward` needs.

        The context keeps the parameters that it was made with, also if `params` changes later.

        Args:
            batch: of the kind that `capabilities` names.
            seed: of random numbers, such as jitter.
            step: of the fit, for other random numbers at each.
            options: policies of this rendering.
        """

    @abstractmethod
    def render_backward(self, context: Any, d_outputs: Outputs) -> Gradients:
        """dL/d parameters for the rendering that left `context`, given dL/d outputs.

        Args:
            context: the second result of `render`.
            d_outputs: of the shapes of the outputs; None for an output stands for zeros.
        """

    def priors(self) -> Sequence[Prior]:
        """Regularizers that make sense for this representation."""
        return ()

    def refine(self, step: int, statistics: Mapping[str, Array]) -> RowMap | None:
        """Change the number of rows of `params`; None if nothing changed.

        The optimizer applies the returned map (rows kept, cloned, split, added) to its own state.
        Contexts of earlier renderings keep the parameters that they were made with.

        Args:
            step: of the fit.
            statistics: arrays that the caller has collected.
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


CAPABILITIES = frozenset({"rays", "image", "canvas2d", "path"})
REGISTERED: dict[str, type[Representation]] = {}
"""By name; `photograd.fields.representations` fills it, by importing them all."""


def register(cls: type[Representation]) -> type[Representation]:
    """Class decorator: makes a representation known under `cls.name`.

    If it is a `Fittable`, commands and `photograd.fit` take the name.

    Raises:
        DtypeError: no subclass of `Representation`, or one that lacks an abstract method.
        RangeError: no name, the name of another class, or an unknown capability.
    """
    if not (isinstance(cls, type) and issubclass(cls, Representation)):
        raise DtypeError(message("register", "cls", "a subclass of Representation", f"{cls!r}"))
    if missing := sorted(cls.__abstractmethods__):
        raise DtypeError(message("register", "cls", f"the methods {', '.join(missing)}", "none"))
    name, others = getattr(cls, "name", ""), REGISTERED.get(getattr(cls, "name", ""))
    if not isinstance(name, str) or not name:
        raise RangeError(message("register", f"{cls.__name__}.name", "a name", repr(name)))
    if others is not None and others.__qualname__ != cls.__qualname__:
        got = f"{name!r}, the name of {others.__qualname__}"
        raise RangeError(message("register", f"{cls.__name__}.name", "a new name", got))
    capabilities = getattr(cls, "capabilities", None)
    if not isinstance(capabilities, frozenset) or not capabilities <= CAPABILITIES:
        expected = f"a frozenset of {', '.join(sorted(CAPABILITIES))}"
        raise RangeError(
            message("register", f"{cls.__name__}.capabilities", expected, f"{capabilities!r}")
        )
    REGISTERED[name] = cls
    return cls
