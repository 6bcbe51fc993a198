"""Small captures of a sphere in every file format, written without the code under test."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from photograd.capture.camera import Camera
from PIL import Image

Array = npt.NDArray[np.float64]

SPHERE_CENTER = np.array([0.2, 0.1, -0.1])
SPHERE_RADIUS = 0.5
FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
Z_UP_FROM_Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])


def look_at(position: Array, target: Array) -> Array:
    """world_from_camera with OpenCV axes and +Y of the world upwards in the image."""
    forward = (target - position) / np.linalg.norm(target - position)
    right = np.cross(forward, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :4] = np.stack([right, np.cross(forward, right), forward, position], axis=1)
    return pose


def orbit(count: int = 9, width: int = 24, height: int = 20, focal: float = 26.0) -> list[Camera]:
    """Cameras around the sphere at three heights, all looking at its neighborhood."""
    cameras = []
    for index in range(count):
        angle = 2.0 * math.pi * index / count
        lift = 0.4 + 0.5 * (index % 3)
        position = np.array([2.5 * math.cos(angle), lift, 2.5 * math.sin(angle)])
        pose = look_at(position, np.array([0.1, 0.0, 0.05]))
        cameras.append(Camera(width, height, focal, focal, 0.5 * width, 0.5 * height, pose))
    return cameras


def picture(camera: Camera) -> npt.NDArray[np.uint8]:
    """(H, W, 4) 8-bit: the sphere colored by its normal, transparent elsewhere."""
    origins, directions = camera.rays()
    offset = SPHERE_CENTER - origins
    along = (offset * directions).sum(axis=1)
    gap = SPHERE_RADIUS**2 - (np.square(offset).sum(axis=1) - along**2)
    hit = gap > 0.0
    points = origins + directions * (along - np.sqrt(gap.clip(min=0.0)))[:, None]
    color = 0.5 + 0.5 * (points - SPHERE_CENTER) / SPHERE_RADIUS
    rgba = np.concatenate([color.clip(0.0, 1.0), np.ones((len(hit), 1))], axis=1) * hit[:, None]
    levels: npt.NDArray[np.uint8] = np.rint(rgba * 255.0).astype(np.uint8)
    return levels.reshape(camera.height, camera.width, 4)


def write_pictures(folder: Path, cameras: list[Camera], *, alpha: bool = True) -> list[str]:
    """PNG files 0000.png and so on; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"{index:04d}.png" for index in range(len(cameras))]
    for name, camera in zip(names, cameras, strict=True):
        pixels = picture(camera) if alpha else picture(camera)[..., :3].copy()
        Image.fromarray(pixels).save(folder / name)
    return names


def opengl_z_up(camera: Camera) -> list[list[float]]:
    """The pose as Blender files hold it."""
    matrix: list[list[float]] = (Z_UP_FROM_Y_UP @ camera.world_from_camera @ FLIP).tolist()
    return matrix


def write_blender(folder: Path, cameras: list[Camera], tests: list[Camera]) -> None:
    """transforms_train.json and transforms_test.json."""
    for split, members in (("train", cameras), ("test", tests)):
        names = write_pictures(folder / split, members)
        frames = [
            {"file_path": f"./{split}/{Path(name).stem}", "transform_matrix": opengl_z_up(camera)}
            for name, camera in zip(names, members, strict=True)
        ]
        angle = 2.0 * math.atan(0.5 * members[0].width / members[0].fx)
        content = {"camera_angle_x": angle, "frames": frames}
        (folder / f"transforms_{split}.json").write_text(json.dumps(content))


def write_nerfstudio(
    folder: Path, cameras: list[Camera], *, shared: bool = True, **members: Any
) -> None:
    """transforms.json with intrinsics for all frames or for each; `members` go to the top level."""
    names = write_pictures(folder / "images", cameras)
    content: dict[str, Any] = dict(members)
    frames = []
    for name, camera in zip(names, cameras, strict=True):
        lens = {"fl_x": camera.fx, "fl_y": camera.fy, "cx": camera.cx, "cy": camera.cy}
        lens |= {"w": camera.width, "h": camera.height}
        frame = {"file_path": f"images/{name}", "transform_matrix": opengl_z_up(camera)}
        if shared:
            content |= lens
            frames.append(frame)
        else:
            frames.append(frame | lens)
    (folder / "transforms.json").write_text(json.dumps(content | {"frames": frames}))


def edit_json(path: Path, change: Callable[[Any], None]) -> None:
    """Change the parsed content of a JSON file in place."""
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))


