"""What happens between surfaces: `python docs/figures_media.py` writes docs/images/media.png.

Fog around posts, a cloud from a .vdb file in the sun, and wax with a light behind it; below, how
each of their pixels changes with a number of the medium. `check` asserts what the caption says.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import write_vdb
from photograd.lights import SphereLight
from photograd.transport import (
    BOUNDARY,
    Environment,
    Material,
    Medium,
    PathOptions,
    PathTracer,
    Scene,
    builtin_scene,
    derivative_image,
    read_scene,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import box, rectangle
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, SPP = 128, 256
OPTIONS = PathOptions(max_depth=40)
PARAMETERS = {"fog": "media.fog.sigma_t", "cloud": "media.cloud.sigma_t", "wax": "media.wax.albedo"}
SUN = [0.8, 0.7, 0.25]
CLOUD = """
[camera]
position = [0, 1.0, 5.2]
look_at = [0, 0.75, 0]
field_of_view = 32
size = [{size}, {size}]
[environment]
zenith = [0.15, 0.28, 0.6]
horizon = [0.5, 0.6, 0.75]
ground = 0.2
[[lights]]
kind = "directional"
direction = {sun}
irradiance = [4.2, 3.8, 3.2]
[materials.field]
model = "lambert"
albedo = [0.28, 0.34, 0.2]
[media.cloud]
sigma_t = 9
albedo = 0.995
g = 0.5
density = "cloud.vdb"
corner = [-0.9, 0.75, -0.5]
size = [1.8, 0.8, 1.0]
[[shapes]]
kind = "rectangle"
corner = [-6, 0, 4]
edge_u = [12, 0, 0]
edge_v = [0, 0, -12]
material = "field"
[[shapes]]
kind = "box"
center = [0, 1.15, 0]
size = [2.0, 1.0, 1.2]
material = "boundary"
interior = "cloud"
"""


def display(radiance: Array) -> Array:
    """Linear radiance as a screen wants it, clipped at white."""
    return srgb_encode(np.clip(radiance, 0.0, 1.0))


def fog(size: int, *, clear: bool = False) -> Scene:
    """Posts before a light that hides behind the middle one, in even fog or in clear air."""
    posts = tuple(
        box(f"post {x}", [x, 0.8, 0.0], [0.22, 1.6, 0.22], "stone")
        for x in (-1.1, -0.55, 0.0, 0.55, 1.1)
    )
    air = replace(box("air", [0, 1.3, 0], [5, 2.6, 5], BOUNDARY), interior="fog")
    shapes: tuple[Any, ...] = (
        rectangle("floor", [-4, 0, 4], [8, 0, 0], [0, 0, -8], "stone"),
        *posts,
    )
    stone = Material("lambert", {"albedo": [0.45, 0.42, 0.4]})
    lamp = SphereLight([0.0, 0.9, -0.9], 0.1, [160.0, 128.0, 86.0])
    camera = camera_at([0.0, 1.1, 4.6], [0.0, 0.8, 0.0], 38.0, size, size)
    media = {} if clear else {"fog": Medium(0.16, 0.95, values={"g": 0.4})}
    return Scene(
        "fog",
        shapes if clear else (*shapes, air),
        {"stone": stone},
        camera,
        Environment.constant([0.02, 0.03, 0.05]),
        (lamp,),
        media=media,
    )


def billows(n: int = 56) -> SparseGrid:
    """A cumulus (n, n/2, n/2): balls that have grown into one another, with a ragged edge."""
    shape = (n, n // 2, n // 2)
    x, y, z = np.meshgrid(*((np.arange(k) + 0.5) / n for k in shape), indexing="ij")
    g = np.random.default_rng(7)
    inside = np.full(shape, -1.0)
    for _ in range(26):
        cx, cz = g.uniform(0.18, 0.82), g.uniform(0.15, 0.35)
        radius = g.uniform(0.07, 0.15) * (1.2 - 1.2 * abs(cx - 0.5))
        cy = 0.11 + g.uniform(0, 1) * max(0.0, 0.24 - abs(cx - 0.45) * 0.5)
        inside = np.maximum(
            inside, 1 - np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) / radius
        )
    ragged = sum(
        np.sin(g.uniform(25, 60) * (a * x + b * y + c * z) + g.uniform(0, 7)) / 9
        for a, b, c in g.uniform(-1, 1, (9, 3))
    )
    values = np.clip(2.5 * (inside + 0.35 * ragged), 0, 1) * np.clip(14 * (y - 0.05), 0, 1)
    return SparseGrid.from_dense(values.astype(np.float32), tolerance=0.02, name="density")


def cloud(size: int) -> Scene:
    """The cumulus out of a file, over a field."""
    with TemporaryDirectory() as folder:
        write_vdb(Path(folder, "cloud.vdb"), [billows()])
        path = Path(folder, "cloud.toml")
        path.write_text(CLOUD.format(size=size, sun=SUN), encoding="utf-8")
        return read_scene(path)


def pictures(size: int = SIZE, spp: int = SPP) -> dict[str, tuple[Array, Array]]:
    """{scene: picture (H, W, 3) linear, d picture / d PARAMETERS, channels summed (H, W)}."""
    found = {}
    for scene in (fog(size), cloud(size), builtin_scene("wax", size)):
        sums, derivative = derivative_image(
            PathTracer(scene), PARAMETERS[scene.name], spp=spp, seed=1, options=OPTIONS
        )
        found[scene.name] = sums.mean, derivative.mean.sum(axis=2)
    return found


def part(image: Array, left: float, right: float, top: float, bottom: float) -> Array:
    """Rows and columns between shares of the picture, as one list of pixels."""
    h, w = image.shape[:2]
    cut = image[round(top * h) : round(bottom * h), round(left * w) : round(right * w)]
    return cut.reshape(-1, *image.shape[2:])


def check(found: dict[str, tuple[Array, Array]], size: int) -> dict[str, float]:
    """Raises AssertionError unless the caption is true; returns the numbers that it rests on."""
    clear = PathTracer(fog(size, clear=True)).render(spp=32, seed=2, options=OPTIONS).mean
    picture, by_extinction = found["fog"]
    air, stone = (0.1, 0.9, 0.08, 0.22), (0.18, 0.2, 0.3, 0.7)  # over the posts; lit side of one
    field, by_thickness = found["cloud"]
    shadow, beside = (0.08, 0.3, 0.72, 0.745), (0.6, 0.95, 0.72, 0.745)
    body = (0.3, 0.75, 0.3, 0.5)
    wax, by_albedo = found["wax"]
    red, _, blue = part(wax, 0.12, 0.3, 0.4, 0.6).mean(axis=0)
    numbers = {
        "light in the air, of that in clear air": part(picture, *air).mean()
        / part(clear, *air).mean(),
        "change of the air by more fog": part(by_extinction, *air).mean(),
        # The median: single paths of few samples are brighter than all others together.
        "change of the stone behind it": float(np.median(part(by_extinction, *stone))),
        "shadow, of the field beside": part(field, *shadow).mean() / part(field, *beside).mean(),
        "change of the cloud by more extinction": part(by_thickness, *body).mean(),
        "red over blue in the wax, of those of its light": float(red / blue) / (7.0 / 5.6),
        "least change by the wax's albedo": by_albedo.min(),
        "largest change by the wax's albedo": by_albedo.max(),
    }
    light, air_grows, stone_falls, shade, cloud_grows, redder, least, most = numbers.values()
    assert light > 1.3, numbers
    assert air_grows > 0 > stone_falls, numbers
    assert shade < 0.7, numbers
    assert cloud_grows > 0, numbers
    assert redder > 1.05, numbers
    assert most > 0 <= least, numbers
    return {what: float(value) for what, value in numbers.items()}


def media_figure() -> Figure:
    """Three pictures, and below each its derivative, on a scale of its own."""
    found = pictures()
    check(found, SIZE)
    side, gap, left, top = 2.2, 0.15, 0.15, 0.35
    titles = {
        "fog": ("fog", "d picture / d extinction"),
        "cloud": ("cloud from a .vdb file", "d picture / d extinction"),
        "wax": ("wax, amber, smoke", "d picture / d albedo of wax"),
    }
    with style.house_style():
        figure = style.new_figure(3 * side + 2 * gap + 2 * left, 2 * (side + top) + 0.8)
        for column, (name, (picture, slope)) in enumerate(found.items()):
            x = left + column * (side + gap)
            axes = style.place_axes(figure, x, top, side, side)
            axes.imshow(display(picture))
            axes.set_title(titles[name][0])
            axes.axis("off")
            axes = style.place_axes(figure, x, 2 * top + side, side, side)
            limit = float(np.quantile(np.abs(slope), 0.98))
            axes.imshow(slope, norm=style.symmetric_scale(limit), cmap=style.signed_color_map())
            axes.set_title(titles[name][1])
            axes.axis("off")
        style.write_caption(
            figure,
            "Above: participating media. Below: the derivative of each pixel with respect to one "
            "parameter of the medium, red positive, blue negative. Denser fog brightens the air "
            "around the hidden light and dims the lit stone behind it. The cloud casts a shadow; a "
            "denser cloud is brighter. Light through wax is redder than its light source; with a "
            "higher albedo no pixel gets darker.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(media_figure(), IMAGES / "media.png")


if __name__ == "__main__":
    main()
