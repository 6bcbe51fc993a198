"""The representations that a capture can start: what a fit, a model file and a picture may hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from photograd._plain_values import from_plain
from photograd.capture.bounds import Bounds
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.frozen_leaves import TreePolicy
from photograd.fields.march import MarchPolicy
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.first_scene import first_scene, scene_control
from photograd.fitting.options import FitOptions
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import SplatOptions
from photograd.types import Array

FittedGrid: TypeAlias = DenseGrid | SparseSh
VoxelField: TypeAlias = FittedGrid | OctreeSh
FittedField: TypeAlias = VoxelField | GaussianScene
HARMONIC_GRIDS: dict[str, type[SparseSh]] = {SparseSh.name: SparseSh, DenseSh.name: DenseSh}
FITTED = (DenseGrid.name, *HARMONIC_GRIDS, OctreeSh.name, GaussianScene.name)


def start_field(
    capture: Capture,
    bounds: Bounds,
    options: FitOptions,
    points: Callable[[int], tuple[Array, Array]] | None = None,
) -> tuple[FittedField, str]:
    """What a fit of photographs alone begins with, and a sentence on where it comes from.

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


def frozen_field(field: FittedField, options: FitOptions) -> tuple[OctreeSh, str]:
    """The leaves of a field that was fitted before, and a sentence on them.

    Raises RangeError for a field that has no voxels.
    """
    if isinstance(field, DenseGrid):
        tree = OctreeSh.from_dense_grid(field, degree=options.degree)
    elif isinstance(field, SparseSh):
        tree = OctreeSh.from_sparse_sh(field, degree=options.degree)
    else:
        expected = f"a model of {' or '.join((DenseGrid.name, *HARMONIC_GRIDS))}"
        raise RangeError(message("Fit.start", "start_from", expected, repr(field.name)))
    leaves, side = len(tree.tree.values), tree.resolution
    return tree, f"{tree.shape[0]:,} of {leaves:,} leaves hold matter, in a tree of {side}³ cells"


def saved_field(
    params: Mapping[str, Array],
    state: Mapping[str, Array],
    policy: object,
    options: FitOptions,
) -> FittedField:
    """The field of a checkpoint that `check_checkpoint` has passed, `policy` as JSON has it.

    Raises Error where a policy or the values of the state make no sense.
    """
    if options.representation == GaussianScene.name:
        splats = from_plain("checkpoint", SplatOptions, policy)
        return GaussianScene.of_state(params, state, policy=splats, control=scene_control(options))
    if options.representation == OctreeSh.name:
        tree_policy = from_plain("checkpoint", TreePolicy, policy)
        return OctreeSh.of_state(params, state, tree_policy)
    march = from_plain("checkpoint", MarchPolicy, policy)
    if options.representation in HARMONIC_GRIDS:
        rest = {key: value for key, value in state.items() if key != "background_density"}
        return HARMONIC_GRIDS[options.representation](
            ActiveVoxels.of_state(rest, "load_model"), params["density"], params["sh"], march,
            background_density=float(state["background_density"]),
        )  # fmt: skip
    return DenseGrid(params["values"], march)
