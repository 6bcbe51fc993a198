"""The light around a glossy ball, from pictures of the ball alone.

The truth is DATA/envmaps/blender_studio.exr, reduced; what stands behind the ball is cut out.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.images.exr import read_exr
from photograd.lights import EnvironmentMap
from photograd.transport import (
    InverseRendering,
    Material,
    Parameter,
    PathOptions,
    PathTracer,
    RecoveryOptions,
    RecoveryResult,
    Scene,
    SphereShape,
    Target,
    scene_with,
)
from photograd.transport.builtin import camera_at, map_directions
from photograd.transport.inverse.pictures import display
from photograd_course.viz import style

Array = NDArray[Any]
ROWS, SIZE, TARGET_SPP = 16, 64, 256
ROUGHNESS, DISTANCE = 0.25, 5.0
PATH = PathOptions(max_depth=2)
OPTIONS = RecoveryOptions(
    steps=200, spp=8, learning_rate=0.25, views=1, resample_every=30, path=PATH
)
START, TURN = 0.4, 56.25  # radiance; degrees by which the studio is turned
BANDS = ((0, 20), (20, 45), (45, 90), (90, 180))
"""Degrees from the direction in which the first camera looks: 0 lies straight behind the ball."""
IMAGE = "recover_environment.png"
TEXELS = "lights.0.texels"


def studio(data: Path, rows: int = ROWS) -> Array:
    """The studio's radiance (rows, 2 rows, 3) float32: means of texels, a light behind the ball."""
    image = read_exr(data / "envmaps" / "blender_studio.exr")[..., :3]
    height = image.shape[0] // rows
    split = image.reshape(rows, height, 2 * rows, height, 3)
    turned = np.roll(split.mean(axis=(1, 3)), -round(TURN / 360 * 2 * rows), axis=1)
    return np.ascontiguousarray(turned, np.float32)


def cameras(count: int, size: int = SIZE) -> list[Camera]:
    """Around the ball at its height, the first from +Z."""
    turns = 2 * np.pi * np.arange(count) / count
    view = 2 * np.degrees(np.arcsin(1 / DISTANCE)) + 1.0
    return [
        camera_at([DISTANCE * np.sin(t), 0.0, DISTANCE * np.cos(t)], [0, 0, 0], view, size, size)
        for t in turns
    ]


def ball_under(texels: Array, size: int = SIZE) -> Scene:
    """A ball of rough silver, and nothing else, under a map."""
    ball = SphereShape("ball", np.zeros(3), 1.0, "silver")
    silver = Material("ggx_metal", {"f0": [0.95, 0.93, 0.88], "roughness": ROUGHNESS})
    light = EnvironmentMap(np.asarray(texels, np.float32), uniform_share=0.3)
    return Scene("ball", (ball,), {"silver": silver}, cameras(1, size)[0], lights=(light,))


