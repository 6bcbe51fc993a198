"""The page of `photograd view`: viser's server, cameras of its clients, and one thread that draws.

A client's camera asks for a picture; the thread draws for the newest request, coarse and then
fine, and leaves a picture for a newer one. Photographs are frusta, which lie before all pictures,
points a cloud.
"""

from __future__ import annotations

import contextlib
import io
import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.cli import note

from photograd._extras import import_extra
from photograd.capture import Capture
from photograd.capture.camera import Camera
from photograd.capture.frames import quaternion_from_rotation, rotation_from_quaternion
from photograd.capture.orbit import orbit_cameras
from photograd.commands.render_output import depth_colors, depth_range
from photograd.commands.view_drawing import Drawing, Viewed
from photograd.errors import Error, RangeError
from photograd.fitting.drawing import Picture
from photograd.types import Array, FloatArray

FRUSTUM = 0.1
"""Size of a camera, in diagonals of the scene."""
MOST_PHOTOGRAPHS = 100
THUMBNAIL = 96
MOST_POINTS = 200_000
POINT = 0.002
"""Size of a point, in diagonals of the scene."""


@dataclass(frozen=True)
class Wish:
    """A picture that a client waits for.

    Attributes:
        number: of the client.
        camera: what it sees.
        show: takes a picture to its page.
    """

    number: int
    camera: Camera
    show: Callable[[Picture], None]


class Painter:
    """One thread that draws for all clients, the newest wish first.

    Attributes:
        drawing: what is drawn; may be replaced at any time.
    """

    def __init__(self, drawing: Drawing) -> None:
        """Start the thread.

        Args:
            drawing: see above.
        """
        self.drawing = drawing
        self._wishes: dict[int, Wish] = {}
        self._changed = threading.Condition()
        self._ended = False
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def wish(self, wish: Wish) -> None:
        """Ask for a picture; an earlier wish of the same client is forgotten.

        Args:
            wish: of a client.
        """
        with self._changed:
            self._wishes.pop(wish.number, None)
            self._wishes[wish.number] = wish
            self._changed.notify()

    def forget(self, number: int) -> None:
        """Draw no more for a client that is gone.

        Args:
            number: of the client.
        """
        with self._changed:
            self._wishes.pop(number, None)

    def close(self) -> None:
        """End the thread, within a strip of a picture."""
        with self._changed:
            self._ended = True
            self._changed.notify()
        self._thread.join()

    def _work(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ended or bool(self._wishes))
                if self._ended:
                    return
                _, wish = self._wishes.popitem()  # the last one that came
            try:
                self._draw(wish)
            except Error as failure:
                note(f"warning: {failure}", style="yellow")

    def _draw(self, wish: Wish) -> None:
        for picture in self.drawing(wish.camera):
            if picture is not None:
                wish.show(picture)
            with self._changed:
                if self._ended:
                    return
                if self._wishes:
                    if wish.number not in self._wishes:  # another client's: this one's turn again
                        self._wishes = {wish.number: wish, **self._wishes}
                    return


def camera_of(wxyz: Any, position: Any, fov: float, size: tuple[int, int], largest: int) -> Camera:
    """The camera of a page, with at most `largest` pixels along an edge.

    Args:
        wxyz: (4,) quaternion of the pose, OpenCV axes.
        position: (3,) in meters.
        fov: vertical angle of view in radians.
        size: (width, height) of the page's canvas in pixels.
        largest: see above.

    Raises:
        RangeError: what `Camera` raises.
    """
    share = min(1.0, largest / max(size))
    width, height = (max(round(edge * share), 1) for edge in size)
    focal = 0.5 * height / math.tan(0.5 * fov)
    pose = np.eye(4)
    pose[:3, :3] = rotation_from_quaternion(np.asarray(wxyz, np.float64))
    pose[:3, 3] = position
    return Camera(width, height, focal, focal, 0.5 * width, 0.5 * height, pose)


def layer_image(picture: Picture, layer: str) -> Array:
    """A layer of a picture as bytes (H, W, 3).

    Args:
        picture: that was drawn.
        layer: "color", "depth" or "opacity".
    """
    if layer == "opacity":
        values = np.repeat(np.clip(picture.opacity, 0, 1)[..., None], 3, axis=2)
    elif layer == "depth":
        try:
            values = depth_colors(picture.depth, *depth_range([picture.depth]))
        except RangeError:  # nothing is there
            values = np.ones((*picture.depth.shape, 3))
    else:
        values = picture.color
    return np.floor(255.0 * values + 0.5).astype(np.uint8)


