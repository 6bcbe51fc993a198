"""Density control: what decides how many Gaussians there are, and where.

Gradients move what is there; they cannot add a Gaussian where one is missing, or remove one that
nobody needs. A `DensityControl` does, at some steps of a fit, and says what the optimiser must
know: which rows came from where, and which groups begin anew.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.portable_math import log, log1p, sigmoid
from photograd_course.row_map import RowMap

from photograd.errors import RangeError, message
from photograd.splats.grad2d import Grad2dStatistics
from photograd.types import Array

Params = Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Change:
    """New parameters, and the rows they came from."""

    params: dict[str, Array]
    row_map: RowMap


@dataclass(frozen=True)
class Schedule:
    """Every `every` steps from `first` to before `last`."""

    first: int = 500
    last: int = 15_000
    every: int = 100

    def __post_init__(self) -> None:
        for name, least in (("first", 0), ("last", 0), ("every", 1)):
            if getattr(self, name) < least:
                found = getattr(self, name)
                raise RangeError(message("Schedule", name, f"{least} or more", f"{found}"))

    def due(self, step: int) -> bool:
        """Whether something happens before this step."""
        return self.first <= step < self.last and step % self.every == 0


class DensityControl(ABC):
    """A strategy; its random numbers are a function of its seed and the step."""

    @abstractmethod
    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """What becomes of the Gaussians before this step; None if nothing changes."""

    def add_priors(self, params: Params, gradients: dict[str, Array], *, extent: float) -> None:
        """Add the gradient of what the strategy wants besides the photographs."""
        del params, gradients, extent

    def explore(self, params: Params, *, extent: float, rate: float, step: int) -> None:
        """Move Gaussians at random, in place, after a step; `rate` is that of the means, in m."""
        del params, extent, rate, step


class NoControl(DensityControl):
    """Leaves the number of Gaussians as it is."""

    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """None."""
        del params, grad2d, extent, step
        return None


def opacities(params: Params) -> Array:
    """(N,) float64 in 0 .. 1, of the logits."""
    return sigmoid(params["opacity_logits"].astype(np.float64))


def logits(opacity: Array) -> Array:
    """The inverse of the sigmoid, (N,) float64, finite for 0 and 1."""
    held = np.clip(opacity, 1e-7, 1 - 1e-7)
    return np.asarray(log(held) - log1p(-held))


def rebuilt(
    params: Params, kept: Array, added: Mapping[str, Array]
) -> tuple[dict[str, Array], RowMap]:
    """The rows `kept` (M,) in their order, then those of `added`, which are fresh."""
    after: dict[str, Any] = {
        name: np.concatenate([array[kept], added[name].astype(array.dtype)])
        for name, array in params.items()
    }
    fresh = np.full(len(added["means"]), -1, np.int64)
    source = np.concatenate([kept.astype(np.int64), fresh])
    return after, RowMap(source, source_count=len(params["means"]))
