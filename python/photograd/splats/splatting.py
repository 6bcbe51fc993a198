"""3D Gaussian splatting on the CPU: pictures, and derivatives with respect to all parameters.

A Gaussian has a mean, three log-scales, a quaternion, an opacity logit and spherical-harmonic
colors. `render` projects them, sorts them by depth and blends them front to back, pixel by pixel;
`render_backward` gives dL/d of every parameter, of the background and of the camera's pose. Both
give the same bits on any number of threads. [Kerbl2023; Zwicker2001]

Splats have cut-offs, which are discontinuities: `SplatOptions.smooth()` switches all of them off,
for comparisons with finite differences.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photograd import sh
from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_choices, require_finite
from photograd._compiled import _core
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.errors import RangeError, message
from photograd.types import Array

MAX_DEGREE = 3


SHAPES: dict[str, tuple[str | int, ...]] = {
    "means": ("N", 3),
    "log_scales": ("N", 3),
    "quats": ("N", 4),
    "opacity_logits": ("N",),
    "sh": ("N", "K", 3),
}


@typed_call
@dataclass(frozen=True, eq=False)
class Gaussians:
    """N Gaussians, as an optimizer sees them: every number may take any value.

    Attributes:
        means: (N, 3), meters, world frame.
        log_scales: (N, 3), logarithm of the standard deviations along the Gaussian's axes, in
            meters; minus infinity is a Gaussian without extent.
        quats: (N, 4), quaternions (w, x, y, z) of any length; a zero one stands for no rotation.
        opacity_logits: (N,), opacity = sigmoid(logit); infinite ones are opaque, or absent.
        sh: (N, K, 3), K = 1, 4, 9 or 16; color = max(0, 1/2 + sum_k Y_k(d) sh_k) in the direction
            d from the camera to the mean, with the signs of `photograd.sh`.

    Raises:
        DtypeError: the arrays are not all float32 or all float64.
        ShapeError, RangeError: another shape, or another K.
    """

    means: Array
    log_scales: Array
    quats: Array
    opacity_logits: Array
    sh: Array

    def __post_init__(self) -> None:
        call = Arguments("Gaussians")
        for name, shape in SHAPES.items():
            array = call.array(name, getattr(self, name), shape, finite=False)
            object.__setattr__(self, name, array)
        k = self.sh.shape[1]
        if k not in [sh.count(degree) for degree in range(MAX_DEGREE + 1)]:
            raise RangeError(message("Gaussians", "sh", "1, 4, 9 or 16 coefficients", k))

    def __len__(self) -> int:
        return len(self.means)

    @property
    def degree(self) -> int:
        """Degree of the spherical harmonics, 0 to 3."""
        return sh.degree_of(self.sh.shape[1])

    def arrays(self) -> dict[str, Array]:
        """The five arrays by name, not copied."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def astype(self, dtype: type[np.floating[Any]]) -> Gaussians:
        """The same in float32 or float64.

        Args:
            dtype: np.float32 or np.float64.
        """
        return Gaussians(**{name: array.astype(dtype) for name, array in self.arrays().items()})


@typed_call
@dataclass(frozen=True)
class SplatOptions:
    """Policies of splatting. The defaults are those of the original code where it has them.

    Attributes:
        low_pass: pixel^2, added to each splat's screen covariance: none is thinner than a pixel.
        antialiased: opacity makes up for the low-pass, so that thin splats seen from afar keep
            their total instead of growing brighter [Yu2024].
        alpha_min: fainter contributions are dropped; 0 switches it off.
        alpha_max: a splat's opacity in a pixel is held here; 1 switches it off.
        clamped_gradient: derivative where alpha_max holds: "zero", which is right, or "pass", as in
            the original code.
        extent_sigmas: a splat ends so many standard deviations from its mean, along each axis of
            the screen; 0 switches it off.
        stop: a pixel ends before the splat that would leave its transmittance below; 0 switches it
            off.
        near: meters; Gaussians whose mean is closer, or behind the camera, are not drawn.
        frustum_margin: in image sizes; the projection's Jacobian is that of a mean held inside of
            the field of view widened by this on each side.

    Raises:
        RangeError: a value without meaning.
    """

    low_pass: float = 0.3
    antialiased: bool = False
    alpha_min: float = 1 / 255
    alpha_max: float = 0.999
    clamped_gradient: Literal["zero", "pass"] = "zero"
    extent_sigmas: float = 0.0
    stop: float = 1e-4
    near: float = 0.01
    frustum_margin: float = 0.15

    def __post_init__(self) -> None:
        require_choices(self)
        require_bounds(self, "low_pass", "extent_sigmas", "frustum_margin", low=0, high=1e3)
        require_bounds(self, "alpha_min", "stop", low=0, high=0.5)
        require_bounds(self, "alpha_max", low=0.5, high=1)
        require_bounds(self, "near", low=1e-6, high=1e6)

    def smooth(self) -> SplatOptions:
        """The same without cut-offs: every splat reaches every pixel, and no pixel ends early."""
        return replace(self, alpha_min=0.0, alpha_max=1.0, extent_sigmas=0.0, stop=0.0)

    def _core(self) -> Any:
        return _core.SplatOptions(
            self.low_pass,
            self.antialiased,
            self.alpha_min,
            self.alpha_max,
            self.clamped_gradient == "pass",
            self.extent_sigmas,
            self.stop,
            self.near,
            self.frustum_margin,
        )


@typed_call
@dataclass(frozen=True, eq=False)
class SplatPicture:
    """A picture: color (H, W, 3) with the background, opacity (H, W), depth (H, W).

    depth is the sum of weight times distance along the viewing axis, in meters: divide it by
        opacity
    for a mean. Imported splats are made for display colors, not for linear ones.
    """

    color: Array
    opacity: Array
    depth: Array


