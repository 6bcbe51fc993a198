"""The squared error of a picture that is only known with noise, and a derivative without bias.

    L = mean over pixels and channels of w (a - t) (b - t)

t is the target, w a weight, a and b are two pictures of the same scene from independent random
numbers, each right on average. Independent means E[a b] = E[a] E[b], and so

    E[L] = mean w (E[a] - t)^2

is the squared error of the picture without noise. With one picture in both places, as in
mean w (a - t)^2, E[L] = mean w ((E[a] - t)^2 + Var[a]). Its derivative makes the noise smaller as
well, by darkening what is noisy, and a fit ends somewhere else, after any number of steps. So it is
wherever a derivative is estimated with the paths of the picture: it is multiplied by a difference
that contains the same noise.

    dL/da = w (b - t) / N        dL/db = w (a - t) / N        N = numbers in the picture

Each half's paths carry the derivative that the other half's picture asks for. Held constant: t, w.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from photograd.data.camera import Camera
from photograd.transport.tracer import DEFAULTS, PathOptions, PathTracer

Array = npt.NDArray[Any]


def cross_loss(a: Array, b: Array, target: Array, weight: Array) -> float:
    """The mean of w (a - t) (b - t); all four are (H, W, 3). Below 0 now and then, by chance."""
    return float(np.mean(weight * (a - target) * (b - target)))


def cross_loss_backward(
    a: Array, b: Array, target: Array, weight: Array, d_loss: float = 1.0
) -> tuple[Array, Array]:
    """(dL/da, dL/db), (H, W, 3) each."""
    share = d_loss * weight / weight.size
    return share * (b - target), share * (a - target)


def loss_and_gradients(
    tracer: PathTracer, target: Array, weight: Array, *, spp: int, seeds: tuple[int, int],
    camera: Camera | None = None, options: PathOptions = DEFAULTS,
    names: Iterable[str] | None = None,
) -> tuple[float, dict[str, Array]]:  # fmt: skip
    """The loss of two half pictures, and its derivative by the tracer's parameters.

    Args:
        tracer: whose `params` are those to differentiate by.
        target, weight: (H, W, 3), linear radiance, and what squares are multiplied by.
        spp: samples a pixel of each half; powers of two are spread most evenly.
        seeds: of the two halves. Two equal ones give the derivative of mean w (a - t)^2, which is
            biased.
        camera, options: as for `PathTracer.render`.
        names: of the parameters wanted; None for all.

    Returns:
        The loss, and {name: dL/dparameter}, float64: the derivative of that very loss, the choice
        of paths held fixed.

    Raises:
        As `PathTracer.render` and `render_backward`.
    """
    a, b = (
        tracer.render(spp=spp, seed=each, options=options, camera=camera).mean for each in seeds
    )
    loss = cross_loss(a, b, target, weight)
    found: dict[str, Array] = {}
    # Each half's paths carry what the other half's picture asks for.
    for seed, d_half in zip(seeds, cross_loss_backward(a, b, target, weight), strict=True):
        part = tracer.render_backward(d_half, spp=spp, seed=seed, options=options, camera=camera)
        for name in part if names is None else names:
            found[name] = found.get(name, 0.0) + part[name].astype(np.float64)
    return loss, found
