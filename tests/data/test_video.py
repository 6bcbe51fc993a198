"""Videos, read back with the libraries of FFmpeg: sizes, rates, colors, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from photograd.errors import IoError, RangeError, ShapeError
from photograd.images import video
from photograd.images.video import write_video

COLORS = ((0.85, 0.2, 0.15), (0.1, 0.6, 0.2), (0.15, 0.25, 0.9), (0.5, 0.5, 0.5))
LEVEL = 3.5 / 255  # luma and chroma are rounded, and the colors again. Measured: 3 / 255


def frames(count: int = 3) -> list[Any]:
    """Four upright stripes, a pixel further to the right in each frame."""
    stripes = np.repeat(np.array(COLORS)[:, None], 16, axis=1).reshape(1, 64, 3)
    return [np.roll(np.repeat(stripes, 48, axis=0), k, axis=1) for k in range(count)]


def decoded(path: Path) -> tuple[Any, Any]:
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        told = (stream.codec_context.name, stream.width, stream.height, stream.average_rate)
        pixels = [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)]
    return told, np.stack(pixels) / 255.0


@pytest.mark.parametrize(("name", "codec"), [("a.mp4", "h264"), ("a.webm", "vp9")])
def test_colors_come_back(tmp_path: Path, name: str, codec: str) -> None:
    path = tmp_path / name
    assert write_video(path, iter(frames()), frames_per_second=24) == 3
    told, pixels = decoded(path)
    assert told == (codec, 64, 48, 24)
    for k, picture in enumerate(pixels):
        middles = [picture[24, 8 + 16 * stripe + k] for stripe in range(4)]
        np.testing.assert_allclose(middles, COLORS, atol=LEVEL)
    assert list(tmp_path.iterdir()) == [path]
    first = path.read_bytes()
    write_video(path, frames(), frames_per_second=24)
    assert path.read_bytes() == first


def test_other_matrices_would_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Written as BT.601 and read as the BT.709 that the file says, colors are off by 0.03."""
    monkeypatch.setattr(video, "_COLORS", "scale=out_color_matrix=bt601,setparams=colorspace=bt709")
    write_video(tmp_path / "a.mp4", frames(1))
    picture = decoded(tmp_path / "a.mp4")[1][0]
    off = np.abs([picture[24, 8 + 16 * k] - COLORS[k] for k in range(4)])
    assert off.max() > 2.5 * LEVEL
    assert off[3].max() < LEVEL  # gray is gray


def test_what_is_no_video_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.mp4"
    with pytest.raises(IoError, match=r"a name that ends in \.mp4 or \.webm"):
        write_video(tmp_path / "a.mov", frames())
    with pytest.raises(RangeError, match="at least one frame"):
        write_video(path, [])
    with pytest.raises(RangeError, match="an even width and height"):
        write_video(path, [np.zeros((7, 8, 3))])
    with pytest.raises(ShapeError, match=r"frames\[1\]"):
        write_video(path, [np.zeros((8, 8, 3)), np.zeros((8, 10, 3))])
    with pytest.raises(RangeError, match=r"frames\[1\]"):
        write_video(path, [np.zeros((8, 8, 3)), np.full((8, 8, 3), 1.5)])
    with pytest.raises(RangeError, match="frames_per_second"):
        write_video(path, frames(), frames_per_second=0.5)
    assert list(tmp_path.iterdir()) == []
