"""Marching through the voxels of a sparse grid: what the core is given, and what it gives back.

The mathematics is in cpp/photograd/field/sparse_sh.h.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from photograd._compiled import _core
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.march import (
    MarchPolicy,
    check_camera_adjoint,
    checked_rays,
    checked_values,
    cotangent_arrays,
    require_finite_image,
)
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd.types import Array


@dataclass(frozen=True)
class SparseContext:
    """What the backward pass needs, topology included: it cannot change under a rendering."""

    active: ActiveVoxels
    parameters: tuple[Array, Array, Array]  # density (N,), sh (N, K, 3), background (1 + 3 K,)
    settings: Any
    origins: Array
    directions: Array
    t0: Array
    samples: Array
    color: Array
    transmittance: Array
    depth: Array
    camera_adjoint: bool
    fused: bool
    looked_up: int  # samples whose voxels were read, all in float64; the others were skipped


def march_sparse(
    active: ActiveVoxels,
    parameters: tuple[Array, Array, Array],
    policy: MarchPolicy,
    batch: RayBatch,
    options: RenderOptions,
    *,
    seed: int,
    step: int,
    fused: bool = True,
) -> tuple[Outputs, SparseContext]:
    """Render rays through a sparse grid. Shapes as in `RayBatch` and `Outputs`.

    `parameters` are density (N,), harmonics (N, K, 3) and what is outside of the active voxels
    (1 + 3 K,). Raises as `photograd.fields.march.march`.

    Args:
        active: which voxels there are.
        parameters: see above.
        policy: box, step and activations.
        batch: the rays.
        options: of this rendering.
        seed: of the jitter.
        step: of the fit, for other jitter at each.
        fused: False takes the readable form of the kernel.
    """
    check_camera_adjoint("SparseSh.render", policy, options)
    density, coefficients, _ = parameters
    checked_values("SparseSh.render", "density", density)
    checked_values("SparseSh.render", "sh", coefficients)
    settings = policy.settings(options.stop)
    rays = checked_rays(batch, settings, options, density.dtype, seed=seed, step=step)
    color, transmittance, depth, looked_up = _core.march_sparse_sh(
        active.table, parameters, settings, 0.0, rays, fused=fused
    )
    require_finite_image(color, transmittance, batch)
    image = color, transmittance, depth
    context = SparseContext(
        active, parameters, settings, *rays, *image, options.camera_adjoint, fused, looked_up
    )
    return Outputs(color, 1 - transmittance, depth), context


def march_sparse_backward(c: SparseContext, d_outputs: Outputs) -> tuple[dict[str, Array], Array]:
    """{"density", "sh", with camera_adjoint "origins", "directions"}; d_background (1 + 3 K,).

    Args:
        c: context of `march_sparse`.
        d_outputs: of the shapes of the outputs.
    """
    density, coefficients, background = c.parameters
    cotangents = cotangent_arrays("march_sparse_backward", d_outputs, len(c.t0), density.dtype)
    d_background = np.zeros_like(background)
    gradients = {"density": np.zeros_like(density), "sh": np.zeros_like(coefficients)}
    if c.camera_adjoint:
        gradients["origins"] = np.zeros_like(c.origins)
        gradients["directions"] = np.zeros_like(c.directions)
    _core.march_sparse_sh_backward(
        c.active.table,
        c.parameters,
        c.settings,
        0.0,
        (c.origins, c.directions, c.t0, c.samples),
        (c.color, c.transmittance, c.depth),
        cotangents,
        (gradients["density"], gradients["sh"], d_background),
        (gradients["origins"], gradients["directions"]) if c.camera_adjoint else None,
        c.fused,
    )
    return gradients, d_background


def greatest_weights(
    active: ActiveVoxels,
    parameters: tuple[Array, Array, Array],
    policy: MarchPolicy,
    batches: Iterable[RayBatch],
) -> Array:
    """(N,) float32, the greatest weight that each voxel has in any sample of these rays.

    Args:
        active: which voxels there are.
        parameters: as of `march_sparse`.
        policy: box, step and activations.
        batches: rays.
    """
    density, coefficients, background = (np.ascontiguousarray(p, np.float32) for p in parameters)
    settings, kind = policy.settings(0.0), np.dtype(np.float32)
    max_weight = np.zeros(len(active), np.float32)
    for batch in batches:
        rays = checked_rays(batch, settings, RenderOptions(), kind, seed=0, step=0)
        narrow = density, coefficients, background
        _core.sparse_sh_weights(active.table, narrow, settings, rays, max_weight)
    return max_weight
