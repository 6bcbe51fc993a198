"""Three wall colors from one picture of a room.

Also what the known mistake does: the same search with the paths of the picture in its derivative.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.transport import (
    Accumulation,
    InverseRendering,
    Material,
    Parameter,
    PathOptions,
    PathTracer,
    RecoveryOptions,
    RecoveryResult,
    Scene,
    builtin_scene,
    recover,
    scene_with,
)
from photograd.transport.inverse.loss import Target, loss_weights
from photograd.transport.inverse.pictures import display, draw_loss, draw_values
from photograd_course.viz import style

Array = NDArray[Any]
WALLS = {"left wall": "red", "right wall": "green", "floor": "floor"}
SIZE, TARGET_SPP, STEP = 64, 512, 0.02
PATH = PathOptions(max_depth=12)
OPTIONS = RecoveryOptions(steps=150, spp=4, path=PATH)
NOISY = replace(OPTIONS, spp=1)
IMAGE = "recover_walls.png"


class EqualSeeds(InverseRendering):
    """The known mistake: both halves are one picture, and the derivative has its paths."""

    def seeds(self, step: int, view: int) -> tuple[int, int]:
        """One seed, twice."""
        one, _ = super().seeds(step, view)
        return one, one


def room(size: int) -> Scene:
    """The Cornell box with a floor of its own color."""
    scene = builtin_scene("cornell-box", size)
    shapes = tuple(
        replace(shape, material="floor") if shape.name == "floor" else shape
        for shape in scene.shapes
    )
    floor = Material("lambert", {"albedo": [0.55, 0.5, 0.35]})
    return replace(scene, shapes=shapes, materials={**scene.materials, "floor": floor})


def parameters() -> list[Parameter]:
    """The three colors, from gray."""
    return [Parameter(f"materials.{name}.albedo", start=0.5) for name in WALLS.values()]


def errors(scene: Scene, result: RecoveryResult) -> dict[str, float]:
    """Largest error of a channel, by wall."""
    return {
        wall: float(np.abs(result.params[f"materials.{name}.albedo"] - truth_of(scene, name)).max())
        for wall, name in WALLS.items()
    }


def truth_of(scene: Scene, name: str) -> Array:
    """The true albedo of a wall (3,)."""
    return np.asarray(scene.materials[name].values["albedo"], np.float64)


def pull_on_red(scene: Scene, target: Array, spp: int) -> tuple[Array, Array]:
    """The gray room's picture, and what each pixel adds to dL/d(red of the left wall), (H, W).

    The difference to the target comes from one seed, the derivative of the pixel (a central
    difference with paths held; albedos enter a path as factors) from another.
    """
    gray = {each.name: np.full(3, 0.5) for each in parameters()}
    tracer = PathTracer(scene_with(scene, gray))
    picture = tracer.render(spp=spp, seed=11, options=PATH).mean
    held = {name: value.copy() for name, value in tracer.params.items()}
    slope = np.zeros_like(picture)
    for sign in (-1, 1):
        step = np.array([sign * STEP, 0, 0], np.float32)
        tracer.params["materials.red.albedo"] = held["materials.red.albedo"] + step
        sums = Accumulation.empty(*picture.shape[:2])
        tracer.add_samples(sums, spp, seed=12, options=PATH, sampling_params=held)
        slope += sign * sums.mean / (2 * STEP)
    weight = loss_weights(Target(target), OPTIONS.loss)
    return picture, (2 * weight * (picture - target) * slope).sum(axis=2) / picture.size


def sees_wall(scene: Scene, x: float) -> NDArray[np.bool_]:
    """Pixels (H, W) whose middle shows the wall in the plane x, boxes left aside."""
    camera = scene.camera
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    rays = np.stack(
        [(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones_like(u)], axis=-1
    )
    rays = rays @ camera.world_from_camera[:3, :3].T
    origin = camera.world_from_camera[:3, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        hit = origin + ((x - origin[0]) / rays[..., :1]) * rays
        forward = (x - origin[0]) / rays[..., 0] > 0
    inside = (np.abs(hit[..., 1] - 1) < 1) & (np.abs(hit[..., 2]) < 1)
    return np.asarray(forward & inside)


def measure(_data: Path | None) -> tuple[list[str], Figure]:
    """Lines of the page, and the figure."""
    scene = room(SIZE)
    target = PathTracer(scene).render(spp=TARGET_SPP, seed=1, options=PATH).mean
    result = recover(scene, target, parameters(), options=OPTIONS, bar=True)
    lines = [
        f"One picture of {SIZE} x {SIZE} pixels, {OPTIONS.steps} steps of twice {OPTIONS.spp} "
        f"samples a pixel, {result.seconds:.0f} s.",
        "",
        "| wall | true albedo | found, from 0.5 | largest error |",
        "|---|---|---|---|",
    ]
    for wall, worst in errors(scene, result).items():
        name = WALLS[wall]
        albedo = result.params[f"materials.{name}.albedo"]
        cells = (", ".join(f"{x:.3f}" for x in row) for row in (truth_of(scene, name), albedo))
        lines.append(f"| {wall} | {' | '.join(cells)} | {worst:.4f} |")
    lines += [
        "",
        "With one sample instead, and with the known mistake, both halves and their derivatives "
        "from one seed, the largest errors at the end are:",
        "",
        "| seeds of the two halves | " + " | ".join(WALLS) + " |",
        "|---|" + "---|" * len(WALLS),
    ]
    for words, kind in (("independent", InverseRendering), ("equal: the mistake", EqualSeeds)):
        found = errors(scene, kind(scene, target, parameters(), NOISY).run())
        lines.append(f"| {words} | " + " | ".join(f"{x:.4f}" for x in found.values()) + " |")
    return lines, walls_figure(scene, target, result)


def walls_figure(scene: Scene, target: Array, result: RecoveryResult) -> Figure:
    """Target, start, found and the pull of each pixel; loss and values below."""
    start, pull = pull_on_red(scene, target, 256)
    found = PathTracer(result.scene).render(spp=256, seed=2, options=PATH).mean
    truth = {f"materials.{name}.albedo": truth_of(scene, name) for name in WALLS.values()}
    side, gap, left = 2.0, 0.15, 0.15
    with style.house_style():
        figure = style.new_figure(4 * side + 3 * gap + 2 * left, 5.6)
        panels = (("one picture", target), ("begin: gray walls", start), ("found", found))
        for k, (title, image) in enumerate(panels):
            axes = style.place_axes(figure, left + k * (side + gap), 0.35, side, side)
            axes.imshow(display(image))
            axes.set_title(title)
            axes.axis("off")
        axes = style.place_axes(figure, left + 3 * (side + gap), 0.35, side, side)
        limit = float(np.quantile(np.abs(pull), 0.99))
        scale, colors = style.symmetric_scale(limit), style.signed_color_map()
        axes.imshow(pull, norm=scale, cmap=colors)
        axes.set_title("the left wall's red: who asks")
        axes.axis("off")
        loss = style.place_axes(figure, 0.66, 2.85, 3.3, 1.6)
        draw_loss(loss, result.history)
        values = style.place_axes(figure, 4.76, 2.85, 3.7, 1.6)
        for k, (name, rows) in enumerate(result.curves.items()):
            draw_values(values, name, rows, ("-", "--", ":")[k], truth[name])
        values.set_title("albedos; thin lines: the truth")
        values.legend(loc="upper right", fontsize=6.0, ncols=3)
        values.set_ylim(0, 0.85)
        for axes in (loss, values):
            axes.set_xlabel("step")
        style.write_caption(
            figure,
            "Three wall colors from one picture, from gray. Right: what each pixel adds to the "
            "derivative of the loss by the red of the left wall, before the first step. Pixels of "
            "the wall itself want more of it (blue). Those of the right wall want less (red): they "
            "are too bright in red, because that wall is not green yet, and blame all who send "
            "red light there. What is said wrongly at first is taken back as other colors settle.",
            left=left,
            right=left,
        )
    return figure
