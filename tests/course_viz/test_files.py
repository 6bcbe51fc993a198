"""The same input gives the same bytes, whatever the reader's own Matplotlib settings are."""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from photograd_course.errors import Error, IoError, RangeError, ShapeError
from photograd_course.viz import (
    FitCurves,
    comparison_strips,
    fit_curves,
    projection_steps,
    save_figure,
    signed_projections,
    signed_slices,
    write_frames,
    write_gif,
)
from PIL import Image

IMAGES = [np.random.default_rng(i).uniform(size=(10, 14, 3)) for i in range(3)]


def draw_curves(_: Any) -> Figure:
    steps = np.arange(200)
    loss = 0.1 * np.exp(-steps / 50) + 1e-3
    return fit_curves(
        FitCurves(steps, loss, -10 * np.log10(loss), [99, 199], [20.0, 25.0], {100: "64³"}),
        title="A fit",
        caption="Text.",
    )


FIGURES: dict[str, Callable[[Any], Figure]] = {
    "slices": lambda f: signed_slices(
        f.values, f.bounds, outline=f.occupied, title="T", caption="C " * 90
    ),
    "projections": lambda f: signed_projections(f.values, f.bounds, outline=f.occupied),
    "steps": lambda f: projection_steps({i: f.values / (i + 1) for i in range(5)}, f.bounds),
    "curves": draw_curves,
    "strips": lambda _: comparison_strips(IMAGES[:2], IMAGES[1:]),
}


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_the_same_bytes_twice(name: str, field: Any, tmp_path: Path) -> None:
    first = save_figure(FIGURES[name](field), tmp_path / "first.png").read_bytes()
    untouched = dict(mpl.rcParams)
    with mpl.rc_context({"font.size": 23, "axes.facecolor": "pink", "savefig.dpi": 31}):
        second = save_figure(FIGURES[name](field), tmp_path / "second.png").read_bytes()
    assert first == second
    assert dict(mpl.rcParams) == untouched
    assert np.asarray(Image.open(io.BytesIO(first)).convert("L")).std() > 5.0  # not blank
    for word in (b"matplotlib", b"tIME", b"Software", b"Creation"):
        assert word not in first.replace(b"Matplotlib", b"matplotlib")


def test_pyplot_is_never_imported() -> None:
    code = "import sys, photograd_course.viz; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_missing_folder_is_named(field: Any, tmp_path: Path) -> None:
    with pytest.raises(IoError, match="existing folder"):
        save_figure(FIGURES["slices"](field), tmp_path / "missing" / "figure.png")


def test_gif_and_frames_say_what_they_were_given(tmp_path: Path) -> None:
    frames = [np.full((8, 6, 3), (i / 4, 0.5, 1.0 - i / 4)) for i in range(5)]
    first = write_gif(frames, tmp_path / "a.gif", frames_per_second=25).read_bytes()
    assert first == write_gif(frames, tmp_path / "b.gif", frames_per_second=25).read_bytes()
    with Image.open(tmp_path / "a.gif") as gif:
        assert (gif.n_frames, gif.size, gif.info["loop"]) == (5, (6, 8), 0)
        for number, frame in enumerate(frames):
            gif.seek(number)
            assert gif.info["duration"] == 40
            # 256 colors for 5 flat frames: at most the rounding of the palette, 4 of 255.
            assert np.abs(np.asarray(gif.convert("RGB")) / 255 - frame).max() < 0.016
    paths = write_frames(frames, tmp_path / "frames", prefix="view")
    assert [path.name for path in paths][:2] == ["view_0000.png", "view_0001.png"]
    for path, frame in zip(paths, frames, strict=True):
        assert np.abs(np.asarray(Image.open(path)) / 255 - frame).max() <= 0.5 / 255 + 1e-12


def test_wrong_frames_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ShapeError, match=r"frames\[1\]: expected shape"):
        write_gif([np.zeros((4, 4, 3)), np.zeros((4, 5, 3))], tmp_path / "a.gif")
    with pytest.raises(RangeError, match=r"write_gif: frames\[0\]: expected display values"):
        write_gif([np.full((4, 4, 3), 1.5)], tmp_path / "a.gif")
    with pytest.raises(ShapeError, match="at least one image"):
        write_gif([], tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


def test_without_pillow_a_typed_error_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(Error, match="pip install pillow"):
        write_gif([np.zeros((4, 4, 3))], tmp_path / "a.gif")
