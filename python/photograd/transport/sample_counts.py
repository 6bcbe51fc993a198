"""Where the paths of a derivative go: as many to each pixel, or more to those that matter.

A derivative is a sum over pixels of d_p times the mean of that pixel's n_p paths, so that its
variance is the sum of d_p^2 s_p^2 / n_p, s_p being the spread of one path's part. For a given sum
of n_p it is least where n_p grows as |d_p| s_p. s_p is not known, but d_p is, and for a loss of
squares few pixels (a highlight, the rim of a lamp) hold most of it.

Whatever n_p is, the mean of the estimate stays, as long as n_p knows nothing of these very paths:
it may follow d_image, which comes from other paths.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.errors import RangeError, message

Array = npt.NDArray[Any]
SPREADS = ("even", "cotangent")
EVEN_SHARE = 0.25
"""Of all paths: a pixel may hide a large s_p behind a small d_p, so that none goes without."""
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
    mean = size.mean()
    if spread == "even" or not 0 < mean < np.inf:
        return None
    wanted = spp * (EVEN_SHARE + (1 - EVEN_SHARE) * size / mean)
    counts: Array = np.clip(np.rint(wanted), 1, MOST * spp).astype(np.uint32)
    return counts
