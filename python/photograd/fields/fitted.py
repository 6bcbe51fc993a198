"""The fields that a capture can start: what a fit, a model file and a picture may hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.march import MarchPolicy
from photograd.fields.sparse_sh import SparseSh
from photograd.fit_options import FitOptions
from photograd.representation import Array

FittedField: TypeAlias = DenseGrid | SparseSh
FITTED = (DenseGrid.name, SparseSh.name)


def start_field(box: Array, options: FitOptions) -> FittedField:
    """Nearly empty space in `box` (2, 3) world metres, at the coarsest level of the options."""
    size, finest = options.levels()[0], options.resolution
    if options.representation == SparseSh.name:
        return SparseSh.full(
            box, size, degree=options.degree, finest=finest, sigma_t=options.sigma_t,
            steps_per_voxel=options.steps_per_voxel,
        )  # fmt: skip
    return DenseGrid.empty(
        box, size, finest=finest, sigma_t=options.sigma_t, steps_per_voxel=options.steps_per_voxel
    )


def saved_field(
    params: Mapping[str, Array], state: Mapping[str, Array], policy: MarchPolicy, name: str
) -> FittedField:
    """The field of a checkpoint. Raises KeyError where something is lacking."""
    if name == SparseSh.name:
        rest = {key: value for key, value in state.items() if key != "background_density"}
        return SparseSh(
            ActiveVoxels.of_state(rest, "load_model"), params["density"], params["sh"], policy,
            background_density=float(state["background_density"]),
        )  # fmt: skip
    return DenseGrid(params["values"], policy)