@typed_call
@dataclass(frozen=True, eq=False)
class SplatContext:
    """What `render_backward` needs of a rendering. The Gaussians must not change in between."""

    gaussians: Gaussians
    picture: SplatPicture
    prepared: Any
    camera_from_world: Array

    @property
    def visible(self) -> NDArray[np.bool_]:
        """Which Gaussians have pixels in the picture, (N,)."""
        boxes = self.prepared.boxes
        return np.asarray(boxes[:, 0] < boxes[:, 1])


@typed_call
@dataclass(frozen=True, eq=False)
class SplatGradients:
    """dL/d of everything that `render` was given.

    Attributes:
        gaussians: {name: array} in the shapes of `Gaussians`; zero for those that are not in the
            picture.
        background: (3,).
        camera_from_world: (3, 4), as twelve free numbers; `twist_gradient` makes a motion of it.
        screen: (N, 2), of the projected means, per pixel; density control looks at its length.
    """

    gaussians: dict[str, Array]
    background: Array
    camera_from_world: Array
    screen: Array


@typed_call
def render(
    gaussians: Gaussians,
    camera: Camera,
    *,
    background: ArrayLike = (0.0, 0.0, 0.0),
    options: SplatOptions | None = None,
    camera_from_world: ArrayLike | None = None,
) -> tuple[SplatPicture, SplatContext]:
    """The picture of Gaussians that a camera takes.

    Gaussians blend in the order of their means' depth along the viewing axis; of equal ones, the
    row that comes first is in front. Splats that numbers cannot hold, among them those wider than
    10^6 pixels, are not drawn.

    Args:
        gaussians: N of them; none is a picture of the background.
        camera: size, focal lengths and pose.
        background: (3,) color behind everything.
        options: policies; None for the defaults.
        camera_from_world: (3, 4) in place of the camera's pose, rigid or nearly so; for optimizing
            it.

    Raises:
        RangeError: a parameter is NaN, or infinite where that has no meaning; the row is named.
        ShapeError: a background or matrix of another shape.
        Error: the picture is not finite, since colors overflow; the pixel is named.
    """
    dtype = gaussians.means.dtype
    if camera_from_world is None:
        camera_from_world = invert_rigid(camera.world_from_camera)[:3]
    call = Arguments("splat.render", dtype)
    view = call.array("camera_from_world", camera_from_world, (3, 4))
    behind = call.array("background", background, (3,))
    image = _core.SplatImage(
        camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy
    )
    prepared = _core.prepare_splats(
        list(gaussians.arrays().values()),
        image=image,
        options=(options or SplatOptions())._core(),
        camera_from_world=view,
        background=behind,
    )
    picture = SplatPicture(*prepared.render())
    require_finite("splat.render", vars(picture), lambda at: f"pixel ({at[1]}, {at[0]})")
    return picture, SplatContext(gaussians, picture, prepared, view)


@typed_call
def render_backward(
    context: SplatContext,
    d_color: Array | None = None,
    d_opacity: Array | None = None,
    d_depth: Array | None = None,
) -> SplatGradients:
    """dL/d parameters, from dL/d color (H, W, 3), opacity (H, W) and depth (H, W); None is zero.

    The order of splats and the pixels that cut-offs drop are held constant. Memory: 40 bytes
    (float32) for each pair of a splat and a tile of 16 x 16 pixels that it touches.

    Args:
        context: of `render`.
        d_color: (H, W, 3), or None.
        d_opacity: (H, W), or None.
        d_depth: (H, W), or None.

    Raises:
        DtypeError, ShapeError: a cotangent of another kind than its output.
    """
    parameters, dtype = context.gaussians.arrays(), context.gaussians.means.dtype
    image = list(vars(context.picture).values())
    gradients = {name: np.zeros_like(array) for name, array in parameters.items()}
    rest = {
        "camera_from_world": np.zeros((3, 4), dtype),
        "background": np.zeros(3, dtype),
        "screen": np.zeros((len(context.gaussians), 2), dtype),
    }
    context.prepared.backward(
        list(parameters.values()),
        image,
        filled_cotangents(image, (d_color, d_opacity, d_depth)),
        list(gradients.values()),
        **{f"d_{name}": array for name, array in rest.items()},
    )
    return SplatGradients(gradients, **rest)


def filled_cotangents(image: list[Array], given: Sequence[Array | None]) -> list[Array]:
    """The cotangents of an image as the core takes them; None is zero.

    Args:
        image: color, opacity and depth.
        given: the cotangent of each, or None.
    """
    return [
        np.zeros_like(array) if d is None else np.ascontiguousarray(d)
        for array, d in zip(image, given, strict=True)
    ]


def twist_gradient(d_camera_from_world: Array, camera_from_world: ArrayLike) -> Array:
    """dL/d of a small motion of the camera's frame: rotation (3,) in radians, then translation
    (3,).

    The motion (omega, v) takes [W | b] = camera_from_world to exp([omega]x) [W | b] + [0 | v].

    Args:
        d_camera_from_world: (3, 4) dL/d pose.
        camera_from_world: (3, 4) or (4, 4).
    """
    rows = np.asarray(camera_from_world)[:3]
    # omega x row-vectors: the derivative with respect to omega_k pairs the rows i, j of a cyclic
    # triple (k, i, j).
    pairs = d_camera_from_world @ rows.T
    turn = [pairs[2, 1] - pairs[1, 2], pairs[0, 2] - pairs[2, 0], pairs[1, 0] - pairs[0, 1]]
    return np.array([*turn, *d_camera_from_world[:, 3]])
