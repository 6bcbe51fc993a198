"""Where the paths of a derivative go: as many to each pixel, or more to those that matter.

A derivative is a sum over pixels of d_p times the mean of that pixel's n_p paths, so that its
variance is the sum of d_p^2 s_p^2 / n_p, s_p being the spread of one path's part. For a given sum
of n_p it is least where n_p grows as |d_p| s_p. s_p is not known, but d_p is, and for a loss of
squares few pixels (a highlight, the rim of a lamp) hold most of it.

Whatever n_p is, the mean of the estimate stays, as long as n_p knows nothing of these very paths:
it may follow d_image, which comes from other paths.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from photograd.errors import RangeError, message
from photograd.transport.accumulation import Accumulation
from photograd.types import Array

SPREADS = ("even", "cotangent")
EVEN_SHARE = 0.25
"""Of all paths: a pixel may hide a large s_p behind a small d_p, so that none goes without."""
PAIR_EVEN_SHARE = 0.75
"""The same where the paths serve the picture as well."""
AROUND = 2
"""Pixels to each side that are asked how much they vary; a pilot's few paths say little of one."""
MOST = 64
"""Times `spp`, so that one pixel does not keep one thread busy alone."""


def sample_counts(d_image: Array, spp: int, spread: str) -> Array | None:
    """Paths of each pixel, (H, W) uint32, at least 1; None where all have `spp`.

    Args:
        d_image: dL/dimage (H, W, 3).
        spp: paths a pixel, on average; the sum is off by the rounding of each pixel.
        spread: of `SPREADS`.

    Raises:
        RangeError: another spread.
    """
    if spread not in SPREADS:
        raise RangeError(message("render_backward", "spread", SPREADS, spread))
    size = np.abs(np.asarray(d_image, np.float64)).sum(axis=-1)
    return None if spread == "even" else _dealt(size, spp, EVEN_SHARE)


def pair_counts(pilot: Accumulation, d_image: Array, spp: int, spread: str) -> Array | None:
    """The same for two pictures that are each other's cotangent (recovery/cross_loss.py).

    A pixel's paths serve its derivative, where |d_p| s_p says how many are wanted, and its picture,
    whose noise tells most where d_p may be small. So most are dealt out evenly, and the others by
    |d_p| s_p, s_p being how much the radiance of the pilot's paths varies around the pixel.

    Args:
        pilot: a picture of a few other paths, two at least.
        d_image: dL/dimage (H, W, 3) as that picture says.
        spp: paths a pixel, on average.
        spread: of `SPREADS`.

    Raises:
        RangeError: another spread.
    """
    if spread not in SPREADS:
        raise RangeError(message("loss_and_gradients", "spread", SPREADS, spread))
    if spread == "even":
        return None
    variance = np.maximum(pilot.squares / pilot.count - pilot.mean**2, 0.0).sum(axis=-1)
    size = np.sqrt(variance) * np.abs(d_image).sum(axis=-1)
    edges = np.pad(size, AROUND, mode="edge")
    around = sliding_window_view(edges, (2 * AROUND + 1, 2 * AROUND + 1)).mean(axis=(2, 3))
    return _dealt(around, spp, PAIR_EVEN_SHARE)


def _dealt(size: Array, spp: int, even_share: float) -> Array | None:
    """Counts of which `even_share` is even and the rest in proportion to `size` (H, W)."""
    mean = size.mean()
    if not 0 < mean < np.inf:
        return None
    wanted = spp * (even_share + (1 - even_share) * size / mean)
    counts: Array = np.clip(np.rint(wanted), 1, MOST * spp).astype(np.uint32)
    return counts
