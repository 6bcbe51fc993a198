"""One thread that draws pictures for the pages of `photograd view`, and their way to bytes.

A client's camera asks for a picture; the thread draws for the newest request, coarse and then
fine, and leaves a picture for a newer one.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd_course.cli import note

from photograd.capture.camera import Camera
from photograd.capture.frames import rotation_from_quaternion
from photograd.commands.render_output import depth_colors, depth_range
from photograd.commands.view_drawing import Drawing
from photograd.errors import Error, RangeError
from photograd.fitting.drawing import Picture
from photograd.types import Array


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
    """One thread that draws for all clients, the newest wish first."""

    def __init__(self, drawing: Drawing, on_failure: Callable[[str], None] | None = None) -> None:
        """Start the thread.

        Args:
            drawing: what is drawn.
            on_failure: takes what went wrong with a picture; None notes it on stderr.
        """
        self._drawing = drawing
        self._on_failure = on_failure or (lambda text: note(f"warning: {text}", style="yellow"))
        self._drawn = True
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

    @property
    def idle(self) -> bool:
        """Whether nothing is being drawn, nor waited for."""
        with self._changed:
            return self._drawn and not self._wishes

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
                self._drawn = False
            try:
                self._draw(wish)
            except Error as failure:
                self._on_failure(f"{failure}")
            with self._changed:
                self._drawn = True

    def _draw(self, wish: Wish) -> None:
        for picture in self._drawing(wish.camera):
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
        layer: "depth", "opacity", or any other, which is the color of the picture.
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
