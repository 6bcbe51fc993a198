"""W1: rays through NumPy arrays into a mesh of a million triangles.

All rays start inside of the mesh and hit. "primary" is a camera at the center, row by row; "bounce"
starts where those hit and leaves in random directions. The timing begins with the rays as (R, 3)
float32 arrays in this order and ends with distances and triangle numbers in the same order:
whatever reordering helps is inside. Building the hierarchy is timed apart ("build_seconds").
"""

from __future__ import annotations

import sys
from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from photograd._compiled import _core

try:
    from photograd.geometry.mesh import Bvh, Hits, Mesh
except ImportError as failure:
    sys.stderr.write(f"w1_rays: this photograd cannot trace meshes ({failure})\n")
    sys.exit(2)


def quality(hits: Hits, seconds: float) -> dict[str, Any]:
    """What other tracers must agree with, and the speed that one reads off."""
    hit = hits.hit
    return {
        "hits": int(hit.sum()),
        "prim_sum": int(hits.primitive[hit].sum(dtype=np.int64)),
        "mean_t": float(hits.t[hit].mean(dtype=np.float64)),
        "mrays_per_s": len(hit) / seconds / 1e6,
    }


def main() -> None:
    args = _common.options("W1: rays into a large mesh", nv=500, res=2048).parse_args()
    _core.set_thread_count(args.threads)
    vertices, faces = _inputs.displaced_sphere(2 * args.nv, args.nv)
    rays = _inputs.ray_sets(vertices, faces, args.res)
    build, bvh = _common.measure(lambda: Bvh(Mesh(vertices, faces)), args.reps)
    found: dict[str, Any] = {}
    parts: dict[str, Any] = {}
    for name, (origins, directions) in rays.items():
        # Memory for the answers is lent and used again, as other tracers' allocators do.
        answers = Hits.empty(len(origins), origins.dtype)

        def cast(o: Any = origins, d: Any = directions, out: Hits = answers) -> Hits:
            return bvh.trace(o, d, out=out)

        parts[name], hits = _common.measure(cast, args.reps, args.warmup)
        found[name] = quality(hits, parts[name]["median"])
    count = args.res * args.res
    total = sum(timing["median"] for timing in parts.values())
    name = f"W1 nv={args.nv} res={args.res}"
    _common.report(
        "W1",
        args,
        {"triangles": len(faces), "rays": [count, count]},
        found,
        forward={"median": total, "parts": parts, "build": build},
        build_seconds=build["median"],
        bound=_bounds.ray_bound(count, count),
        inputs=_inputs.inputs_row(name, vertices, faces, *rays["primary"], *rays["bounce"]),
    )


if __name__ == "__main__":
    main()
