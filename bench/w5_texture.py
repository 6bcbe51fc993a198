"""W5: a texture recovered from colors at random points, by plain gradient descent.

n x n texels of three channels, points in random order, clamped bilinear lookup. The loss is the
mean over points and channels of the squared difference to the true texture's colors. Forward is
`iters` lookups of all points; forward and backward is `iters` steps of 40,000 times the gradient,
from 0.5.

Sorting the points, one plan for all steps, is inside the timing, and so are clearing the gradient
and the step itself. `--breakdown` times those stages.
"""

from __future__ import annotations

import argparse
from typing import Any

import _bounds
import _common
import _inputs
import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.textures import TexturePlan, sample, sample_backward

Array = NDArray[Any]
STEP = np.float32(40_000)


class Recovery:
    """The workload: points, their true colors, and arrays that are used again."""

    def __init__(self, n: int, points: int, iters: int) -> None:
        self.truth = _inputs.texture(n)
        self.uv = _inputs.texture_points(points)
        self.target = sample(self.truth, self.uv)
        self.iters = iters
        self.color = np.empty_like(self.target)
        self.gradient = np.empty_like(self.truth)
        self.inputs = _inputs.inputs_row(f"W5 n={n} points={points}", self.truth, self.uv)

    def start(self) -> Array:
        return np.full_like(self.truth, 0.5)

    def plan(self) -> TexturePlan:
        return TexturePlan(self.uv, self.target, self.truth.shape[:2])

    def forward(self) -> None:
        texture = self.start()
        for _ in range(self.iters):
            sample(texture, self.uv, out=self.color)

    def step(self, plan: TexturePlan, texture: Array) -> float:
        loss, gradient = plan.loss_and_gradient(texture, out=self.gradient)
        gradient *= STEP
        texture -= gradient
        return loss

    def recover(self) -> tuple[float, Array]:
        """The loss before the last step, and the texture after it."""
        texture, plan = self.start(), self.plan()
        loss = 0.0
        for _ in range(self.iters):
            loss = self.step(plan, texture)
        return loss, texture


def breakdown(work: Recovery, reps: int) -> dict[str, float]:
    """Seconds of the stages, the gradient of one step, and of a step that does not sort first."""
    plan, texture = work.plan(), work.start()
    d_color = work.color - work.target
    stages = {
        "sort": work.plan,
        "loss_and_gradient": lambda: plan.loss_and_gradient(texture, out=work.gradient),
        "step": lambda: work.step(plan, texture),
        "sample_backward": lambda: sample_backward(texture, work.uv, d_color),
    }
    seconds: dict[str, float] = {}
    foreign = 0.0
    for name, stage in stages.items():
        timing, _ = _common.measure(stage, 5 * reps)
        seconds[name] = timing["median"]
        foreign = max(foreign, *timing["foreign"])
    return seconds | {"foreign": foreign}


def psnr(a: Array, b: Array) -> float:
    """Decibels, of a peak of 1."""
    error = np.square(a.astype(np.float64) - b.astype(np.float64)).mean()
    return float(-10 * np.log10(error))


def main() -> None:
    parser = _common.options("W5: texture recovery", n=512, points=1_000_000, iters=50)
    parser.add_argument("--breakdown", action="store_true", help="time the stages as well")
    args: argparse.Namespace = parser.parse_args()
    _core.set_thread_count(args.threads)
    work = Recovery(args.n, args.points, args.iters)
    forward, _ = _common.measure(work.forward, args.reps, args.warmup)
    both, (loss, texture) = _common.measure(work.recover, args.reps, args.warmup)
    quality = {"last_loss": loss, "psnr": psnr(texture, work.truth)}
    size = {"n": args.n, "points": args.points, "iters": args.iters}
    bound = _bounds.texture_bound(args.points * args.iters)
    more: dict[str, Any] = {"bound": bound, "inputs": work.inputs}
    if args.breakdown:
        more["breakdown"] = breakdown(work, args.reps)
    _common.report("W5", args, size, quality, forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
