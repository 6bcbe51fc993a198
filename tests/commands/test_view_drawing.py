"""`photograd view` without a browser: pictures from coarse to fine, and the thread that draws."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.commands import view_drawing
from photograd.commands.view_drawing import reduced, strips, viewed_file, viewed_scene
from photograd.commands.view_painter import Painter, Wish, camera_of, layer_image
from photograd.errors import SceneError
from photograd.fitting import load_model
from photograd.fitting.drawing import Picture, draw_field
from photograd.splats.files import write_gaussians

from tests.commands.conftest import Photograd
from tests.splat import oracle

pytestmark = pytest.mark.usefixtures("core")


def pictures(drawing: Any, camera: Camera) -> list[Picture]:
    return [picture for picture in drawing(camera) if picture is not None]


def test_strips_make_up_the_whole_picture(
    model_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(view_drawing, "STRIP", 300)
    viewed = viewed_file(model_folder)
    (camera,) = orbit_cameras(viewed.box, 1, size=(40, 30))
    assert [strip.height for strip in strips(camera)] == [7, 7, 7, 7, 2]
    coarse, fine = pictures(viewed.draw, camera)
    model = load_model(model_folder)
    whole = draw_field(model.field, model.background, camera)
    for name in ("color", "opacity", "depth"):
        np.testing.assert_array_equal(getattr(fine, name), getattr(whole, name))
    assert coarse.color.shape == (7, 10, 3)
    small = draw_field(model.field, model.background, reduced(camera, 4))
    np.testing.assert_array_equal(coarse.color, small.color)
    assert whole.color.min() < 0.7
    steps = list(viewed.draw(camera))
    assert steps.count(None) == 5  # where it can be left


def test_steps_of_a_fit_are_shown(model_folder: Path) -> None:
    viewed = viewed_file(model_folder)
    (camera,) = orbit_cameras(viewed.box, 1, size=24)
    assert sorted(viewed.steps) == [0, 1, 4, 12, 40]
    first, last = (pictures(viewed.steps[step].draw, camera)[-1].color for step in (0, 40))
    assert np.abs(first - last).max() > 0.2
    np.testing.assert_array_equal(last, pictures(viewed.draw, camera)[-1].color)
    assert viewed.capture is not None


def test_gaussians_are_drawn_in_strips(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_drawing, "STRIP", 200)
    write_gaussians(tmp_path / "a.ply", oracle.cloud(40, 1).astype(np.float32))
    viewed = viewed_file(tmp_path / "a.ply")
    (camera,) = orbit_cameras(viewed.box, 1, size=24)
    split = pictures(viewed.draw, camera)[-1]
    monkeypatch.setattr(view_drawing, "STRIP", 10**6)
    np.testing.assert_allclose(split.color, pictures(viewed.draw, camera)[-1].color, atol=1.5 / 255)
    assert split.opacity.max() > 0.3


def test_a_scene_is_traced_further_and_further() -> None:
    viewed = viewed_scene("cornell-box", spp=6, max_depth=4)
    assert viewed.layers == ("color",)
    assert viewed.start is not None
    camera = replace(reduced(viewed.start, 32))
    found = pictures(viewed.draw, camera)
    assert [picture.color.shape for picture in found] == [(4, 4, 3), *[(16, 16, 3)] * 4]
    truth = pictures(viewed_scene("cornell-box", spp=256, max_depth=4).draw, camera)[-1].color
    off = [np.abs(picture.color - truth).mean() for picture in found[1:]]
    assert off[-1] < 0.7 * off[0]
    assert truth.max() > 0.5


def test_cameras_of_a_page_are_ours() -> None:
    (camera,) = orbit_cameras(np.array([[-1.0, -1, -1], [1, 1, 1]]), 1, size=(64, 48))
    from photograd.capture.frames import quaternion_from_rotation

    q = quaternion_from_rotation(camera.world_from_camera[:3, :3])
    fov = 2 * np.arctan(0.5 * camera.height / camera.fy)
    again = camera_of(q, camera.position, fov, (64, 48), 1000)
    np.testing.assert_allclose(again.world_from_camera, camera.world_from_camera, atol=1e-12)
    assert again.fy == pytest.approx(camera.fy)
    small = camera_of(q, camera.position, fov, (1600, 1200), 400)
    assert (small.width, small.height) == (400, 300)


def test_layers_are_bytes() -> None:
    depth = np.array([[1.0, 2.0], [np.nan, 3.0]])
    picture = Picture(np.full((2, 2, 3), 0.5), np.array([[1.0, 0.5], [0.0, 1.0]]), depth)
    assert layer_image(picture, "color").tolist() == [[[128] * 3] * 2] * 2
    assert layer_image(picture, "opacity")[..., 0].tolist() == [[255, 128], [0, 255]]
    shown = layer_image(picture, "depth")
    assert shown[1, 0].tolist() == [255] * 3
    assert shown[0, 0, 1] > shown[0, 1, 1] > shown[1, 1, 1]  # near is yellow, far is purple
    nothing = Picture(picture.color, 0 * picture.opacity, np.full((2, 2), np.nan))
    assert layer_image(nothing, "depth").min() == 255


def test_a_newer_camera_ends_an_older_picture() -> None:
    (a, b) = orbit_cameras(np.array([[-1.0, -1, -1], [1, 1, 1]]), 2, size=8)
    entered, go_on = threading.Event(), threading.Event()
    blank = Picture(np.zeros((8, 8, 3)), np.zeros((8, 8)), np.zeros((8, 8)))

    def drawing(camera: Camera) -> Iterator[Picture | None]:
        yield blank
        if camera is a:
            entered.set()
            assert go_on.wait(10)
            yield None
            raise AssertionError("the older picture went on")
        yield blank

    shown: list[str] = []
    done = threading.Event()

    def show_b(_: Picture) -> None:
        shown.append("b")
        if shown.count("b") == 2:
            done.set()

    painter = Painter(drawing)
    painter.wish(Wish(1, a, lambda _: shown.append("a")))
    assert entered.wait(10)
    painter.wish(Wish(1, b, show_b))
    go_on.set()
    assert done.wait(10)
    painter.close()
    assert shown == ["a", "b", "b"]


def test_another_client_gets_its_turn_and_errors_do_not_end_the_thread(
    capsys: pytest.CaptureFixture[str],
) -> None:
    cameras = orbit_cameras(np.array([[-1.0, -1, -1], [1, 1, 1]]), 3, size=8)
    blank = Picture(np.zeros((8, 8, 3)), np.zeros((8, 8)), np.zeros((8, 8)))

    def drawing(camera: Camera) -> Iterator[Picture | None]:
        yield blank
        if camera is cameras[2]:
            raise SceneError("scene: camera: expected a free view, got a wall")
        yield blank

    shown: list[int] = []
    done = threading.Event()

    def show(number: int) -> Any:
        def add(_: Picture) -> None:
            shown.append(number)
            if shown.count(0) >= 2 and shown.count(1) >= 2:
                done.set()

        return add

    painter = Painter(drawing)
    for number in (2, 0, 1):
        painter.wish(Wish(number, cameras[number], show(number)))
    assert done.wait(10)
    painter.close()
    assert 2 in shown or "got a wall" not in capsys.readouterr().err


def test_the_command_without_viser_names_the_extra(
    photograd: Photograd, model_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    done = photograd("view", model_folder)
    assert done.code == 1
    assert "pip install 'photograd[viewer]'" in done.err
    assert "--up: expected auto or one of" in photograd("view", model_folder, "--up", "north").err
    assert "nothing.npz" in photograd("view", "nothing.npz").err
