"""Is dL/dsigma_t negative where matter must appear, and positive where only background is seen?

Many views around a scene see every voxel before or behind matter in one of them; then no voxel is
left that is seen against the background alone, and the claim would be empty. It is therefore put to
the loss of as many training views as leave both kinds of voxels, and says how many they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from photograd_course.viz import SignReport, sign_report

from photograd.capture.capture import Capture
from photograd.fields.voxel_field import VoxelField
from photograd.fitting.data import TrainingPixels
from photograd.fitting.voxel_gradients import density_gradient, voxel_masks
from photograd.types import Array

VIEW_COUNTS = (48, 24, 12, 6)  # tried after all of them
ENOUGH = 30  # voxels of each kind; with fewer, fewer views may leave more


@dataclass(frozen=True)
class SignClaim:
    """The gradient (X, Y, Z) of the loss of `views` out of `all_views` views, and its signs."""

    report: SignReport
    d_sigma_t: Array
    occupied: NDArray[np.bool_]
    views: int
    all_views: int

    def caption(self) -> str:
        """The sentences that belong under a picture of this gradient."""
        if self.views == self.all_views:
            return self.report.caption()
        return (
            f"Loss of {self.views} of the {self.all_views} training views: more would leave few or "
            f"no voxels that are seen against the background alone. {self.report.caption()}"
        )


def sign_claim(
    field: VoxelField, capture: Capture, *, rays: int, seed: int, background: Array | None = None
) -> SignClaim | None:
    """Weigh the signs of the first gradient; None if voxels of one kind are missing throughout.

    Raises RangeError if the capture has no alpha.

    Args:
        field: a nearly transparent start.
        capture: photographs with alpha.
        rays: training pixels of the gradient.
        seed: of their choice.
        background: linear (3,), or None for random ones.
    """
    total, most, best = len(capture.train), 0, None
    for count in (total, *(n for n in VIEW_COUNTS if n < total)):
        masks = voxel_masks(field, capture.subsample(count))
        voxels = int(min(masks.occupied.sum(), masks.background_only.sum()))
        if voxels > most:
            most, best = voxels, (count, masks)
        if most >= ENOUGH:
            break
    if best is None:
        return None
    count, masks = best
    part = capture.subsample(count)
    pixels = TrainingPixels(part.train, part.color_space)
    found = density_gradient(field, pixels, seed=seed, background=background, rays=rays)
    report = sign_report(
        found.d_sigma_t, occupied=masks.occupied, background_only=masks.background_only
    )
    return SignClaim(report, found.d_sigma_t, masks.occupied, count, total)
