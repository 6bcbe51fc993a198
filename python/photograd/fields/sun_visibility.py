"""Where in a box of voxels solids let the sun through: the shadow side of fog."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photograd.errors import RangeError, message
from photograd.geometry.mesh import Bvh


def voxel_centres(box: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """(X, Y, Z, 3) middles of the equal voxels that fill a box (2, 3)."""
    corners = np.asarray(box, np.float64)
    axes = [
        lo + (np.arange(n) + 0.5) * (hi - lo) / n
        for n, lo, hi in zip(shape, *corners.tolist(), strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def sun_visibility(
    solids: Bvh, box: ArrayLike, shape: tuple[int, ...], sun: ArrayLike, *, samples: int = 2
) -> NDArray[np.float64]:
    """(X, Y, Z) share of samples^3 points of each voxel from which the sun is seen.

    Args:
        solids: what throws shadows.
        box: (2, 3) of the world, metres.
        shape: (X, Y, Z).
        sun: (3,) unit, towards the sun.
        samples: points a side, spread evenly; more of them make edges softer, not sharper.

    Raises:
        RangeError: samples below 1.
    """
    if samples < 1:
        raise RangeError(message("sun_visibility", "samples", "at least 1", samples))
    fine = tuple(int(n) * samples for n in shape)
    origins = voxel_centres(box, fine).reshape(-1, 3)
    towards = np.ascontiguousarray(np.broadcast_to(np.asarray(sun, np.float64), origins.shape))
    seen = ~solids.occluded(origins, towards)
    x, y, z = shape
    cells = seen.reshape(x, samples, y, samples, z, samples)
    return np.asarray(cells.mean(axis=(1, 3, 5)))
