"""Damaged captures: readers may refuse with a typed error, and nothing else may escape.

Each reader gets PHOTOGRAD_FUZZ_SECONDS of damage, shared by its files (under a second in a normal
run). Every round has a seed of its own, so that longer runs see what shorter ones saw, and more.
"""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from photograd.capture import estimate_bounds, load_capture
from photograd.images import read_image, write_exr, write_png, write_radiance
from photograd_course.errors import Error
from PIL import Image

from support import capture_files as files
from support.png import sixteen_bits

pytestmark = pytest.mark.fuzz

SECONDS = float(os.environ.get("PHOTOGRAD_FUZZ_SECONDS", "0.8"))
EXAMPLES_A_ROUND = 12
FILES_OF = {
    "blender": 2,
    "nerfstudio": 2,
    "opensfm": 2,
    "text": 6,
    "binary": 6,
    "llff": 2,
    "image": 4,
}
"""Among how many tests below the time of a reader is shared; text and binary are one reader."""
CAMERAS = files.orbit(4, 8, 6, 9.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One small good capture of each kind."""
    root = tmp_path_factory.mktemp("captures")
    files.write_blender(root / "blender", CAMERAS, CAMERAS[:1])
    files.write_nerfstudio(root / "nerfstudio", CAMERAS, camera_model="OPENCV", k1=0.1, p1=0.01)
    files.write_llff(root / "llff", CAMERAS)
    files.write_opensfm(root / "opensfm", CAMERAS, k1=0.05)
    for form, write in (("text", files.write_colmap_text), ("binary", files.write_colmap_binary)):
        names = files.write_pictures(root / form / "images", CAMERAS)
        write(root / form / "sparse", CAMERAS, names, files.sphere_points(10))
    image = np.random.default_rng(0).random((6, 5, 4), dtype=np.float32)
    write_png(root / "eight.png", image)
    (root / "sixteen.png").write_bytes(sixteen_bits(np.rint(image * 65535)))
    write_exr(root / "radiance.exr", image)
    return root


@st.composite
def byte_damage(draw: st.DrawFn, data: bytes) -> bytes:
    """A few bytes changed, a piece removed, doubled or replaced, or the end cut off."""
    result = bytearray(data)
    for _ in range(draw(st.integers(1, 4))):
        if not result:
            break
        start = draw(st.integers(0, len(result) - 1))
        stop = min(len(result), start + draw(st.integers(1, 12)))
        kind = draw(st.sampled_from(["flip", "cut", "double", "replace", "end"]))
        if kind == "flip":
            result[start] ^= 1 << draw(st.integers(0, 7))
        elif kind == "cut":
            del result[start:stop]
        elif kind == "double":
            result[start:start] = result[start:stop]
        elif kind == "replace":
            interesting = [
                b"\xff" * 8,
                b"\0" * 8,
                b"-1",
                b"nan",
                b"1e400",
                b"9" * 30,
                b"[",
                b"\n",
                b"#",
            ]
            result[start:stop] = draw(st.sampled_from(interesting) | st.binary(max_size=8))
        else:
            del result[start:]
    return bytes(result)


STRANGE: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.just(10**400),
    st.floats(allow_nan=True, allow_infinity=True),
    st.text(max_size=6),
    st.sampled_from(
        ["", "..", "/", "train/0000", "\0", "x" * 300, "\ud800", [], {}, [[]], [0] * 4]
    ),
)


@st.composite
def structural_damage(draw: st.DrawFn, content: Any) -> Any:
    """One to three values anywhere in a JSON tree replaced, removed or doubled."""
    result = json.loads(json.dumps(content))
    for _ in range(draw(st.integers(1, 3))):
        node, parent, key = result, None, None
        while isinstance(node, dict | list) and node and (parent is None or draw(st.booleans())):
            keys = sorted(node) if isinstance(node, dict) else range(len(node))
            parent, key = node, draw(st.sampled_from(list(keys)))
            node = parent[key]
        if parent is None:
            return draw(STRANGE)
        kind = draw(st.sampled_from(["replace", "remove", "double"]))
        if kind == "replace":
            parent[key] = draw(STRANGE)
        elif kind == "remove":
            del parent[key]
        elif isinstance(parent, list):
            parent.append(node)
        else:
            parent[draw(st.text(max_size=4))] = node
    return result


def survive(kind: str, strategy: st.SearchStrategy[Any], use: Callable[[Any], None]) -> None:
    """Feed damage to `use` until time is up. It must refuse some, and may take the rest."""
    refused, taken = 0, 0
    end = time.monotonic() + SECONDS / FILES_OF[kind]

    def attempt(damage: Any) -> None:
        nonlocal refused, taken
        try:
            use(damage)
            taken += 1
        except Error as error:
            refused += 1
            if ": expected " not in str(error):
                pytest.fail(f"not in the form of our errors: {error}")

    number = 0
    options = settings(
        max_examples=EXAMPLES_A_ROUND,
        deadline=None,
        database=None,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
    while number == 0 or time.monotonic() < end:
        seed(number)(options(given(strategy)(attempt)))()
        number += 1
    assert refused > 0
    assert refused + taken >= EXAMPLES_A_ROUND // 2  # Hypothesis may run out of new examples


def read_all(path: Path) -> None:
    """Everything that a command would do with a capture before fitting to it."""
    capture = load_capture(path)
    capture.split_hash()
    for view in capture.views[:2]:
        view.rgba()
        view.valid_mask()
        view.camera.rays()
    estimate_bounds(capture)


@pytest.mark.parametrize(
    "file",
    [
        "blender/transforms_train.json",
        "nerfstudio/transforms.json",
        "opensfm/reconstruction.json",
        "text/sparse/cameras.txt",
        "text/sparse/images.txt",
        "text/sparse/points3D.txt",
        "binary/sparse/cameras.bin",
        "binary/sparse/images.bin",
        "binary/sparse/points3D.bin",
        "llff/poses_bounds.npy",
    ],
)
def test_damaged_bytes(folder: Path, tmp_path: Path, file: str) -> None:
    kind = file.partition("/")[0]
    shutil.copytree(folder / kind, tmp_path / kind)
    read_all(tmp_path / kind)
    target = tmp_path / file

    def use(damage: bytes) -> None:
        target.write_bytes(damage)
        read_all(tmp_path / kind)

    survive(kind, byte_damage(target.read_bytes()), use)


@pytest.mark.parametrize(
    "file",
    ["blender/transforms_train.json", "nerfstudio/transforms.json", "opensfm/reconstruction.json"],
)
def test_damaged_structure(folder: Path, tmp_path: Path, file: str) -> None:
    kind = file.partition("/")[0]
    shutil.copytree(folder / kind, tmp_path / kind)
    target = tmp_path / file

    def use(damage: Any) -> None:
        target.write_text(json.dumps(damage))
        read_all(tmp_path / kind)

    survive(kind, structural_damage(json.loads(target.read_text())), use)


NUMBERS = st.floats(allow_nan=True, allow_infinity=True) | st.sampled_from(
    [0.0, -1.0, 1e308, 1e-300]
)


def test_damaged_numbers_in_llff(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "llff", tmp_path / "llff")
    table = np.load(folder / "llff/poses_bounds.npy")
    places = st.tuples(st.integers(0, len(table) - 1), st.integers(0, 16), NUMBERS)

    def use(damage: list[tuple[int, int, float]]) -> None:
        changed = table.copy()
        for row, column, number in damage:
            changed[row, column] = number
        np.save(tmp_path / "llff/poses_bounds.npy", changed)
        read_all(tmp_path / "llff")

    survive("llff", st.lists(places, min_size=1, max_size=3), use)


@pytest.mark.parametrize(
    "name", ["eight.png", "sixteen.png", "radiance.exr", "photo.jpg", "sky.hdr", "sky.pfm"]
)
def test_damaged_images(
    folder: Path, tmp_path: Path, name: str, capfd: pytest.CaptureFixture[str]
) -> None:
    if name == "photo.jpg":
        Image.open(folder / "eight.png").convert("RGB").save(folder / name)
    if name.startswith("sky"):
        write_radiance(folder / name, read_image(folder / "radiance.exr")[..., :3])
    data = (folder / name).read_bytes()
    target = tmp_path / name

    def use(damage: bytes) -> None:
        target.write_bytes(damage)
        pixels = read_image(target)
        assert pixels.dtype == np.float32
        assert pixels.shape[2] == 4
        assert np.isfinite(pixels).all()

    survive("image", byte_damage(data), use)
    capfd.readouterr()  # the EXR library reports on stderr what it refuses