def quaternion_of(rotation: Array) -> Array:
    """(w, x, y, z): the eigenvector of the largest eigenvalue of Bar-Itzhack's matrix."""
    r = rotation
    m = np.array(
        [
            [r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
            [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
            [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)],
        ]
    )
    vector = np.linalg.eigh(m / 3.0)[1][:, -1]
    return vector[[3, 0, 1, 2]]


def colmap_rows(cameras: list[Camera], points: Array) -> list[tuple[Array, Array, Array]]:
    """Quaternion, translation and observed pixels (N, 2) of every camera."""
    rows = []
    for camera in cameras:
        inverse = np.linalg.inv(camera.world_from_camera)
        local = points @ inverse[:3, :3].T + inverse[:3, 3]
        focal, center = np.array([camera.fx, camera.fy]), np.array([camera.cx, camera.cy])
        pixels = local[:, :2] / local[:, 2:] * focal + center
        rows.append((quaternion_of(inverse[:3, :3]), inverse[:3, 3], pixels))
    return rows


def sphere_points(count: int = 40) -> Array:
    """Points on the sphere."""
    directions = np.random.default_rng(3).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points: Array = SPHERE_CENTER + SPHERE_RADIUS * directions
    return points


def write_colmap_text(model: Path, cameras: list[Camera], names: list[str], points: Array) -> None:
    """A PINHOLE camera, images and points in text form."""
    model.mkdir(parents=True)
    c = cameras[0]
    line = f"# CAMERA_ID, MODEL\n7 PINHOLE {c.width} {c.height} {c.fx} {c.fy} {c.cx} {c.cy}\n"
    (model / "cameras.txt").write_text(line)
    lines = ["# comment"]
    for index, (q, t, pixels) in enumerate(colmap_rows(cameras, points)):
        numbers = " ".join(repr(float(x)) for x in [*q, *t])
        lines.append(f"{index + 1} {numbers} 7 {names[index]}")
        seen = [f"{x!r} {y!r} {k + 5}" for k, (x, y) in enumerate(pixels.tolist())]
        lines.append(" ".join(seen))
    (model / "images.txt").write_text("\n".join(lines) + "\n")
    rows = [
        f"{k + 5} {x!r} {y!r} {z!r} 1 2 3 0.5 1 0" for k, (x, y, z) in enumerate(points.tolist())
    ]
    (model / "points3D.txt").write_text("\n".join(rows) + "\n")


def write_colmap_binary(
    model: Path, cameras: list[Camera], names: list[str], points: Array
) -> None:
    """The same model in binary form."""
    model.mkdir(parents=True)
    c = cameras[0]
    head = struct.pack("<QiiQQ", 1, 7, 1, c.width, c.height)
    (model / "cameras.bin").write_bytes(head + struct.pack("<4d", c.fx, c.fy, c.cx, c.cy))
    data = struct.pack("<Q", len(cameras))
    for index, (q, t, pixels) in enumerate(colmap_rows(cameras, points)):
        data += struct.pack("<i7di", index + 1, *q, *t, 7) + names[index].encode() + b"\0"
        data += struct.pack("<Q", len(points))
        for k, (x, y) in enumerate(pixels.tolist()):
            data += struct.pack("<ddq", x, y, k + 5)
    (model / "images.bin").write_bytes(data)
    data = struct.pack("<Q", len(points))
    for k, (x, y, z) in enumerate(points.tolist()):
        data += struct.pack("<Q3d3BdQ", k + 5, x, y, z, 1, 2, 3, 0.5, 1) + struct.pack("<ii", 1, 0)
    (model / "points3D.bin").write_bytes(data)


def write_llff(folder: Path, cameras: list[Camera], scale: float = 1.0) -> None:
    """poses_bounds.npy, which speaks of images `scale` times as large as those written."""
    write_pictures(folder / "images", cameras, alpha=False)
    rows = []
    for camera in cameras:
        pose = camera.world_from_camera
        size = np.array([camera.height, camera.width, camera.fx]) * scale
        columns = [pose[:3, 1], pose[:3, 0], -pose[:3, 2], pose[:3, 3], size]
        rows.append(np.concatenate([np.stack(columns, axis=1).ravel(), [1.5, 4.0]]))
    np.save(folder / "poses_bounds.npy", np.array(rows))


def write_opensfm(folder: Path, cameras: list[Camera], **lens: Any) -> None:
    """reconstruction.json in an east-north-up world."""
    names = write_pictures(folder / "images", cameras, alpha=False)
    c = cameras[0]
    longer = max(c.width, c.height)
    camera = {"projection_type": "perspective", "width": 10 * c.width, "height": 10 * c.height}
    camera |= {"focal": c.fx / longer} | lens
    shots = {}
    for name, member in zip(names, cameras, strict=True):
        inverse = np.linalg.inv(Z_UP_FROM_Y_UP @ member.world_from_camera)
        w, *xyz = quaternion_of(inverse[:3, :3])
        sine = float(np.linalg.norm(xyz))
        vector = np.array(xyz) / sine * 2.0 * math.atan2(sine, w)
        pose = {"rotation": vector.tolist(), "translation": inverse[:3, 3].tolist()}
        shots[name] = pose | {"camera": "lens"}
    point = {"coordinates": [1.0, 2.0, 3.0], "color": [10, 20, 30]}
    content = [{"cameras": {"lens": camera}, "shots": shots, "points": {"1": point}}]
    (folder / "reconstruction.json").write_text(json.dumps(content))
