"""Draws Gaussians that others fitted and writes what it took: `python docs/results_splats.py DATA`.

DATA is a folder with biker.ply, biker.spz, biker.compressed.ply and test_garden.npz. Rewrites a
table of docs/results.md and, with --picture, docs/images/splat_files.jpg.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd._compiled import _core
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.splats.files import read_gaussians
from photograd.splats.frames import file_from_upright
from photograd.splats.orbit import scene_box
from photograd.splats.splatting import Gaussians, SplatOptions, render
from photograd_course.metrics import psnr

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "results.md"
BEGIN, END = "<!-- splats -->", "<!-- end of splats -->"
WIDTH, HEIGHT = 640, 360
FRAMES = 24

Array = NDArray[Any]


def views(gaussians: Gaussians, count: int) -> list[Camera]:
    """Cameras on a circle around Gaussians whose -y is up, WIDTH x HEIGHT."""
    turn = file_from_upright("-y")
    box = scene_box(gaussians) @ turn
    upright = np.stack([box.min(axis=0), box.max(axis=0)])
    return [wide(camera, turn) for camera in orbit_cameras(upright, count, size=HEIGHT)]


def wide(camera: Camera, turn: Array) -> Camera:
    """The same camera with more to the left and to the right, in the frame of the file."""
    pose = camera.world_from_camera.copy()
    pose[:3] = turn @ pose[:3]
    return Camera(WIDTH, HEIGHT, camera.fx, camera.fy, WIDTH / 2, camera.cy, pose)


def garden_views(path: Path) -> list[Camera]:
    """The three cameras of the photographs that the points come from."""
    with np.load(path) as file:
        width, height = int(file["width"]), int(file["height"])
        poses = np.linalg.inv(file["viewmats"].astype(np.float64))
        return [
            Camera(width, height, k[0, 0], k[1, 1], k[0, 2], k[1, 2], pose)
            for k, pose in zip(file["Ks"].astype(np.float64), poses, strict=True)
        ]


def cloud(count: int) -> Gaussians:
    """Gaussians of degree 3 in the unit ball, the more the smaller: the scene of benchmark W8."""
    g = np.random.default_rng(7)
    axis = g.standard_normal((count, 3))
    means = axis / np.linalg.norm(axis, axis=1, keepdims=True) * g.random((count, 1)) ** (1 / 3)
    arrays = {
        "means": means,
        "log_scales": np.log(0.008 * (1e5 / count) ** (1 / 3))
        + 0.5 * g.standard_normal((count, 3)),
        "quats": g.standard_normal((count, 4)),
        "opacity_logits": g.uniform(-2.0, 3.0, count),
        "sh": np.concatenate(
            [0.6 * g.standard_normal((count, 1, 3)), 0.08 * g.standard_normal((count, 15, 3))],
            axis=1,
        ),
    }
    return Gaussians(**{name: array.astype(np.float32) for name, array in arrays.items()})


def picture(gaussians: Gaussians, camera: Camera) -> Array:
    """(H, W, 3) over white, display values in [0, 1]."""
    found, _ = render(gaussians, camera, background=(1.0, 1.0, 1.0), options=SplatOptions())
    return np.clip(found.color.astype(np.float64), 0, 1)


def row(name: str, gaussians: Gaussians, cameras: Sequence[Camera]) -> str:
    """A line of the table: the median of FRAMES pictures, each of another camera in turn."""
    took = []
    for k in range(FRAMES):
        start = time.perf_counter()
        picture(gaussians, cameras[k % len(cameras)])
        took.append(1000 * (time.perf_counter() - start))
    middle = float(np.median(took))
    size = f"{cameras[0].width} x {cameras[0].height}"
    return f"| {name} | {len(gaussians):,} | {size} | {middle:.0f} | {1000 / middle:.1f} |"


def agreement(data: Path) -> list[str]:
    """How alike the pictures of one scene in three formats are."""
    true = read_gaussians(data / "biker.ply").gaussians
    camera = views(true, 8)[1]
    expected = picture(true, camera)
    lines = []
    for name in ("biker.compressed.ply", "biker.spz"):
        seen = picture(read_gaussians(data / name).gaussians, camera)
        same = np.array_equal(seen, expected)
        words = "the same bits" if same else f"{psnr(seen, expected):.1f} dB"
        lines.append(f"- `{name}` drawn beside `biker.ply`: {words}.")
    return lines


def main() -> None:
    """Measure, and rewrite what stands between the two markers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--picture", action="store_true", help="draw the picture, too")
    given = parser.parse_args()
    biker = read_gaussians(given.data / "biker.ply").gaussians
    garden = read_gaussians(given.data / "test_garden.npz").gaussians
    ball = cloud(200_000)
    lines = [
        f"{_core.thread_count()} threads, {os.cpu_count()} cores.",
        "",
        "| scene | Gaussians | pixels | ms a frame | frames a second |",
        "|---|---|---|---|---|",
        row("biker.ply", biker, views(biker, FRAMES)),
        row("test_garden.npz", garden, garden_views(given.data / "test_garden.npz")),
        row("a ball of random ones, degree 3", ball, views(ball, FRAMES)),
        "",
        *agreement(given.data),
    ]
    text = RESULTS.read_text(encoding="utf-8")
    head, rest = text.split(BEGIN, 1)
    tail = rest.split(END, 1)[1]
    RESULTS.write_text(head + "\n".join([BEGIN, *lines, END]) + tail, encoding="utf-8")
    if given.picture:
        from PIL import Image

        seen = [picture(biker, views(biker, 8)[1])]
        wide_view = garden_views(given.data / "test_garden.npz")[0]
        seen.append(picture(garden, wide_view)[:HEIGHT, :WIDTH])
        image = np.rint(255 * np.concatenate(seen, axis=1)).astype(np.uint8)
        Image.fromarray(image).save(ROOT / "docs" / "images" / "splat_files.jpg", quality=85)


if __name__ == "__main__":
    main()
