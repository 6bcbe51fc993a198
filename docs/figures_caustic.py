"""Light that a glass ball gathers: `python docs/figures_caustic.py` writes docs/images/caustic.png.

The same scene by camera paths, by photons counted over two radii, and as the irradiance of the
table, by particles from the light.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.lights import SpotLight
from photograd.transport import (
    Accumulation,
    IrradianceSensor,
    Material,
    PathTracer,
    PhotonMap,
    Scene,
    SphereShape,
    trace_light,
)
from photograd.transport.builtin import camera_at
from photograd.transport.shapes import rectangle
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE, SPP, PARTICLES = 128, 32, 1 << 18
CENTER, RADIUS, LAMP = np.array([0.0, 0.45, 0.0]), 0.35, np.array([-1.2, 2.4, 0.5])
BLURS = (0.12, 0.02)  # m
HALF = 1.0  # m, of the table's part whose irradiance is drawn


def scene(size: int) -> Scene:
    """A ball of glass over a table, in a spot light without size."""
    axis = (CENTER - LAMP) / np.linalg.norm(CENTER - LAMP)
    shapes = (
        rectangle("table", [-2, 0, 2], [4, 0, 0], [0, 0, -4], "table"),
        SphereShape("ball", CENTER, RADIUS, "glass"),
    )
    materials = {
        "table": Material("lambert", {"albedo": [0.7, 0.68, 0.65]}),
        "glass": Material("glass", {"eta": 1.5, "tint": [0.85, 0.97, 0.9]}),
    }
    light = SpotLight(LAMP, axis, [14.0, 13.0, 11.0], 0.9, 0.5)
    camera = camera_at([0.5, 1.7, 2.6], [0.1, 0.15, 0.0], 38.0, size, size)
    return Scene("caustic", shapes, materials, camera, lights=(light,))


def table_irradiance(tracer: PathTracer, cells: int, particles: int) -> Accumulation:
    """W/m^2 of the middle of the table, seen from above; the camera's side is below."""
    sensor = IrradianceSensor([-HALF, 0, HALF], [2 * HALF, 0, 0], [0, 0, -2 * HALF], cells, cells)
    return trace_light(tracer, sensor, particles, seed=1)


def pictures(size: int, spp: int, particles: int) -> list[Array]:
    """Linear pictures (H, W, 3): camera paths, then photons over each of BLURS."""
    tracer = PathTracer(scene(size))
    found = [tracer.render(spp=spp, seed=1).mean]
    for radius in BLURS:
        photons = PhotonMap(tracer, particles, radius=radius, seed=1)
        found.append(photons.render(spp=max(1, spp // 4), seed=1).mean)
    return found


def caustic_figure() -> Figure:
    """Three pictures and a map."""
    side, gap, left = 2.0, 0.15, 0.15
    panels = [np.clip(image, 0, 1) for image in pictures(SIZE, SPP, PARTICLES)]
    landed = table_irradiance(PathTracer(scene(8)), SIZE, 4 * PARTICLES).mean
    panels.append(np.clip(landed / np.quantile(landed, 0.995), 0, 1))
    titles = (
        "camera paths",
        f"photons within {100 * BLURS[0]:.0f} cm",
        f"photons within {100 * BLURS[1]:.0f} cm",
        "irradiance of the table",
    )
    with style.house_style():
        figure = style.new_figure(4 * side + 3 * gap + 2 * left, 3.3)
        for column, (title, image) in enumerate(zip(titles, panels, strict=True)):
            axes = style.place_axes(figure, left + column * (side + gap), 0.35, side, side)
            axes.imshow(srgb_encode(image))
            axes.set_title(title)
            axes.axis("off")
        style.write_caption(
            figure,
            "A glass ball under a point light. A path of the camera that leaves the table "
            "can never hit the light, and next event estimation is blocked by the ball: in the "
            "shadow there is nothing but what the table sends through the ball. Particles come "
            "from the light, and in the middle of the shadow they bring several times the light of "
            "the open table. A wide radius blurs that patch, a small one shows how few photons are "
            "left.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(caustic_figure(), IMAGES / "caustic.png")


if __name__ == "__main__":
    main()
