"""What the figures of assignment 15 draw: cameras, the capture, a fit, pieces of pictures."""

from __future__ import annotations

import functools
from collections.abc import Callable
from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from photograd_course.build.kits import source_folders
from photograd_course.captures import look_at_origin, read_capture
from photograd_course.viz.handout import Array, Facts

Scene = dict[str, Array]
Camera = dict[str, object]
BLACK = np.zeros(3)
HERE = source_folders()["15_gaussian_splatting"]
WIDE, STEPS, BEGIN, MOST = 72, 160, 250, 600  # of the fit: pixels, steps, Gaussians
MARKS = (0, 20, 40, 80, STEPS)


def camera_of(pose: Array, focal: float, wide: int, tall: int) -> Camera:
    """From world from camera."""
    W = pose[:3, :3].T
    return {
        "camera_from_world": np.concatenate([W, -(W @ pose[:3, 3])[:, None]], axis=1),
        "focal": np.full(2, focal),
        "center": np.array([wide / 2, tall / 2]),
        "width": wide,
        "height": tall,
    }


def camera_at(place: Array, wide: int, tall: int = 0, focal: float = 1.2) -> Camera:
    """At a place, looking at the origin; y down, a focal length in widths."""
    return camera_of(look_at_origin(place), focal * wide, wide, tall or wide)


def world(camera: Camera, t: Array) -> Array:
    pose = np.asarray(camera["camera_from_world"])
    return (t - pose[:, 3]) @ pose[:, :3]


def cloud(count: int, scale: float) -> Scene:
    """Gray balls at random positions."""
    rng = np.random.default_rng(15)
    return balls(
        rng.uniform(-0.8, 0.8, (count, 3)), np.full(count, scale), np.full((count, 3), 0.5)
    )


def balls(means: Array, radii: Array, colors: Array) -> Scene:
    return {
        "means": means,
        "quats": np.eye(4)[[0] * len(means)],
        "log_scales": np.repeat(np.log(radii)[:, None], 3, axis=1),
        "opacity_logits": np.full(len(means), -1.0),
        "colors": colors,
    }


def photographs(wide: int) -> tuple[list[tuple[Camera, Array]], list[tuple[Camera, Array]]]:
    """The capture in display values: (those of the fit, those held out)."""
    views = []
    for photo in read_capture(HERE / "data", wide, 1000):
        tall = len(photo.colors)
        camera = camera_of(photo.world_from_camera, photo.focal, wide, tall)
        views.append((camera, photo.colors ** (1 / 2.2)))
    return [view for k, view in enumerate(views) if k % 7 != 3], views[3::7]


def begin() -> Scene:
    """Balls at some points of the capture."""
    points = np.load(HERE / "data" / "points.npy").astype(np.float64)
    points = points[np.random.default_rng(15).permutation(len(points))[:BEGIN]]
    away = np.linalg.norm(points[:, None, :3] - points[None, :, :3], axis=2)
    return balls(points[:, :3], np.clip(np.sort(away)[:, 2], 0.02, 0.3), points[:, 3:])


@functools.cache
def fitted(module: ModuleType) -> tuple[list[Scene], Array]:
    """The scenes of a fit to small photographs at the marked steps, and the background."""
    views, kept = photographs(WIDE)[0], {}
    background = np.mean([truth.mean(axis=(0, 1)) for _, truth in views], axis=0)

    def watch(step: int, scene: Scene, _: float) -> None:
        if step in MARKS:
            kept[step] = scene

    rng = np.random.default_rng(15)
    found, _ = module.fit(begin(), views, STEPS, rng, background, MOST, 30, watch)
    return [kept.get(mark, found) for mark in MARKS], background


def score_of(
    module: ModuleType, scene: Scene, views: list[tuple[Camera, Array]], background: Array
) -> float:
    error = [module.picture(scene, camera, background)[0] - truth for camera, truth in views]
    return float(-10 * np.log10(np.mean(np.square(error))))


def ellipse(middle: Array, cov2d: Array, k: float, **style: object) -> Ellipse:
    """The ellipse of k standard deviations."""
    values, vectors = np.linalg.eigh(cov2d[[0, 1, 1, 2]].reshape(2, 2))
    angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1]))
    wide, narrow = 2 * k * np.sqrt(np.maximum(values[::-1], 0))
    return Ellipse(
        tuple(middle), wide, narrow, angle=angle, fill=False, linewidth=1.4, zorder=5, **style
    )


def show(axes: Axes, picture: Array, title: str) -> None:
    axes.imshow(np.clip(picture, 0, 1), interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.set_title(title, fontsize=8)


def calm(make: Callable[[ModuleType], tuple[Figure, Facts]]) -> Callable[..., tuple[Figure, Facts]]:
    """Far from a splat exp underflows to 0, as intended."""

    @functools.wraps(make)
    def drawn(module: ModuleType) -> tuple[Figure, Facts]:
        with np.errstate(under="ignore"):
            return make(module)

    return drawn
