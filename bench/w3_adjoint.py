"""W3: the gradient of W2's picture by the wall's texels and the block's roughness.

The loss is the mean over pixels and channels of (I - 0.2)^2. Two pictures with paths of their own,
`--spp` each, tell each other what it asks for, so that the gradient is right on average. A few of
the paths find out where the others are needed (`--spread`). Roulette begins later than for a
picture: few bright pixels carry much of the gradient, and roulette looks at the path alone.
`--reference` names files
NAME_texture.npy (64, 64, 3) and NAME_alpha.npy (value, standard error), the latter by alpha, the
square of our roughness.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import Any

import _common
import _estimates
import numpy as np
from numpy.typing import NDArray
from photograd.transport import PathOptions, PathTracer
from photograd.transport.accumulation import SPREADS
from photograd.transport.inverse import loss_and_gradients

Array = NDArray[Any]
GOAL = 0.2
ROULETTE = 4


def gradient(
    tracer: PathTracer, options: PathOptions, spp: int, seed: int, spread: str
) -> tuple[float, Array, float]:
    """The loss, its derivative with respect to the texels (64, 64, 3), and by the block's alpha."""
    shape = (tracer.scene.camera.height, tracer.scene.camera.width, 3)
    loss, found = loss_and_gradients(
        tracer,
        np.full(shape, GOAL),
        np.ones(shape),
        spp=spp,
        seeds=(2 * seed, 2 * seed + 1),
        options=replace(options, roulette_from=ROULETTE),
        spread=spread,
    )
    roughness = float(tracer.params["materials.block.roughness"])
    by_alpha = float(found["materials.block.roughness"]) / (2 * roughness)
    return loss, found["textures.picture"], by_alpha


def main() -> None:
    parser = _estimates.options(
        "W3: adjoint path tracing", spp=32, reference="start of the names of two files"
    )
    parser.add_argument("--spread", choices=SPREADS, default="cotangent")
    args = parser.parse_args()
    tracer, options = _estimates.tracer(args)
    seeds = count()
    forward, _ = _common.measure(
        lambda: tracer.render(spp=args.spp, seed=next(seeds), options=options),
        args.reps,
        args.warmup,
    )
    found: list[tuple[float, Array, float]] = []
    both, _ = _common.measure(
        lambda: found.append(gradient(tracer, options, args.spp, next(seeds), args.spread)),
        args.reps,
        args.warmup,
    )
    quality: dict[str, Any] = {"loss": found[-1][0], "alpha_grad": [row[2] for row in found]}
    truth = _estimates.reference(args.reference, "_texture")
    if truth is not None:
        alpha = float(_estimates.reference(args.reference, "_alpha")[0])  # type: ignore[index]
        errors = [float(np.linalg.norm(g - truth) / np.linalg.norm(truth)) for _, g, _ in found]
        error = float(np.median(errors))
        quality |= {
            "texture_grad_rel_error": error,
            "seconds_x_rel_error_sq": error**2 * both["median"],
            "alpha_grad_reference": alpha,
            "alpha_grad_rms_error": float(np.sqrt(np.mean([(a - alpha) ** 2 for *_, a in found]))),
        }
    _common.report(
        "W3",
        args,
        _estimates.size(args),
        quality,
        forward=forward,
        both=both,
        roulette=args.roulette,
        sampler=args.sampler,
        spread=args.spread,
    )


if __name__ == "__main__":
    main()
