"""How much the step of the march matters: the same views again, with half the step.

The march is of second order in its step [Max1995], and its default step is two thirds of a voxel.
Where density changes little from sample to sample, halving the step changes no color by more than
1e-3. At the surfaces of a fitted grid, which are a voxel thick and opaque, it does: docs/results.md
has the numbers. Each model is therefore measured where it is scored.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from photograd.capture.view import View
from photograd.fields.march import MarchPolicy
from photograd.fitting.evaluate import render_camera
from photograd.fitting.model import Model

VISIBLE = 1e-3
"""Of white, linear: a quarter of one of 256 levels near white."""
MOST_VIEWS = 3


@dataclass(frozen=True)
class StepChange:
    """By how much pixels change when the step is halved: the largest of their three channels."""

    largest: float
    mean: float
    share: float  # of the pixels that change by more than VISIBLE
    views: int


def step_change(
    model: Model, views: Sequence[View], *, most: int = MOST_VIEWS
) -> StepChange | None:
    """Compare at most `most` of the views, evenly spaced; None for a field without steps.

    Colors are premultiplied and as the field has them, so that no background takes part; rays are
    not stopped early.
    """
    policy = model.field.policy
    if not isinstance(policy, MarchPolicy) or not views:
        return None
    finer: Any = copy(model.field)  # whose parameters are shared
    finer.policy = replace(policy, dt=0.5 * policy.dt)
    chosen = views[:: -(-len(views) // most)]
    models = model, replace(model, field=finer)
    changes = []
    for view in chosen:
        coarse, fine = (render_camera(each, view.camera, stop=0.0)[0] for each in models)
        changes.append(np.abs(fine - coarse).max(axis=-1).ravel())
    change = np.concatenate(changes)
    return StepChange(
        float(change.max()), float(change.mean(dtype=np.float64)),
        float((change > VISIBLE).mean()), len(chosen),
    )  # fmt: skip


def as_entry(change: StepChange | None) -> dict[str, Any]:
    """{"half_step": ...} for the result of `photograd evaluate`; {} where there is no step."""
    return {} if change is None else {"half_step": asdict(change)}
