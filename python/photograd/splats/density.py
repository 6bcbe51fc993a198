"""Density control: what decides how many Gaussians there are, and where.

A Gaussian whose mean gets large gradients from every picture covers something that one Gaussian
cannot explain. The measure is |dL/d mean| on the screen, averaged over the pictures that show it,
in units of half the picture's longer side:

    p_n = mean over pictures of  |dL/d(u, v)_n| max(W, H) / 2          (u, v) in pixels

The loss is a mean over pixels, so a Gaussian's share of it does not depend on the picture's size,
while moving by a pixel means half as much at twice the size. With the factor, a threshold means the
same at every resolution: `threshold` divided by max(W, H) / 2 is the one per pixel [Kerbl2023].

Gradients move what is there; they cannot add a Gaussian where one is missing, or remove one that
nobody needs. A `DensityControl` does, at some steps of a fit, and says what the optimizer must
know: which rows came from where, and which groups begin anew.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import log, log1p, matmul, sigmoid
from photograd_course.row_map import RowMap

from photograd._arrays import Arguments
from photograd._checks import require_bounds
from photograd.capture.camera import Camera
from photograd.types import Array


def rotation_matrices(quats: Array) -> Array:
    """(N, 3, 3) float64 of quaternions (N, 4) as (w, x, y, z), of any length; zero ones turn
    nothing.

    R = I + 2 w [v]x + 2 [v]x [v]x for a unit quaternion (w, v). [Shoemake1985]

    Raises:
        DtypeError, ShapeError: `quats` is not (N, 4) numbers.
    """
    call = Arguments("rotation_matrices", np.float64)
    q = call.array("quats", quats, ("N", 4), finite=False)
    length = np.linalg.norm(q, axis=1, keepdims=True)
    w, x, y, z = (np.where(length > 0, q / np.where(length > 0, length, 1), [1, 0, 0, 0])).T
    zero = np.zeros_like(w)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(-1, 3, 3)
    turned: Array = np.eye(3) + 2 * w[:, None, None] * cross + 2 * matmul(cross, cross)
    return turned


# Positional gradient statistics (grad2d): the criterion of density control.


@dataclass(eq=False)
class Grad2dStatistics:
    """Sums since the last refinement: total (N,) float64 of p_n, count (N,) int64 of pictures."""

    total: Array
    count: NDArray[np.int64]

    @classmethod
    def zero(cls, count: int) -> Grad2dStatistics:
        """Of `count` Gaussians that no picture has shown."""
        return cls(np.zeros(count), np.zeros(count, np.int64))

    def checked(self, count: int) -> Grad2dStatistics:
        """Itself. Raises ShapeError or RangeError unless it belongs to `count` Gaussians."""
        call = Arguments("Grad2dStatistics", np.float64)
        call.array("total", self.total, (count,), low=0)
        call.array("count", self.count, (count,), dtype=np.int64, low=0)
        return self

    def add(self, screen: Array, visible: NDArray[np.bool_], camera: Camera) -> None:
        """Add a picture: dL/d projected means (N, 2) per pixel, and which were in it (N,).

        Args:
            screen: (N, 2).
            visible: (N,).
            camera: of the picture.
        """
        half = max(camera.width, camera.height) / 2
        self.total += half * np.linalg.norm(screen.astype(np.float64), axis=1)
        self.count += visible

    def mean(self) -> Array:
        """The measure p (N,); 0 for Gaussians that no picture has shown."""
        found: Array = self.total / np.maximum(self.count, 1)
        return found


# Density control: what decides how many Gaussians there are, and where.


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
        require_bounds(self, "first", "last", low=0)
        require_bounds(self, "every", low=1)

    def due(self, step: int) -> bool:
        """Whether something happens before this step."""
        return self.first <= step < self.last and step % self.every == 0


class DensityControl(ABC):
    """A strategy; its random numbers are a function of its seed and the step."""

    first_share: ClassVar[float] = 1.0
    """Of the budget, with which a fit begins."""

    @abstractmethod
    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """What becomes of the Gaussians before this step; None if nothing changes.

        Args:
            params: of the Gaussians, by group.
            grad2d: positional gradients since the last change.
            extent: of the scene, in meters.
            step: of the fit.
        """

    def add_priors(self, params: Params, gradients: dict[str, Array], *, extent: float) -> None:
        """Add the gradient of what the strategy wants besides the photographs.

        Args:
            params: of the Gaussians, by group.
            gradients: of the loss, changed in place.
            extent: of the scene, in meters.
        """
        del params, gradients, extent

    def explore(self, params: Params, *, extent: float, rate: float, step: int) -> None:
        """Move Gaussians at random, in place, after a step; `rate` is that of the means, in m.

        Args:
            params: of the Gaussians, by group.
            extent: of the scene, in meters.
            rate: learning rate of the means.
            step: of the fit.
        """
        del params, extent, rate, step


class NoControl(DensityControl):
    """Leaves the number of Gaussians as it is."""

    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """None.

        Args:
            params: not used.
            grad2d: not used.
            extent: not used.
            step: not used.
        """
        del params, grad2d, extent, step
        return None


def opacities(params: Params) -> Array:
    """(N,) float64 in 0 .. 1, of the logits.

    Args:
        params: of the Gaussians, by group.
    """
    return sigmoid(params["opacity_logits"].astype(np.float64))


def logits(opacity: Array) -> Array:
    """The inverse of the sigmoid, (N,) float64, finite for 0 and 1.

    Args:
        opacity: (N,) in 0 to 1.
    """
    held = np.clip(opacity, 1e-7, 1 - 1e-7)
    return np.asarray(log(held) - log1p(-held))


def rebuilt(
    params: Params, kept: Array, added: Mapping[str, Array]
) -> tuple[dict[str, Array], RowMap]:
    """The rows `kept` (M,) in their order, then those of `added`, which are fresh.

    Args:
        params: of the Gaussians, by group.
        kept: (M,) numbers of rows.
        added: rows of each group.
    """
    after: dict[str, Any] = {
        name: np.concatenate([array[kept], added[name].astype(array.dtype)])
        for name, array in params.items()
    }
    fresh = np.full(len(added["means"]), -1, np.int64)
    source = np.concatenate([kept.astype(np.int64), fresh])
    return after, RowMap(source, source_count=len(params["means"]))