def shows_ball(camera: Camera) -> Array:
    """1 where a pixel shows nothing but the ball, (H, W): the sky behind it is not to be seen."""
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    off = np.hypot((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy)
    rim = np.tan(np.arcsin(1 / DISTANCE)) - 1.0 / camera.fx
    return np.asarray(off < rim, np.float64)


def targets_of(scene: Scene, views: list[Camera], spp: int) -> list[Target]:
    """Pictures of the ball."""
    tracer = PathTracer(scene)
    return [
        Target(
            tracer.render(spp=spp, seed=200 + k, options=PATH, camera=view).mean,
            view,
            shows_ball(view),
        )
        for k, view in enumerate(views)
    ]


def search(
    truth: Array, count: int, options: RecoveryOptions, size: int, spp: int
) -> InverseRendering:
    """From an even gray sky."""
    scene = ball_under(truth, size)
    targets = targets_of(scene, cameras(count, size), spp)
    gray = scene_with(scene, {TEXELS: np.full_like(truth, START)})
    return InverseRendering(gray, targets, [Parameter(TEXELS)], options)


def first_gradient(job: InverseRendering) -> Array:
    """First dL/dtexel (H, W) of squared radiance, summed over channels, by solid angle.

    The loss of the search counts lights relatively, and their wishes would hardly be seen.
    """
    squares = replace(job.options, loss="squared")
    begin = InverseRendering(job.scene, job.targets, [Parameter(TEXELS)], squares)
    gradient = begin.loss_and_gradients(0)[1][TEXELS].sum(axis=2)
    return np.asarray(gradient / solid_angle(len(gradient)))


def sensitivity(job: InverseRendering, spp: int = 64) -> Array:
    """d(sum of all pixels that count)/dtexel, summed over channels, by solid angle, (H, W)."""
    tracer = job.tracer()
    total = np.zeros(job.x[TEXELS].shape[:2])
    for target in job.targets:
        found = tracer.render_backward(
            np.asarray(target.weight), spp=spp, seed=9, options=PATH, camera=target.camera
        )
        total += found[TEXELS].sum(axis=2)
    return np.asarray(total / solid_angle(len(total)))


def solid_angle(rows: int) -> Array:
    """Of the texels of each row, (rows, 1), steradians."""
    edges = np.cos(np.linspace(0, np.pi, rows + 1))
    return np.asarray((edges[:-1] - edges[1:])[:, None] * np.pi / rows)


def bands(rows: int) -> list[NDArray[np.bool_]]:
    """Which texels (rows, 2 rows) lie in each of `BANDS`."""
    angle = np.degrees(np.arccos(np.clip(-map_directions(rows)[..., 2], -1, 1)))
    return [np.asarray((angle >= lo) & (angle < hi)) for lo, hi in BANDS]


def errors(found: Array, truth: Array) -> list[float]:
    """Root mean square error over solid angle, in each band and over all."""
    weight = np.broadcast_to(solid_angle(len(truth)), truth.shape[:2])[..., None]
    everywhere = np.ones(truth.shape[:2], bool)
    return [
        float(np.sqrt((weight * np.square(found - truth))[band].sum() / (3 * weight[band].sum())))
        for band in (*bands(len(truth)), everywhere)
    ]


def measure(data: Path) -> tuple[list[str], Figure]:
    """Lines of the page, and the figure."""
    truth = studio(data)
    results: dict[int, RecoveryResult] = {}
    jobs: dict[int, InverseRendering] = {}
    words = [f"{lo}° to {hi}°" for lo, hi in BANDS]
    lines = [
        f"A map of {2 * ROWS} x {ROWS} texels from pictures of {SIZE} x {SIZE} pixels of a ball of "
        f"rough metal (roughness {ROUGHNESS}, known), the sky around it cut out; {OPTIONS.steps} "
        f"steps, each of one picture and twice {OPTIONS.spp} samples a pixel, from "
        f"{START} everywhere. Errors are root mean squares over solid angle, in units of "
        "radiance, at angles from what lies straight behind the ball for the first camera.",
        "",
        "| views | " + " | ".join(words) + " | all | s |",
        "|---|" + "---|" * (len(BANDS) + 2),
    ]
    for title, map_ in (("(the truth's own)", 0 * truth), ("(the start)", 0 * truth + START)):
        cells = " | ".join(f"{x:.2f}" for x in errors(map_, truth))
        lines.append(f"| {title} | {cells} | |")
    for count in (1, 3):
        jobs[count] = search(truth, count, OPTIONS, SIZE, TARGET_SPP)
        results[count] = jobs[count].run()
        found = errors(results[count].params[TEXELS], truth)
        cells = " | ".join(f"{x:.2f}" for x in found)
        lines.append(f"| {count} | {cells} | {results[count].seconds:.0f} |")
    share = sensitivity(jobs[1])
    mean = [float(share[band].mean() / share.mean()) for band in bands(ROWS)]
    lines.append(
        "| light that one view shows, by solid angle, of the mean | "
        + " | ".join(f"{x:.2f}" for x in mean)
        + " | 1 | |"
    )
    return lines, environment_figure(truth, jobs[1], first_gradient(jobs[1]), results)


def environment_figure(
    truth: Array, job: InverseRendering, first: Array, results: dict[int, RecoveryResult]
) -> Figure:
    """The ball and the maps."""
    wide, gap, left = 2.9, 0.15, 0.15
    side = wide / 2
    found = PathTracer(results[1].scene).render(spp=128, seed=5, options=PATH).mean
    mask = np.asarray(job.targets[0].weight)
    balls = (("one picture", job.targets[0].image), ("found, drawn", found))
    limit = float(np.quantile(np.abs(first), 0.95))
    signed = {"norm": style.symmetric_scale(limit), "cmap": style.signed_color_map()}
    maps: tuple[tuple[str, Array, dict[str, Any]], ...] = (
        ("truth", display(truth), {}),
        ("first dL/dtexel, by solid angle", first, signed),
        ("found from 1 picture", display(results[1].params[TEXELS]), {}),
        ("found from 3 pictures", display(results[3].params[TEXELS]), {}),
    )
    with style.house_style():
        figure = style.new_figure(side + 2 * wide + 2 * gap + 2 * left, 4.75)
        for k, (title, image) in enumerate(balls):
            axes = style.place_axes(figure, left, 0.35 + k * (side + 0.35), side, side)
            axes.imshow(display(np.where(mask > 0, image, 1.0)))
            axes.set_title(title)
            axes.axis("off")
        for k, (title, image, options) in enumerate(maps):
            x = left + side + gap + (k % 2) * (wide + gap)
            axes = style.place_axes(figure, x, 0.35 + (k // 2) * (side + 0.35), wide, side)
            axes.imshow(image, **options)
            axes.set_title(title)
            axes.axis("off")
        style.write_caption(
            figure,
            "A studio, out of its reflections in a ball of rough metal. The middle of a map lies "
            "behind the camera, its left and right edges behind the ball. The derivative before "
            "the first step asks for light (blue) where the lights are and for less (red) where it "
            "is dark. It is silent at the edges: one picture says nothing of the light straight "
            "behind the ball, and the map found from it does not have it. Two more pictures do.",
            left=left,
            right=left,
        )
    return figure