class Page:
    """A server, and what its pages show.

    Attributes:
        address: to open in a browser.
    """

    def __init__(
        self, viewed: Viewed | None, capture: Capture | None, *, host: str, port: int, largest: int
    ) -> None:
        """Start to serve.

        Args:
            viewed: what is drawn; None shows photographs and points alone.
            capture: photographs and points, or None.
            host: address to listen at.
            port: to listen at, or the next one that is free.
            largest: pixels along an edge of a picture.

        Raises:
            IoError: viser is not installed.
        """
        viser = import_extra("view", "viser", "viewer")
        self._viewed, self._largest, self._layer = viewed, largest, "color"
        with _quiet():
            self._server = viser.ViserServer(host=host, port=port, verbose=False)
        self.address = f"http://{host}:{self._server.get_port()}"
        self._painter = None if viewed is None else Painter(viewed.draw)
        self._server.scene.set_up_direction("+y")
        box = _box(viewed, capture)
        self._start = _start_camera(viewed, box)
        self._reach = float(np.linalg.norm(box[1] - box[0]))
        ahead = float((box.mean(axis=0) - self._start.position) @ self._start.forward)
        self._pivot = self._start.position + max(ahead, 0.05 * self._reach) * self._start.forward
        if capture is not None:
            turn = (lambda camera, _: camera) if viewed is None else viewed.from_capture
            self._add_photographs(capture, turn)
        self._add_controls()
        self._server.on_client_connect(self._welcome)
        self._server.on_client_disconnect(self._part)

    def close(self) -> None:
        """Stop drawing and serving."""
        if self._painter is not None:
            self._painter.close()
        with _quiet():
            self._server.stop()

    def _welcome(self, client: Any) -> None:
        camera = self._start
        client.camera.up_direction = (0.0, 1.0, 0.0)
        client.camera.position = camera.position
        client.camera.look_at = self._pivot
        client.camera.fov = 2 * math.atan(0.5 * camera.height / camera.fy)
        client.camera.on_update(lambda _: self._ask(client))

    def _part(self, client: Any) -> None:
        if self._painter is not None:
            self._painter.forget(client.client_id)

    def _ask(self, client: Any) -> None:
        if self._painter is None:
            return
        handle = client.camera
        size = (max(handle.image_width, 1), max(handle.image_height, 1))
        camera = camera_of(handle.wxyz, handle.position, handle.fov, size, self._largest)

        def show(picture: Picture) -> None:
            image = layer_image(picture, self._layer)
            client.scene.set_background_image(image, format="jpeg", jpeg_quality=90)

        self._painter.wish(Wish(client.client_id, camera, show))

    def _ask_all(self) -> None:
        for client in self._server.get_clients().values():
            self._ask(client)

    def _add_controls(self) -> None:
        viewed = self._viewed
        if viewed is None:
            return
        if len(viewed.layers) > 1:
            layer = self._server.gui.add_dropdown("Layer", viewed.layers, initial_value="color")

            @layer.on_update  # type: ignore[untyped-decorator]
            def _(_: Any) -> None:
                self._layer = layer.value
                self._ask_all()

        if len(viewed.steps) > 1:
            steps = sorted(viewed.steps)
            slider = self._server.gui.add_slider(
                "Step", min=0, max=len(steps) - 1, step=1, initial_value=len(steps) - 1
            )
            label = self._server.gui.add_markdown(f"step {steps[-1]} of the fit")

            @slider.on_update  # type: ignore[untyped-decorator]
            def _(_: Any) -> None:
                step = steps[int(slider.value)]
                label.content = f"step {step} of the fit"
                assert self._painter is not None
                last = step == steps[-1]
                self._painter.drawing = viewed.draw if last else viewed.steps[step]
                self._ask_all()

    def _add_photographs(
        self, capture: Capture, turn: Callable[[Camera, FloatArray], Camera]
    ) -> None:
        scene, views = self._server.scene, capture.views
        kept = views[:: -(-len(views) // MOST_PHOTOGRAPHS)]
        for view in kept:
            camera = turn(view.camera, capture.world_from_source)
            thumbnail = np.floor(255.0 * view.thumbnail(THUMBNAIL) + 0.5).astype(np.uint8)
            scene.add_camera_frustum(
                f"/photographs/{view.name}",
                fov=2 * math.atan(0.5 * camera.height / camera.fy),
                aspect=camera.width / camera.height,
                scale=FRUSTUM * self._reach,
                image=thumbnail,
                wxyz=quaternion_from_rotation(camera.world_from_camera[:3, :3]),
                position=camera.position,
            )
        boxed = self._server.gui.add_checkbox("Photographs", initial_value=True)

        @boxed.on_update  # type: ignore[untyped-decorator]
        def _(_: Any) -> None:
            for view in kept:
                scene.get_handle_by_name(f"/photographs/{view.name}").visible = boxed.value

        if capture.points is not None and self._viewed is None:
            some = slice(None, None, -(-len(capture.points) // MOST_POINTS))
            colors = capture.point_colors
            gray = np.full((len(capture.points), 3), 128, np.uint8)
            scene.add_point_cloud(
                "/points",
                capture.points[some].astype(np.float32),
                (gray if colors is None else colors)[some],
                point_size=POINT * self._reach,
            )


def _quiet() -> contextlib.redirect_stdout[io.StringIO]:
    """What viser prints of itself is left aside: stdout is for results."""
    return contextlib.redirect_stdout(io.StringIO())


def _box(viewed: Viewed | None, capture: Capture | None) -> Array:
    """(2, 3) around what is shown."""
    if viewed is not None:
        return viewed.box
    assert capture is not None
    at = np.stack([view.camera.position for view in capture.views])
    corners = (
        [at] if capture.points is None else [at, np.percentile(capture.points, [2, 98], axis=0)]
    )
    every = np.concatenate(corners)
    return np.stack([every.min(axis=0) - 1e-3, every.max(axis=0) + 1e-3])


def _start_camera(viewed: Viewed | None, box: Array) -> Camera:
    if viewed is not None and viewed.start is not None:
        return viewed.start
    (camera,) = orbit_cameras(box, 1, size=256)
    return camera
