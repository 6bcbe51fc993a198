"""Pictures of a mesh's gradient: arrows point where the vertices have to go."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from photograd.commands.gradients import draw_gradients
from photograd.fitting.data import TrainingViews
from photograd.fitting.model import load_model
from photograd.fitting.surface_gradients import surface_gradients
from PIL import Image

from tests.fit.test_mesh_surface_fit import capture, start
from tests.fit.test_resume import run


def test_silhouettes_of_a_mesh_that_is_too_large_are_pulled_inward() -> None:
    field: Any = start().model
    view = TrainingViews(capture().train).views[0]
    found = surface_gradients(field, view, ssim_weight=0.0)
    way = -found.silhouettes
    asked = found.visible & way.any(axis=1)
    assert asked.sum() > 15
    inward = (way * found.normals).sum(axis=1)[asked] < 0
    assert inward.mean() > 0.9
    assert np.abs(found.interior).max() < 1e-12  # of one gray, which stays the same everywhere


def test_the_command_draws_three_steps(tmp_path: Path) -> None:
    folder = tmp_path / "model"
    run(start(steps=4), folder)
    drawn = draw_gradients(load_model(folder), folder, capture(), tmp_path / "out", 1, 0)
    with Image.open(drawn["surface_gradients"]) as picture:
        assert picture.width > 600
        assert np.asarray(picture.convert("L")).std() > 10
