"""A growing number of Gaussians: clone, split, prune, and make everything a little fainter.

A Gaussian with a large positional gradient (see `grad2d`) covers too much or too little. A small
one is cloned: its twin is free to go elsewhere. A large one is split in two along its longest axis.
Faint ones are dropped [Kerbl2023]. Each time all opacities are lowered a little: what is needed
recovers, what only fogs the view in front of a camera does not [Bulo2024]. (The original code
lowers them to 0.01 every 3000 steps, after which a fit has to begin anew.)

None of this may cost what the fit has learned. Two Gaussians of opacity a at one place cover like
one of 1 - (1 - a)^2, so a clone and its original get

    a' = 1 - sqrt(1 - a)

which keeps the middle of the splat as it was [Bulo2024]; where its falloff is g, the two cover more
by a'^2 g (1 - g). The original code leaves a to both, and doubles the matter.

The parts of a split Gaussian of scale s along its longest axis get

    s' = s / 1.6,    offsets +-d with d^2 + s'^2 = s^2,    a' = 1.6 a / 2

so that together they have its mean, its covariance and, but for their overlap, its coverage. The
original code draws two places from the Gaussian itself, shrinks all axes and leaves a to both: in
a fit that costs up to two decibels.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from photograd_course.portable_math import exp, log

from photograd.splats.density import (
    Change,
    DensityControl,
    Grad2dStatistics,
    Params,
    Schedule,
    logits,
    opacities,
    rebuilt,
    rotation_matrices,
)
from photograd.types import Array

SPLIT = 1.6
"""A part of a split Gaussian is shorter by this, along its longest axis [Kerbl2023]."""


@dataclass(frozen=True)
class CloneSplitPrune(DensityControl):
    """Density control by cloning, splitting and pruning [Kerbl2023].

    Attributes:
        budget: there are never more Gaussians; those with the largest grad2d go first.
        schedule: of cloning, splitting and pruning.
        threshold: grad2d above which a Gaussian is cloned or split.
        small: in extents; Gaussians whose longest scale is below are cloned, others split.
        faint: opacity below which a Gaussian is dropped.
        large: in extents; Gaussians with a longer scale are dropped.
        fading: opacity that every Gaussian loses each time; what is needed recovers.
    """

    first_share: ClassVar[float] = 1 / 3
    budget: int
    schedule: Schedule = field(default_factory=Schedule)
    threshold: float = 2e-4
    small: float = 0.01
    faint: float = 0.005
    large: float = 0.1
    fading: float = 0.001

    def change(
        self, params: Params, grad2d: Grad2dStatistics, *, extent: float, step: int
    ) -> Change | None:
        """Rows kept in their order, then clones, then the parts of split ones.

        Args:
            params: of the Gaussians, by group.
            grad2d: positional gradients since the last change.
            extent: of the scene, in meters.
            step: of the fit.
        """
        if not self.schedule.due(step):
            return None
        alpha = opacities(params)
        longest = exp(params["log_scales"].astype(np.float64)).max(axis=1)
        pruned = (alpha < self.faint) | (longest > self.large * extent)
        if pruned.all():
            pruned[np.argmax(alpha)] = False  # an empty scene has no gradient to grow from
        chosen = self._above_threshold(grad2d.mean(), pruned)
        small = longest <= self.small * extent
        cloned, split = np.flatnonzero(chosen & small), np.flatnonzero(chosen & ~small)
        before = _with_clones_thinned(params, cloned)
        added = _concatenated(_rows(before, cloned), _parts(before, split))
        kept = np.flatnonzero(~pruned & ~(chosen & ~small))
        after, row_map = rebuilt(before, kept, added)
        alpha = opacities(after) - self.fading
        after["opacity_logits"] = logits(alpha).astype(params["opacity_logits"].dtype)
        return Change(after, row_map)

    def _above_threshold(self, grad2d: Array, pruned: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(N,) those above the threshold, the largest first while the budget lasts."""
        wanted = np.flatnonzero((grad2d >= self.threshold) & ~pruned)
        room = max(0, self.budget - int((~pruned).sum()))
        order = np.argsort(-grad2d[wanted], kind="stable")[:room]
        chosen = np.zeros(len(grad2d), np.bool_)
        chosen[wanted[order]] = True
        return chosen


def _rows(params: Params, rows: Array) -> dict[str, Array]:
    return {name: array[rows] for name, array in params.items()}


def _concatenated(one: Params, two: Params) -> dict[str, Array]:
    return {name: np.concatenate([one[name], two[name]]) for name in one}


def _parts(params: Params, rows: Array) -> dict[str, Array]:
    """The first part of each row, then the second."""
    parts = _rows(params, np.concatenate([rows, rows]))
    log_scales = parts["log_scales"].astype(np.float64)
    part, longest = np.arange(len(log_scales)), log_scales.argmax(axis=1)
    offset = np.sqrt(1 - 1 / (SPLIT * SPLIT)) * exp(log_scales[part, longest])
    offset[: len(rows)] *= -1
    axis = rotation_matrices(parts["quats"])[part, :, longest]
    parts["means"] = parts["means"] + offset[:, None] * axis
    log_scales[part, longest] -= log(SPLIT)
    parts["log_scales"] = log_scales
    parts["opacity_logits"] = logits(0.5 * SPLIT * opacities(parts))
    return parts


def _with_clones_thinned(params: Params, cloned: Array) -> dict[str, Array]:
    """A copy in which the rows that get a twin have the opacity of which two make the old one."""
    after = dict(params)
    raw = params["opacity_logits"].copy()
    alpha = opacities(params)[cloned]
    raw[cloned] = logits(1 - np.sqrt(1 - alpha))
    after["opacity_logits"] = raw
    return after
