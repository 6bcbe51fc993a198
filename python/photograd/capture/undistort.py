"""Lenses: where they show the points of a pinhole camera, and photographs without distortion.

Points are normalized image coordinates (x, y) = (X/Z, Y/Z) of the pinhole camera that we fit. The
photograph shows them at (x', y'), in units of the same focal lengths and about the same principal
point.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from photograd._arrays import Arguments
from photograd._extras import import_extra
from photograd._typed import typed_call
from photograd.capture.camera import Camera
from photograd.errors import RangeError, message
from photograd.types import FloatArray

MAX_STEPS = 50
"""Newton converges in about 5 steps wherever the lens does not fold; the rest is for the search."""
MAX_COEFFICIENT = 1e6


class Lens(Protocol):
    """What a photograph does to the points of a pinhole camera."""

    def distort(self, points: FloatArray) -> FloatArray:
        """Where the lens shows ideal points: (N, 2) normalized to (N, 2) normalized."""

    def inside_fold(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Which ideal points (N, 2) lie where the lens maps one to one."""


@typed_call
@dataclass(frozen=True)
class Distortion:
    """The radial (k1, k2) and tangential (p1, p2) model [Brown1966]; all zero is a pinhole.

    With r^2 = x^2 + y^2:
        x' = x (1 + k1 r^2 + k2 r^4) + 2 p1 x y + p2 (r^2 + 2 x^2)
        y' = y (1 + k1 r^2 + k2 r^4) + p1 (r^2 + 2 y^2) + 2 p2 x y
    There is no closed inverse.
    """

    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0

    def __post_init__(self) -> None:
        _check_coefficients(self)

    @property
    def is_identity(self) -> bool:
        """True if every coefficient is zero."""
        return not any(astuple(self))

    def distort(self, points: FloatArray) -> FloatArray:
        """Where the lens shows ideal points: (N, 2) normalized to (N, 2) normalized.

        Raises:
            ShapeError: points not (N, 2).
        """
        points = _points("Distortion.distort", points)
        x, y = points[:, 0], points[:, 1]
        k1, k2, p1, p2 = astuple(self)
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * k2)
        return np.stack(
            [
                x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
            ],
            axis=-1,
        )

    def jacobian(self, points: FloatArray) -> FloatArray:
        """Derivative (N, 2, 2) of `distort` with respect to the ideal point; symmetric.

        With R = 1 + k1 r^2 + k2 r^4 and R' = dR/d(r^2) = k1 + 2 k2 r^2:
            dx'/dx = R + 2 x^2 R' + 2 p1 y + 6 p2 x      dx'/dy = 2 x y R' + 2 p1 x + 2 p2 y
            dy'/dy = R + 2 y^2 R' + 6 p1 y + 2 p2 x      dy'/dx = dx'/dy

        Args:
            points: (N, 2) ideal points, at depth 1.
        """
        x, y = points[:, 0], points[:, 1]
        k1, k2, p1, p2 = astuple(self)
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * k2)
        slope = k1 + 2.0 * k2 * r2
        xx = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x
        xy = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y
        yy = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x
        return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)

    def undistort(self, points: FloatArray, tolerance: float = 1e-12) -> FloatArray:
        """Ideal points (N, 2) that the lens shows at `points` (N, 2): Newton's method on `distort`.

        A step that does not reduce a point's residual is halved, so that Newton cannot run away
        near a fold.

        Raises:
            ShapeError: points not (N, 2).
            RangeError: some point did not converge to `tolerance`: the lens model never shows it,
                or only beyond its fold.
        """
        points = _points("Distortion.undistort", points)
        ideal = np.array(points)
        residual = self.distort(ideal) - points
        step_size = np.ones(len(ideal))
        with np.errstate(all="ignore"):
            for _ in range(MAX_STEPS):
                open_points = ~(np.abs(residual).max(axis=-1, initial=0.0) <= tolerance)
                if not bool(open_points.any()):
                    break
                jacobian = self.jacobian(ideal)
                determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] ** 2
                step_x = jacobian[:, 1, 1] * residual[:, 0] - jacobian[:, 0, 1] * residual[:, 1]
                step_y = jacobian[:, 0, 0] * residual[:, 1] - jacobian[:, 0, 1] * residual[:, 0]
                step = np.stack([step_x, step_y], axis=-1) / determinant[:, None]
                trial = ideal - step_size[:, None] * step
                trial_residual = self.distort(trial) - points
                better = np.linalg.norm(trial_residual, axis=-1) < np.linalg.norm(residual, axis=-1)
                accept = open_points & better
                ideal[accept], residual[accept] = trial[accept], trial_residual[accept]
                step_size = np.where(better, 1.0, 0.5 * step_size)
            on_our_side = self.inside_fold(ideal)
        failed = ~((np.abs(residual).max(axis=-1, initial=0.0) <= tolerance) & on_our_side)
        if bool(failed.any()):
            got = (
                f"{int(failed.sum())} of {len(ideal)} points without one, first {points[failed][0]}"
            )
            expected = "points that the lens shows"
            raise RangeError(message("Distortion.undistort", "points", expected, got))
        return ideal

    def inside_fold(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Which ideal points (N, 2) lie where the lens still maps one to one.

        The radial part folds at the first r > 0 with d/dr [r (1 + k1 r^2 + k2 r^4)] = 0, a
        quadratic in r^2; with tangential terms the sign of the Jacobian's determinant counts too.
        """
        fold = _first_root([5.0 * self.k2, 3.0 * self.k1, 1.0])
        jacobian = self.jacobian(points)
        determinant = jacobian[:, 0, 0] * jacobian[:, 1, 1] - jacobian[:, 0, 1] * jacobian[:, 1, 0]
        inside: npt.NDArray[np.bool_] = np.square(points).sum(axis=-1) < fold
        return inside & (determinant > 0.0)


@typed_call
@dataclass(frozen=True)
class FisheyeDistortion:
    """The equidistant model with four radial coefficients [Kannala2006, eq. 6].

    With r^2 = x^2 + y^2 and the angle to the optical axis theta = atan(r):
        (x', y') = (x, y) theta / r (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
    """

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0

    def __post_init__(self) -> None:
        _check_coefficients(self)

    def distort(self, points: FloatArray) -> FloatArray:
        """Where the lens shows ideal points: (N, 2) normalized to (N, 2) normalized.

        Raises:
            ShapeError: points not (N, 2).
        """
        points = _points("FisheyeDistortion.distort", points)
        r = np.hypot(points[:, 0], points[:, 1])
        theta = np.arctan(r)
        t = theta * theta
        k1, k2, k3, k4 = astuple(self)
        scale = np.where(r > 0.0, theta / np.where(r > 0.0, r, 1.0), 1.0)
        scale *= 1.0 + t * (k1 + t * (k2 + t * (k3 + t * k4)))
        return points * scale[:, None]

    def inside_fold(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Which ideal points (N, 2) lie where the lens still maps one to one.

        It folds at the first theta > 0 where the derivative of the radius with respect to theta is
        0: 1 + 3 k1 theta^2 + 5 k2 theta^4 + 7 k3 theta^6 + 9 k4 theta^8, a quartic in theta^2.
        """
        k1, k2, k3, k4 = astuple(self)
        fold = _first_root([9.0 * k4, 7.0 * k3, 5.0 * k2, 3.0 * k1, 1.0])
        theta = np.arctan(np.hypot(points[:, 0], points[:, 1]))
        inside: npt.NDArray[np.bool_] = theta * theta < fold
        return inside


@typed_call
@dataclass(frozen=True)
class ColmapLens:
    """A lens of any other model of COLMAP, as pycolmap computes it (extra `sfm`).

    Attributes:
        model: COLMAP's name, such as "FULL_OPENCV".
        parameters: all of the model's, the focal lengths and the principal point in pixels first.

    Raises:
        RangeError: parameters that are not finite.
        IoError: pycolmap is not installed.
    """

    model: str
    parameters: tuple[float, ...]

    def __post_init__(self) -> None:
        call = Arguments("ColmapLens", np.float64)
        call.array("parameters", self.parameters, ("P",), above=-1e9, below=1e9)
        self._camera()

    def _camera(self) -> Any:
        pycolmap = import_extra(f"a lens of the model {self.model}", "pycolmap", "sfm")
        size = {"width": 1, "height": 1}  # no projection depends on it
        return pycolmap.Camera(model=self.model, params=list(self.parameters), **size)

    def distort(self, points: FloatArray) -> FloatArray:
        """Where the lens shows ideal points: (N, 2) normalized to (N, 2) normalized, or NaN.

        Raises:
            ShapeError: points not (N, 2).
        """
        points = _points("ColmapLens.distort", points)
        camera = self._camera()
        pixels = camera.img_from_cam(np.column_stack([points, np.ones(len(points))]))
        center = [camera.principal_point_x, camera.principal_point_y]
        shown: FloatArray = (pixels - center) / [camera.focal_length_x, camera.focal_length_y]
        return shown

    def inside_fold(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Which ideal points (N, 2) the inverse finds again: those on our side of any fold."""
        camera = self._camera()
        there = camera.img_from_cam(np.column_stack([points, np.ones(len(points))]))
        error = np.abs(camera.cam_from_img(there) - points).max(axis=-1, initial=0.0)
        found: npt.NDArray[np.bool_] = error <= 1e-6 * (1.0 + np.abs(points).max(initial=0.0))
        return found


def _points(function: str, points: FloatArray) -> FloatArray:
    return Arguments(function, np.float64).array("points", points, ("N", 2), finite=False)


def _check_coefficients(lens: Distortion | FisheyeDistortion) -> None:
    call = Arguments(type(lens).__name__)
    for name, value in vars(lens).items():
        call.number(name, value, above=-MAX_COEFFICIENT, below=MAX_COEFFICIENT)


def _first_root(coefficients: list[float]) -> float:
    """The smallest positive root of a polynomial, highest power first; infinity without one."""
    roots = np.roots(coefficients)
    real = [float(root.real) for root in roots if abs(root.imag) < 1e-12 and root.real > 0.0]
    return min(real, default=np.inf)


def source_positions(camera: Camera, lens: Lens) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Where in the photograph each pixel of the ideal `camera` looks.

    Returns:
        Pixel positions (H, W, 2), and which of them (H, W) can be read by bilinear interpolation:
        one to one under the lens and inside the hull of the photograph's pixel centers.
    """
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    ideal = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy], axis=-1)
    with np.errstate(all="ignore"):
        shown = lens.distort(ideal.reshape(-1, 2)).reshape(ideal.shape)
        valid = lens.inside_fold(ideal.reshape(-1, 2)).reshape(ideal.shape[:2])
        positions = shown * [camera.fx, camera.fy] + [camera.cx, camera.cy]
        slack = 1e-9 * max(camera.width, camera.height)
        for axis, size in ((0, camera.width), (1, camera.height)):
            valid &= positions[..., axis] >= 0.5 - slack
            valid &= positions[..., axis] <= size - 0.5 + slack
    return positions, valid


@typed_call
def undistort_image(
    image: npt.NDArray[np.float32], camera: Camera, lens: Lens
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.bool_]]:
    """The photograph as the ideal `camera` (same size and intrinsics) would have taken it.

    Args:
        image: (H, W, 4) with straight alpha; interpolated in premultiplied alpha, so that hidden
            colors of transparent pixels do not bleed.
        camera: of the ideal view.
        lens: of the photograph.

    Returns:
        The image (H, W, 4) with zeros where the photograph does not reach, and the mask (H, W) of
        pixels that it does reach.

    Raises:
        ShapeError: the image is not that of the camera.
    """
    shape = (camera.height, camera.width, 4)
    image = Arguments("undistort_image", np.float32).array("image", image, shape, finite=False)
    positions, valid = source_positions(camera, lens)
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
