"""A scene whose truth is known: three colored balls in a dense grid, seen by our marcher."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.capture.write import write_blender_capture
from photograd.fields import DenseGrid
from photograd.fields.march import MarchPolicy
from photograd.fitting import FitOptions
from photograd.fitting.evaluate import render_camera
from photograd.fitting.model import Model
from photograd_course.color import srgb_encode, unpremultiply

BOX = np.array([[-0.8, -0.6, -0.7], [0.8, 0.6, 0.7]])
BALLS = (  # center, radius, linear color
    ((-0.35, -0.1, 0.0), 0.32, (0.8, 0.15, 0.1)),
    ((0.3, 0.15, 0.25), 0.27, (0.1, 0.6, 0.2)),
    ((0.2, -0.2, -0.3), 0.25, (0.15, 0.25, 0.9)),
)
SIZE = 24  # pixels along an edge


@cache
def truth() -> DenseGrid:
    """32 voxels along the box: 40/m inside of the balls, fading over a twentieth of a meter."""
    shape = (32, 24, 28)
    axes = [BOX[0, k] + (np.arange(n) + 0.5) * 0.05 for k, n in enumerate(shape)]
    position = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values = np.zeros((*shape, 4))
    weight = np.zeros(shape)
    for center, radius, color in BALLS:
        inside = 1 / (1 + np.exp((np.linalg.norm(position - center, axis=-1) - radius) / 0.012))
        values[..., 3] += 40 * inside
        values[..., :3] += (inside + 1e-9)[..., None] * np.array(color)
        weight += inside + 1e-9
    values[..., :3] /= weight[..., None]
    policy = MarchPolicy(
        (tuple(BOX[0].tolist()), tuple(BOX[1].tolist())),
        0.02,
        density_activation="identity",
        color_activation="identity",
    )
    return DenseGrid(values, policy)


def as_model(field: DenseGrid) -> Model:
    return Model(field, None, FitOptions(), {}, np.zeros((0, 3)))


def cameras(count: int, *, elevation: float, size: int = SIZE) -> list[Camera]:
    return orbit_cameras(BOX, count, size=size, elevation=elevation)


def photograph(camera: Camera) -> Any:
    """(H, W, 4) float32, display-encoded, straight alpha."""
    color, opacity, _ = render_camera(as_model(truth()), camera, stop=0.0)
    straight = np.clip(srgb_encode(unpremultiply(color, opacity)), 0, 1)
    return np.concatenate([straight, opacity[..., None]], axis=-1).astype(np.float32)


@cache
def frames() -> dict[str, list[tuple[str, Camera, Any]]]:
    """Twelve training views at two heights and four held-out ones between them."""
    train = cameras(7, elevation=35.0) + cameras(5, elevation=-10.0)
    test = cameras(4, elevation=15.0)
    return {
        split: [(f"{split}_{k}", c, photograph(c)) for k, c in enumerate(members)]
        for split, members in (("train", train), ("test", test))
    }


def over_wall(image: Any, color: tuple[float, float, float]) -> Any:
    """The photograph in front of a wall of one display color: opaque, as cameras take them."""
    alpha = image[..., 3:]
    return np.concatenate(
        [image[..., :3] * alpha + (1 - alpha) * np.array(color), np.ones_like(alpha)],
        axis=-1,
        dtype=np.float32,
    )


def capture(*, wall: tuple[float, float, float] | None = None) -> Capture:
    """The scene in memory, with its true box; with a `wall` color, photographs without alpha."""
    views = {
        split: tuple(
            View(name, camera, image if wall is None else over_wall(image, wall))
            for name, camera, image in members
        )
        for split, members in frames().items()
    }
    return Capture(
        views["train"], views["test"], "memory", Path("memory"), "display", wall is None, bounds=BOX
    )


def write(folder: Path, *, train: int = 12, test: int = 4) -> Path:
    """The same scene as files: the first views of each split."""
    splits = {
        split: [(name, camera, image, None) for name, camera, image in frames()[split][:count]]
        for split, count in (("train", train), ("test", test))
        if count
    }
    write_blender_capture(folder, splits, aabb=BOX)
    return folder


def options(**changes: Any) -> FitOptions:
    """A fit of a second: 16 voxels along the longest edge, three levels."""
    values: dict[str, Any] = {"resolution": 16, "steps": 60, "rays": 512, "seed": 1}
    return FitOptions(**(values | changes))
