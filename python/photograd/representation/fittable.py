"""What a fit, a comparison and a picture of gradients ask of a representation, besides.

The loop, the commands and the checkpoints call these methods; none of them asks what kind of field
it has.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal, Protocol, Self

from photograd_course.optim import Optimizer
from photograd_course.schedules import exponential

from photograd._checkpoint import Row, write_npz
from photograd._fit_options import FitOptions
from photograd.capture.bounds import Bounds
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.representation.base import REGISTERED, Representation
from photograd.representation.batches import RayBatch
from photograd.types import Array

COPIES = 4
"""A parameter, its gradient and two moments; also the 1.1 GB measured for 256³ voxels."""


@dataclass(frozen=True)
class Memory:
    """Bytes that a fit takes for one reason."""

    option: str  # that decides it
    what: str
    size: int
    remedy: str


@dataclass(frozen=True)
class Start:
    """What a fit begins with.

    Attributes:
        capture, bounds, options: of the fit.
        field: of the model to start from, or None.
        points: points(count) returns places (N, 3) in meters on what that model shows, and display
            colors (N, 3); None without a model.
    """

    capture: Capture
    bounds: Bounds
    options: FitOptions
    field: Fittable | None = None
    points: Callable[[int], tuple[Array, Array]] | None = None


class FitInProgress(Protocol):
    """What a field may ask of the fit that changes it, before step `step_number`."""

    step_number: int
    options: FitOptions

    @property
    def optimizer(self) -> Optimizer:
        """Its moments belong to the field's parameters."""

    def batches(self, max_rays: int) -> Iterator[RayBatch]:
        """Rays of all training views, evenly spaced.

        Args:
            max_rays: about so many in all.
        """

    def mean_gradient(self, group: str, max_rays: int) -> Array:
        """dL/d params[group] of the loss over all training views, from evenly spaced rays.

        Args:
            group: of parameters.
            max_rays: about so many in all.
        """


