"""The page of `photograd view`: viser's server, what its panel offers, and cameras of its clients.

Photographs are frusta, which lie before all pictures, points a cloud. Pictures come from one thread
(view_painter), so that a click or a slider never waits for one.
"""

from __future__ import annotations

import contextlib
import errno
import io
import math
import socket
from typing import Any

import numpy as np
from photograd_course.cli import note

from photograd._extras import import_extra
from photograd.capture import Capture
from photograd.capture.camera import Camera
from photograd.capture.orbit import orbit_cameras
from photograd.commands.view_door import guarded
from photograd.commands.view_drawing import Shown, Viewed
from photograd.commands.view_gradients import GradientLayer, scale_bar
from photograd.commands.view_hits import Pick
from photograd.commands.view_painter import Painter, Wish, camera_of, layer_image
from photograd.commands.view_panel import Frusta, StepSlider, absent_gradient
from photograd.commands.view_photographs import (
    HOW_TO,
    LAYERS,
    NEAREST,
    Overlay,
    Photographs,
    fov_that_shows,
    nothing,
)
from photograd.commands.view_picking import pick
from photograd.commands.view_scene import SceneParameters, add_controls, pick_in_scene
from photograd.errors import Error, IoError, message
from photograd.fitting.drawing import Picture
from photograd.types import Array

LOOPBACK = "127.0.0.1"
TRIED = 100
"""Ports after the wanted one that may be taken instead."""
GRADIENT = "gradient"
MARK = "/picked"
MARKED = (255, 140, 0)


