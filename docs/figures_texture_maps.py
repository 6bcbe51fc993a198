"""What textures hold besides colors: `python docs/figures_texture_maps.py`.

Writes docs/images/texture_maps.png: ambient occlusion baked into the walls of a room beside the
same traced to the camera, and a checkerboard looked up with and without mip maps.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.transport import (
    Accumulation,
    Environment,
    Material,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    Texture,
    TextureUse,
    bake_ambient_occlusion,
    builtin_scene,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, TEXELS, SPP, RADIUS = 160, 160, 256, 2.0
"""Of the picture, of each map; rays a texel and a pixel; meters within which a surface occludes."""
HORIZON, NO_MAP = 0.31, "#9fb4d0"
"""Part of the checkerboard's picture that is sky, and not drawn; color of shapes without a map."""


def baked_room(scene: Scene, texels: int, spp: int) -> tuple[Scene, dict[str, Texture]]:
    """The scene shining by the maps of all its shapes that have coordinates; and the maps."""
    maps: dict[str, Texture] = {}
    shapes = []
    for shape in scene.shapes:
        if isinstance(shape, MeshShape) and shape.uv is not None and not shape.emission.any():
            baked = bake_ambient_occlusion(
                scene, shape.name, texels, radius=RADIUS, spp=spp, seed=1
            )
            maps[shape.name] = replace(baked, values=np.repeat(baked.values, 3, axis=2))
            shapes.append(
                replace(shape, emission=np.ones(3), emission_texture=TextureUse(shape.name))
            )
        else:
            shapes.append(replace(shape, emission=np.zeros(3)))
    textures = {**scene.textures, **maps}
    return replace(scene, shapes=tuple(shapes), textures=textures), maps


def occlusion_pictures(size: int, texels: int, spp: int) -> tuple[Array, Array, Array, Array]:
    """The floor's map (H, W), the room by its maps, and traced (size, size); which pixels show
    nothing but what has a map.
    """
    scene = builtin_scene("cornell-box", size)
    glowing, maps = baked_room(scene, texels, spp)
    looked_up = PathTracer(glowing).render(spp=spp, seed=2, options=PathOptions(max_depth=1)).mean
    white = {name: replace(t, values=np.ones((1, 1, 3))) for name, t in maps.items()}
    bright = PathTracer(replace(glowing, textures=white))
    whole = bright.render(spp=spp, seed=2, options=PathOptions(max_depth=1)).mean[..., 0]
    sums = Accumulation.empty(size, size)
    PathTracer(scene).add_occlusion(sums, spp, seed=3, radius=RADIUS)
    floor = maps["floor"].values[..., 0]
    return floor, looked_up[..., 0], sums.mean[..., 0], whole > 1 - 1e-6


def checkerboard(filter: str, size: int) -> Scene:
    """A floor of 64 x 64 squares, 8 x 8 texels each, under an even sky, out to the horizon."""
    squares = np.kron(np.indices((64, 64)).sum(axis=0) % 2, np.ones((8, 8)))
    values = 0.1 + 0.8 * np.repeat(squares[..., None], 3, axis=2)
    paint = Material("lambert", {"albedo": [1.0] * 3}, {"albedo": TextureUse("squares")})
    floor = rectangle("floor", [-32, 0, 4], [64, 0, 0], [0, 0, -64], "paint")
    camera = camera_at([0.0, 1.5, 3.0], [0.0, 0.0, -6.0], 40.0, size, size)
    textures = {"squares": Texture(values, ("clamp", "clamp"), filter)}
    sky = Environment.constant(1.0)
    return Scene("floor", (floor,), {"paint": paint}, camera, sky, textures=textures)


def floor_pictures(size: int, spp: int) -> tuple[Array, Array, Array]:
    """The floor with one sample a pixel, bilinear and by mip maps, and bilinear with `spp`."""
    options = PathOptions("bsdf")
    one, filtered = (
        PathTracer(checkerboard(name, size)).render(spp=1, seed=4, options=options).mean[..., 0]
        for name in ("bilinear", "mip")
    )
    truth = PathTracer(checkerboard("bilinear", size)).render(spp=spp, seed=5, options=options)
    return one, filtered, truth.mean[..., 0]


def texture_maps_figure() -> Figure:
    """Two rows of pictures."""
    floor, looked_up, traced, mapped = occlusion_pictures(SIZE, TEXELS, SPP)
    below = slice(round(HORIZON * SIZE), None)
    one, filtered, truth = (image[below] for image in floor_pictures(SIZE, 256))
    shown = np.ma.masked_where(~mapped, looked_up)
    rows = (
        (("AO map of the floor", floor), ("room from AO maps", shown), ("traced AO", traced)),
        (("bilinear, 1 spp", one), ("mip maps, 1 spp", filtered), ("bilinear, 256 spp", truth)),
    )
    side, gap, left, top = 2.0, 0.15, 0.15, 0.3
    colors = colormaps["gray"].with_extremes(bad=NO_MAP)
    with style.house_style():
        low = side * (1 - HORIZON)
        figure = style.new_figure(3 * side + 2 * gap + 2 * left, side + low + 2 * top + 0.95)
        for line, row in enumerate(rows):
            for column, (title, image) in enumerate(row):
                x, y = left + column * (side + gap), top + line * (side + top)
                axes = style.place_axes(figure, x, y, side, low if line else side)
                axes.imshow(image, cmap=colors, vmin=0, vmax=1, interpolation="nearest")
                axes.set_title(title)
                axes.axis("off")
        style.write_caption(
            figure,
            "Above: ambient occlusion within two meters, baked into textures of the walls, and "
            "traced with 256 rays per pixel. The boxes and the light, in blue, have no texture. "
            "Below: a checkerboard out to the horizon. With mip mapping, one sample per pixel "
            "matches 256 far away, and over-blurs slightly at middle distance.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(texture_maps_figure(), IMAGES / "texture_maps.png")


if __name__ == "__main__":
    main()
