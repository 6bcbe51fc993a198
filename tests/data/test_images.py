"""Image files: what is written is read, and what is damaged is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd.images import downscale_image, read_image, write_exr, write_jpeg, write_png
from photograd.images.read import read_header
from photograd_course.errors import Error, IoError, RangeError, ShapeError
from PIL import Image

RNG = np.random.default_rng(5)
PICTURE = RNG.random((7, 9, 4), dtype=np.float32)


@pytest.mark.parametrize("channels", [3, 4])
def test_png_round_trip(tmp_path: Path, channels: int) -> None:
    samples = np.rint(PICTURE[..., :channels] * 255)
    write_png(tmp_path / "a.png", (samples / 255).astype(np.float32))
    again = read_image(tmp_path / "a.png")
    assert again.shape == (7, 9, 4)
    assert again.dtype == np.float32
    np.testing.assert_array_equal(np.rint(again[..., :channels] * 255), samples)
    if channels == 3:
        assert (again[..., 3] == 1.0).all()
    header = read_header(tmp_path / "a.png")
    assert (header.width, header.height, header.has_alpha) == (9, 7, channels == 4)
    assert header.color_space == "display"


def test_eight_bits_are_k_over_255(tmp_path: Path) -> None:
    ramp = np.arange(256, dtype=np.uint8).reshape(16, 16)
    Image.fromarray(ramp).save(tmp_path / "gray.png")
    expected = (np.arange(256) / 255.0).astype(np.float32).reshape(16, 16)
    np.testing.assert_array_equal(read_image(tmp_path / "gray.png")[..., 1], expected)


def test_other_modes(tmp_path: Path) -> None:
    gray = RNG.integers(0, 65536, (4, 5)).astype(np.uint16)
    Image.fromarray(gray).save(tmp_path / "gray16.png")
    expected = gray / np.float32(65535.0)
    np.testing.assert_allclose(read_image(tmp_path / "gray16.png")[..., 0], expected, rtol=1e-6)
    palette = Image.fromarray(RNG.integers(0, 3, (4, 5)).astype(np.uint8)).convert("P")
    palette.putpalette([10, 20, 30, 40, 50, 60, 70, 80, 90])
    palette.save(tmp_path / "palette.png", transparency=1)
    assert read_header(tmp_path / "palette.png").has_alpha
    looked_up = read_image(tmp_path / "palette.png")
    index = np.asarray(palette)
    np.testing.assert_allclose(looked_up[..., 2] * 255, index * 30 + 30, rtol=1e-6)
    np.testing.assert_array_equal(looked_up[..., 3], index != 1)


def test_jpeg_is_close(tmp_path: Path) -> None:
    x = np.linspace(0.1, 0.9, 32, dtype=np.float32)
    image = np.stack(np.broadcast_arrays(x, x[:, None], np.float32(0.5)), axis=-1)
    write_jpeg(tmp_path / "a.jpg", image)
    # Quality 95 of a smooth picture: a few of 255 levels; measured: 2.5.
    np.testing.assert_allclose(read_image(tmp_path / "a.jpg")[..., :3], image, atol=3.5 / 255)
    with pytest.raises(ShapeError, match="write_jpeg: image"):
        write_jpeg(tmp_path / "b.jpg", PICTURE)


@pytest.mark.parametrize("half", [False, True])
def test_exr_round_trip(tmp_path: Path, half: bool) -> None:
    radiance = (PICTURE * 20.0).astype(np.float16 if half else np.float32).astype(np.float32)
    radiance[..., 3] = 0.5
    radiance[0, 0] = 0.0
    write_exr(tmp_path / "a.exr", radiance, half=half)
    again = read_image(tmp_path / "a.exr")
    np.testing.assert_array_equal(again[..., 3], radiance[..., 3])
    np.testing.assert_array_equal(again[..., :3] * again[..., 3:], radiance[..., :3])
    header = read_header(tmp_path / "a.exr")
    assert (header.width, header.height) == (9, 7)
    assert header.has_alpha
    assert header.color_space == "linear"
    write_exr(tmp_path / "b.exr", radiance[..., :3], half=half)
    np.testing.assert_array_equal(read_image(tmp_path / "b.exr")[..., :3], radiance[..., :3])
    assert not read_header(tmp_path / "b.exr").has_alpha


@pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.exr"])
@pytest.mark.parametrize("kept", [0.0, 0.02, 0.5, 0.97])
def test_truncated_files_are_refused(tmp_path: Path, name: str, kept: float) -> None:
    big = RNG.random((40, 40, 3), dtype=np.float32)
    write = {"a.png": write_png, "a.jpg": write_jpeg, "a.exr": write_exr}[name]
    write(tmp_path / name, big)
    assert read_image(tmp_path / name).shape == (40, 40, 4)
    data = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(data[: int(len(data) * kept)])
    with pytest.raises(IoError, match=rf"{name}'?: expected"):
        read_image(tmp_path / name)


def test_not_an_image(tmp_path: Path) -> None:
    with pytest.raises(IoError, match="expected a file, got none"):
        read_image(tmp_path / "absent.png")
    (tmp_path / "text.png").write_text("hello")
    with pytest.raises(IoError, match="readable image"):
        read_image(tmp_path / "text.png")
    with pytest.raises(IoError, match="readable image"):
        read_header(tmp_path / "text.png")
    Image.new("CMYK", (4, 4)).save(tmp_path / "cmyk.jpg")
    with pytest.raises(IoError, match="mode CMYK"):
        read_image(tmp_path / "cmyk.jpg")
    with pytest.raises(IoError, match="expected a readable file, got embedded null"):
        read_image(tmp_path / "\0.png")


@pytest.mark.parametrize(
    ("image", "error"),
    [
        (np.zeros((3, 3), dtype=np.float32), ShapeError),
        (np.zeros((0, 3, 3), dtype=np.float32), ShapeError),
        (np.full((3, 3, 3), 1.1, dtype=np.float32), RangeError),
        (np.full((3, 3, 3), np.nan, dtype=np.float32), RangeError),
    ],
)
def test_impossible_pixels_are_not_written(
    tmp_path: Path, image: np.ndarray, error: type[Error]
) -> None:
    with pytest.raises(error, match="write_png: image"):
        write_png(tmp_path / "a.png", image)
    assert not list(tmp_path.iterdir())


def test_half_refuses_what_it_cannot_hold(tmp_path: Path) -> None:
    with pytest.raises(RangeError, match="65504"):
        write_exr(tmp_path / "a.exr", np.full((2, 2, 3), 7e4, dtype=np.float32), half=True)


def test_downscaling_averages_premultiplied() -> None:
    image = np.zeros((2, 4, 4), dtype=np.float32)
    image[0, 0] = [1.0, 0.5, 0.0, 1.0]
    image[0, 1] = [0.0, 1.0, 1.0, 0.0]  # transparent: its color must not count
    image[:, 2:] = [0.25, 0.5, 0.75, 1.0]
    small, valid = downscale_image(image, 2)
    np.testing.assert_allclose(small[0, 0], [1.0, 0.5, 0.0, 0.25])
    np.testing.assert_allclose(small[0, 1], [0.25, 0.5, 0.75, 1.0])
    assert valid.all()
    mask = np.ones((2, 4), dtype=np.bool_)
    mask[1, 3] = False
    assert downscale_image(image, 2, mask)[1].tolist() == [[True, False]]
    assert downscale_image(PICTURE, 4)[0].shape == (1, 2, 4)
    with pytest.raises(RangeError, match="downscale_image: factor"):
        downscale_image(image, 3)
