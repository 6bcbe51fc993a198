"""Images that decode to more than their file is long: limits on pixels, and memory per pixel."""

from __future__ import annotations

import tracemalloc
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from photograd.capture.sfm.photographs import find_photographs
from photograd.images import read_image, write_exr, write_png
from photograd.images.read import read_header
from photograd.transport import read_model
from photograd.transport.texture import read_texture
from photograd_course.errors import IoError
from PIL import Image
from tests.transport.gltf_samples import core, square

from support.png import SIGNATURE, chunk, header


def textured(picture: bytes) -> bytes:
    """A .glb whose one material has the colors of an image file."""
    glb = square(**core(baseColorTexture={"index": 0}))
    view = glb.view(picture)
    glb.json |= {"textures": [{"source": 0}], "images": [{"bufferView": view}]}
    return glb.bytes()


RAISE = "set PHOTOGRAD_MAX_PIXELS to a larger number"


def claimed_png(side: int) -> bytes:
    """The beginning of a 1-bit PNG whose header states side x side pixels."""
    return SIGNATURE + header(side, side, 1, 0) + chunk(b"IDAT", zlib.compress(bytes(100)))


@pytest.mark.filterwarnings("ignore::PIL.Image.DecompressionBombWarning")
@pytest.mark.parametrize("side", [13_000, 30_000])  # Pillow warns of the one, refuses the other
def test_a_picture_beyond_the_limit_is_refused_by_its_header(tmp_path: Path, side: int) -> None:
    for name in "abc":
        (tmp_path / f"{name}.png").write_bytes(claimed_png(side))
    file = tmp_path / "a.png"
    for read in (read_header, read_image, read_texture):
        with pytest.raises(IoError, match="at most 134,217,728 pixels in an image") as caught:
            read(file)
        assert f"{side * side:,}" in str(caught.value) or f"{side * side}" in str(caught.value)
        assert RAISE in str(caught.value)
    with pytest.raises(IoError, match=r"capture: .*a\.png: expected at most 134,217,728 pixels"):
        find_photographs(tmp_path)


@pytest.mark.filterwarnings("ignore:.*could be decompression bomb")
@pytest.mark.parametrize("side", [13_000, 30_000])
def test_a_picture_in_a_mesh_file_is_left_out_by_its_header(tmp_path: Path, side: int) -> None:
    (tmp_path / "m.glb").write_bytes(textured(claimed_png(side)))
    with pytest.warns(UserWarning, match=r"images\[0\]: left out: .* at most 134,217,728 pixels"):
        model = read_model(tmp_path / "m.glb")
    assert not model.textures


def test_the_limit_can_be_set(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_png(tmp_path / "a.png", np.zeros((10, 10, 3), np.float32))
    write_exr(tmp_path / "a.exr", np.zeros((10, 10, 3), np.float32))
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "99")
    for name in ("a.png", "a.exr"):
        with pytest.raises(IoError, match="at most 99 pixels in an image, got 10 x 10 = 100"):
            read_image(tmp_path / name)
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "100")
    assert read_image(tmp_path / "a.png").shape == read_image(tmp_path / "a.exr").shape


def test_channels_of_an_exr_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    planes = {name: np.zeros((10, 10), np.float32) for name in "RGBXYZUV"}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, planes) as opened:
        opened.write(str(tmp_path / "a.exr"))
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "199")
    with pytest.raises(IoError, match=r"at most 199 pixels .*got 10 x 10 = 100 of 8 channels"):
        read_image(tmp_path / "a.exr")
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "200")
    assert read_image(tmp_path / "a.exr").shape == (10, 10, 4)


def test_pillow_refuses_no_picture_that_the_limit_allows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_png(tmp_path / "a.png", np.zeros((10, 10, 3), np.float32))
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 40)
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "45")
    with pytest.raises(IoError, match=RAISE):
        read_image(tmp_path / "a.png")
    monkeypatch.setenv("PHOTOGRAD_MAX_PIXELS", "100")
    assert read_image(tmp_path / "a.png").shape == (10, 10, 4)


def bytes_per_pixel(read: Callable[[], object], pixels: int) -> float:
    """What NumPy held at the peak; Pillow's own 3 or 4 bytes are not seen."""
    read()  # imports and caches are no part of it
    tracemalloc.start()
    try:
        read()
        return tracemalloc.get_traced_memory()[1] / pixels
    finally:
        tracemalloc.stop()


def test_memory_per_pixel(tmp_path: Path) -> None:
    side = 512
    levels = np.random.default_rng(1).integers(0, 256, (side, side, 3), np.uint8)
    Image.fromarray(levels).save(tmp_path / "a.png", compress_level=1)
    (tmp_path / "m.glb").write_bytes(textured((tmp_path / "a.png").read_bytes()))
    # Of the float32 RGBA that is returned 16, and 3 for the samples, twice while Pillow copies.
    assert 16 <= bytes_per_pixel(lambda: read_image(tmp_path / "a.png"), side**2) < 24
    # Texels of float32 12, the 8-bit RGBA 4, the file itself 3 and more while it is taken apart.
    model = bytes_per_pixel(lambda: read_model(tmp_path / "m.glb"), side**2)
    assert 12 <= model < 32
