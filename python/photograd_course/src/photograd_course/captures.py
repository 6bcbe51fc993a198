"""Photographs to recover scenes from, drawn by formulas or read from files of one's own.

Cameras look at the origin; x is to the right, y down, z forward. Colors are linear.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

from .input_files import read_file, read_text

Array = np.ndarray[Any, np.dtype[np.float64]]
GOLDEN_ANGLE = 2.399963  # radians
# Center, radius and color of three balls within a meter of the origin.
BALLS = (
    ((-0.3, 0.0, 0.1), 0.5, (0.95, 0.5, 0.35)),
    ((0.45, 0.2, -0.3), 0.35, (0.45, 0.75, 0.95)),
    ((0.3, -0.45, 0.35), 0.25, (0.9, 0.85, 0.4)),
)


def ball_volume(
    n: int, balls: Iterable[tuple[ArrayLike, float, ArrayLike]], wave: ArrayLike, contrast: float
) -> Array:
    """A volume (n, n, n, 4) of assignment 08, between -1 and 1: balls with soft edges.

    Args:
        n: voxels along each axis.
        balls: (center, radius, color) of each.
        wave: (3,) of the stripes, radians per unit of length.
        contrast: of the stripes, from 0 to 1/2; their brightest is the color.
    """
    x = (np.moveaxis(np.indices((n, n, n)), 0, -1) + 0.5) / n * 2 - 1
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    for center, radius, color in balls:
        away = np.linalg.norm(x - np.asarray(center), axis=-1)
        inside = np.clip((radius - away) * n / 3 + 0.5, 0, 1)
        here = inside > grid[..., 3] / 10
        stripes = 1 - contrast + contrast * np.sin(x[here] @ np.asarray(wave))
        grid[here, :3] = stripes[:, None] * np.asarray(color)
        grid[..., 3] = np.maximum(grid[..., 3], 10 * inside)
    return grid


def two_striped_balls(n: int, scale: float = 1.0) -> Array:
    """A volume (n, n, n, 4) of assignment 08, between -1 and 1: two balls with soft edges.

    Args:
        n: voxels along each axis.
        scale: of the balls and their distance; 1 nearly fills the box.
    """
    balls = (
        (scale * np.array([-0.25, 0.0, 0.1]), scale * 0.45, (0.95, 0.7, 0.6)),
        (scale * np.array([0.4, 0.2, -0.25]), scale * 0.3, (0.6, 0.75, 0.95)),
    )
    return ball_volume(n, balls, (6.0, 8.0, 3.0), 0.25)


def all_around(
    count: int, turn: float = 0.0, *, up: int = 2, top: float = 1.0, span: float = 2.0
) -> Array:
    """Places (count, 3) on the unit sphere, spread evenly along a spiral around the axis ``up``.

    Args:
        count: how many.
        turn: of the spiral around its axis, in radians.
        up: the axis.
        top, span: heights run from ``top`` downwards by ``span``.
    """
    height = top - span * (np.arange(count) + 0.5) / count
    phi, ring = np.arange(count) * GOLDEN_ANGLE + turn, np.sqrt(1 - height**2)
    level = [ring * np.cos(phi), ring * np.sin(phi)]
    return np.stack([*level[:up], height, *level[up:]], axis=1)


def look_at_origin(place: Array, up: Sequence[float] = (0.0, 1.0, 0.0)) -> Array:
    """The pose (4, 4), world from camera, of a camera at ``place`` (3,) that looks at the origin.

    Args:
        place: in the world.
        up: a direction of the world that is up in the picture.
    """
    forward = -place / np.linalg.norm(place)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    pose[:3, 3] = place
    return pose


def rays_to_origin(places: Array, size: int, tangent: float) -> Array:
    """Rays of square pictures from ``places``, for scenes whose third axis is up.

    Args:
        places: of the cameras, (N, 3).
        size: pixels of a side.
        tangent: of half the angle of view.

    Returns:
        (2, N size^2, 3): origins, and directions of length 1; row by row.
    """
    aside = ((np.arange(size) + 0.5) / size * 2 - 1) * tangent
    directions = []
    for place in places / np.linalg.norm(places, axis=1, keepdims=True):
        right = np.cross([0.0, 0.0, 1.0], place)
        right /= np.linalg.norm(right)
        d = aside[None, :, None] * right - aside[:, None, None] * np.cross(place, right) - place
        directions.append((d / np.linalg.norm(d, axis=-1, keepdims=True)).reshape(-1, 3))
    return np.stack([np.repeat(places, size**2, axis=0), np.concatenate(directions)])


def striped_balls(eye: Array, directions: Array, background: Sequence[float]) -> Array:
    """Colors (..., 3) of three lit and striped balls, seen from one place.

    Args:
        eye: the place, (3,).
        directions: of rays, (..., 3), of length 1.
        background: what lies behind the balls, (3,).
    """
    image = np.tile(np.asarray(background, np.float64), (*directions.shape[:-1], 1))
    nearest = np.full(directions.shape[:-1], np.inf)
    for middle, radius, paint in BALLS:
        away = np.array(middle) - eye
        along = directions @ away
        inside = radius**2 - away @ away + along**2
        t = along - np.sqrt(np.maximum(inside, 0))
        hit = (inside > 0) & (t < nearest)
        p = eye + t[hit, None] * directions[hit]
        light = 0.45 + 0.55 * np.maximum((p - middle) @ [0.4, 0.8, 0.45] / radius, 0)
        stripes = np.where(np.sin(p @ [9.0, 14.0, 5.0]) > 0, 1.0, 0.55)
        image[hit] = (light * stripes)[:, None] * np.array(paint)
        nearest[hit] = t[hit]
    return image


@dataclass(frozen=True)
class Photograph:
    """A picture of a capture, made small.

    Attributes:
        colors: (H, W, 3), linear (roughly, by a power of 2.2); what is transparent is black.
        world_from_camera: (4, 4), y down and z forward.
        focal: in pixels of this size.
    """

    colors: Array
    world_from_camera: Array
    focal: float

    def rays(self) -> tuple[Array, Array]:
        """Origins and directions (H W, 3), row by row; z of the directions is 1 in the camera."""
        height, width = self.colors.shape[:2]
        v, u = np.meshgrid(np.arange(height) + 0.5, np.arange(width) + 0.5, indexing="ij")
        aside = [(u - width / 2) / self.focal, (v - height / 2) / self.focal, np.ones(u.shape)]
        pose = self.world_from_camera
        directions = np.stack(aside, axis=2).reshape(-1, 3) @ pose[:3, :3].T
        return np.tile(pose[:3, 3], (len(directions), 1)), directions

    @property
    def border(self) -> Array:
        """Colors (N, 3) of the outermost pixels."""
        c = self.colors
        return np.concatenate([c[0], c[-1], c[:, 0], c[:, -1]])


def read_capture(folder: Path, width: int, most: int) -> Iterator[Photograph]:
    """Photographs of a folder with `transforms.json` (or `transforms_train.json`) and pictures.

    Args:
        folder: holds the file, whose cameras have y up and look along -z, and an angle of view or
            a focal length in pixels.
        width: of the pictures, in pixels.
        most: about how many are taken, evenly spread.

    Raises:
        IoError: a file cannot be read.
        OSError: a picture is none.
        KeyError, ValueError: `transforms.json` is not of this form.
    """
    file = folder / "transforms.json"
    file = file if file.exists() else folder / "transforms_train.json"
    told = json.loads(read_text("read_capture", file))
    for frame in told["frames"][:: max(1, len(told["frames"]) // max(1, most))]:
        file = folder / frame["file_path"]
        file = file if file.suffix else file.with_suffix(".png")
        image = Image.open(BytesIO(read_file("read_capture", file)), formats=("PNG", "JPEG"))
        wide, tall = image.size
        focal = frame.get("fl_x", told.get("fl_x"))
        angle = frame.get("camera_angle_x", told.get("camera_angle_x"))
        focal = focal / told.get("w", wide) if focal else 0.5 / np.tan(angle / 2)
        small = image.convert("RGBA").resize((width, max(1, round(width * tall / wide))))
        values = np.asarray(small, np.float64) / 255
        pose = np.array(frame["transform_matrix"], np.float64) @ np.diag([1.0, -1.0, -1.0, 1.0])
        yield Photograph(values[..., :3] ** 2.2 * values[..., 3:], pose, float(focal) * width)
