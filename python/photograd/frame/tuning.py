"""Settings of a frame found by descent, where engines search by hand.

The occlusion that a screen shows can only imitate the one that rays find: which radius, falloff and
distribution of samples imitate it best depends on the scene. Here the traced occlusion is the
target, and the gradient is that of `ssao_backward`.

    loss = mean over all views and pixels of (clip(ssao, 0, 1) - traced)^2

Settings descend as logarithms, so that they stay above 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from photograd_course.optim import Adam
from photograd_course.portable_math import exp, log

from photograd._arrays import Arguments
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.frame.gbuffer import GBuffer, draw_surfaces
from photograd.frame.occlusion import SsaoSettings, ssao, ssao_backward
from photograd.frame.scene import FrameScene
from photograd.transport.accumulation import Accumulation
from photograd.transport.tracer import PathTracer
from photograd.types import Array, FloatArray

LEAST = 1e-4
"""The smallest value of a setting; a bias of 0 starts here."""


@typed_call
@dataclass(frozen=True, eq=False)
class TunedOcclusion:
    """What was found.

    Attributes:
        settings: of the least loss.
        before, after: root of the mean squared difference from the traced occlusion, of the start
            and of `settings`.
        history: (steps + 1,) of the loss.
    """

    settings: SsaoSettings
    before: float
    after: float
    history: FloatArray


@typed_call
def traced_occlusion(
    scene: FrameScene, camera: Camera, *, spp: int, seed: int = 0, radius: float = np.inf
) -> Array:
    """The part of the sky that each pixel sees, by rays, (H, W) from 0 to 1.

    Args:
        scene: that is looked at.
        camera: of the picture.
        spp: rays a pixel.
        seed: of the rays.
        radius: meters; what is further away hides nothing.
    """
    sums = Accumulation.empty(camera.height, camera.width)
    tracer = PathTracer(replace(scene.scene, camera=camera), allow_incomplete=True)
    tracer.add_occlusion(sums, spp, seed=seed, radius=radius)
    found: Array = sums.mean[..., 0]
    return found


@typed_call
def tune_occlusion(
    scene: FrameScene,
    cameras: Sequence[Camera],
    start: SsaoSettings,
    *,
    steps: int = 100,
    rate: float = 0.05,
    samples: int = 16,
    spp: int = 64,
    seed: int = 0,
    radius: float = np.inf,
    report: Callable[[int, float], None] | None = None,
) -> TunedOcclusion:
    """Find the settings whose occlusion is nearest to the traced one.

    Args:
        scene: that is looked at.
        cameras: of the views that are compared.
        start: where to begin.
        steps: of Adam.
        rate: of the logarithms, a step.
        samples: of `ssao`, a pixel.
        spp: rays a pixel of the target.
        seed: of the target.
        radius: of the target, meters.
        report: is called with the number of the step and the loss.

    Raises:
        DtypeError, RangeError: numbers out of range, or no camera.
    """
    call = Arguments("tune_occlusion")
    call.integer("len(cameras)", len(cameras), low=1)
    call.integer("steps", steps, low=1)
    rate = call.number("rate", rate, above=0.0)
    views = [draw_surfaces(scene, camera, "opaque", "mask", "glass")[1] for camera in cameras]
    targets = [
        traced_occlusion(scene, camera, spp=spp, seed=seed, radius=radius) for camera in cameras
    ]
    x = {name: log(np.array([max(value, LEAST)])) for name, value in asdict(start).items()}
    optimizer, history = Adam(), []
    best, least = start, np.inf
    for step in range(steps + 1):
        settings = SsaoSettings(**{name: float(exp(value)[0]) for name, value in x.items()})
        loss, d = _loss(views, targets, settings, samples)
        history.append(loss)
        if loss < least:
            best, least = settings, loss
        if report is not None:
            report(step, loss)
        d_x = {name: np.array([d[name] * value]) for name, value in asdict(settings).items()}
        optimizer.step(x, d_x, rate)
    return TunedOcclusion(
        best, float(np.sqrt(history[0])), float(np.sqrt(least)), np.array(history)
    )


def _loss(
    views: Sequence[GBuffer], targets: Sequence[Array], settings: SsaoSettings, samples: int
) -> tuple[float, dict[str, float]]:
    """The loss, and dL/dsettings."""
    count = sum(int(view.covered.sum()) for view in views)
    loss, d = 0.0, dict.fromkeys(asdict(settings), 0.0)
    for view, target in zip(views, targets, strict=True):
        depth, normals = view.depth, view.shading.astype(np.float64)
        found = ssao(depth, normals, view.camera, settings, samples=samples)
        difference = np.where(view.covered, np.clip(found, 0.0, 1.0) - target, 0.0)
        loss += float((difference * difference).sum()) / count
        inside = (found > 0.0) & (found < 1.0)
        d_out = np.where(inside, 2.0 * difference / count, 0.0)
        part = ssao_backward(depth, normals, view.camera, d_out, settings, samples=samples)
        d = {name: d[name] + value for name, value in part.items()}
    return loss, d
