"""What the figures of assignment 15 draw: scenes, measurements, pieces of pictures."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from photograd_course.assignment.bundle import read_folder
from photograd_course.build.kits import source_folders
from photograd_course.captures import all_around, look_at_origin, striped_balls
from photograd_course.viz.handout import Array, Facts

Scene = dict[str, Array]
Camera = dict[str, object]
BLACK = np.zeros(3)
SIZE, VIEWS, MOST, STEPS = 32, 12, 180, 120


def camera_at(place: Array, size: int) -> Camera:
    """At a place, looking at the origin; y down."""
    W = look_at_origin(place)[:3, :3].T
    return {
        "camera_from_world": np.concatenate([W, -(W @ place)[:, None]], axis=1),
        "focal": np.full(2, 1.2 * size),
        "center": np.full(2, size / 2),
        "width": size,
        "height": size,
    }


def world(camera: Camera, t: Array) -> Array:
    pose = np.asarray(camera["camera_from_world"])
    return (t - pose[:, 3]) @ pose[:, :3]


def places(count: int, turn: float = 0.0) -> Array:
    return 3.2 * all_around(count, turn, up=1, top=0.8, span=1.2)


def rays_of(camera: Camera, fine: int = 1) -> tuple[Array, Array]:
    """Origin (3,) and unit directions (H, W, 3) of a camera's rays."""
    n, pose = int(str(camera["width"])), np.asarray(camera["camera_from_world"])
    v, u = (np.mgrid[0 : fine * n, 0 : fine * n] + 0.5) / fine
    d = (np.stack([u, v], axis=-1) - camera["center"]) / camera["focal"]
    d = np.concatenate([d, np.ones((*u.shape, 1))], axis=-1)
    return world(camera, np.zeros(3)), d / np.linalg.norm(d, axis=-1, keepdims=True) @ pose[:, :3]


def photograph(camera: Camera) -> Array:
    """Three lit and striped balls before black, nine rays a pixel."""
    image = striped_balls(*rays_of(camera, 3), BLACK)
    n = len(image) // 3
    return image.reshape(n, 3, n, 3, 3).mean(axis=(1, 3))


def photographs(count: int, turn: float = 0.0) -> list[tuple[Camera, Array]]:
    cameras = [camera_at(place, SIZE) for place in places(count, turn)]
    return [(camera, photograph(camera)) for camera in cameras]


def cloud(count: int, scale: float) -> Scene:
    """Gray balls at random positions."""
    rng = np.random.default_rng(15)
    return {
        "means": rng.uniform(-0.8, 0.8, (count, 3)),
        "quats": np.eye(4)[[0] * count],
        "log_scales": np.full((count, 3), np.log(scale)),
        "opacity_logits": np.full(count, -1.0),
        "colors": np.full((count, 3), 0.5),
    }


def fitted(
    module: ModuleType, marks: tuple[int, ...], steps: int = STEPS
) -> tuple[list[Scene], Scene, list[tuple[Camera, Array]]]:
    """The scenes at the marked steps, the last one, and the photographs."""
    views, kept = photographs(VIEWS), {}

    def watch(step: int, scene: Scene, _: float) -> None:
        if step in marks:
            kept[step] = scene

    found, _ = module.fit(
        cloud(80, 0.1), views, steps, np.random.default_rng(15), BLACK, MOST, 20, watch
    )
    return [kept.get(mark, found) for mark in marks], found, views


def score_of(module: ModuleType, scene: Scene, views: list[tuple[Camera, Array]]) -> float:
    error = [module.picture(scene, camera, BLACK)[0] - truth for camera, truth in views]
    return float(-10 * np.log10(np.mean(np.square(error))))


def solution_of(number: str) -> ModuleType:
    """The solution of another assignment, as a module."""
    folder = next(Path(path) for name, path in source_folders().items() if name.startswith(number))
    return read_folder(folder).reference


def views_of_09(views: list[tuple[Camera, Array]]) -> dict[str, object]:
    poses = []
    for camera, _ in views:
        pose = np.eye(4)
        pose[:3] = camera["camera_from_world"]
        poses.append(np.linalg.inv(pose))
    return {
        "pictures": np.stack([truth for _, truth in views]),
        "world_from_camera": np.stack(poses),
        "focal": float(np.asarray(views[0][0]["focal"])[0]),
        "low": np.full(3, -1.0),
        "high": np.full(3, 1.0),
        "background": BLACK,
    }


def volume(
    views: list[tuple[Camera, Array]], unseen: list[tuple[Camera, Array]]
) -> tuple[Array, Array, tuple[float, Array]]:
    """The fit of assignment 09: volume, density gradient at its start, score and a view."""
    other = solution_of("09")
    photos, new = views_of_09(views), views_of_09(unseen)
    fog = other.fog((20, 20, 20))
    found, _ = other.fit_volume(photos, fog, 40, np.random.default_rng(15))
    everything = np.arange(np.asarray(new["pictures"])[..., 0].size)
    origins, directions, truth = other.ray_batch(new, everything)
    shown = other.render_rays(found, new["low"], new["high"], origins, directions, 32, BLACK)
    score = float(-10 * np.log10(np.mean((shown - truth) ** 2)))
    chosen = np.random.default_rng(15).choice(VIEWS * SIZE**2, 1000, replace=False)
    origins, directions, truth = other.ray_batch(photos, chosen)
    rays = (photos["low"], photos["high"], origins, directions, other.SAMPLES, BLACK)
    _, d_pixels = other.mse_and_cotangent(other.render_rays(fog, *rays), truth)
    slope = other.render_adjoint(fog, *rays, d_pixels)[0][..., 3]
    return found, slope, (score, shown.reshape(len(unseen), SIZE, SIZE, 3)[0])


def grid(
    views: list[tuple[Camera, Array]], unseen: list[tuple[Camera, Array]]
) -> tuple[int, Array, tuple[float, Array]]:
    """The fit of assignment 11: its size, density gradient at its start, and a view."""
    other = solution_of("11")
    rays, target = bundle(views)
    chosen = np.random.default_rng(15).choice(len(target), 1000, replace=False)
    rays, target = rays[:, chosen], target[chosen]
    starts = []
    for n in (6, 24):
        coefficients = np.zeros((n, n, n, 4, 3))
        coefficients[..., 0, :] = np.sqrt(np.pi)  # gray: one half
        starts.append((np.full((n, n, n), 0.1), coefficients))
    found = other.fit_plenoxels(*starts[0], rays, target, 3, 10)
    samples = other.march(starts[1][0].shape, rays)
    _, slope, _ = other.loss_and_grad(*starts[1], samples, target)
    rays, truth = bundle(unseen)
    shown = other.render(found[0], found[1], other.march(found[0].shape, rays))
    score = float(-10 * np.log10(np.mean((shown - truth) ** 2)))
    numbers = found[0].size + found[1].size
    return numbers, slope, (score, shown.reshape(len(unseen), SIZE, SIZE, 3)[0])


def bundle(views: list[tuple[Camera, Array]]) -> tuple[Array, Array]:
    """All rays (2, R, 3) of views, and their colors (R, 3)."""
    origins, directions = [], []
    for camera, _ in views:
        eye, d = rays_of(camera)
        directions.append(d.reshape(-1, 3))
        origins.append(np.broadcast_to(eye, directions[-1].shape))
    target = np.concatenate([truth.reshape(-1, 3) for _, truth in views])
    return np.stack([np.concatenate(origins), np.concatenate(directions)]), target


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
