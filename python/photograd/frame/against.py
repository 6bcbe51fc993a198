"""A frame beside the path traced truth: for each technique, the light that it claims to reproduce.

    direct light    that surfaces send on once, without the sky: paths of two segments
    sky light       that surfaces send on once, of the sky alone: paths of two segments
    all light       paths of as many segments as are asked for; no pass makes what is sent on twice

Pictures are compared as they are displayed: tone mapped or exposed, clipped to [0, 1] and encoded.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from photograd_course.color import srgb_encode

from photograd.capture.camera import Camera
from photograd.frame._post_passes import show
from photograd.frame.light_views import infinite_lights
from photograd.frame.options import FrameOptions
from photograd.frame.pipeline import frame_graph
from photograd.frame.scene import FrameScene
from photograd.transport.path_options import PathOptions
from photograd.transport.scene import Scene
from photograd.transport.tracer import PathTracer
from photograd.types import Array


@dataclass(frozen=True, eq=False)
class Comparison:
    """One technique, and the light that it stands for.

    Attributes:
        technique: its name.
        frame, truth: (H, W, 3), as displayed, 0 to 1.
        milliseconds: of the frame.
        noise: of the truth, its relative standard error.
    """

    technique: str
    frame: Array
    truth: Array
    milliseconds: float
    noise: float

    @property
    def rms(self) -> float:
        """Root of the mean squared difference of the displayed colors."""
        difference = np.asarray(self.frame, np.float64) - self.truth
        return float(np.sqrt(np.mean(difference * difference)))


def compare_with_paths(
    scene: Scene,
    options: FrameOptions,
    *,
    spp: int,
    seed: int = 0,
    max_depth: int = 64,
    camera: Camera | None = None,
    report: Callable[[str], None] | None = None,
) -> list[Comparison]:
    """Draw frames of a scene's kinds of light, and path trace the same.

    Args:
        scene: whose light is compared.
        options: of the frames.
        spp: samples a pixel of the truth.
        seed: of the truth.
        max_depth: segments of the paths of all light.
        camera: None takes the scene's.
        report: is called with the name of each technique before its turn.

    Returns:
        A comparison for each kind of light that the scene has; with two kinds, or paths of more
        than two segments, one of all light, last. In a scene with surfaces that cover in part, of
        all light alone: paths count what they cross as segments.

    Raises:
        SceneError: what `FrameScene` cannot draw.
        RangeError: spp below 1.
    """
    view = scene.camera if camera is None else camera
    found = []
    for technique, lit, depth in kinds_of_light(scene, max_depth):
        if report is not None:
            report(technique)
        graph = frame_graph(FrameScene(lit), options_for(options, depth))
        frame = graph.run({"camera": view}, ["radiance"])
        sums = PathTracer(lit, allow_incomplete=True).render(
            spp=spp, seed=seed, options=PathOptions(max_depth=depth), camera=view
        )
        noise = sums.noise if spp > 1 else float("nan")
        shown = [displayed(each, options) for each in (frame["radiance"], sums.mean)]
        spent = sum(frame.milliseconds.values())
        found.append(Comparison(technique, shown[0], shown[1], spent, noise))
    return found


def kinds_of_light(scene: Scene, max_depth: int) -> list[tuple[str, Scene, int]]:
    """(name, the scene with this light alone, segments of the paths), as for a comparison.

    Args:
        scene: whose light is compared.
        max_depth: segments of the paths of all light.
    """
    sky = tuple(infinite_lights(scene).values())
    nearby = tuple(light for light in scene.lights if light not in sky)
    black = tuple(replace(shape, emission=np.zeros(3)) for shape in scene.shapes)
    found = []
    if any(material.has_opacity for material in scene.materials.values()):
        return [("all light", scene, max_depth)]  # segments also count what is crossed
    if nearby or any(shape.emission.any() for shape in scene.shapes):
        found.append(("direct light", replace(scene, environment=None, lights=nearby), 2))
    if sky:
        found.append(("sky light", replace(scene, shapes=black, environment=None, lights=sky), 2))
    if len(found) > 1 or max_depth > 2:
        found.append(("all light", scene, max_depth))
    return found


def options_for(options: FrameOptions, max_depth: int) -> FrameOptions:
    """Options of a frame that is compared with paths of so many segments.

    Args:
        options: of the frame; with two segments, it gathers no light that was sent on before.
        max_depth: segments of the paths.
    """
    return replace(options, gather_frame=options.gather_frame and max_depth > 2)


def displayed(radiance: Array, options: FrameOptions) -> Array:
    """Radiance (H, W, 3) as a display shows it, encoded, 0 to 1.

    Args:
        radiance: of at least 0.
        options: of which exposure and tone curve count.
    """
    return srgb_encode(np.clip(show(radiance, options), 0.0, 1.0))
