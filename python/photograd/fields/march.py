"""The ray marcher as representations use it: options as an enum-typed dataclass, context, backward.

The mathematics is in cpp/photograd/ops/composite.h (value and adjoint of a ray) and
cpp/photograd/render/march/march.h (the loop).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from photograd_course.portable_math import norm
from photograd_course.random import uniform

from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_choices, require_finite
from photograd._compiled import _core
from photograd.errors import Error, RangeError, message
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd.types import Array

LATTICES = {"origin": 0, "entry": 1}
QUADRATURES = {"alpha": 0, "riemann": 1}
BORDERS = {"clamp": 0, "zero": 1}
ACTIVATIONS = {"identity": 0, "relu": 1, "softplus": 2, "exp": 3, "sigmoid": 4}
CODES = {
    "lattice": LATTICES,
    "quadrature": QUADRATURES,
    "border": BORDERS,
    "density_activation": ACTIVATIONS,
    "color_activation": ACTIVATIONS,
}
Lattice = Literal["origin", "entry"]
Quadrature = Literal["alpha", "riemann"]
Border = Literal["clamp", "zero"]
Activation = Literal["identity", "relu", "softplus", "exp", "sigmoid"]

MOST_SAMPLES: int = _core.max_samples
"""Of a ray along the diagonal of the box; a shorter step takes hours, and then memory."""


@dataclass(frozen=True)
class MarchPolicy:
    """How a field is marched through.

    lattice: "origin" puts samples at multiples of `dt` from the ray's origin, "entry" from the
    point where it enters the box; that has no derivatives with respect to the camera.
    quadrature: "alpha" (1 - exp(-sigma_t dt), second order) or "riemann" (sigma_t dt, first order,
    kept for the lesson). border: "clamp" continues the outermost voxels, "zero" fades to nothing
    over one voxel.

    Raises:
        DtypeError: a number that is none.
        RangeError: a box that is not finite or has no volume, a step that is not positive or takes
            more than `MOST_SAMPLES` to cross the box, a density scale that is not finite, or an
            unknown name.
    """

    box: tuple[tuple[float, float, float], tuple[float, float, float]]  # world, meters
    dt: float  # step in meters; `photograd evaluate` says what half of it would change
    lattice: Lattice = "origin"
    quadrature: Quadrature = "alpha"
    border: Border = "clamp"
    density_activation: Activation = "softplus"
    color_activation: Activation = "sigmoid"
    density_scale: float = 1.0  # 1/m

    def __post_init__(self) -> None:
        box = Arguments("MarchPolicy", np.float64).box("box", self.box)
        require_bounds(self, "density_scale", "dt")
        shortest = norm(box[1] - box[0]) / MOST_SAMPLES
        if self.dt < shortest:
            expected = f"{shortest:.3g} m or more, {MOST_SAMPLES:,} samples across the box"
            raise RangeError(message("MarchPolicy", "dt", expected, self.dt))
        require_choices(self)

    def settings(self, stop: float) -> Any:
        """The core's form of this policy.

        Args:
            stop: transmittance below which a ray ends.
        """
        return _core.MarchSettings(
            box=[list(corner) for corner in self.box],
            dt=self.dt,
            stop=stop,
            density_scale=self.density_scale,
            **{name: codes[getattr(self, name)] for name, codes in CODES.items()},
        )


@dataclass(frozen=True)
class MarchContext:
    """What the backward pass needs: O(1) per ray."""

    field: str
    parameters: Array
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

    @property
    def sample_count(self) -> int:
        """Number of samples that were placed on all rays."""
        return int(self.samples.sum(dtype=np.int64))


def march(
    field: str,
    parameters: Array,
    policy: MarchPolicy,
    batch: RayBatch,
    options: RenderOptions,
    *,
    seed: int,
    step: int,
    fused: bool = True,
    t_max: Array | None = None,
) -> tuple[Outputs, MarchContext]:
    """Render rays through a field of the core. Shapes as in `RayBatch` and `Outputs`.

    `fused=False` forces the staged form, the readable oracle of the dense grid's kernel. `t_max`
    (R,) ends each ray at that distance, infinity included: samples beyond are left out. Raises
    Error if a parameter or an output is not finite, RangeError for rays that are not finite or
    whose directions are not of length one, named by their pixel, or as `check_camera_adjoint`.

    Args:
        field: name in the core.
        parameters: of the field.
        policy: box, step and activations.
        batch: the rays.
        options: of this rendering.
        seed: of the jitter.
        step: of the fit, for other jitter at each.
        fused: see above.
        t_max: see above.
    """
    check_camera_adjoint("march", policy, options)
    checked_values("march", "parameters", parameters)
    settings = policy.settings(options.stop)
    origins, directions, t0, samples = checked_rays(
        batch, settings, options, parameters.dtype, seed=seed, step=step
    )
    if t_max is not None:
        before = np.floor(np.clip((t_max - t0) / policy.dt + 0.5, 0, samples))
        samples = np.ascontiguousarray(before, np.int32)
    color, transmittance, depth = _core.march(
        field, parameters, settings, (origins, directions, t0, samples), fused
    )
    require_finite_image(color, transmittance, batch)
    context = MarchContext(
        field,
        parameters,
        settings,
        origins,
        directions,
        t0,
        samples,
        color,
        transmittance,
        depth,
        options.camera_adjoint,
        fused,
    )
    return Outputs(color, 1 - transmittance, depth), context


def cotangent_arrays(
    function: str, d_outputs: Outputs, rays: int, dtype: npt.DTypeLike
) -> list[Array]:
    """Derivatives of a loss with respect to color, transmittance and depth, as marches take them.

    Args:
        function: on whose behalf errors speak.
        d_outputs: of the shapes of the outputs; None stands for zeros.
        rays: their number R.
        dtype: of the results.

    Returns:
        (R, 3), (R,), (R,); transmittance is 1 - opacity.

    Raises:
        ShapeError: other shapes.
    """
    call, found = Arguments(function, dtype), []
    for name, shape in {"color": (rays, 3), "opacity": (rays,), "depth": (rays,)}.items():
        given = getattr(d_outputs, name)
        d = np.zeros(shape, dtype) if given is None else given
        found.append(call.array(f"d_outputs.{name}", d, shape, finite=False))
    found[1] = -found[1]
    return found


def march_backward(context: MarchContext, d_outputs: Outputs) -> dict[str, Array]:
    """{"parameters": ..., and with camera_adjoint "origins", "directions"} for a march.

    The camera adjoint is the interior term: where a ray enters and leaves the box is held fixed.

    Args:
        context: of the march.
        d_outputs: of the shapes of the outputs.
    """
    c = context
    cotangents = cotangent_arrays("march_backward", d_outputs, len(c.t0), c.parameters.dtype)
    gradients = {"parameters": np.zeros_like(c.parameters)}
    if c.camera_adjoint:
        gradients["origins"] = np.zeros_like(c.origins)
        gradients["directions"] = np.zeros_like(c.directions)
    _core.march_backward(
        c.field,
        c.parameters,
        c.settings,
        (c.origins, c.directions, c.t0, c.samples),
        (c.color, c.transmittance, c.depth),
        cotangents,
        gradients["parameters"],
        (gradients["origins"], gradients["directions"]) if c.camera_adjoint else None,
        c.fused,
    )
    return gradients


def check_camera_adjoint(function: str, policy: MarchPolicy, options: RenderOptions) -> None:
    """Refuse derivatives with respect to the camera where samples hang on the point of entry.

    That point moves with the camera; the adjoint holds all t fixed and would leave its part out.

    Args:
        function: on whose behalf the error speaks.
        policy: with the lattice.
        options: of the rendering.

    Raises:
        RangeError: `camera_adjoint` with the lattice "entry".
    """
    if options.camera_adjoint and policy.lattice == "entry":
        got = "'entry', whose samples move with the point where a ray enters the box"
        remedy = "MarchPolicy(lattice='origin') has the whole derivative"
        expected = "a lattice with a whole derivative with respect to the camera"
        raise RangeError(message(function, "options.camera_adjoint", expected, got, remedy))


def checked_rays(
    batch: RayBatch,
    settings: Any,
    options: RenderOptions,
    dtype: np.dtype[Any],
    *,
    seed: int,
    step: int,
) -> tuple[Array, Array, Array, Array]:
    """Origins, directions (R, 3), t0 and samples (R,) of a batch, with its jitter.

    Raises RangeError for rays that are not finite or whose directions are not of length one.

    Args:
        batch: the rays.
        settings: of the core.
        options: of the rendering.
        dtype: of the field.
        seed: of the jitter.
        step: of the fit.
    """
    _check_rays(batch)
    origins = np.ascontiguousarray(batch.origins, dtype)
    directions = np.ascontiguousarray(batch.directions, dtype)
    jitter = None
    if options.jitter:
        jitter = uniform(seed, step=step, pixel=batch.pixel, sample=0, dimension=0).astype(dtype)
    t0, samples = _core.place_samples(settings, origins, directions, jitter)
    return origins, directions, t0, samples


def checked_values(function: str, argument: str, values: Array) -> None:
    """Kernels may assume finite numbers, and would hide others; one pass over them, done here.

    Args:
        function: on whose behalf the error speaks.
        argument: what it calls the values.
        values: of any shape.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        if np.isfinite(values.sum()):
            return
    count = values.size - int(np.isfinite(values).sum())
    if count:  # else only the sum itself overflowed
        raise Error(message(function, argument, "finite values", f"{count} that are not"))


def _check_rays(batch: RayBatch) -> None:
    length = np.einsum("rk,rk->r", batch.directions, batch.directions)
    # Ten per cent leave room for differences in the directions, and catch unscaled ones.
    bad = ~((length > 0.9) & (length < 1.1) & np.isfinite(batch.origins).all(axis=1))
    if not bad.any():
        return
    first = int(np.flatnonzero(bad)[0])
    got = f"{int(bad.sum())} others, the first for pixel {int(batch.pixel[first])}"
    got += f": from {batch.origins[first]} along {batch.directions[first]}"
    raise RangeError(message("march", "batch", "finite origins and unit directions", got))


def require_finite_image(color: Array, transmittance: Array, batch: RayBatch) -> None:
    """Raise Error, naming the first pixel, if a ray is not finite.

    Args:
        color: (R, 3).
        transmittance: (R,).
        batch: the rays.
    """
    outputs = {"color": color, "transmittance": transmittance}
    require_finite("march", outputs, lambda at: f"pixel {int(batch.pixel[at[0]])}")
