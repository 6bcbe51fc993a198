"""W4: a dense volume, marched forward, and forward and backward.

n^3 voxels of colour and sigma_t on [-1, 1]^3, clamped at the border; a step of 1 / n from the point
where a ray enters; radiance L = sum of T sigma_t c dt with T = exp(-sum of earlier sigma_t dt). The
loss is the mean of (L - target)^2 over rays and channels.

The arrays come indexed [z, y, x] and stay so: photograd's grids are [x, y, z], so every call gets
the rays with their coordinates reversed. That reversal, where samples lie, the check for non-finite
outputs, a cleared gradient, and the loss with its derivative are all inside the timing.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd.core import _core
from photograd.fields.march import MarchContext, MarchPolicy, march, march_backward
from photograd.representation import Outputs, RayBatch, RenderOptions

Array = NDArray[Any]
CUBE = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


class Volume:
    """The workload: a grid, rays, and the image that another grid makes."""

    def __init__(self, n: int, res: int, views: int) -> None:
        self.grid = _inputs.volume_grid(n, 0.0)
        other = _inputs.volume_grid(n, 0.6)
        self.origins, self.directions = _inputs.orbit_rays(res, views)
        self.pixel = np.arange(len(self.origins), dtype=np.uint32)
        self.policy = MarchPolicy(
            CUBE, 1 / n, lattice="entry", quadrature="riemann", border="clamp",
            density_activation="identity", color_activation="identity",
        )  # fmt: skip
        self.target = self.render(other)[0].color
        name = f"W4 n={n} res={res} views={views}"
        self.inputs = _inputs.inputs_row(name, self.grid, other, self.origins, self.directions)

    def batch(self) -> RayBatch:
        return RayBatch(self.origins[:, ::-1], self.directions[:, ::-1], self.pixel)

    def render(self, grid: Array) -> tuple[Outputs, MarchContext]:
        return march("dense_grid", grid, self.policy, self.batch(), RenderOptions(), seed=0, step=0)

    def forward(self) -> tuple[Array, MarchContext]:
        outputs, context = self.render(self.grid)
        return outputs.color, context

    def loss(self, color: Array) -> tuple[float, Array]:
        """The loss, summed in double, and its derivative by the colour (R, 3)."""
        difference = color - self.target
        loss = float(np.square(difference).mean(dtype=np.float64))
        return loss, difference * np.float32(2 / difference.size)

    def forward_backward(self) -> tuple[float, Array]:
        color, context = self.forward()
        loss, d_color = self.loss(color)
        return loss, march_backward(context, Outputs(d_color))["parameters"]


class Stages:
    """Seconds by stage, and how many cores others used meanwhile."""

    def __init__(self, reps: int) -> None:
        self.reps = reps
        self.seconds: dict[str, float] = {}
        self.foreign = 0.0

    def time(self, name: str, function: Callable[[], Any]) -> None:
        timing, _ = _common.measure(function, self.reps)
        self.seconds[name] = timing["median"]
        self.foreign = max(self.foreign, *timing["foreign"])


def breakdown(volume: Volume, args: argparse.Namespace) -> dict[str, float]:
    """Seconds of the stages that can be told apart from outside of the core.

    "backward" is record (march again, cotangents of each sample), bin (sort runs of samples by
    brick) and gather (one task a brick). Only binning runs on one thread: what more threads do not
    shorten is its share, (n t_n - t_1) / (n - 1) from the times of one and of n threads. The
    estimate means something only where "foreign" is near zero.
    """
    color, c = volume.forward()
    _, d_color = volume.loss(color)

    def place() -> tuple[Array, Array]:
        batch = volume.batch()
        origins = np.ascontiguousarray(batch.origins)
        return _core.place_samples(c.settings, origins, np.ascontiguousarray(batch.directions))

    def walk() -> Any:
        return _core.march(
            c.field, c.parameters, c.settings, c.origins, c.directions, c.t0, c.samples
        )

    def backward() -> Any:
        return march_backward(c, Outputs(d_color))

    stages = Stages(args.reps)
    stages.time("reverse_and_place", place)
    stages.time("forward", walk)
    stages.time("loss", lambda: volume.loss(color))
    stages.time("clear", lambda: np.full_like(volume.grid, 0.0))
    stages.time("backward", backward)
    if args.threads > 1:
        _core.set_thread_count(1)
        stages.time("backward_one_thread", backward)
        _core.set_thread_count(args.threads)
        t_n, t_1, n = (
            stages.seconds["backward"],
            stages.seconds["backward_one_thread"],
            args.threads,
        )
        stages.seconds["bin_estimate"] = (n * t_n - t_1) / (n - 1)
        stages.seconds["record_and_gather_estimate"] = t_n - stages.seconds["bin_estimate"]
    return stages.seconds | {"foreign": stages.foreign}


def main() -> None:
    parser = _common.options("W4: dense volume, forward and backward", n=128, res=200, views=8)
    parser.add_argument("--breakdown", action="store_true", help="time the stages as well")
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    volume = Volume(args.n, args.res, args.views)
    forward, (color, context) = _common.measure(volume.forward, args.reps, args.warmup)
    both, (loss, grad) = _common.measure(volume.forward_backward, args.reps, args.warmup)
    color, grad = color.astype(np.float64), grad.astype(np.float64)
    quality = {
        "image_mean": float(color.mean()),
        "loss": loss,
        "grad_norm_rgb": float(np.linalg.norm(grad[..., :3])),
        "grad_norm_sigma": float(np.linalg.norm(grad[..., 3])),
    }
    samples = context.sample_count
    size = {"n": args.n, "rays": len(color), "samples": samples}
    more: dict[str, Any] = {"bound": _bounds.volume_bound(samples), "inputs": volume.inputs}
    if args.breakdown:
        more["breakdown"] = breakdown(volume, args)
    _common.report("W4", args, size, quality, forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
