"""What a fit of Gaussians begins with, from its options."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from photograd_course.portable_math import norm

from photograd.capture.capture import Capture
from photograd.fitting.options import FitOptions
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.density import DensityControl, NoControl, Schedule
from photograd.splats.markov_chain import MarkovChain
from photograd.splats.model import GaussianScene
from photograd.splats.start import start_gaussians
from photograd.types import Array

FIRST_SHARE = 1 / 3
"""Of the budget, before cloning and splitting; a fixed number begins complete."""


def first_scene(
    capture: Capture,
    box: Array,
    options: FitOptions,
    points: Callable[[int], tuple[Array, Array]] | None = None,
) -> tuple[GaussianScene, str]:
    """A scene of constant colours, and a sentence on where its Gaussians come from.

    `points(count)` may give places (N, 3) and display colours (N, 3) to begin with.
    """
    control = scene_control(options)
    share = FIRST_SHARE if isinstance(control, CloneSplitPrune) else 1.0
    count = max(1, int(share * options.gaussians))
    gaussians, rule = start_gaussians(
        capture, box, count, degree=options.degree, seed=options.seed,
        given=points(count) if points else None,
    )  # fmt: skip
    extent = scene_extent(capture, box)
    return GaussianScene(gaussians, extent=extent, control=control, active_degree=0), rule


def scene_control(options: FitOptions) -> DensityControl:
    """The density control that the options name, from a tenth to three quarters of the steps.

    It acts some thirty times, and in long fits every 100 steps, as the authors' do.
    """
    steps = options.steps
    schedule = Schedule(
        first=min(500, steps // 10), last=3 * steps // 4, every=min(100, max(1, steps // 40))
    )
    if options.density_control == "mcmc":
        return MarkovChain(options.gaussians, seed=options.seed, schedule=schedule)
    if options.density_control == "clone_split_prune":
        return CloneSplitPrune(options.gaussians, schedule=schedule)
    return NoControl()


def scene_extent(capture: Capture, box: Array) -> float:
    """1.1 times the greatest distance of a camera from their mean, in metres [Kerbl2023].

    Cameras that all stand in one place say nothing: then half the diagonal of the box.
    """
    places = np.array([view.camera.position for view in capture.train])
    spread = float(np.linalg.norm(places - places.mean(axis=0), axis=1).max())
    diagonal = norm(box[1] - box[0])
    return 1.1 * spread if spread > 0.05 * diagonal else 0.5 * diagonal
