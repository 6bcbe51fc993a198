"""The picture of textured scenes: `python docs/figures_meshes.py` writes docs/images/meshes.png.

A textured floor under a ball of metal, through a pinhole and through a thin lens; the derivative
with respect to each texel; and the texture recovered from one picture.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.transport import (
    Environment,
    Lens,
    Material,
    PathTracer,
    Scene,
    SphereShape,
    Texture,
    TextureUse,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle
from photograd_course.color import srgb_encode
from photograd_course.optim import Adam
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
TEXELS, SIZE, SPP, STEPS, STEP_SPP = 32, 256, 96, 100, 6


def paint() -> Array:
    """Colored tiles with a ring on them, (TEXELS, TEXELS, 3), linear."""
    row, column = np.mgrid[0:TEXELS, 0:TEXELS] / TEXELS
    tiles = (np.floor(4 * row) + np.floor(4 * column)) % 2
    color = np.where(tiles[..., None] > 0, [0.75, 0.65, 0.45], [0.12, 0.25, 0.35])
    ring = np.abs(np.hypot(row - 0.5, column - 0.5) - 0.36) < 0.05
    color[ring] = [0.7, 0.08, 0.06]
    return color


def scene(size: int, texels: Array) -> Scene:
    """The floor, the ball on it, a light and a dim sky."""
    floor = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("floor")})
    metal = Material("ggx_metal", {"f0": [0.95, 0.9, 0.85], "roughness": 0.15})
    black = Material("lambert", {"albedo": [0.0] * 3})
    shapes = (
        rectangle("floor", [-1, 0, 1], [2, 0, 0], [0, 0, -2], "floor"),
        SphereShape("ball", np.array([0.0, 0.45, 0.0]), 0.45, "metal"),
        rectangle("lamp", [-0.5, 2.4, -0.5], [1, 0, 0], [0, 0, 1], "black", [5.0, 4.8, 4.5]),
    )
    camera = camera_at([0.0, 1.9, 3.2], [0.0, 0.2, 0.0], 36.0, size, size)
    materials = {"floor": floor, "metal": metal, "black": black}
    sky = Environment.constant(0.35)
    return Scene("floor", shapes, materials, camera, sky, textures={"floor": Texture(texels)})


def found_again(truth: Array) -> Array:
    """The texture after STEPS steps of Adam, from gray, to match one picture."""
    photograph = PathTracer(scene(64, truth)).render(spp=SPP, seed=1).mean
    tracer = PathTracer(scene(64, np.full_like(truth, 0.4)))
    texels = tracer.params["textures.floor"]
    adam = Adam()
    for step in range(STEPS):
        d = tracer.render(spp=STEP_SPP, seed=10 + step).mean - photograph
        slope = tracer.render_backward(d, spp=STEP_SPP, seed=10_000 + step)
        rate = 0.06 / (1 + step / 30)
        adam.step({"t": texels}, {"t": slope["textures.floor"]}, {"t": rate})
        texels.clip(0, 1, out=texels)
    return texels


def mesh_figure() -> Figure:
    """Pinhole, thin lens, derivative with respect to texels, recovered texels."""
    truth = paint()
    tracer = PathTracer(scene(SIZE, truth))
    whole = tracer.render(spp=SPP, seed=1).mean
    lens = Lens(0.12, 2.6)
    blurred = PathTracer(replace(tracer.scene, lens=lens)).render(spp=SPP, seed=1).mean
    weight = tracer.render_backward(np.ones_like(whole), spp=32, seed=2)["textures.floor"]
    panels = (
        ("pinhole camera", srgb_encode(np.clip(whole, 0, 1))),
        ("thin lens, focus in front", srgb_encode(np.clip(blurred, 0, 1))),
        ("d picture / d texel", weight.sum(axis=2)),
        (f"recovered in {STEPS} steps", srgb_encode(np.clip(found_again(truth), 0, 1))),
    )
    side, gap, left = 2.0, 0.15, 0.15
    with style.house_style():
        figure = style.new_figure(4 * side + 3 * gap + 2 * left, 3.2)
        for column, (title, image) in enumerate(panels):
            axes = style.place_axes(figure, left + column * (side + gap), 0.35, side, side)
            axes.imshow(image, cmap="viridis" if image.ndim == 2 else None)
            axes.set_title(title)
            axes.axis("off")
        style.write_caption(
            figure,
            "A textured floor and a ball of rough metal. Third: the derivative of the sum of all "
            "pixels with respect to each texel of the floor, near the camera below: yellow is "
            "large, and dark texels, behind the ball, have nearly none. Right: the texture "
            "recovered from one picture of 64 x 64 pixels; texels without a derivative keep noise.",
            left=left,
            right=left,
        )
    return figure


if __name__ == "__main__":
    save_figure(mesh_figure(), IMAGES / "meshes.png")
