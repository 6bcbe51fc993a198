"""Does the gradient of the loss point the right way? Its sign, weighed by its size, in two regions.

From a start of low sigma_t, descent must add matter where the scene has some (dL/dsigma_t < 0)
and take it away where cameras see nothing but background (dL/dsigma_t > 0). About the remaining
empty voxels, hidden behind matter or seen in front of it, no sign is claimed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..checks import require_mask
from ..errors import RangeError, message
from .checks import check_field


@dataclass(frozen=True)
class SignReport:
    """Shares of the mass sum |dL/dsigma_t| that have the expected sign, and what they rest on."""

    occupied_fraction: float  # of the mass in occupied voxels: share that is negative
    background_fraction: float  # of the mass in background-only voxels: share that is positive
    occupied_mass: float  # sum of |d_sigma_t| over occupied voxels
    background_mass: float  # the same over background-only voxels
    other_mass: float  # the same over the voxels nothing is claimed about
    occupied_voxels: int
    background_voxels: int
    other_voxels: int

    def holds(self, least: float = 0.95) -> bool:
        """Whether both shares reach ``least``."""
        return self.occupied_fraction >= least and self.background_fraction >= least

    def caption(self) -> str:
        """The sentences that belong under a picture of this gradient."""
        return (
            f"By mass of |gradient|, {self.occupied_fraction:.1%} is negative in the "
            f"{self.occupied_voxels} occupied voxels (blue: matter must appear) and "
            f"{self.background_fraction:.1%} is positive in the {self.background_voxels} voxels "
            f"seen only against the background (red: they must stay empty). The other "
            f"{self.other_voxels} empty voxels are shown, not asserted: hidden by matter or seen "
            "in front of it, they may have either sign."
        )


def sign_report(
    d_sigma_t: NDArray[np.floating],
    *,
    occupied: NDArray[np.bool_],
    background_only: NDArray[np.bool_],
) -> SignReport:
    """Weigh the signs of a gradient in the occupied and in the background-only voxels.

    Args:
        d_sigma_t: (X, Y, Z) dL/dsigma_t, float32 or float64.
        occupied: (X, Y, Z) voxels inside the true object.
        background_only: (X, Y, Z) empty voxels all of whose rays end in the background.

    Raises:
        DtypeError, ShapeError: wrong arrays.
        RangeError: the masks overlap, one is empty, or the gradient is zero all over one of them
            (then there is no sign to speak of).
    """
    function = "sign_report"
    gradient = check_field(function, "d_sigma_t", d_sigma_t).astype(np.float64)
    require_mask(function, "occupied", occupied, gradient.shape)
    require_mask(function, "background_only", background_only, gradient.shape)
    overlap = int((occupied & background_only).sum())
    if overlap:
        raise RangeError(
            message(function, "background_only", "no voxel that is occupied too", f"{overlap}")
        )
    occupied_mass, negative = _weigh(function, "occupied", -gradient[occupied])
    background_mass, positive = _weigh(function, "background_only", gradient[background_only])
    other = ~(occupied | background_only)
    return SignReport(
        occupied_fraction=negative / occupied_mass,
        background_fraction=positive / background_mass,
        occupied_mass=occupied_mass,
        background_mass=background_mass,
        other_mass=float(np.abs(gradient[other]).sum()),
        occupied_voxels=int(occupied.sum()),
        background_voxels=int(background_only.sum()),
        other_voxels=int(other.sum()),
    )


def _weigh(function: str, argument: str, values: NDArray[np.float64]) -> tuple[float, float]:
    """The mass of ``values`` and the part of it that is positive."""
    if values.size == 0:
        raise RangeError(message(function, argument, "at least one True voxel", "none"))
    mass = float(np.abs(values).sum())
    if mass == 0.0:
        got = f"zero in all {values.size} voxels"
        remedy = "do the cameras see them? is the picture empty?"
        raise RangeError(message(function, argument, "a gradient that is not zero", got, remedy))
    return mass, float(values[values > 0.0].sum())
