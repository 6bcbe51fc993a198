"""W8: a picture of n Gaussians of degree 3, and the gradient of a loss by all their parameters.

EWA projection with 0.3 pixel^2 of low-pass, alpha = min(0.999, opacity exp(-sigma)), contributions
below 1/255 dropped, a pixel ends below T = 1e-4, black background. The loss is the mean of
(color - 1/2)^2. Projecting, sorting and binning are inside the timing, and so are the loss and
clearing the gradients. `--breakdown` times the stages.
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
from photograd.capture.camera import Camera
from photograd.splats.splatting import (
    Gaussians,
    SplatContext,
    SplatGradients,
    SplatOptions,
    SplatPicture,
    render,
    render_backward,
)

Array = NDArray[Any]


class Splatting:
    """The workload: Gaussians and a camera."""

    def __init__(self, n: int, res: int, options: SplatOptions) -> None:
        arrays = _inputs.gaussians(n)
        self.gaussians = Gaussians(**arrays)
        self.view, focal = _inputs.splat_camera(res)
        self.camera = Camera(res, res, focal, focal, res / 2, res / 2, np.eye(4))
        self.options = options
        self.inputs = _inputs.inputs_row(f"W8 n={n} res={res}", *arrays.values(), self.view)

    def forward(self) -> tuple[SplatPicture, SplatContext]:
        return render(
            self.gaussians, self.camera, options=self.options, camera_from_world=self.view
        )

    def loss(self, picture: SplatPicture) -> tuple[float, Array]:
        error = picture.color - np.float32(0.5)
        flat = error.ravel()
        value = float(np.dot(flat, flat)) / error.size
        error *= np.float32(2 / error.size)
        return value, error

    def both(self) -> tuple[float, SplatGradients]:
        picture, context = self.forward()
        loss, d_color = self.loss(picture)
        return loss, render_backward(context, d_color)


def breakdown(work: Splatting, reps: int) -> dict[str, float]:
    """Seconds of the stages that can be told apart from Python."""
    picture, context = work.forward()
    _, d_color = work.loss(picture)
    stages = {
        "forward": work.forward,
        "blend": context.prepared.render,
        "loss": lambda: work.loss(picture),
        "backward": lambda: render_backward(context, d_color),
    }
    seconds: dict[str, float] = {}
    foreign = 0.0
    for name, stage in stages.items():
        timing, _ = _common.measure(stage, 3 * reps)
        seconds[name] = timing["median"]
        foreign = max(foreign, *timing["foreign"])
    seconds["project, sort, bin"] = seconds.pop("forward") - seconds["blend"]
    return seconds | {"foreign": foreign}


def main() -> None:
    parser = _common.options("W8: Gaussian splatting", gaussians=100_000, res=512)
    parser.add_argument("--breakdown", action="store_true", help="time the stages as well")
    args: argparse.Namespace = parser.parse_args()
    _core.set_thread_count(args.threads)
    work = Splatting(args.gaussians, args.res, SplatOptions())
    forward, (picture, context) = _common.measure(work.forward, args.reps, args.warmup)
    both, (loss, gradients) = _common.measure(work.both, args.reps, args.warmup)
    norms = {
        name: float(np.linalg.norm(array.astype(np.float64)))
        for name, array in gradients.gaussians.items()
    }
    # The figures that all peers agree on; one of them has wrong gradients of scales and rotations.
    quality = {
        "image_mean": float(picture.color.mean(dtype=np.float64)),
        "loss": loss,
        "grad_norm_sh": norms.pop("sh"),
    }
    size = {"gaussians": args.gaussians, "res": args.res, "sh_degree": 3}
    # Counted once: 14.4 million pixels of a Gaussian with alpha >= 1/255 at the default size.
    contributions = int(144 * args.gaussians * (args.res / 512) ** 2)
    more: dict[str, Any] = {
        "bound": _bounds.splat_bound(contributions),
        "unit": {"name": "Gaussian-pixel pair", "count": contributions},
        "inputs": work.inputs,
        "pairs": context.prepared.pairs,
        "grad_norms": norms,
    }
    if args.breakdown:
        more["breakdown"] = breakdown(work, args.reps)
    _common.report("W8", args, size, quality, forward=forward, both=both, **more)


if __name__ == "__main__":
    main()
