"""Lens distortion in the radial-tangential model, and its inverse [Brown1966].

With normalised image coordinates (x, y) = (X/Z, Y/Z) and r^2 = x^2 + y^2:
    x' = x (1 + k1 r^2 + k2 r^4) + 2 p1 x y + p2 (r^2 + 2 x^2)
    y' = y (1 + k1 r^2 + k2 r^4) + p1 (r^2 + 2 y^2) + 2 p2 x y
The photograph shows (x', y'); the pinhole camera that we fit sees (x, y). There is no closed
inverse.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np
import numpy.typing as npt

from photograd.capture.camera import Camera
from photograd.errors import RangeError, ShapeError, message
from photograd.types import FloatArray

LARGEST_STEPS = 50
"""Newton converges in about 5 steps wherever the lens does not fold; the rest is for the search."""


@dataclass(frozen=True)
class Distortion:
    """Coefficients of the radial (k1, k2) and tangential (p1, p2) terms; all zero is a pinhole."""

    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0

    def __post_init__(self) -> None:
        for name, value in zip(("k1", "k2", "p1", "p2"), astuple(self), strict=True):
            if not abs(value) < 1e6:
                raise RangeError(message("Distortion", name, "a finite coefficient", value))

    @property
    def is_identity(self) -> bool:
        """True if every coefficient is zero."""
        return not any(astuple(self))


def distort(distortion: Distortion, points: FloatArray) -> FloatArray:
    """Where the lens shows ideal points: (N, 2) normalised to (N, 2) normalised.

    Raises:
        ShapeError: points not (N, 2).
    """
    if points.ndim != 2 or points.shape[1] != 2:
        raise ShapeError(message("distort", "points", "shape (N, 2)", points.shape))
    x, y = points[:, 0], points[:, 1]
    k1, k2, p1, p2 = astuple(distortion)
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * k2)
    return np.stack(
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ],
        axis=-1,
    )


def distort_jacobian(distortion: Distortion, points: FloatArray) -> FloatArray:
    """Derivative (N, 2, 2) of `distort` by the ideal point; symmetric in this model.

    With R = 1 + k1 r^2 + k2 r^4 and R' = dR/d(r^2) = k1 + 2 k2 r^2:
        dx'/dx = R + 2 x^2 R' + 2 p1 y + 6 p2 x      dx'/dy = 2 x y R' + 2 p1 x + 2 p2 y
        dy'/dy = R + 2 y^2 R' + 6 p1 y + 2 p2 x      dy'/dx = dx'/dy
    """
    x, y = points[:, 0], points[:, 1]
    k1, k2, p1, p2 = astuple(distortion)
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * k2)
    slope = k1 + 2.0 * k2 * r2
    xx = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x
    xy = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y
    yy = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)


def undistort(distortion: Distortion, points: FloatArray, tolerance: float = 1e-12) -> FloatArray:
    """Ideal points (N, 2) that the lens shows at `points` (N, 2): Newton's method on `distort`.

    A step that does not reduce a point's residual is halved, so that Newton cannot run away near a
    fold.

    Raises:
        ShapeError: points not (N, 2).
        RangeError: some point did not converge to `tolerance`: the lens model never shows it, or
            only beyond its fold.
    """
    ideal = np.array(points, dtype=np.float64)
    residual = distort(distortion, ideal) - points
    step_length = np.ones(len(ideal))
    with np.errstate(all="ignore"):
        for _ in range(LARGEST_STEPS):
            open_points = ~(np.abs(residual).max(axis=-1, initial=0.0) <= tolerance)
            if not bool(open_points.any()):
                break
            jacobian = distort_jacobian(distortion, ideal)
            determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] ** 2
            step_x = jacobian[:, 1, 1] * residual[:, 0] - jacobian[:, 0, 1] * residual[:, 1]
            step_y = jacobian[:, 0, 0] * residual[:, 1] - jacobian[:, 0, 1] * residual[:, 0]
            step = np.stack([step_x, step_y], axis=-1) / determinant[:, None]
            trial = ideal - step_length[:, None] * step
            trial_residual = distort(distortion, trial) - points
            better = np.linalg.norm(trial_residual, axis=-1) < np.linalg.norm(residual, axis=-1)
            accept = open_points & better
            ideal[accept], residual[accept] = trial[accept], trial_residual[accept]
            step_length = np.where(better, 1.0, 0.5 * step_length)
        on_our_side = inside_fold(distortion, ideal)
    failed = ~((np.abs(residual).max(axis=-1, initial=0.0) <= tolerance) & on_our_side)
    if bool(failed.any()):
        got = f"{int(failed.sum())} of {len(ideal)} points without one, first {points[failed][0]}"
        raise RangeError(message("undistort", "points", "points that the lens shows", got))
    return ideal


def inside_fold(distortion: Distortion, points: FloatArray) -> npt.NDArray[np.bool_]:
    """Which ideal points (N, 2) lie where the lens still maps one to one.

    The radial part folds at the first r > 0 with d/dr [r (1 + k1 r^2 + k2 r^4)] = 0, a quadratic in
    r^2; with tangential terms the sign of the Jacobian's determinant is asked too.
    """
    k1, k2 = distortion.k1, distortion.k2
    roots = np.roots([5.0 * k2, 3.0 * k1, 1.0])
    real = [float(root.real) for root in roots if abs(root.imag) < 1e-12 and root.real > 0.0]
    fold = min(real, default=np.inf)
    jacobian = distort_jacobian(distortion, points)
    determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] * jacobian[:, 1, 0]
    inside: npt.NDArray[np.bool_] = (np.square(points).sum(axis=-1) < fold) & (determinant > 0.0)
    return inside


def source_positions(
    camera: Camera, distortion: Distortion
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Where in the photograph each pixel of the ideal `camera` looks.

    Returns:
        Pixel positions (H, W, 2), and which of them (H, W) can be read by bilinear interpolation:
        one to one under the lens and inside the hull of the photograph's pixel centres.
    """
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    ideal = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy], axis=-1)
    with np.errstate(all="ignore"):
        seen = distort(distortion, ideal.reshape(-1, 2)).reshape(ideal.shape)
        valid = inside_fold(distortion, ideal.reshape(-1, 2)).reshape(ideal.shape[:2])
        positions = seen * [camera.fx, camera.fy] + [camera.cx, camera.cy]
        slack = 1e-9 * max(camera.width, camera.height)
        for axis, size in ((0, camera.width), (1, camera.height)):
            valid &= positions[..., axis] >= 0.5 - slack
            valid &= positions[..., axis] <= size - 0.5 + slack
    return positions, valid


