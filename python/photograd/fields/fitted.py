"""The representations that a capture can start: what a fit, a model file and a picture may hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from photograd.data.bounds import Bounds
from photograd.data.capture import Capture
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.gaussians import GaussianScene
from photograd.fields.march import MarchPolicy
from photograd.fields.sparse_sh import SparseSh
from photograd.fit_options import FitOptions
from photograd.representation import Array
from photograd.splat import SplatOptions
from photograd.splats.first_scene import first_scene, scene_control

FittedGrid: TypeAlias = DenseGrid | SparseSh
FittedField: TypeAlias = FittedGrid | GaussianScene
HARMONIC_GRIDS: dict[str, type[SparseSh]] = {SparseSh.name: SparseSh, DenseSh.name: DenseSh}
FITTED = (DenseGrid.name, *HARMONIC_GRIDS, GaussianScene.name)


def start_field(
    capture: Capture,
    bounds: Bounds,
    options: FitOptions,
    points: Callable[[int], tuple[Array, Array]] | None = None,
) -> tuple[FittedField, str]:
    """What a fit begins with, and a sentence on where it comes from.

    Grids: nearly empty space in the box, at the coarsest level of the options. Gaussians: a part of
    the budget, at what `points(count)` returns, at the capture's points or at random.
    """
    if options.representation == GaussianScene.name:
        scene, rule = first_scene(capture, bounds.box, options, points)
        return scene, f"Gaussians: {rule}"
    size, finest = options.levels()[0], options.resolution
    if options.representation in HARMONIC_GRIDS:
        harmonic = HARMONIC_GRIDS[options.representation].full(
            bounds.box, size, degree=options.degree, finest=finest, sigma_t=options.sigma_t,
            steps_per_voxel=options.steps_per_voxel,
        )  # fmt: skip
        return harmonic, f"box: {bounds.rule}"
    dense = DenseGrid.empty(
        bounds.box, size, finest=finest, sigma_t=options.sigma_t,
        steps_per_voxel=options.steps_per_voxel,
    )  # fmt: skip
    return dense, f"box: {bounds.rule}"


def saved_field(
    params: Mapping[str, Array],
    state: Mapping[str, Array],
    policy: Mapping[str, Any],
    options: FitOptions,
) -> FittedField:
    """The field of a checkpoint. Raises KeyError or TypeError where something is lacking."""
    if options.representation == GaussianScene.name:
        return GaussianScene.of_state(
            params, state, policy=SplatOptions(**policy), control=scene_control(options)
        )
    march = MarchPolicy(**{**policy, "box": tuple(tuple(corner) for corner in policy["box"])})
    if options.representation in HARMONIC_GRIDS:
        rest = {key: value for key, value in state.items() if key != "background_density"}
        return HARMONIC_GRIDS[options.representation](
            ActiveVoxels.of_state(rest, "load_model"), params["density"], params["sh"], march,
            background_density=float(state["background_density"]),
        )  # fmt: skip
    return DenseGrid(params["values"], march)
