"""Halving the step of the march: invisible where the field is resolved, else measured."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.fields import DenseGrid, Fittable, SparseSh
from photograd.fields.march import MarchPolicy
from photograd.fitting import FitOptions
from photograd.fitting.evaluate import VISIBLE, step_change
from photograd.fitting.loop import Fit
from photograd.splats.model import GaussianScene

from tests.fit import scene


def fog(width: float, steps: float, dtype: Any = np.float64) -> DenseGrid:
    """A ball of colored fog in 48 voxels, its rim `width` voxels wide; 10/m, 0.6 m across."""
    axis = np.arange(48) - 23.5
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    inside = 1 / (1 + np.exp((np.sqrt(x * x + y * y + z * z) - 10) / (0.25 * width)))
    color = np.stack([0.5 + x / 60, 0.5 + y / 60, 0.5 + z / 60], axis=-1)
    values = np.concatenate([color, 10 * inside[..., None]], axis=-1).astype(dtype)
    box = ((-0.7, -0.7, -0.7), (0.7, 0.7, 0.7))
    return DenseGrid(
        values,
        MarchPolicy(
            box, 1.4 / 48 / steps, density_activation="identity", color_activation="identity"
        ),
    )


def change(field: Fittable) -> Any:
    return step_change(scene.as_model(field), scene.capture().test)


def test_the_default_step_is_fine_enough_where_the_field_is_resolved() -> None:
    """A rim of four voxels is; the surfaces of a fit, a voxel thick and opaque, are not."""
    steps = FitOptions().steps_per_voxel
    assert steps == 1.5
    soft = change(fog(4.0, steps))
    assert soft.views == 2
    assert 0 < soft.largest < VISIBLE  # measured: 1.2e-4
    assert soft.share == 0
    fit = Fit.start(scene.capture(), scene.options(resolution=24, steps=100))
    while fit.step_number < 100:
        fit.step()
    fitted = change(fit.model)
    assert fitted.largest > 3 * VISIBLE  # measured: 6.0e-3, 4 % of the pixels above 1e-3
    assert 0.01 < fitted.share < 0.1
    assert fitted.mean < 3e-4  # measured: 1.3e-4


def test_the_change_falls_with_the_square_of_the_step() -> None:
    # Trilinear interpolation has kinks, between which samples lie by chance: a factor of 3.0 for
    # the first halving, 5.6 for the second. Measured for both: 16.6, for rims of 1 to 6 voxels 15
    # to 17.
    coarse, fine = (change(fog(4.0, steps)).mean for steps in (1.5, 6.0))
    assert coarse / fine == pytest.approx(16.0, rel=0.15)


def test_fields_without_steps_have_no_measure() -> None:
    assert change(GaussianScene.example(seed=1)) is None
    sparse = SparseSh.full(scene.BOX, 12, degree=0, sigma_t=2.0)
    before = sparse.policy
    assert change(sparse).largest > 0
    assert sparse.policy is before  # that of a copy is another
