"""W4: a dense volume, marched forward, and forward and backward.

n^3 voxels of color and sigma_t on [-1, 1]^3, clamped at the border; a step of 1 / n from the point
where a ray enters; radiance L = sum of T sigma_t c dt with T = exp(-sum of earlier sigma_t dt). The
loss is the mean of (L - target)^2 over rays and channels.

The arrays come indexed [z, y, x] and stay so: photograd's grids are [x, y, z], so every call gets
the rays with their coordinates reversed. That reversal, clearing the gradient, and the loss with
its derivative are inside the timing. Where a ray enters and how many samples it has belong to the
inputs, for other programs as for ours.
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
from photograd._compiled import _core
from photograd.fields.march import MarchPolicy

Array = NDArray[Any]
CUBE = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))


class Volume:
    """The workload: a grid, rays, and the image that another grid makes."""

    def __init__(self, n: int, res: int, views: int) -> None:
        self.grid = _inputs.volume_grid(n, 0.0)
        other = _inputs.volume_grid(n, 0.6)
        self.origins, self.directions = _inputs.orbit_rays(res, views)
        policy = MarchPolicy(
            CUBE,
            1 / n,
            lattice="entry",
            quadrature="riemann",
            border="clamp",
            density_activation="identity",
            color_activation="identity",
        )
        self.settings = policy.settings(0.0)  # no early stop
        self.t0, self.samples = _core.place_samples(self.settings, *self.reversed_rays())
        self.gradient = np.zeros_like(self.grid)
        self.nothing = np.zeros_like(self.t0)  # cotangent of transmittance and depth
        self.target = self.march(other, self.rays())[0]
        name = f"W4 n={n} res={res} views={views}"
        self.inputs = _inputs.inputs_row(name, self.grid, other, self.origins, self.directions)

    def reversed_rays(self) -> tuple[Array, Array]:
        """Origins and directions (R, 3) with z y x as the first, second and third coordinate."""
        return tuple(np.ascontiguousarray(a[:, ::-1]) for a in (self.origins, self.directions))

    def rays(self) -> tuple[Array, Array, Array, Array]:
        return (*self.reversed_rays(), self.t0, self.samples)

    def march(self, grid: Array, rays: tuple[Array, ...]) -> tuple[Array, Array, Array]:
        """Color (R, 3), transmittance (R,), depth (R,)."""
        return _core.march("dense_grid", grid, self.settings, rays)

    def forward(self) -> Array:
        return self.march(self.grid, self.rays())[0]

    def loss(self, color: Array) -> tuple[float, Array]:
        """The loss, summed in double, and its derivative with respect to the color (R, 3)."""
        difference = color - self.target
        loss = float(np.square(difference).mean(dtype=np.float64))
        return loss, difference * np.float32(2 / difference.size)

    def backward(self, rays: tuple[Array, ...], outputs: tuple[Array, ...], d_color: Array) -> None:
        """Adds dL/d grid to the gradient."""
        _core.march_backward(
            "dense_grid",
            self.grid,
            self.settings,
            rays,
            outputs,
            (d_color, self.nothing, self.nothing),
            self.gradient,
        )

    def forward_backward(self) -> float:
        rays = self.rays()
        outputs = self.march(self.grid, rays)
        loss, d_color = self.loss(outputs[0])
        self.gradient.fill(0)
        self.backward(rays, outputs, d_color)
        return loss


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
    rays = volume.rays()
    outputs = volume.march(volume.grid, rays)
    _, d_color = volume.loss(outputs[0])

    def backward() -> None:
        volume.backward(rays, outputs, d_color)

    stages = Stages(args.reps)
    stages.time("reverse", volume.reversed_rays)
    stages.time("forward", lambda: volume.march(volume.grid, rays))
    stages.time("loss", lambda: volume.loss(outputs[0]))
    stages.time("clear", lambda: volume.gradient.fill(0))
    stages.time("backward", backward)
    if args.threads > 1:
        _core.set_thread_count(1)
        stages.time("backward_one_thread", backward)
        _core.set_thread_count(args.threads)
        seconds, n = stages.seconds, args.threads
        serial = (n * seconds["backward"] - seconds["backward_one_thread"]) / (n - 1)
        seconds["bin_estimate"] = serial
        seconds["record_and_gather_estimate"] = seconds["backward"] - serial
    return stages.seconds | {"foreign": stages.foreign}


def main() -> None:
    parser = _common.options("W4: dense volume, forward and backward", n=128, res=200, views=8)
    parser.add_argument("--breakdown", action="store_true", help="time the stages as well")
    args = parser.parse_args()
    _core.set_thread_count(args.threads)
    volume = Volume(args.n, args.res, args.views)
    forward, color = _common.measure(volume.forward, args.reps, args.warmup)
    both, loss = _common.measure(volume.forward_backward, args.reps, args.warmup)
    grad = volume.gradient.astype(np.float64)
    quality = {
        "image_mean": float(color.mean(dtype=np.float64)),
        "loss": loss,
        "grad_norm_rgb": float(np.linalg.norm(grad[..., :3])),
        "grad_norm_sigma": float(np.linalg.norm(grad[..., 3])),
    }
    samples = int(volume.samples.sum(dtype=np.int64))
    size = {"n": args.n, "rays": len(color), "samples": samples}
    more: dict[str, Any] = {"bound": _bounds.volume_bound(samples), "inputs": volume.inputs}
    if args.breakdown:
        more["breakdown"] = breakdown(volume, args)
    _common.report("W4", args, size, quality, forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
