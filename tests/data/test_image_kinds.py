"""Images are opened by their content, and only of the kinds that this project reads."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.sfm.photographs import copy_photographs, find_photographs
from photograd.errors import IoError
from photograd.images import read_image, write_jpeg, write_png
from photograd.images.read import read_header
from photograd.transport.texture import read_texture
from PIL import Image

from support.tree import ROOT, python_texts

POSTSCRIPT = b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 16 16\n%%EndComments\n(x) show\n"
READERS: list[Callable[[Path], Any]] = [
    read_image,
    read_header,
    read_texture,
    lambda path: find_photographs(path.parent),
]


@pytest.fixture
def stub(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file that a `gs` of ours leaves behind, should anything call it."""
    folder = tmp_path / "bin"
    folder.mkdir()
    trace = folder / "was_called"
    program = folder / "gs"
    program.write_text(f"#!/bin/sh\necho called > '{trace}'\n", encoding="ascii")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")
    return trace


@pytest.mark.parametrize("name", ["photo.png", "photo.jpg"])
def test_no_program_is_started_for_a_picture(tmp_path: Path, stub: Path, name: str) -> None:
    folder = tmp_path / "photographs"
    folder.mkdir()
    for extra in ("a.png", "b.png", name):
        (folder / extra).write_bytes(POSTSCRIPT)
    for read in READERS:
        with pytest.raises(IoError, match=r"\(PNG, JPEG.*, got PostScript data"):
            read(folder / name)
    assert not stub.exists()


@pytest.mark.parametrize(
    ("kind", "found"),
    [
        ("GIF", "GIF"),
        ("TIFF", "TIFF"),
        ("BMP", "BMP"),
        ("WEBP", "WebP"),
        ("PPM", "PPM"),
        ("PDF", "PDF"),
        ("ICO", "data that begins with"),
    ],
)
def test_other_kinds_are_named(tmp_path: Path, kind: str, found: str) -> None:
    buffer = io.BytesIO()
    Image.new("RGB", (16, 16), (200, 10, 10)).save(buffer, format=kind)
    for name in ("a.png", "b.jpg", "c.png"):
        (tmp_path / name).write_bytes(buffer.getvalue())
    for read in READERS:
        with pytest.raises(IoError, match=f"a readable image .*, got {found}"):
            read(tmp_path / "a.png")


def test_every_call_of_pillow_names_its_formats() -> None:
    texts = [*python_texts().values()]
    texts += [path.read_text(encoding="utf-8") for path in ROOT.glob("assignments/*/*.py")]
    call = re.compile(r"Image\.open\((?:[^()]|\([^()]*\))*\)")
    calls = [found for text in texts for found in call.findall(text)]
    assert len(calls) >= 6
    assert [found for found in calls if "formats=" not in found] == []


def test_a_name_that_misleads_does_no_harm(tmp_path: Path) -> None:
    picture = np.full((20, 20, 3), 0.6, np.float32)
    for index in range(3):
        write_jpeg(tmp_path / f"{index}.png", picture)
    write_png(tmp_path / "png.jpg", picture)
    for name in ("0.png", "png.jpg"):
        assert read_header(tmp_path / name).width == 20
        np.testing.assert_allclose(read_image(tmp_path / name)[..., :3], picture, atol=2 / 255)
    photographs, _ = find_photographs(tmp_path)
    assert len(photographs) == 4


def test_two_pictures_in_one_file_are_the_first(tmp_path: Path) -> None:
    # Cameras and telephones add a small or a second picture to a JPEG file.
    first, second = Image.new("RGB", (20, 16), (250, 0, 0)), Image.new("RGB", (20, 16), (0, 0, 250))
    tags = Image.Exif()
    tags[0x0112] = 6
    for index in range(3):
        path = tmp_path / f"{index}.jpg"
        first.save(path, format="MPO", save_all=True, append_images=[second], exif=tags)
    assert read_image(tmp_path / "0.jpg")[5, 5, 0] > 0.9
    found, _ = find_photographs(tmp_path)
    copy_photographs(found, tmp_path / "copies")
    with Image.open(tmp_path / "copies" / "0.jpg") as copy:
        assert (copy.format, copy.size) == ("JPEG", (16, 20))
        assert np.asarray(copy)[5, 5, 0] > 230
