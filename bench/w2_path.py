"""W2: a room by path tracing, at most 8 segments a path: seconds times squared error.

A picture on the back wall, a copper block, a ball with smooth normals that is principled or metal,
a square light. Next event estimation and BSDF sampling with the power heuristic; a box filter. Each
call takes another seed. `--reference` names a picture of many samples (H, W, 3), linear .npy.
"""

from __future__ import annotations

from itertools import count

import _common
import _estimates
import numpy as np


def main() -> None:
    args = _estimates.options(
        "W2: path tracing", spp=64, reference="picture of many samples, .npy"
    ).parse_args()
    tracer, options = _estimates.tracer(args)
    seeds = count()
    forward, sums = _common.measure(
        lambda: tracer.render(spp=args.spp, seed=next(seeds), options=options),
        args.reps,
        args.warmup,
    )
    image = sums.mean
    quality = {"mean": float(image.mean())}
    truth = _estimates.reference(args.reference)
    if truth is not None:
        squares = np.square(image - truth)
        mse = float(squares.mean())
        quality |= {
            "mse": mse,
            "relmse": float((squares / (np.square(truth) + 1e-2)).mean()),
            "seconds_x_mse": mse * forward["median"],
        }
    _common.report(
        "W2",
        args,
        _estimates.size(args),
        quality,
        forward=forward,
        roulette=args.roulette,
        sampler=args.sampler,
    )


if __name__ == "__main__":
    main()
