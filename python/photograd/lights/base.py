"""What every light can be asked, and the checks of what it is asked with."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.errors import RangeError, message
from photograd.types import Array


@typed_call
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


@typed_call
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
        call, points = self._called("sample", points)
        u2 = call.array("u2", u2, ("N", 2), low=0.0, below=1.0)
        core, leading = self.core_call(points.dtype)
        direction, distance, radiance, pdf = call.run(core.sample, *leading, points, u2)
        return LightSamples(direction, distance, radiance, pdf, self.is_delta)

    def L(self, points: Array, w: Array) -> Array:
        """What arrives at the points from w (N, 3), W/(m^2 sr); 0 of delta lights."""
        call, points = self._called("L", points)
        core, leading = self.core_call(points.dtype)
        found: Array = call.run(core.radiance, *leading, points, _directions(call, w))
        return found

    def pdf(self, points: Array, w: Array) -> Array:
        """Density (N,) over solid angle with which `sample` chooses w; 0 of delta lights."""
        call, points = self._called("pdf", points)
        core, leading = self.core_call(points.dtype)
        density: Array = call.run(core.pdf, *leading, points, _directions(call, w))
        return density

    def L_backward(self, points: Array, w: Array, d_L: Array) -> dict[str, Array]:
        """dL/dparameters of dL/d(L(points, w)) (N, 3), by name."""
        call, points = self._called("L_backward", points)
        return self._backward("radiance_backward", call, points, w=w, d_L=d_L)

    def sample_backward(
        self, points: Array, samples: LightSamples, d_radiance: Array
    ) -> dict[str, Array]:
        """dL/dparameters of dL/d(samples.radiance) (N, 3), by name.

        Which directions were sampled, and how densely, is held constant. Rows with pdf = 0 must
        have a d_radiance of 0: nothing arrived there.
        """
        call, points = self._called("sample_backward", points)
        rows = {"samples.direction": samples.direction, "d_radiance": d_radiance}
        return self._backward("sample_backward", call, points, **rows)

    def _called(self, function: str, points: Array) -> tuple[Arguments, Array]:
        call = Arguments(f"{type(self).__name__}.{function}")
        return call, call.array("points", points, ("N", 3))

    def _backward(
        self, function: str, call: Arguments, points: Array, **rows: Array
    ) -> dict[str, Array]:
        w, d_radiance = (call.array(name, array, ("N", 3)) for name, array in rows.items())
        core, leading = self.core_call(points.dtype)
        d = np.zeros_like(leading[0])
        return self.named(call.run(getattr(core, function), *leading, points, w, d_radiance, d))


def _directions(call: Arguments, w: Array) -> Array:
    """Directions (N, 3) of unit length, to a thousandth."""
    w = call.array("w", w, ("N", 3))
    gap = np.abs((w * w).sum(axis=1) - 1.0)
    if len(w) and gap.max() > 2e-3:
        row = int(gap.argmax())
        got = f"{w[row]} in row {row}"
        raise RangeError(message(call.function, "w", "unit length", got, "divide by the norm"))
    return w