class Page:
    """A server, and what its pages show.

    Attributes:
        address: to open in a browser.
    """

    def __init__(
        self,
        viewed: Viewed | None,
        capture: Capture | None,
        *,
        host: str = LOOPBACK,
        port: int = 8080,
        largest: int = 1024,
    ) -> None:
        """Start to serve.

        Args:
            viewed: what is drawn; None shows photographs and points alone.
            capture: photographs and points, or None.
            host: address to listen at.
            port: to listen at, a free one.
            largest: pixels along an edge of a picture.

        Raises:
            IoError: viser is not installed.
        """
        viser = import_extra("view", "viser", "viewer")
        self._viewed, self._largest = viewed, largest
        self._shown: Shown | None = None if viewed is None else viewed.last
        self._layer = "color" if viewed is not None else LAYERS[0]
        self._chosen = NEAREST
        box = _box(viewed, capture)
        self._start = _start_camera(viewed, box)
        self._reach = float(np.linalg.norm(box[1] - box[0]))
        ahead = float((box.mean(axis=0) - self._start.position) @ self._start.forward)
        self._queued = max(ahead, 0.05 * self._reach)
        with _quiet(), guarded(host):
            self._server = viser.ViserServer(host=host, port=port, verbose=False)
        self.address = f"http://{host}:{self._server.get_port()}"
        self._server.scene.set_up_direction("+y")
        self._overlay: Overlay | None = None
        self._frusta: Frusta | None = None
        if capture is not None:
            turn = (lambda camera, _: camera) if viewed is None else viewed.from_capture
            photographs = Photographs.of(capture, turn, self._reach)
            self._overlay = Overlay(photographs, self._say)
            points = capture if viewed is None else None
            self._frusta = Frusta(self._server, photographs, points, self._look_through)
        self._gradients = GradientLayer(self._say)
        self._painter = Painter(self._pictures, self._fail)
        self._ready = False  # a page of an earlier server may have come back already
        self._add_controls()
        self._ready = True
        self._server.on_client_connect(self._welcome)
        self._server.on_client_disconnect(lambda client: self._painter.forget(client.client_id))
        if viewed is not None:
            self._server.scene.on_click()(self._pick)

    def close(self) -> None:
        """Stop drawing and serving."""
        self._painter.close()
        with _quiet():
            self._server.stop()

    @property
    def watched(self) -> bool:
        """Whether anybody looks, and has seen what there is."""
        return bool(self._server.get_clients()) and self._painter.idle

    def replace(self, viewed: Viewed, said: str = "") -> None:
        """Show a newer state of the same, where the page shows the last step.

        Args:
            viewed: as it is now.
            said: about it, in Markdown.
        """
        self._viewed = viewed
        self._steps.replace(viewed.steps, viewed.last)
        if said:
            self._say(said)
        self._ask_all()

    def _pictures(self, camera: Camera) -> Any:
        """The pictures that the thread draws of the layer that is chosen."""
        layer, shown = self._layer, self._shown
        draw = nothing if shown is None else shown.draw
        if self._overlay is None or not (layer == GRADIENT or layer in LAYERS):
            return draw(camera)
        if layer == GRADIENT:
            assert shown is not None
            view = self._overlay.photographs.named(self._chosen, camera)
            return self._gradients.pictures(shown, view, camera)
        return self._overlay.pictures(layer, draw, camera)

    def _say(self, text: str) -> None:
        if self._status.content != text:
            self._status.content = text

    def _fail(self, text: str) -> None:
        note(f"warning: {text}", style="yellow")
        self._say(text)

    def _welcome(self, client: Any) -> None:
        client.camera.on_update(lambda _: self._ask(client))
        self._go(client, self._start, 2 * math.atan(0.5 * self._start.height / self._start.fy))

    def _go(self, client: Any, camera: Camera, fov: float) -> None:
        """Take a client to a camera, upright unless that is rolled."""
        rolled = abs(float(camera.world_from_camera[1, 0])) > 1e-6
        up = -camera.world_from_camera[:3, 1] if rolled else np.array([0.0, 1.0, 0.0])
        with client.atomic():
            client.camera.up_direction = up
            client.camera.position = camera.position
            client.camera.look_at = camera.position + self._queued * camera.forward
            client.camera.fov = fov

    def _look_through(self, client: Any, camera: Camera) -> None:
        aspect = max(client.camera.image_width, 1) / max(client.camera.image_height, 1)
        self._go(client, camera, fov_that_shows(camera, aspect))

    def _camera(self, client: Any) -> Camera:
        handle = client.camera
        size = (max(handle.image_width, 1), max(handle.image_height, 1))
        return camera_of(handle.wxyz, handle.position, handle.fov, size, self._largest)

    def _ask(self, client: Any) -> None:
        camera = self._camera(client)
        if self._frusta is not None:
            self._frusta.hide_at(camera)

        def show(picture: Picture) -> None:
            image = layer_image(picture, self._layer)
            client.scene.set_background_image(image, format="jpeg", jpeg_quality=90)

        self._painter.wish(Wish(client.client_id, camera, show))

    def _ask_all(self) -> None:
        if not self._ready:
            return
        for client in self._server.get_clients().values():
            self._ask(client)

    def _layers(self) -> list[str]:
        viewed = self._viewed
        if viewed is None:
            return [LAYERS[0]]
        compared = [] if self._overlay is None else list(LAYERS)
        gradient = [] if absent_gradient(viewed, self._overlay is not None) else [GRADIENT]
        return [*viewed.layers, *gradient, *compared]

    def _add_controls(self) -> None:
        gui, viewed = self._server.gui, self._viewed
        layers = self._layers()
        if len(layers) > 1:
            layer = gui.add_dropdown("Layer", layers, initial_value=layers[0])

            @layer.on_update  # type: ignore[untyped-decorator]
            def _(_: Any) -> None:
                self._layer = layer.value
                self._bar.visible = layer.value == GRADIENT
                if layer.value != GRADIENT:
                    self._say("")
                self._ask_all()

        self._bar = gui.add_image(scale_bar(), visible=False)
        compared = self._overlay is not None
        said = HOW_TO if viewed is None else absent_gradient(viewed, compared)
        self._status = gui.add_markdown(said)
        self._steps = StepSlider(gui, self._show_step)
        if viewed is not None:
            self._steps.replace(viewed.steps, viewed.last)
        if self._overlay is not None:
            self._add_photographs(self._overlay.photographs, gradient=GRADIENT in layers)
        home = gui.add_button("Home")
        fov = 2 * math.atan(0.5 * self._start.height / self._start.fy)
        home.on_click(lambda event: self._go(event.client, self._start, fov))
        if viewed is None:
            return
        with gui.add_folder("Picked"):
            self._picked = gui.add_markdown("Click on the picture.")
        if viewed.tracer is not None:
            add_controls(gui, SceneParameters(viewed.tracer), self._ask_all)

    def _show_step(self, shown: Shown) -> None:
        self._shown = shown
        self._ask_all()

    def _add_photographs(self, photographs: Photographs, *, gradient: bool) -> None:
        gui = self._server.gui
        boxed = gui.add_checkbox("Photographs", initial_value=True)

        @boxed.on_update  # type: ignore[untyped-decorator]
        def _(_: Any) -> None:
            assert self._frusta is not None
            self._frusta.show(visible=boxed.value)

        look = gui.add_button("Look through the nearest")

        @look.on_click  # type: ignore[untyped-decorator]
        def _(event: Any) -> None:
            camera = self._camera(event.client)
            view = photographs.views[photographs.nearest(camera)]
            self._look_through(event.client, view.camera)

        if not gradient:
            return
        names = [NEAREST, *(view.name for view in photographs.views)]
        chosen = gui.add_dropdown("Loss against", names, initial_value=NEAREST)

        @chosen.on_update  # type: ignore[untyped-decorator]
        def _(_: Any) -> None:
            self._chosen = chosen.value
            self._ask_all()

    def _pick(self, event: Any) -> None:
        """A click on the picture: what it hits goes to the panel, and is marked."""
        if self._frusta is not None and self._frusta.just_clicked():
            return
        camera, shown = self._camera(event.client), self._shown
        at = event.screen_pos[0] * camera.width, event.screen_pos[1] * camera.height
        assert shown is not None
        try:
            found = self._hit(shown, camera, at)
        except Error as failure:
            self._picked.content = f"{failure}"
            return
        self._picked.content = "Nothing there." if found is None else found.markdown()
        lines = np.zeros((0, 2, 3)) if found is None else found.lines @ shown.field_from_page
        colors = np.broadcast_to(np.array(MARKED, np.uint8), lines.shape)
        self._server.scene.add_line_segments(
            MARK,
            points=lines.astype(np.float32),
            colors=colors,
            thickness=3.0,
            thickness_units="screen",
        )

    def _hit(self, shown: Shown, camera: Camera, at: tuple[float, float]) -> Pick | None:
        if shown.field is None:
            assert self._viewed is not None
            assert self._viewed.tracer is not None
            return pick_in_scene(self._viewed.tracer, camera, at)
        gradient = None
        if self._overlay is not None:
            view = self._overlay.photographs.named(self._chosen, camera)
            gradient = self._gradients.of(shown, view)
        return pick(shown.field(), shown.camera(camera), at, shown.background, gradient)


