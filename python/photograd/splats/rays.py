"""3D Gaussians along rays: the same Gaussians as in `splatting`, seen by any rays there are.

Splatting projects a Gaussian as a whole, with the linear part of a pinhole's projection at its
mean. Here each ray asks each Gaussian near it for its largest value along the ray, exactly, so that
rays of a fisheye, a mirror or a single pixel are as good as those of a pinhole. [MoenneLoccoz2024]

    alpha = opacity * exp(-q / 2),    q = smallest (x - mean)^T cov^-1 (x - mean) on the ray

A ray blends what it sees front to back, in the order of the peaks, ties in the order of rows.
`render_backward` gives dL/d of every parameter, of the background and of the rays. Both give the
same bits on any number of threads.

Against splatting: no low-pass, since a ray has no width (Gaussians thinner than a pixel flicker;
take several rays a pixel); the order is each ray's own instead of one for the picture; colors
are those of the ray's direction, not of the direction to the mean; depth is measured along the
ray. For small Gaussians and a narrow field of view the pictures agree.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_finite
from photograd._compiled import _core
from photograd.splats.splatting import Gaussians, filled_cotangents
from photograd.types import Array


@dataclass(frozen=True)
class RayOptions:
    """Policies of casting rays at Gaussians; the numbers are those of `SplatOptions`.

    Attributes:
        alpha_min: fainter contributions are dropped; 0 switches it off, and makes every ray look at
            every Gaussian.
        alpha_max: a Gaussian's opacity along a ray is held here, with derivative zero; 1 switches
            it off.
        stop: a ray ends before the Gaussian that would leave its transmittance below; 0 switches it
            off.
        t_min: meters; Gaussians whose peak is closer to the ray's origin, or behind it, are not
            seen.

    Raises:
        RangeError: a value without meaning.
    """

    alpha_min: float = 1 / 255
    alpha_max: float = 0.999
    stop: float = 1e-4
    t_min: float = 0.01

    def __post_init__(self) -> None:
        require_bounds(self, "alpha_min", "stop", low=0, high=0.5)
        require_bounds(self, "alpha_max", low=0.5, high=1)
        require_bounds(self, "t_min", low=0, high=1e6)

    def smooth(self) -> RayOptions:
        """The same without cut-offs, but for `t_min`: for comparisons with finite differences."""
        return replace(self, alpha_min=0.0, alpha_max=1.0, stop=0.0)


@dataclass(frozen=True, eq=False)
class RayPicture:
    """color (R, 3) with the background, opacity (R,), depth (R,).

    depth is the sum of weight times distance along the ray, in meters, whatever the length of its
    direction: divide it by opacity for a mean.
    """

    color: Array
    opacity: Array
    depth: Array


@dataclass(frozen=True, eq=False)
class RayContext:
    """What `render_backward` needs of a rendering. The Gaussians must not change in between."""

    gaussians: Gaussians
    picture: RayPicture
    prepared: Any

    @property
    def crossings(self) -> NDArray[np.uint32]:
        """How many Gaussians each ray blended, (R,)."""
        return np.asarray(self.prepared.crossings)


@dataclass(frozen=True, eq=False)
class RayGradients:
    """dL/d of everything that `render` was given.

    Attributes:
        gaussians: {name: array} in the shapes of `Gaussians`; zero for those that no ray sees.
        background: (3,).
        origins, directions: (R, 3), or None where `render_backward` was not asked for them. A
            direction's length changes nothing, so its gradient is orthogonal to it.
    """

    gaussians: dict[str, Array]
    background: Array
    origins: Array | None
    directions: Array | None


def render(
    gaussians: Gaussians,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    background: ArrayLike = (0.0, 0.0, 0.0),
    options: RayOptions | None = None,
) -> tuple[RayPicture, RayContext]:
    """What rays see of Gaussians, front to back.

    Gaussians with a standard deviation below 1e-12 m (flat ones among them) or above 1e12 m, or a
    mean farther than 1e15 m, are not drawn.

    Args:
        gaussians: N of them; none is a picture of the background.
        origins: (R, 3), meters, world frame; converted to the Gaussians' dtype.
        directions: (R, 3) of any length but zero; `Camera.rays()` gives those of a camera.
        background: (3,) color behind everything.
        options: policies; None for the defaults.

    Raises:
        RangeError: a parameter, a ray or the background is no number where it must be one, or a
            direction is zero; the row is named.
        ShapeError: an array of another shape.
        Error: what is seen is not finite, since colors overflow; the ray is named.
    """
    call = Arguments("splat_rays.render", gaussians.means.dtype)
    starts = call.array("origins", origins, ("R", 3))
    along = call.array("directions", directions, ("R", 3))
    length = np.linalg.norm(along.astype(np.float64), axis=1)
    call.array("directions: lengths", length, above=1e-15, below=1e15, dtype=np.float64)
    behind = call.array("background", background, (3,))
    policies = options or RayOptions()
    arrays = list(gaussians.arrays().values())
    core_options = _core.RayOptions(**vars(policies))
    prepared = _core.prepare_splat_rays(arrays, core_options, starts, along, behind)
    picture = RayPicture(*prepared.render(arrays))
    require_finite("splat_rays.render", vars(picture), lambda at: f"ray {at[0]}")
    return picture, RayContext(gaussians, picture, prepared)


def render_backward(
    context: RayContext,
    d_color: Array | None = None,
    d_opacity: Array | None = None,
    d_depth: Array | None = None,
    *,
    rays: bool = False,
) -> RayGradients:
    """dL/d parameters, from dL/d color (R, 3), opacity (R,) and depth (R,); None is zero.

    The order of Gaussians along each ray, and what cut-offs drop, are held constant. Scratch: 40 MB
    (float32), whatever the number of rays and Gaussians; nothing is kept of the forward pass but
    the rays and a count for each.

    Args:
        context: of `render`.
        d_color: (R, 3), or None.
        d_opacity: (R,), or None.
        d_depth: (R,), or None.
        rays: also dL/d origins and directions.

    Raises:
        DtypeError, ShapeError: a cotangent of another kind than its output.
    """
    image = list(vars(context.picture).values())
    parameters = context.gaussians.arrays()
    gradients = {name: np.zeros_like(array) for name, array in parameters.items()}
    background = np.zeros(3, context.gaussians.means.dtype)
    d_rays = [np.zeros_like(context.picture.color) for _ in range(2)] if rays else None
    context.prepared.backward(
        list(parameters.values()),
        image,
        filled_cotangents(image, (d_color, d_opacity, d_depth)),
        list(gradients.values()),
        background,
        d_rays,
    )
    return RayGradients(gradients, background, *(d_rays or (None, None)))
