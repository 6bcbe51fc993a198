"""What `photograd view` shows while a camera moves: something coarse at once, then the rest.

A drawing is a generator of pictures, each better than the one before. It yields None where it can
be left for a newer camera, so that dragging never waits for a whole picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from dataclasses import field as dataclass_field
from pathlib import Path

import numpy as np
from photograd_course.color import srgb_encode
from photograd_course.metrics import round_to_8_bits

from photograd.capture.camera import Camera
from photograd.commands.render_subjects import AUTO, subject_of
from photograd.commands.trace import load_scene
from photograd.fitting.drawing import Picture, draw_field
from photograd.fitting.model import load_snapshots
from photograd.representation import Fittable
from photograd.transport.accumulation import Accumulation
from photograd.transport.path_options import PathOptions
from photograd.transport.tracer import PathTracer
from photograd.types import Array, FloatArray

COARSE = 4
"""Along each edge the first picture has so many times fewer pixels."""
STRIP = 1 << 15
"""Pixels that are drawn before a newer camera is looked for."""
COARSE_SPP = 4
SCENE_SIZE = 512
"""Pixels along the edge of a built-in scene's camera, of which its angle of view remains."""
LAYERS = ("color", "depth", "opacity")
Drawing = Callable[[Camera], Iterator[Picture | None]]


@dataclass(frozen=True, eq=False)
class Shown:
    """What is drawn, differentiated and picked at one step of a fit.

    Attributes:
        draw: pictures of it, from coarse to fine.
        field: makes the representation that is drawn; None of scenes.
        background: linear (3,) behind it, or None.
        field_from_page: (3, 3) rotation from the frame of the page to that of the field.
    """

    draw: Drawing
    field: Callable[[], Fittable] | None = None
    background: Array | None = None
    field_from_page: FloatArray = dataclass_field(default_factory=lambda: np.eye(3))

    def camera(self, camera: Camera) -> Camera:
        """A camera of the page in the frame of the field.

        Args:
            camera: in the frame of the page.
        """
        pose = camera.world_from_camera.copy()
        pose[:3] = self.field_from_page @ pose[:3]
        return replace(camera, world_from_camera=pose)


@dataclass(frozen=True, eq=False)
class Viewed:
    """Something to be looked at from anywhere, in a frame with +Y up.

    Attributes:
        box: (2, 3) around it.
        last: what is shown to begin with, the last step of a fit.
        layers: of `LAYERS`, what there is to see.
        capture: folder of the photographs that it was fitted to, if it says so.
        from_capture: as of `Subject`.
        start: a camera to begin with; None looks at the box from in front.
        steps: {step: the same after that step of its fit}.
        tracer: of a scene, whose parameters sliders change; else None.
    """

    box: Array
    last: Shown
    layers: tuple[str, ...] = LAYERS
    capture: str | None = None
    from_capture: Callable[[Camera, FloatArray], Camera] = lambda camera, _: camera
    start: Camera | None = None
    steps: Mapping[int, Shown] = dataclass_field(default_factory=dict)
    tracer: PathTracer | None = None

    @property
    def draw(self) -> Drawing:
        """Pictures of the last step."""
        return self.last.draw


def viewed_file(path: Path, up: str = AUTO) -> Viewed:
    """A model with the steps of its fit, a volume, or Gaussians.

    Args:
        path: of the file, or the folder of a fit.
        up: of a file of Gaussians.

    Raises:
        IoError, RangeError: what its reader raises.
    """
    volume = {"ramp": "white", "sigma_t": None, "resolution": 128, "window": None}
    found = subject_of(path, up, volume)
    fields = load_snapshots(path) if path.is_dir() else {}
    last = Shown(refined(found.draw), found.field, found.background, found.field_from_upright)
    return Viewed(
        found.box,
        last,
        capture=found.capture,
        from_capture=found.from_capture,
        steps={step: shown_field(each, found.background) for step, each in fields.items()},
    )


