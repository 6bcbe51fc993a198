"""How fast the machine itself could do a workload: counted work divided by a measured rate.

No program reaches these times. They say how far away one is, and which resource sets the limit.
The rates belong to the machine they were measured on, two threads of a virtual AMD EPYC with
AVX-512: on another machine they are wrong.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

RATES = {
    "flop": 514.6e9,  # float32 multiply-adds of 16 lanes, 24 independent chains; counted as two
    "byte": 95.19e9,  # of long arrays, two read and one written past the caches
    "exp": 18.76e9,  # float32 polynomials of 16 lanes
    "load_L2": 4.029e9,  # loads of 32 bytes at random places of a 1 MiB table
    "load_L3": 2.627e9,  # the same in 8 MiB
    "rmw_L2": 1.7964e9,  # read, add and write 32 bytes at random places of 1 MiB
    "rmw_L3": 1.4114e9,  # the same in 8 MiB
}

BOX_TEST = 8 * 12  # flop of a ray against the eight boxes of a node
LEAF_TEST = 4 * 40  # flop of a ray against the four triangles of a leaf


def slowest(work: Mapping[str, float]) -> tuple[float, str]:
    """(seconds, resource) of the work that takes longest, all others hidden behind it."""
    return max((amount / RATES[resource], resource) for resource, amount in work.items())


def volume_bound(samples: int) -> dict[str, Any]:
    """W4: a sample does 90 flop and 4 loads of 32 bytes forward.

    Forward and backward together: 250 flop, two exp, 8 loads and 4 additions in place. Neighboring
    samples share voxels, so a quarter of the accesses counts.
    """
    forward = slowest({"flop": 90 * samples, "load_L2": samples, "exp": samples})
    both = slowest(
        {"flop": 250 * samples, "load_L2": 2 * samples, "rmw_L2": samples, "exp": 2 * samples}
    )
    return _row(forward, both)


def ray_bound(primary: int, bounce: int) -> dict[str, Any]:
    """W1: 14 nodes and 2 leaves a primary ray; 24 and 3, and 8 cache lines, a bounce ray."""
    flop = primary * (14 * BOX_TEST + 2 * LEAF_TEST) + bounce * (24 * BOX_TEST + 3 * LEAF_TEST)
    return _row(slowest({"flop": flop, "load_L3": 8 * bounce}), None)


def texture_bound(lookups: int) -> dict[str, Any]:
    """W5: two rows of texels loaded per lookup; backward two more, which are added to in place.

    For points in the order that they come in. A program that sorts them first can be faster.
    """
    return _row(slowest({"load_L3": 2 * lookups}), slowest({"rmw_L3": 2 * lookups}))


def sh_bound(points: int) -> dict[str, Any]:
    """W6a: a point is 204 bytes of coefficients and direction, and 12 of color.

    Backward reads the cotangent of the color and writes as much as forward reads. Coefficients
    count once: a program that does both in one pass over pieces that fit into a cache can have it
    so.
    """
    forward = slowest({"byte": 216 * points, "flop": 130 * points})
    return _row(forward, slowest({"byte": 432 * points, "flop": 400 * points}))


def hash_bound(points: int, levels: int, weights: int) -> dict[str, Any]:
    """W7a: a point loads 8 rows a level, and adds to 8 of them backward; tables fit L3 one by one.

    A weight of the layers takes 2 flop a point forward and 4 more backward.
    """
    rows = 8 * levels * points
    return _row(
        slowest({"load_L3": rows, "flop": 2 * weights * points}),
        slowest({"rmw_L3": rows, "flop": 6 * weights * points}),
    )


def layers_bound(points: int, weights: int) -> dict[str, Any]:
    """W7b: the three matrix products alone."""
    return _row(slowest({"flop": 2 * weights * points}), slowest({"flop": 6 * weights * points}))


def bsdf_bound(evaluations: int) -> dict[str, Any]:
    """W10: two directions read and a value written; 150 flop forward, 450 with the gradient."""
    bytes_moved = 36 * evaluations
    return _row(
        slowest({"flop": 150 * evaluations, "byte": bytes_moved}),
        slowest({"flop": 450 * evaluations, "byte": bytes_moved}),
    )


def raster_bound(triangles: int, res: int) -> dict[str, Any]:
    """W9: 60 flop to set up a triangle, 20 a pixel and layer of two; the gradient is free."""
    work = slowest({"flop": 60 * triangles + 40 * res * res})
    return _row(work, work)


def splat_bound(contributions: int) -> dict[str, Any]:
    """W8: a pixel and a Gaussian that adds to it take 24 flop and one exp forward, 100 more back.

    Sorting and projecting are not counted.
    """
    forward = slowest({"flop": 24 * contributions, "exp": contributions})
    both = slowest({"flop": 124 * contributions, "exp": 2 * contributions})
    return _row(forward, both)


def _row(forward: tuple[float, str], both: tuple[float, str] | None) -> dict[str, Any]:
    return {
        "seconds_fwd": forward[0],
        "fwd_by": forward[1],
        "seconds_fwdbwd": both[0] if both else None,
        "fwdbwd_by": both[1] if both else None,
    }
