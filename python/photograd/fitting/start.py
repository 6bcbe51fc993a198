"""The representations that a capture can start: what a fit, a model file and a picture may hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np
from photograd_course.portable_math import norm

from photograd._checks import from_plain
from photograd.capture.bounds import Bounds
from photograd.capture.capture import Capture
from photograd.errors import RangeError, message
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.dense_grid import DenseGrid
from photograd.fields.dense_sh import DenseSh
from photograd.fields.march import MarchPolicy
from photograd.fields.octree_leaves import TreePolicy
from photograd.fields.octree_sh import OctreeSh
from photograd.fields.sparse_sh import SparseSh
from photograd.fitting.options import FitOptions
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.density import DensityControl, NoControl, Schedule
from photograd.splats.markov_chain import MarkovChain
from photograd.splats.model import GaussianScene
from photograd.splats.splatting import SplatOptions
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
        capture,
        box,
        count,
        degree=options.degree,
        seed=options.seed,
        given=points(count) if points else None,
    )
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


# The representations that a capture can start: what a fit, a model file and a picture may hold.


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
            bounds.box,
            size,
            degree=options.degree,
            finest=finest,
            sigma_t=options.sigma_t,
            steps_per_voxel=options.steps_per_voxel,
        )
        return harmonic, f"box: {bounds.rule}"
    dense = DenseGrid.empty(
        bounds.box,
        size,
        finest=finest,
        sigma_t=options.sigma_t,
        steps_per_voxel=options.steps_per_voxel,
    )
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
    params: Mapping[str, Array], state: Mapping[str, Array], policy: object, options: FitOptions
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
            ActiveVoxels.of_state(rest, "load_model"),
            params["density"],
            params["sh"],
            march,
            background_density=float(state["background_density"]),
        )
    return DenseGrid(params["values"], march)
