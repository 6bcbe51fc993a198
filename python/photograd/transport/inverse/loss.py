"""The picture to match, and the squared error of one that is only known with noise.

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
This is the dual-buffer loss [Deng2022]; cpp/photograd/render/path/dual_buffer.h traces both at
once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._arrays import Arguments
from photograd._checks import typed
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import ShapeError, message
from photograd.transport.accumulation import Accumulation, Spread, pair_counts
from photograd.transport.incomplete import WholeGradients, require_whole
from photograd.transport.path_options import DEFAULTS, PathOptions
from photograd.transport.scene import Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array


@typed_call
@dataclass(frozen=True, eq=False)
class Target:
    """A photograph, or a rendering, of the scene that is looked for.

    Attributes:
        image: (H, W, 3) linear radiance; kept as float64.
        camera: that took it; None is the scene's.
        weight: how much pixels count, at least 0, of shape (H, W), (H, W, 1) or (H, W, 3); 0 leaves
            a pixel out. None counts all alike.

    Raises:
        ShapeError: a picture of another shape, or one that the camera does not take.
        RangeError: numbers that are not finite, or weights below 0.
    """

    image: Any
    camera: Camera | None = None
    weight: Any = None

    def __post_init__(self) -> None:
        call = Arguments("Target", np.float64)
        image = call.array("image", self.image, ("H", "W", 3), min_length=1)
        object.__setattr__(self, "image", image)
        if self.camera is not None:
            require_size(image, self.camera)
        if self.weight is None:
            return
        shapes = (("H", "W"), ("H", "W", 1), ("H", "W", 3))
        weight = call.array("weight", self.weight, *shapes, low=0.0)
        weight = weight[..., None] if weight.ndim == 2 else weight
        object.__setattr__(self, "weight", np.array(np.broadcast_to(weight, image.shape)))


def require_size(image: Array, camera: Camera) -> None:
    """Raise ShapeError unless the camera takes pictures of this size.

    Args:
        image: (H, W, 3).
        camera: that took it.
    """
    if image.shape[:2] != (camera.height, camera.width):
        expected = f"{camera.width} x {camera.height} pixels as the camera has"
        got = f"{image.shape[1]} x {image.shape[0]}"
        raise ShapeError(message("Target", "image", expected, got))


def checked_targets(targets: Any, scene: Scene) -> tuple[Target, ...]:
    """One picture or several, bare or as `Target`, all with a camera.

    Args:
        targets: a picture, a `Target`, or several of either.
        scene: whose camera is taken where there is none.

    Raises:
        ShapeError: none, or a picture that its camera does not take.
    """
    if isinstance(targets, Target | np.ndarray):
        targets = (targets,)
    if not isinstance(targets, Sequence) or not targets:
        raise ShapeError(message("recover", "targets", "at least one picture", "none"))
    found = []
    for each in targets:
        target = each if isinstance(each, Target) else Target(each)
        camera = scene.camera if target.camera is None else target.camera
        require_size(target.image, camera)
        found.append(Target(target.image, camera, target.weight))
    return tuple(found)


def loss_weights(target: Target, kind: str) -> Array:
    """What the squared difference of each number is multiplied by, (H, W, 3).

    "relative" divides the difference by the target plus the channel's mean: a highlight then does
    not outshout the rest, nor a bright channel a dark one. The weight depends on the target alone:
    through one that depended on the rendering, its noise would come back in.

    Args:
        target: a picture.
        kind: "squared" or "relative".
    """
    own = np.ones_like(target.image) if target.weight is None else target.weight
    if kind == "squared":
        return np.asarray(own)
    level = np.maximum(target.image, 0.0)
    return np.asarray(own / np.square(level + np.maximum(level.mean(axis=(0, 1)), 1e-6)))


# The squared error of a picture that is only known with noise, and a derivative without bias.


PILOT = 16
"""One sample in so many finds out where the others are needed."""
PILOT_SEED = 0x5DEECE66D  # makes another seed of one


@typed_call
def dual_buffer_loss(a: Array, b: Array, target: Array, weight: Array) -> float:
    """The mean of w (a - t) (b - t); all four are (H, W, 3). Below 0 now and then, by chance.

    Args:
        a, b: pictures of independent seeds.
        target: t.
        weight: w.
    """
    return float(np.mean(weight * (a - target) * (b - target)))


@typed_call
def dual_buffer_loss_backward(
    a: Array, b: Array, target: Array, weight: Array, d_loss: float = 1.0
) -> tuple[Array, Array]:
    """(dL/da, dL/db), (H, W, 3) each.

    Args:
        a, b: pictures of independent seeds.
        target: t.
        weight: w.
        d_loss: dL/d of the value.
    """
    share = d_loss * weight / weight.size
    return share * (b - target), share * (a - target)


@typed_call
def loss_and_gradients(
    tracer: PathTracer,
    target: Array,
    weight: Array,
    *,
    spp: int,
    seeds: tuple[int, int],
    camera: Camera | None = None,
    options: PathOptions = DEFAULTS,
    names: Iterable[str] | None = None,
    spread: Spread = "uniform",
) -> tuple[float, dict[str, Array]]:
    """The loss of two half pictures, and its derivative with respect to the tracer's parameters.

    Args:
        tracer: whose `params` are those to differentiate with respect to.
        target, weight: (H, W, 3), linear radiance, and what squares are multiplied by.
        spp: samples a pixel of each half; powers of two are spread most evenly.
        seeds: of the two halves. Two equal ones give the derivative of mean w (a - t)^2, which is
            biased.
        camera, options: as for `PathTracer.render`.
        names: of the parameters wanted; None for all whose derivative is whole.
        spread: "uniform" gives each pixel as many samples; "cotangent" more to those that are noisy
            and far from the target, as one sample in `PILOT` finds out first.

    Returns:
        The loss, and {name: dL/dparameter}, float64: the derivative of that very loss, the choice
        of paths held fixed.

    Raises:
        ShapeError, Error: as `PathTracer.render` and `render_backward`.
        RangeError: as these, and for names whose derivative is incomplete.
    """
    typed("loss_and_gradients", "spread", Spread, spread)
    wanted = None if names is None else list(names)
    require_whole("loss_and_gradients", "names", wanted or (), tracer.incomplete)
    view = tracer.scene.camera if camera is None else camera
    shape = (view.height, view.width, 3)
    call = Arguments("loss_and_gradients", np.float64)
    target = call.array("target", target, shape, finite=False)
    weight = call.array("weight", weight, shape, finite=False)
    call.integer("spp", spp, low=1)
    counts = None
    if spread != "uniform":
        pilot = tracer.render(
            spp=max(2, 2 * spp // PILOT), seed=seeds[0] ^ PILOT_SEED, options=options, camera=camera
        )
        spp = max(1, spp - pilot.count // 2)
        counts = pair_counts(pilot, weight * (pilot.mean - target), spp, spread)
    buffers = np.zeros((2, *shape))
    found = tracer.add_up(
        "loss_and_gradients",
        _core.dual_buffer_backward,
        view,
        options=options.numbers(seeds[0]),
        other_seed=seeds[1],
        spp=spp,
        counts=counts,
        pictures=buffers,
        target=target,
        weight=weight / weight.size,
    )
    Accumulation(buffers.sum(axis=0), buffers.sum(axis=0), 2).check_finite("loss_and_gradients")
    wide = {name: d.astype(np.float64) for name, d in found.items()}
    names = wide if wanted is None else wanted
    gradients = WholeGradients("loss_and_gradients", wide, names, tracer.incomplete)
    return dual_buffer_loss(buffers[0], buffers[1], target, weight), gradients
