"""Photographs of a table with toys: read from the contact sheets beside this file, or rendered.

`python data/photographs.py` renders the sheets with the C++ core: the built-in scene `toy_table`,
in direct light, before black. Cameras stand around it; y is up. Colors are linear in memory and
display-encoded in the files.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from photograd_course.captures import Photograph, all_around, look_at_origin
from PIL import Image

FOLDER = Path(__file__).parent
HALF = 0.66  # meters from the origin of the scene to a face of the cube from -1 to 1
TANGENT = 0.34  # of half the angle of view
TRAINING, HELD_OUT = ("toys", 40, 64, 0.0), ("held_out", 3, 128, 1.1)


def cameras(count: int, size: int, turn: float = 0.0) -> list[Photograph]:
    """Black pictures of ``size`` x ``size`` pixels with the poses of cameras around the cube."""
    places = 3.2 * all_around(count, turn, up=1, top=0.9, span=1.15)
    focal, black = size / (2 * TANGENT), np.zeros((size, size, 3))
    return [Photograph(black, look_at_origin(place), focal) for place in places]


def read(sheet: tuple[str, int, int, float]) -> list[Photograph]:
    """The photographs of a contact sheet, in one file or several."""
    name, count, size, turn = sheet
    found: list[Any] = []
    for file in sorted(FOLDER.glob(f"{name}_*.png")):
        with Image.open(file) as image:
            tiles = np.asarray(image.convert("RGB"), np.float64) / 255
        for row in np.split(tiles, len(tiles) // size):
            found += np.split(row, row.shape[1] // size, axis=1)
    return [
        Photograph(colors**2.2, camera.world_from_camera, camera.focal)
        for colors, camera in zip(found, cameras(count, size, turn), strict=False)
    ]


def smaller(photos: list[Photograph], size: int) -> list[Photograph]:
    """The same photographs with ``size`` x ``size`` pixels, means of the given ones."""
    found = []
    for photo in photos:
        by = len(photo.colors) // size
        colors = photo.colors.reshape(size, by, size, by, 3).mean(axis=(1, 3))
        found.append(Photograph(colors, photo.world_from_camera, photo.focal / by))
    return found


def render(count: int, size: int, turn: float = 0.0, *, seed: int = 0) -> list[Photograph]:
    """New photographs, by the C++ core.

    Raises:
        ImportError: it is not installed.
    """
    light = importlib.import_module("photograd.scenes.direct_light")
    scenes = importlib.import_module("photograd.scenes")
    camera_of: Any = importlib.import_module("photograd.capture.camera").Camera
    toys = light.DirectLight(scenes.scene("toy_table", seed=0))
    found = []
    for k, camera in enumerate(cameras(count, size, turn)):
        pose = camera.world_from_camera.copy()
        pose[:3, 3] *= HALF
        pinhole = camera_of(size, size, camera.focal, camera.focal, size / 2, size / 2, pose)
        colors, _ = toys.render_view(pinhole, 64, seed + k)
        found.append(Photograph(np.clip(colors, 0, 1), camera.world_from_camera, camera.focal))
    return found


def write(sheet: tuple[str, int, int, float], columns: int = 10, rows: int = 2) -> None:
    """Render the photographs of a contact sheet, and write files of `rows` rows."""
    name, count, size, turn = sheet
    tiles = [photo.colors ** (1 / 2.2) for photo in render(count, size, turn)]
    lines = [np.hstack(tiles[k : k + columns]) for k in range(0, count, columns)]
    for k in range(0, len(lines), rows):
        data = np.rint(255 * np.vstack(lines[k : k + rows])).astype(np.uint8)
        Image.fromarray(data).save(FOLDER / f"{name}_{k // rows + 1}.png", optimize=True)


if __name__ == "__main__":
    for each in (TRAINING, HELD_OUT):
        write(each)
