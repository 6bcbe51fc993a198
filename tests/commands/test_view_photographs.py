"""Photographs in `photograd view`: which is nearest, which is looked through, and its layers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.commands.view_drawing import viewed_file
from photograd.commands.view_panel import Frusta
from photograd.commands.view_photographs import (
    NEAREST,
    Overlay,
    Photographs,
    combined,
    display_pixels,
    fov_that_shows,
    nothing,
    photograph_through,
)

pytestmark = pytest.mark.usefixtures("core")
BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])


@pytest.fixture
def photographs(capture_folder: Path) -> Photographs:
    return Photographs.of(load_capture(capture_folder), lambda camera, _: camera, 3.0)


def moved(camera: Camera, by: float) -> Camera:
    pose = camera.world_from_camera.copy()
    pose[:3, 3] += by * pose[:3, 0]
    return replace(camera, world_from_camera=pose)


def test_the_nearest_has_place_and_direction(photographs: Photographs) -> None:
    for number, view in enumerate(photographs.views):
        assert photographs.nearest(moved(view.camera, 0.05)) == number
    first = photographs.views[0].camera
    turned = first.world_from_camera.copy()
    turned[:3, :3] = photographs.views[3].camera.world_from_camera[:3, :3]
    both = Photographs(
        (
            replace(photographs.views[0], name="a"),
            replace(
                photographs.views[0], name="b", camera=replace(first, world_from_camera=turned)
            ),
        ),
        3.0,
    )
    assert both.nearest(replace(first, world_from_camera=turned)) == 1
    assert both.named("a", replace(first, world_from_camera=turned)).name == "a"
    assert both.named(NEAREST, first).name == "a"


def test_only_at_its_place_one_looks_through_a_photograph(photographs: Photographs) -> None:
    view = photographs.views[2]
    assert photographs.through(view.camera) is view
    assert photographs.through(moved(view.camera, 0.002)) is view
    assert photographs.through(moved(view.camera, 0.01)) is None


def test_the_whole_photograph_is_on_the_page() -> None:
    (camera,) = orbit_cameras(BOX, 1, size=(40, 30))
    down, across = 15 / camera.fy, 20 / camera.fx
    assert np.tan(fov_that_shows(camera, 2.0) / 2) == pytest.approx(down)
    assert np.tan(fov_that_shows(camera, 1.0) / 2) == pytest.approx(across)


def test_a_photograph_seen_by_its_own_camera_is_itself(photographs: Photographs) -> None:
    view = photographs.views[1]
    pixels = display_pixels(view)
    seen, inside = photograph_through(pixels, view.camera, view.camera)
    np.testing.assert_array_equal(seen, pixels)
    assert inside.all()
    wide = replace(view.camera, width=48, cx=view.camera.cx + 12)
    seen, inside = photograph_through(pixels, view.camera, wide)
    np.testing.assert_array_equal(seen[:, 12:36], pixels)
    assert inside.sum() == 24 * 24
    pose = view.camera.world_from_camera.copy()
    pose[:3, :3] = pose[:3, :3] @ np.diag([-1.0, 1, -1])
    _, inside = photograph_through(
        pixels, view.camera, replace(view.camera, world_from_camera=pose)
    )
    assert not inside.any()


def test_layers_lie_over_beside_and_against() -> None:
    rendered, seen = np.full((4, 6, 3), 0.25), np.full((4, 6, 3), 0.75)
    inside = np.ones((4, 6), bool)
    inside[0] = False
    over = combined("photograph", rendered, seen, inside)
    assert over[1].min() == 0.75
    assert over[0].max() == 0.25
    split = combined("split", rendered, seen, inside)
    assert split[2, :, 0].tolist() == [0.75, 0.75, 1.0, 0.25, 0.25, 0.25]
    seen[1, 2] = 0.3
    difference = combined("difference", rendered, seen, inside)
    assert np.ptp(difference[0]) < 0.1  # gray: no pixel there
    assert difference[1, 2, 0] < difference[2, 2, 0]  # purple is small, yellow large


def test_pictures_are_compared_where_the_camera_looks_through(
    capture_folder: Path, model_folder: Path
) -> None:
    capture, viewed = load_capture(capture_folder), viewed_file(model_folder)
    overlay = Overlay(Photographs.of(capture, viewed.from_capture, 3.0))
    view = overlay.photographs.views[0]
    last = [p for p in overlay.pictures("photograph", viewed.draw, view.camera) if p][-1]
    np.testing.assert_array_equal(last.color, display_pixels(view))
    off = [p for p in overlay.pictures("photograph", viewed.draw, moved(view.camera, 0.1)) if p]
    plain = [p for p in viewed.draw(moved(view.camera, 0.1)) if p]
    np.testing.assert_array_equal(off[-1].color, plain[-1].color)
    alone = [p for p in overlay.pictures("photograph", nothing, view.camera) if p]
    np.testing.assert_array_equal(alone[-1].color, display_pixels(view))


class Node:
    """A frustum of viser, as far as it is used."""

    visible = True

    def on_click(self, call: object) -> object:
        return call


class Server:
    """Counts frusta."""

    def __init__(self) -> None:
        self.scene = self
        self.nodes: dict[str, Node] = {}

    def add_camera_frustum(self, name: str, **_: object) -> Node:
        self.nodes[name] = Node()
        return self.nodes[name]


def test_the_frustum_that_is_looked_through_is_hidden(photographs: Photographs) -> None:
    server = Server()
    frusta = Frusta(server, photographs, None, lambda *_: None)
    assert len(server.nodes) == len(photographs.views)

    def hidden() -> list[str]:
        return [name for name, node in server.nodes.items() if not node.visible]

    first, second = photographs.views[:2]
    frusta.hide_at(first.camera)
    assert hidden() == [f"/photographs/{first.name}"]
    frusta.hide_at(second.camera)
    assert hidden() == [f"/photographs/{second.name}"]
    frusta.show(visible=False)
    frusta.hide_at(moved(second.camera, 1.5))
    assert len(hidden()) == len(photographs.views)
    frusta.show(visible=True)
    assert hidden() == []
    assert not frusta.just_clicked()
