"""`photograd render`: camera paths, sizes, depth and opacity, videos and numbers."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.fitting import load_model
from photograd.images import read_image

from tests.commands.conftest import Photograd

SMALL = ("--width", 24, "--height", 16)


def frames_of(path: Path) -> np.ndarray[Any, Any]:
    """All frames (F, H, W, 3) of a video, in 0..1, as FFmpeg's libraries decode them."""
    with av.open(str(path)) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    return np.stack(frames) / 255.0


def pictures_in(folder: Path) -> np.ndarray[Any, Any]:
    return np.stack([read_image(path)[..., :3] for path in sorted(folder.glob("frame_*.png"))])


def numbers(photograd: Photograd, model: Path, out: Path, *words: object) -> dict[str, Any]:
    done = photograd("render", model, "--out", out, *words)
    assert done.code == 0, done.err
    with np.load(out) as archive:
        return dict(archive)


@pytest.mark.parametrize(("name", "codec"), [("a.mp4", "h264"), ("a.webm", "vp9")])
def test_a_video_shows_the_pictures(
    photograd: Photograd, model_folder: Path, tmp_path: Path, name: str, codec: str
) -> None:
    words = ("--frames", 5, "--width", 96, "--height", 64)
    out = tmp_path / name
    done = photograd("render", model_folder, *words, "--fps", 12, "--out", out, "--json")
    assert done.code == 0, done.err
    assert done.result() == {"out": str(out), "frames": 5}
    assert photograd("render", model_folder, *words, "--out", tmp_path / "frames").code == 0
    wanted = pictures_in(tmp_path / "frames")
    shown = frames_of(out)
    assert wanted.shape == shown.shape == (5, 64, 96, 3)
    assert wanted.min() < 0.7
    apart = np.abs(shown - wanted).mean()  # chroma is halved, and everything quantized
    assert apart < 0.3 * np.abs(shown - wanted[::-1]).mean()
    with av.open(str(out)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == codec
        assert stream.average_rate == 12
    again = tmp_path / f"again{out.suffix}"
    assert photograd("render", model_folder, *words, "--fps", 12, "--out", again).code == 0
    assert again.read_bytes() == out.read_bytes()


def test_any_aspect_shows_the_whole_box(
    photograd: Photograd, model_folder: Path, tmp_path: Path
) -> None:
    wide = numbers(photograd, model_folder, tmp_path / "a.npz", "--frames", 1, *SMALL)
    square = numbers(photograd, model_folder, tmp_path / "b.npz", "--frames", 1, "--size", 16)
    assert wide["color"].shape == (1, 16, 24, 3)
    np.testing.assert_array_equal(wide["color"][:, :, 4:20], square["color"])
    done = photograd("render", model_folder, "--width", 24, "--out", tmp_path / "c.npz")
    assert done.code == 1
    assert "--width, --height: expected both, or --size, got only --width 24" in done.err


def test_a_spiral_rises_and_a_circle_does_not(
    photograd: Photograd, model_folder: Path, tmp_path: Path
) -> None:
    words = ("--path", "spiral", "--frames", 5, "--size", 8, "--elevation", 50)
    spiral = numbers(photograd, model_folder, tmp_path / "a.npz", *words)
    orbit = numbers(photograd, model_folder, tmp_path / "b.npz", "--frames", 4, "--size", 8)
    heights = spiral["world_from_camera"][:, 1, 3]
    middle = heights[0]  # level with the middle of the box
    assert (np.diff(heights) > 0).all()
    away = np.linalg.norm(spiral["world_from_camera"][-1, :3, 3] - [0, middle, 0])
    assert np.degrees(np.arcsin((heights[-1] - middle) / away)) == pytest.approx(50, abs=2)
    assert np.ptp(orbit["world_from_camera"][:, 1, 3]) < 1e-12


def test_views_are_the_cameras_of_the_photographs(
    photograd: Photograd, model_folder: Path, capture_folder: Path, tmp_path: Path
) -> None:
    test = sorted(load_capture(capture_folder).test, key=lambda view: view.name)
    words = ("--path", "views", "--split", "test")
    found = numbers(photograd, model_folder, tmp_path / "a.npz", *words)
    poses = np.stack([view.camera.world_from_camera for view in test])
    np.testing.assert_array_equal(found["world_from_camera"], poses)
    # The model has seen others only; what it shows is what was photographed.
    truth = np.stack([v.rgba()[..., :3] * v.rgba()[..., 3:] + 1 - v.rgba()[..., 3:] for v in test])
    off = np.abs(found["color"] - truth).mean()
    assert off < 0.6 * np.abs(found["color"][::-1] - truth).mean()
    words = ("--path", "between", "--split", "test", "--frames", 2 * len(test) - 1)
    between = numbers(photograd, model_folder, tmp_path / "b.npz", *words)
    np.testing.assert_allclose(between["world_from_camera"][::2], poses, atol=1e-12)


def test_a_path_may_come_from_a_file(
    photograd: Photograd, model_folder: Path, capture_folder: Path, tmp_path: Path
) -> None:
    file = tmp_path / "transforms.json"
    assert photograd("convert", capture_folder, file).code == 0
    from_file = numbers(photograd, model_folder, tmp_path / "a.npz", "--path", file)
    views = numbers(
        photograd, model_folder, tmp_path / "b.npz", "--path", "views", "--capture", capture_folder
    )
    key = "world_from_camera"
    order = [np.abs(from_file[key] - pose).max(axis=(1, 2)).argmin() for pose in views[key]]
    assert sorted(order) == list(range(len(order)))
    np.testing.assert_allclose(from_file["color"][order], views["color"], atol=1 / 255)
    viewer = {
        "render_width": 12,
        "render_height": 8,
        "camera_path": [{"camera_to_world": np.eye(4).ravel().tolist(), "fov": 90, "aspect": 1.5}],
    }
    file.write_text(json.dumps(viewer), encoding="utf-8")
    found = numbers(photograd, model_folder, tmp_path / "c.npz", "--path", file)
    # OpenGL's -z, in a world with +z up, looks down.
    np.testing.assert_allclose(found[key][0, :3, 2], [0, -1, 0], atol=1e-12)
    np.testing.assert_allclose(found["intrinsics"], [[4, 4, 6, 4]])


def test_depth_and_opacity_are_drawn(
    photograd: Photograd, model_folder: Path, tmp_path: Path
) -> None:
    words = ("--frames", 3, "--size", 24)
    found = numbers(photograd, model_folder, tmp_path / "a.npz", *words)
    told = []
    for show, name in (("opacity", "o"), ("depth", "d")):
        done = photograd(
            "render", model_folder, *words, "--show", show, "--out", tmp_path / name, "--json"
        )
        assert done.code == 0, done.err
        told.append(done.result())
    opacity = pictures_in(tmp_path / "o")[..., 0]
    assert np.abs(opacity - found["opacity"]).max() < 1 / 255
    assert opacity.max() > 0.9
    seen = np.isfinite(found["depth"])
    np.testing.assert_array_equal(seen, found["opacity"] >= 1 / 255)
    # A mean distance, also of what is half transparent: nothing lies before or behind the box.
    box = load_model(model_folder).field.box
    far_off = np.linalg.norm(found["world_from_camera"][:, :3, 3] - box.mean(axis=0), axis=1)
    off = (found["depth"] - far_off[:, None, None])[seen]
    assert np.abs(off).max() < 0.5 * np.linalg.norm(box[1] - box[0])
    depth = pictures_in(tmp_path / "d")
    assert (depth[~seen] == 1).all()
    near, far = told[1]["near_m"], told[1]["far_m"]
    assert near == pytest.approx(np.percentile(found["depth"][seen], 1), rel=1e-5)
    middle = (found["depth"] > near) & (found["depth"] < far)
    # Near is yellow, far is purple: green falls with depth.
    assert np.corrcoef(depth[middle][:, 1], found["depth"][middle])[0, 1] < -0.95
    words = (*words, "--show", "depth", "--depth-range", 1, 2, "--out", tmp_path / "r", "--json")
    assert photograd("render", model_folder, *words).result()["near_m"] == 1


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--path", "circle"), "--path: expected one of orbit, spiral, views, between, or a file"),
        (("--path", "views", "--elevation", 3), "--elevation: expected --path orbit or spiral"),
        (("--split", "test"), "--split: expected --path views or between with it, got orbit"),
        (("--path", "views", "--split", "val"), "--split: expected a split with photographs"),
        (("--path", "none.json"), "none.json: expected a file, got none"),
        (("--show", "normals"), "--show: expected one of color, depth, opacity"),
        (("--depth-range", 1, 2), "--depth-range: expected --show depth, got color"),
        (("--show", "depth", "--depth-range", 2, 1), "expected two depths from 0, the nearer fir"),
        (("--fps", 60, "--out", "x.gif"), "--fps: expected at most 50 frames a second in a GIF"),
        (("--width", 15, "--height", 16, "--out", "x.mp4"), "expected an even width and height"),
        (("--path", "views", "--out", "x.png"), "expected --frames 1 for one picture x.png"),
    ],
)
def test_what_means_nothing_is_refused_before_drawing(
    photograd: Photograd,
    model_folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[object, ...],
    says: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    done = photograd("render", model_folder, *words)
    assert done.code == 1
    assert says in done.err
    assert list(tmp_path.iterdir()) == []


def test_a_video_without_the_writer_names_the_extra(
    photograd: Photograd, model_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    done = photograd("render", model_folder, "--out", tmp_path / "a.mp4")
    assert done.code == 1
    assert "pip install 'photograd[video]'" in done.err
    assert list(tmp_path.iterdir()) == []