def undistort_image(
    image: npt.NDArray[np.float32], camera: Camera, distortion: Distortion
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """The photograph as the ideal `camera` (same size and intrinsics) would have taken it.

    Args:
        image: (H, W, 4) with straight alpha; interpolated in premultiplied alpha, so that hidden
            colours of transparent pixels do not bleed.

    Returns:
        The image (H, W, 4) with zeros where the photograph does not reach, and the mask (H, W) of
        pixels that it does reach.

    Raises:
        ShapeError: the image is not that of the camera.
    """
    shape = (camera.height, camera.width, 4)
    if image.shape != shape:
        raise ShapeError(message("undistort_image", "image", f"shape {shape}", image.shape))
    positions, valid = source_positions(camera, distortion)
    x = np.where(valid, positions[..., 0] - 0.5, 0.0).clip(0.0, camera.width - 1.0)
    y = np.where(valid, positions[..., 1] - 0.5, 0.0).clip(0.0, camera.height - 1.0)
    left, top = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    right, bottom = np.minimum(left + 1, shape[1] - 1), np.minimum(top + 1, shape[0] - 1)
    wx = (x - left).astype(np.float32)[..., None]
    wy = (y - top).astype(np.float32)[..., None]
    buffer = image.copy()
    buffer[..., :3] *= image[..., 3:]
    upper = buffer[top, left] * (1.0 - wx) + buffer[top, right] * wx
    lower = buffer[bottom, left] * (1.0 - wx) + buffer[bottom, right] * wx
    result = (upper * (1.0 - wy) + lower * wy) * valid[..., None]
    alpha = result[..., 3:]
    np.divide(result[..., :3], alpha, out=result[..., :3], where=alpha > 0.0)
    return result.astype(np.float32, copy=False), valid
