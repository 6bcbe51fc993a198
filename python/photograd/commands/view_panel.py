"""Parts of the page of `photograd view`: frusta of photographs, and the slider over steps."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from photograd.capture import Capture
from photograd.capture.camera import Camera
from photograd.capture.frames import quaternion_from_rotation
from photograd.commands.view_drawing import Shown, Viewed
from photograd.commands.view_photographs import Photographs

FRUSTUM = 0.05
"""Size of a camera, in diagonals of the scene."""
ALONE = 0.03
"""The same where nothing is drawn: then the scene is as large as the path of the cameras."""
NEAR = 0.4
"""In diagonals of the scene: a photograph that is nearer to the eye would cover what is drawn."""
GRAY = (150, 150, 150)
MOST_PHOTOGRAPHS = 100
THUMBNAIL = 96
MOST_POINTS = 200_000
POINT = 0.002
"""Size of a point, in diagonals of the scene."""
CLICK_SECONDS = 0.5
"""A click on a frustum is none on the picture behind it, which hears of it as well."""


class Frusta:
    """Photographs as pyramids in space; a click on one looks through it."""

    def __init__(
        self,
        server: Any,
        photographs: Photographs,
        points: Capture | None,
        look_through: Callable[[Any, Camera], None],
    ) -> None:
        """Add at most a hundred photographs, evenly chosen.

        Args:
            server: of viser.
            photographs: in the frame of the page.
            points: capture whose points are shown as well, or None.
            look_through: takes a client to a camera.
        """
        self._photographs, self._visible, self._clicked = photographs, True, -math.inf
        self._handles: dict[str, Any] = {}
        self._hidden: frozenset[str] = frozenset()
        views = photographs.views
        for view in views[:: -(-len(views) // MOST_PHOTOGRAPHS)]:
            camera = view.camera
            thumbnail = np.floor(255.0 * view.thumbnail(THUMBNAIL) + 0.5).astype(np.uint8)
            handle = server.scene.add_camera_frustum(
                f"/photographs/{view.name}",
                fov=2 * math.atan(0.5 * camera.height / camera.fy),
                aspect=camera.width / camera.height,
                scale=(FRUSTUM if points is None else ALONE) * photographs.reach,
                image=thumbnail,
                color=GRAY,
                thickness=1.0,
                thickness_units="screen",
                wxyz=quaternion_from_rotation(camera.world_from_camera[:3, :3]),
                position=camera.position,
            )
            self._handles[view.name] = handle

            @handle.on_click  # type: ignore[untyped-decorator]
            def _(event: Any, camera: Camera = camera) -> None:
                self._clicked = time.monotonic()
                look_through(event.client, camera)

        if points is not None and points.points is not None:
            _add_points(server.scene, points, POINT * photographs.reach)

    def just_clicked(self) -> bool:
        """Whether a frustum was clicked on a moment ago."""
        return time.monotonic() - self._clicked < CLICK_SECONDS

    def show(self, *, visible: bool) -> None:
        """Show or hide all of them.

        Args:
            visible: whether they are shown.
        """
        self._visible = visible
        for name, handle in self._handles.items():
            handle.visible = visible and name not in self._hidden

    def hide_at(self, camera: Camera) -> None:
        """Hide those that are close to the eye, and the one that it looks through.

        Args:
            camera: of the page.
        """
        hidden = frozenset(self._photographs.near(camera, NEAR))
        for name in hidden ^ self._hidden:
            if name in self._handles:
                self._handles[name].visible = self._visible and name not in hidden
        self._hidden = hidden


def _add_points(scene: Any, capture: Capture, size: float) -> None:
    """The capture's points as a cloud."""
    assert capture.points is not None
    some = slice(None, None, -(-len(capture.points) // MOST_POINTS))
    colors = capture.point_colors
    gray = np.full((len(capture.points), 3), 128, np.uint8)
    scene.add_point_cloud(
        "/points",
        capture.points[some].astype(np.float32),
        (gray if colors is None else colors)[some],
        point_size=size,
    )


class StepSlider:
    """A slider over the steps of a fit; at its end it stays with the newest."""

    def __init__(self, gui: Any, show: Callable[[Shown], None]) -> None:
        """Begin without a slider.

        Args:
            gui: of viser's server.
            show: takes what is shown at the step that is chosen.
        """
        self._gui, self._show = gui, show
        self._folder: Any = None
        self._steps: list[int] = []
        self._shown: Mapping[int, Shown] = {}
        self._last: Shown | None = None
        self._at: int | None = None

    def replace(self, steps: Mapping[int, Shown], last: Shown) -> None:
        """Take newer steps; one that is looked at stays, if it is not the end.

        Args:
            steps: {step: what is shown}.
            last: the newest.
        """
        self._shown, self._last = steps, last
        if self._at is not None and self._at not in steps:
            self._at = None
        self._show(last if self._at is None else steps[self._at])
        if sorted(steps) == self._steps:
            return
        self._steps = sorted(steps)
        if self._folder is not None:
            self._folder.remove()
            self._folder = None
        if len(self._steps) > 1:
            self._add()

    def _add(self) -> None:
        end = len(self._steps) - 1
        first = end if self._at is None else self._steps.index(self._at)
        self._folder = self._gui.add_folder("Fit")
        with self._folder:
            slider = self._gui.add_slider("Step", min=0, max=end, step=1, initial_value=first)
            label = self._gui.add_markdown(f"step {self._steps[first]} of the fit")

        @slider.on_update  # type: ignore[untyped-decorator]
        def _(_: Any) -> None:
            number = int(slider.value)
            step = self._steps[number]
            label.content = f"step {step} of the fit"
            self._at = None if number == end else step
            assert self._last is not None
            self._show(self._last if self._at is None else self._shown[step])


def absent_gradient(viewed: Viewed, compared: bool) -> str:
    """Why there is no layer of gradients, in a sentence; empty if there is one.

    Args:
        viewed: what is drawn.
        compared: whether there are photographs.
    """
    if viewed.last.field is None:
        return (
            "No gradients: they are those of a fit. `photograd trace --derivative` draws how a "
            "scene's picture changes with a parameter."
        )
    if not compared:
        return "No gradients: they need photographs; name them with `--capture`."
    return ""