class Fittable(Representation):
    """A representation that a capture can start, and a fit improve.

    Fields with the capability "rays" are fitted to random pixels and have linear colors; others
    are fitted to whole views and have display colors.
    """

    policy: Any
    """How it is drawn: a dataclass of plain values, for checkpoints."""
    fit_defaults: ClassVar[Mapping[str, Any]] = {}
    """Fields of FitOptions with another default."""
    fit_options: ClassVar[frozenset[str]] = frozenset()
    """Fields of FitOptions that have an effect here, but not on every representation."""
    first_model: ClassVar[Literal["refused", "optional", "required"]] = "refused"
    """Whether a fit may, or must, start from another model."""
    first_model_kinds: ClassVar[tuple[str, ...]] = ()
    """Names of the representations of such a model; empty for all."""
    same_resolution: ClassVar[bool] = True
    """Whether `resolution` counts the same in such a model and here."""
    first_model_help: ClassVar[str] = "it starts by itself"
    keeps_background: ClassVar[bool] = False
    """Whether the background of that model is a better start than the mean of the photographs."""
    size_option: ClassVar[str] = "resolution"
    """Field of FitOptions that says how large it is."""
    counts: ClassVar[str] = "grid"
    """What `resolution` counts, for a progress bar."""
    row_updates: ClassVar[bool] = True
    """Whether Adam leaves rows without a gradient alone."""
    gradient_picture: ClassVar[str] = "groups"
    """A key of `photograd.commands.gradients.DRAWERS`."""
    export_suffixes: ClassVar[tuple[str, ...]] = (".npz",)
    """Of files that `export` writes."""
    exported_as: ClassVar[str] = ""
    """File that a finished fit leaves for other programs; empty for none."""

    @property
    @abstractmethod
    def box(self) -> Array:
        """(2, 3) corners of what is worth looking at, in world meters."""

    @property
    @abstractmethod
    def resolution(self) -> int:
        """Its size, in the unit of `counts`."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Size of its arrays, for people."""
        return tuple(n for values in self.params.values() for n in values.shape)

    @property
    def dt(self) -> float | None:
        """Distance of samples along a ray in meters; None where nothing is sampled."""
        return None

    def with_dt(self, dt: float) -> Self:
        """The same field with samples at another distance; parameters are shared.

        Args:
            dt: distance of samples along a ray in meters.
        """
        raise RangeError(message(f"{self.name}.with_dt", "dt", "a field with samples", dt))

    @classmethod
    @abstractmethod
    def start(cls, start: Start) -> tuple[Self, str]:
        """What a fit begins with, and a sentence on where it comes from.

        Args:
            start: photographs, their box, options, and a model to start from.
        """

    @classmethod
    @abstractmethod
    def checkpoint_rows(cls, options: FitOptions) -> tuple[dict[str, Row], dict[str, Row]]:
        """Types and shapes of the parameters and of the state in a checkpoint.

        Args:
            options: of the fit.

        Returns:
            {group: (names of dtypes, shape)} of each, such as {"values": (("float32",), (8, 3))}.
        """

    @classmethod
    @abstractmethod
    def restored(
        cls,
        params: Mapping[str, Array],
        state: Mapping[str, Array],
        policy: object,
        options: FitOptions,
    ) -> Self:
        """The field of a checkpoint whose arrays fit `checkpoint_rows`; `policy` as JSON has it.

        Raises Error where a policy or the values of the state make no sense.

        Args:
            params: of the checkpoint.
            state: of the checkpoint.
            policy: as JSON has it.
            options: of the fit.
        """

    @classmethod
    def memory(cls, box: Array, options: FitOptions, available: int) -> Sequence[Memory]:
        """Lower bounds of what a fit in a box (2, 3) takes, besides photographs and rays.

        Args:
            box: (2, 3) of the scene, in meters.
            options: of the fit.
            available: bytes that there are.
        """
        del box, options, available
        return ()

    def learning_rates(self, options: FitOptions, step: int) -> dict[str, float]:
        """Of every group at a step.

        Args:
            options: of the fit.
            step: its number.
        """
        rate = options.learning_rate * exponential(options.final_rate, options.steps)(step)
        return {name: spec.learning_rate * rate for name, spec in self.param_groups().items()}

    def adapted(self, fit: FitInProgress) -> Fittable:
        """This field, or the one that takes its place, before a step.

        It may have another resolution or other rows; the moments of `fit.optimizer` go along.
        """
        del fit
        return self

    def observe(self, context: Any, gradients: dict[str, Array]) -> None:
        """Take notice of a training batch after its backward pass, and add gradients of its own.

        Args:
            context: of the batch's rendering.
            gradients: by group, changed in place.
        """

    def add_prior(self, gradients: Mapping[str, Array], weight: float, u: float) -> None:
        """Add the prior's gradient on a part of the parameters that stands for all of them.

        `u` in [0, 1) says which part.

        Args:
            gradients: by group, changed in place.
            weight: `FitOptions.total_variation`.
            u: a random number in [0, 1).
        """

    def after_step(self, rates: Mapping[str, float], step: int) -> None:
        """What follows the optimizer's step.

        Args:
            rates: learning rates by group.
            step: its number.
        """

    @classmethod
    def events(cls, options: FitOptions) -> dict[int, str]:
        """{step: label} of changes that a curve of the loss should mark.

        Args:
            options: of the fit.
        """
        del options
        return {}

    @classmethod
    def frozen_at(cls, options: FitOptions) -> int | None:
        """The step from which on its structure can be held; None if nothing of it is discrete.

        Args:
            options: of the fit.
        """
        del options
        return None

    def freeze(self) -> None:
        """Hold the structure from here on, where a fit would still change it."""

    def stored(self) -> dict[str, Array]:
        """The arrays without which it could not be drawn."""
        return {**self.params, **self.state()}

    def gradient_image(self, gradients: Mapping[str, Array]) -> Array | None:
        """(H, W) what a signed picture of the parameters' gradient shows; None for no picture.

        Args:
            gradients: by group.
        """
        del gradients
        return None

    def export(self, path: Path, background: Array | None) -> tuple[str, ...]:
        """Write it for other programs, by `export_suffixes`; returns notes on what they must know.

        Here: parameters, state and box as NumPy arrays, with the linear background (3,).

        Raises IoError if that fails.

        Args:
            path: of the file.
            background: linear (3,), or None.
        """
        arrays = {**self.stored(), "box": self.box}
        if background is not None:
            arrays["background"] = background
        write_npz(path, arrays)
        return ()


def fittable() -> dict[str, type[Fittable]]:
    """The registered representations that a capture can start, by name, in alphabetical order."""
    return {name: cls for name, cls in sorted(REGISTERED.items()) if issubclass(cls, Fittable)}
