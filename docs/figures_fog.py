"""Shafts of light in a dusty hall: `python docs/figures_fog.py` writes docs/images/god_rays.png."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.capture.orbit import look_at
from photograd.fields import SunlitMedium
from photograd.geometry.mesh import Bvh, Mesh
from photograd.representation import Outputs, RayBatch, RenderOptions
from photograd_course.color import srgb_encode
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
PICTURE = Path(__file__).resolve().parent / "images" / "god_rays.png"
PANEL = 3.6  # inches

HALL = np.array([[-4.0, 0.0, -3.0], [4.0, 4.0, 3.0]])  # meters; the front, z = 3, is open
VOXEL = 0.1
SUN = np.array([-1.0, 0.55, -0.05]) / np.linalg.norm([-1.0, 0.55, -0.05])
IRRADIANCE = np.array([11.0, 9.5, 7.5])  # W/m^2
WALL = np.array([0.55, 0.5, 0.45])  # albedo of all surfaces
DIM = 0.015  # what corners that the sun does not reach show nevertheless, W/(m^2 sr)
SIGMA_T = 0.15  # 1/m: 1 - exp(-0.15 * 8) = 70 % from wall to wall
SIZE = 320
EXPOSURE = 3.0  # of what is shown


def rectangle(axis: int, at: float, lo: tuple[float, float], hi: tuple[float, float]) -> Mesh:
    """A rectangle across one axis, given by its extent along the other two."""
    corners = np.empty((4, 3), np.float32)
    corners[:, axis] = at
    others = [k for k in range(3) if k != axis]
    corners[:, others] = [(lo[0], lo[1]), (hi[0], lo[1]), (hi[0], hi[1]), (lo[0], hi[1])]
    return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))


def hall() -> Bvh:
    """Floor, ceiling, back and right wall, and a left wall with three windows."""
    meshes = [
        rectangle(1, 0.0, (-4, -3), (4, 3)),
        rectangle(1, 4.0, (-4, -3), (4, 3)),
        rectangle(2, -3.0, (-4, 0), (4, 4)),
        rectangle(0, 4.0, (0, -3), (4, 3)),
        rectangle(0, -4.0, (0, -3), (1.6, 3)),  # below the windows
        rectangle(0, -4.0, (3.2, -3), (4, 3)),  # above them
    ]
    for left, right in ((-3, -1.9), (-1.2, -0.35), (0.35, 1.2), (1.9, 3)):  # between them
        meshes.append(rectangle(0, -4.0, (1.6, left), (3.2, right)))
    return Bvh(meshes)


def rays(size: int) -> RayBatch:
    """From the open front into the far left corner."""
    camera = Camera(
        size,
        size,
        0.82 * size,
        0.82 * size,
        size / 2,
        size / 2,
        look_at(np.array([3.1, 1.5, 6.2]), np.array([-1.3, 1.75, -1.2])),
    )
    origins, directions = camera.rays()
    return RayBatch(origins, directions, np.arange(len(origins), dtype=np.uint32))


def surfaces(solids: Bvh, batch: RayBatch) -> Array:
    """Radiance (R, 3) of matte walls in the sun, dimmed by the dust on the way from the window."""
    o, d = (np.asarray(a, np.float64) for a in (batch.origins, batch.directions))
    hits = solids.trace(o, d)
    points = solids.surface_points(o, d, hits)
    facing = points.normal * -np.sign(np.einsum("rk,rk->r", points.normal, d))[:, None]
    start = points.position + 1e-3 * facing
    seen = ~solids.occluded(start, np.ascontiguousarray(np.broadcast_to(SUN, o.shape)))
    through = np.exp(-SIGMA_T * (points.position[:, 0] - HALL[0, 0]) / -SUN[0])
    lit = seen * through * np.maximum(facing @ SUN, 0)
    color = WALL / np.pi * IRRADIANCE * lit[:, None] + DIM
    return np.asarray(np.where(hits.hit[:, None], color, 0.25 * DIM))


def dusty_hall(solids: Bvh, voxel: float) -> SunlitMedium:
    """The same dust everywhere in the hall."""
    x, y, z = np.round((HALL[1] - HALL[0]) / voxel).astype(int).tolist()
    return SunlitMedium.homogeneous(
        SIGMA_T,
        (x, y, z),
        HALL,
        voxel / 2,
        albedo=(0.95, 0.95, 0.95),
        g=0.55,
        irradiance=IRRADIANCE,
        sun=SUN,
        solids=solids,
    )


def computed(size: int = SIZE, voxel: float = VOXEL) -> dict[str, Array]:
    """What the picture shows.

    Returns:
        "clear" and "dusty" (H, W, 3) linear radiance, "scattered" (H, W, 3) the dust's own; and of
        the upright plane through the middle window "light" (X, Y) the share of the sun's light
        there, "derivative" (X, Y) of the mean scattered light by sigma_t and volume, 1/m^3.
    """
    solids, batch = hall(), rays(size)
    medium = dusty_hall(solids, voxel)
    outputs, context = medium.render(batch, seed=1, step=0, options=RenderOptions(jitter=True))
    assert outputs.opacity is not None
    behind = surfaces(solids, batch)
    mean = Outputs(np.full_like(outputs.color, 1 / outputs.color.size))
    d_sigma_t = medium.render_backward(context, mean)["sigma_t"]
    middle = d_sigma_t.shape[2] // 2
    pictures = {
        "clear": behind,
        "scattered": outputs.color,
        "dusty": outputs.color + (1 - outputs.opacity)[:, None] * behind,
    }
    slices = {"light": medium.light()[0], "derivative": d_sigma_t / voxel**3}
    return {name: image.reshape(size, size, 3) for name, image in pictures.items()} | {
        name: volume[:, :, middle] for name, volume in slices.items()
    }


def main() -> None:
    """Write the picture."""
    found = computed()
    layer = found["derivative"]
    with style.house_style():
        figure = style.new_figure(4 * PANEL + 0.7, PANEL + 1.1)
        panels = [
            style.place_axes(figure, 0.15 + k * (PANEL + 0.2), 0.35, PANEL * (1 + k // 2), PANEL)
            for k in range(3)
        ]
        for axes, name in zip(panels, ("clear", "dusty"), strict=False):
            axes.imshow(srgb_encode(np.clip(EXPOSURE * found[name], 0, 1)), interpolation="nearest")
        panels[2].imshow(
            layer.T,
            origin="lower",
            extent=(-4, 4, 0, 4),
            cmap=style.signed_color_map(),
            norm=style.symmetric_scale(float(np.quantile(np.abs(layer), 0.995))),
            interpolation="nearest",
        )
        titles = "clear air", "dust: single scattering", "derivative with respect to the dust"
        for axes, title in zip(panels, titles, strict=True):
            axes.set(xticks=[], yticks=[], title=title)
        style.write_caption(
            figure,
            "A hall with three windows on the left. Dust scatters the light of each shaft toward "
            "the camera. Right: the derivative of the picture's mean scattered light with respect "
            "to sigma_t (red: positive, blue: negative), in the upright plane through the middle "
            "window. Dust in a shaft brightens; dust in the dark can only dim what lies behind it.",
            left=0.15,
            right=0.15,
        )
        save_figure(figure, PICTURE)


if __name__ == "__main__":
    main()