def free_port(host: str, port: int, *, exact: bool) -> int:
    """A port to listen at: the one that is wanted or, unless `exact`, the next one that is free.

    Args:
        host: address to listen at.
        port: that is wanted.
        exact: whether no other will do.

    Raises:
        IoError: no such address on this machine, a port that may not be used, or one that is in
            use; then the next free one is named.
    """
    taken = _taken(host, port)
    if not taken:
        return port
    after = range(port + 1, min(port + 1 + TRIED, 65536))
    found = next((other for other in after if not _taken(host, other)), None)
    if exact or found is None:
        remedy = "wait until one is free" if found is None else f"--port {found} is free"
        got = f"{port}, which {taken}"
        raise IoError(message("view", "--port", f"a free port of {host}", got, remedy))
    return found


def _taken(host: str, port: int) -> str:
    """Why a port cannot be listened at; empty if it can."""
    try:
        family, kind, number, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[
            0
        ]
        with socket.socket(family, kind, number) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
    except PermissionError:
        return "this user may not listen at"
    except OSError as failure:
        if failure.errno == errno.EADDRINUSE:
            return "is in use"
        remedy = f"{LOOPBACK} is this machine alone, 0.0.0.0 all of its addresses"
        got = f"{host}: {failure.strerror or failure}"
        raise IoError(
            message("view", "--host", "an address of this machine", got, remedy)
        ) from failure
    return ""


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
