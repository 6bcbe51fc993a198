"""What every light can be asked, and the checks of what it is asked with."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from photograd.errors import DtypeError, RangeError, ShapeError, message
from photograd.types import Array


@dataclass(frozen=True)
class LightSamples:
    """One sample for each of N points.

    An estimate of reflected light is f(wo, direction) cos radiance / pdf, where pdf > 0 and nothing
    stands between the point and the light.

    Attributes:
        direction: (N, 3), unit, from the point towards the light, in the world.
        distance: (N,), m; infinite for lights at infinity.
        radiance: (N, 3), W/(m^2 sr); of a delta light the irradiance of what faces it, W/m^2.
        pdf: (N,), density over solid angle, 1/sr; 1 for a delta light; 0 where nothing arrives,
            and the rest of the row then means nothing.
        is_delta: no ray ever hits the light: it has weight 1 in multiple importance sampling.
    """

    direction: Array
    distance: Array
    radiance: Array
    pdf: Array
    is_delta: bool


class Light(ABC):
    """Calls of the core, with points (N, 3) in the world, in the dtype of the points.

    All raise DtypeError for arrays that are not float32 or float64, ShapeError for other shapes,
    and RangeError for numbers that are not finite, directions that are not of unit length, and
    u2 outside of [0, 1).
    """

    is_delta: ClassVar[bool] = False

    @abstractmethod
    def core_call(self, dtype: npt.DTypeLike) -> tuple[Any, tuple[Array, ...]]:
        """The core's functions and their leading arguments; the first is what is differentiated."""

    @abstractmethod
    def named(self, derivative: Array) -> dict[str, Array]:
        """A derivative in the form of that first argument, by name."""

    def sample(self, points: Array, u2: Array) -> LightSamples:
        """One direction towards the light for each point, from uniform u2 (N, 2)."""
        points, u2 = checked_points(points), checked_rows("u2", u2, points, 2)
        if len(u2) and not (u2.min() >= 0.0 and u2.max() < 1.0):
            got = f"[{u2.min()}, {u2.max()}]"
            raise RangeError(message("sample", "u2", "numbers in [0, 1)", got))
        core, leading = self.core_call(points.dtype)
        direction, distance, radiance, pdf = core.sample(*leading, points, u2)
        return LightSamples(direction, distance, radiance, pdf, self.is_delta)

    def L(self, points: Array, w: Array) -> Array:
        """What arrives at the points from w (N, 3), W/(m^2 sr); 0 of delta lights."""
        points, w = checked_points(points), checked_directions(w, points)
        core, leading = self.core_call(points.dtype)
        found: Array = core.radiance(*leading, points, w)
        return found

    def pdf(self, points: Array, w: Array) -> Array:
        """Density (N,) over solid angle with which `sample` draws w; 0 of delta lights."""
        points, w = checked_points(points), checked_directions(w, points)
        core, leading = self.core_call(points.dtype)
        density: Array = core.pdf(*leading, points, w)
        return density

    def L_backward(self, points: Array, w: Array, d_L: Array) -> dict[str, Array]:
        """dL/dparameters of dL/d(L(points, w)) (N, 3), by name."""
        return self._backward("radiance_backward", points, w, d_L)

    def sample_backward(
        self, points: Array, samples: LightSamples, d_radiance: Array
    ) -> dict[str, Array]:
        """dL/dparameters of dL/d(samples.radiance) (N, 3), by name.

        Which directions were drawn, and how densely, is held constant. Rows with pdf = 0 must have
        a d_radiance of 0: nothing arrived there.
        """
        return self._backward("sample_backward", points, samples.direction, d_radiance)

    def _backward(
        self, function: str, points: Array, w: Array, d_radiance: Array
    ) -> dict[str, Array]:
        points = checked_points(points)
        w, d_radiance = (
            checked_rows(name, array, points, 3)
            for name, array in (("w", w), ("d_radiance", d_radiance))
        )
        core, leading = self.core_call(points.dtype)
        d = np.zeros_like(leading[0])
        return self.named(getattr(core, function)(*leading, points, w, d_radiance, d))


def checked_points(points: Array) -> Array:
    """Points (N, 3), contiguous, of a floating dtype and finite."""
    if not isinstance(points, np.ndarray) or points.dtype not in (np.float32, np.float64):
        got = getattr(points, "dtype", type(points).__name__)
        raise DtypeError(message("light", "points", "a float32 or float64 array", got))
    return checked_rows("points", points, points, 3)


def checked_rows(name: str, array: Array, points: Array, columns: int) -> Array:
    """An array (N, columns) of finite numbers, as many rows as points, in their dtype."""
    array = np.asarray(array)
    if array.ndim != 2 or array.shape != (len(points), columns):
        expected = f"shape (N, {columns}) with N = {len(points)} as in points"
        raise ShapeError(message("light", name, expected, array.shape))
    if array.dtype != points.dtype:
        raise DtypeError(message("light", name, f"{points.dtype} as points", array.dtype))
    if not np.isfinite(array).all():
        row = int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])
        raise RangeError(message("light", name, "finite numbers", f"{array[row]} in row {row}"))
    return np.ascontiguousarray(array)


def checked_directions(w: Array, points: Array) -> Array:
    """Directions (N, 3) of unit length, to a thousandth."""
    w = checked_rows("w", w, points, 3)
    gap = np.abs((w * w).sum(axis=1) - 1.0)
    if len(w) and gap.max() > 2e-3:
        row = int(gap.argmax())
        raise RangeError(
            message("light", "w", "unit length", f"{w[row]} in row {row}", "divide by the norm")
        )
    return w


def unit_vector(light: str, name: str, value: Any) -> Array:
    """`value` (3,), divided by its length.

    Raises:
        ShapeError, RangeError: not three numbers, or of no finite length.
    """
    vector = np.asarray(value, np.float64)
    if vector.shape != (3,):
        raise ShapeError(message(light, name, "shape (3,)", vector.shape))
    norm = float(np.linalg.norm(vector))
    if not 0.0 < norm < np.inf:
        raise RangeError(message(light, name, "a direction", vector))
    return np.asarray(vector / norm)
