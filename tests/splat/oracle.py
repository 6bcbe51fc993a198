"""Gaussian splatting pixel by pixel in NumPy: no tiles, no boxes, no shared code. Small scenes."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd import sh
from photograd.capture.camera import Camera
from photograd.splats.splatting import Gaussians, SplatOptions

Array = Any


def rotation(q: Array) -> Array:
    """Rotation matrix of a quaternion by turning the axes: v' = q v q*."""
    w, v = q[0] / np.linalg.norm(q), q[1:] / np.linalg.norm(q)
    columns = [e + 2 * w * np.cross(v, e) + 2 * np.cross(v, np.cross(v, e)) for e in np.eye(3)]
    return np.stack(columns, 1)


def pixel_centers(camera: Camera) -> tuple[Array, Array]:
    return np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)


def project(g: Gaussians, i: int, camera: Camera, M: Array, o: SplatOptions) -> Any:
    """Depth, screen mean, blurred covariance and compensation of one Gaussian; None behind near."""
    t = M[:, :3] @ g.means[i] + M[:, 3]
    if t[2] < o.near:
        return None
    margin = o.frustum_margin * np.array([camera.width / camera.fx, camera.height / camera.fy])
    lo = np.array([-camera.cx / camera.fx, -camera.cy / camera.fy]) - margin
    hi = np.array([(camera.width - camera.cx) / camera.fx, (camera.height - camera.cy) / camera.fy])
    held = np.clip(t[:2] / t[2], lo, hi + margin)
    J = np.diag([camera.fx, camera.fy]) @ np.column_stack([np.eye(2), -held]) / t[2]
    scale = np.diag(np.exp(2 * g.log_scales[i]))
    R = rotation(g.quats[i])
    cov = J @ M[:, :3] @ R @ scale @ R.T @ M[:, :3].T @ J.T
    blurred = cov + o.low_pass * np.eye(2)
    ratio = np.linalg.det(cov) / np.linalg.det(blurred)
    mean = np.array([camera.fx, camera.fy]) * t[:2] / t[2] + [camera.cx, camera.cy]
    return t[2], mean, blurred, np.sqrt(max(ratio, 2.5e-5))


def render(
    g: Gaussians, camera: Camera, background: Array, o: SplatOptions, M: Array | None = None
) -> dict[str, Array]:
    """color (H, W, 3), opacity (H, W), depth (H, W) in float64."""
    if M is None:
        M = np.linalg.inv(camera.world_from_camera)[:3]
    eye = -M[:, :3].T @ M[:, 3]
    x, y = pixel_centers(camera)
    T, live = np.ones(x.shape), np.ones(x.shape, bool)
    color, depth = np.zeros((*x.shape, 3)), np.zeros(x.shape)
    splats = [(project(g, i, camera, M, o), i) for i in range(len(g))]
    for (z, mean, cov, compensation), i in sorted(
        ((s, i) for s, i in splats if s is not None), key=lambda item: (item[0][0], item[1])
    ):
        d = np.stack([mean[0] - x, mean[1] - y], -1)
        power = 0.5 * np.einsum("hwi,ij,hwj->hw", d, np.linalg.inv(cov), d)
        opacity = 1 / (1 + np.exp(-g.opacity_logits[i])) * (compensation if o.antialiased else 1)
        alpha = np.minimum(opacity * np.exp(-power), o.alpha_max)
        alpha[alpha < o.alpha_min] = 0
        if o.extent_sigmas:
            alpha[(np.abs(d) > o.extent_sigmas * np.sqrt(np.diag(cov))).any(-1)] = 0
        alpha *= live
        live &= ~(T * (1 - alpha) < o.stop)
        alpha *= live
        away = (g.means[i] - eye) / np.linalg.norm(g.means[i] - eye)
        rgb = np.maximum(sh.basis(away[None], g.degree)[0] @ g.sh[i] + 0.5, 0)
        color += (T * alpha)[..., None] * rgb
        depth += T * alpha * z
        T = T * (1 - alpha)
    return {"color": color + T[..., None] * background, "opacity": 1 - T, "depth": depth}


def camera(width: int = 37, height: int = 29, focal: float = 30.0, turn: float = 0.3) -> Camera:
    """3 m in front of the origin, looking at it, turned about two axes; no multiple of a tile."""
    c, s = np.cos(turn), np.sin(turn)
    R = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    pose = np.eye(4)
    pose[:3, :3] = R
    pose[:3, 3] = -3.0 * R[:, 2]
    return Camera(width, height, focal, 1.1 * focal, 0.52 * width, 0.47 * height, pose)


def cloud(
    n: int, seed: int, *, degree: int = 3, size: float = -1.8, spread: float = 1.0
) -> Gaussians:
    """Random Gaussians around the origin, in float64; quaternions of any length."""
    g = np.random.default_rng(seed)
    k = (degree + 1) ** 2
    colors = np.concatenate(
        [g.uniform(-0.3, 1.0, (n, 1, 3)), g.normal(0, 0.08, (n, k - 1, 3))], axis=1
    )
    return Gaussians(
        g.uniform(-spread, spread, (n, 3)),
        size + 0.4 * g.standard_normal((n, 3)),
        g.standard_normal((n, 4)),
        g.uniform(-2, 2, n),
        colors,
    )