def shown_field(field: Fittable, background: Array | None) -> Shown:
    """A field, to be drawn.

    Args:
        field: of a model, or of a step of its fit.
        background: linear (3,) behind it, or None for white.
    """
    draw = refined(lambda camera: draw_field(field, background, camera))
    return Shown(draw, lambda: field, background)


def viewed_scene(name: str, *, spp: int, max_depth: int) -> Viewed:
    """A path traced scene, from its own camera to begin with.

    Args:
        name: of a scene or mesh file, or a built-in scene.
        spp: samples a pixel of the last picture.
        max_depth: segments of the longest path.

    Raises:
        IoError, SceneError: what its reader raises.
    """
    scene, _ = load_scene(name, SCENE_SIZE)
    tracer = PathTracer(scene, allow_incomplete=True)
    corners = np.concatenate([shape.box for shape in scene.shapes])
    return Viewed(
        np.stack([corners.min(axis=0), corners.max(axis=0)]),
        Shown(traced(tracer, spp=spp, options=PathOptions(max_depth=max_depth))),
        ("color",),
        start=scene.camera,
        tracer=tracer,
    )


def refined(draw: Callable[[Camera], Picture]) -> Drawing:
    """A drawing of something without noise: a quarter of the resolution, then all of it.

    Args:
        draw: what a camera sees.
    """

    def pictures(camera: Camera) -> Iterator[Picture | None]:
        yield draw(reduced(camera, COARSE))
        parts = []
        for strip in strips(camera):
            yield None
            parts.append(draw(strip))
        joined = {name: [getattr(part, name) for part in parts] for name in LAYERS}
        yield Picture(**{name: np.concatenate(each) for name, each in joined.items()})

    return pictures


def traced(tracer: PathTracer, *, spp: int, options: PathOptions) -> Drawing:
    """A drawing of a path traced scene: coarse, then 1, 2, 4 and more samples of every pixel.

    Args:
        tracer: of the scene.
        spp: samples a pixel of the last picture.
        options: of the path tracer.
    """

    def pictures(camera: Camera) -> Iterator[Picture | None]:
        yield sampled(reduced(camera, COARSE), COARSE_SPP)
        sums = Accumulation.empty(camera.height, camera.width)
        for count in range(1, spp + 1):
            yield None
            tracer.add_samples(sums, 1, seed=0, options=options, camera=camera)
            if count == spp or count & (count - 1) == 0:
                yield shown(sums)

    def sampled(camera: Camera, count: int) -> Picture:
        return shown(tracer.render(spp=count, seed=0, options=options, camera=camera))

    def shown(sums: Accumulation) -> Picture:
        color = round_to_8_bits(srgb_encode(np.clip(sums.mean, 0.0, 1.0)))
        return Picture(color, np.ones(color.shape[:2]), np.full(color.shape[:2], np.nan))

    return pictures


def reduced(camera: Camera, factor: int) -> Camera:
    """The camera with so many times fewer pixels along each edge, at least one.

    Args:
        camera: of the whole picture.
        factor: at least 1.
    """
    size = max(camera.height // factor, 1), max(camera.width // factor, 1)
    return resized(camera, size)


def resized(camera: Camera, size: tuple[int, ...]) -> Camera:
    """The camera with a picture of another size and the same edges.

    Args:
        camera: of a picture.
        size: (height, width) in pixels.
    """
    height, width = size
    across, down = width / camera.width, height / camera.height
    return replace(
        camera,
        width=width,
        height=height,
        fx=camera.fx * across,
        fy=camera.fy * down,
        cx=camera.cx * across,
        cy=camera.cy * down,
    )


def strips(camera: Camera) -> list[Camera]:
    """Cameras of some rows each, from above, that make up the picture.

    Args:
        camera: of the whole picture.
    """
    rows = max(STRIP // camera.width, 1)
    starts = range(0, camera.height, rows)
    return [
        replace(camera, height=min(rows, camera.height - start), cy=camera.cy - start)
        for start in starts
    ]
