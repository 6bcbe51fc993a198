"""Image-based lighting by the split-sum approximation, against path tracing, on a ball.

The light is DATA/envmaps/blender_studio.exr (soft lights) and blender_city.exr (a sun). Nothing but
the ball is there, so that shadows and light between surfaces play no part.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.capture.camera import Camera
from photograd.images.exr import read_exr
from photograd.lights import EnvironmentMap, Light
from photograd.lights.dfg import dfg_table
from photograd.lights.prefilter import PrefilteredLight, irradiance_map, shade, specular_map
from photograd.transport import Material, PathOptions, PathTracer, Scene, SphereShape
from photograd.transport.builtin import camera_at
from photograd.transport.inverse.pictures import display
from photograd_course.viz import style

Array = NDArray[Any]
SIZE, SPP, DISTANCE, ROWS = 48, 1024, 5.0, 256
MATTE_SIZE, MATTE_SPP, MATTE_SHOWN_SPP = 18, 32768, 4096
ROUGHNESSES = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
SHOWN = (0.1, 0.3, 0.5, 1.0)
SKIES = ("studio", "city")
IMAGE = "image_based_light.png"

WHITE: dict[str, Any] = {"base_color": np.ones(3), "metalness": 0.0, "reflectance": 0.0}
SILVER: dict[str, Any] = {
    "base_color": np.array([0.95, 0.93, 0.88]),
    "metalness": 1.0,
    "reflectance": 0.5,
}
COATING: dict[str, Any] = {"base_color": np.zeros(3), "metalness": 0.0, "reflectance": 0.5}
"""A dielectric's lobe over black."""


def sky(data: Path, name: str) -> EnvironmentMap:
    """A map of 256 x 512 texels, means of those of the file."""
    image = read_exr(data / "envmaps" / f"blender_{name}.exr")[..., :3]
    step = image.shape[0] // ROWS
    texels = image.reshape(ROWS, step, 2 * ROWS, step, 3).mean(axis=(1, 3))
    return EnvironmentMap(np.ascontiguousarray(texels, np.float32))


def ball_camera(size: int) -> Camera:
    """Sees the ball alone, a little from above."""
    angle = 2 * np.degrees(np.arcsin(1 / DISTANCE)) + 1.0
    way = np.array([0.3, 0.25, 1.0])
    return camera_at(DISTANCE * way / np.linalg.norm(way), [0, 0, 0], angle, size, size)


def traced(light: Light, material: Material, size: int, spp: int) -> tuple[Array, float]:
    """Brute force: the picture, and how large a standard error its samples speak of.

    Root mean squares, the one in parts of the other.
    """
    ball = SphereShape("ball", np.zeros(3), 1.0, "m")
    scene = Scene("ball", (ball,), {"m": material}, ball_camera(size), lights=(light,))
    options = PathOptions(max_depth=2, roulette_from=None)
    found = PathTracer(scene).render(spp=spp, seed=1, options=options)
    inside = on_ball(ball_camera(size))[1]
    return found.mean, size_of(found.standard_error[inside]) / size_of(found.mean[inside])


def size_of(numbers: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.square(numbers).mean()))


def on_ball(camera: Camera, points: int = 6) -> tuple[Array, NDArray[np.bool_]]:
    """Normals (P, H, W, 3) at points^2 places of every pixel, and which pixels show the ball alone.

    Where a ray misses the ball, the normal is one of its rim.
    """
    part = (np.arange(points) + 0.5) / points
    du, dv = (x.reshape(-1, 1, 1) for x in np.meshgrid(part, part))
    u, v = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    x, y = (u + du - camera.cx) / camera.fx, (v + dv - camera.cy) / camera.fy
    d = np.stack([x, y, np.ones_like(x)], -1) @ camera.world_from_camera[:3, :3].T
    d /= np.linalg.norm(d, axis=-1, keepdims=True)
    along = -(d @ camera.position)
    inside = 1 - camera.position @ camera.position + along**2
    points_on = camera.position + (along - np.sqrt(np.maximum(inside, 0)))[..., None] * d
    rim = camera.fx * np.tan(np.arcsin(1 / DISTANCE)) - 1.0
    middle = np.hypot(u + 0.5 - camera.cx, v + 0.5 - camera.cy)
    n = points_on / np.linalg.norm(points_on, axis=-1, keepdims=True)
    return n, middle < rim


def split_sum(
    tables: PrefilteredLight,
    values: dict[str, Any],
    roughness: float,
    size: int,
    *,
    leaning: bool = True,
) -> Any:
    """The picture from the tables, (H, W, 3)."""
    camera = ball_camera(size)
    n, _ = on_ball(camera)
    wo = camera.position - n
    wo /= np.linalg.norm(wo, axis=-1, keepdims=True)
    return shade(tables, n, wo, roughness=roughness, leaning=leaning, **values).mean(axis=0)


@dataclass(frozen=True)
class Comparison:
    """Of two pictures of the ball, over pixels that show nothing else.

    Attributes:
        brute, split: (H, W, 3).
        rms: of the difference, in parts of the root mean square of the radiance.
        plain: the same of lobes that do not lean.
        bias: of the mean, relative.
        largest: difference of a pixel, in parts as `rms`; of matte surfaces, of its own radiance.
        noise: standard error of the brute force, in parts as `rms`.
    """

    brute: Array
    split: Array
    rms: float
    plain: float
    bias: float
    largest: float
    noise: float


def compare(
    light: Light,
    tables: PrefilteredLight,
    values: dict[str, Any],
    roughness: float,
    size: int = SIZE,
    spp: int = SPP,
) -> Comparison:
    """Path traced, and from the tables."""
    material = Material("standard", {**values, "roughness": roughness})
    brute, noise = traced(light, material, size, spp)
    split = split_sum(tables, values, roughness, size)
    straight = split_sum(tables, values, roughness, size, leaning=False)
    inside = on_ball(ball_camera(size))[1]
    gap, level = (split - brute)[inside], size_of(brute[inside])
    bias = float(gap.mean() / brute[inside].mean())
    plain = size_of((straight - brute)[inside]) / level
    largest = float(np.abs(gap).max()) / level
    return Comparison(brute, split, size_of(gap) / level, plain, bias, largest, noise)


def ground_under(light: Light, tables: PrefilteredLight, size: int, spp: int) -> Comparison:
    """Of a white matte ball: E / pi against the path tracer."""
    white = Material("lambert", {"albedo": np.ones(3)})
    brute, noise = traced(light, white, size, spp)
    n, inside = on_ball(ball_camera(size))
    split = tables.irradiance.at(n).mean(axis=0) / np.pi
    gap, bias = (split - brute)[inside], float((split - brute)[inside].mean())
    largest = float((np.abs(gap) / brute[inside]).max())
    rms = size_of(gap) / size_of(brute[inside])
    return Comparison(brute, split, rms, rms, bias / float(brute[inside].mean()), largest, noise)


def measure(data: Path) -> tuple[list[str], Figure]:
    """Lines of the page, and the figure."""
    lines = [
        f"A ball in {SIZE} x {SIZE} pixels under maps of {2 * ROWS} x {ROWS} texels, against a "
        f"path tracer with {SPP} samples a pixel. Irradiance and, for each of these roughnesses, "
        "radiance in 128 x 64 cells (512 x 256 for 0.1, 256 x 128 for 0.2), the lobe's albedo in "
        "64 x 64. Errors are root mean squares over the pixels that show the ball alone, in parts "
        "of the root mean square of the radiance, with the lobe around the mirrored view as "
        "published, and leaning towards the normal; in brackets what the brute force's samples "
        "say of its own noise (which is less: they are spread evenly).",
        "",
        "| light | surface | " + " | ".join(f"roughness {r}" for r in ROUGHNESSES) + " |",
        "|---|---|" + "---|" * len(ROUGHNESSES),
    ]
    shown: list[tuple[str, Comparison]] = []
    below, pictures = [], {}
    for name in SKIES:
        light = sky(data, name)
        tables = PrefilteredLight(
            irradiance_map(light), specular_map(light, ROUGHNESSES), dfg_table()
        )
        matte = ground_under(light, tables, MATTE_SIZE, MATTE_SPP)
        below.append(
            f"Matte white under the {name}, {MATTE_SIZE} x {MATTE_SIZE} pixels of {MATTE_SPP} "
            f"samples: RMS {matte.rms:.2%}, largest difference of a pixel from its own radiance "
            f"{matte.largest:.2%}, of the mean {matte.bias:+.3%}; noise {matte.noise:.2%}."
        )
        for title, values in (("metal", SILVER), ("coating over black", COATING)):
            found = {r: compare(light, tables, values, r) for r in ROUGHNESSES}
            cells = " | ".join(f"{c.plain:.1%}" for c in found.values())
            lines.append(f"| {name} | {title}, as published | {cells} |")
            cells = " | ".join(f"{c.rms:.1%} ({c.noise:.1%})" for c in found.values())
            lines.append(f"| {name} | {title}, leaning | {cells} |")
            pictures[name, title] = found
        if name == "studio":
            shown.append(("matte", ground_under(light, tables, SIZE, MATTE_SHOWN_SPP)))
    shown += [(f"metal, {r}", pictures["studio", "metal"][r]) for r in SHOWN]
    return [*lines, "", *below], figure_of(shown)


def figure_of(shown: list[tuple[str, Comparison]]) -> Figure:
    """Rows: path traced, split sum, difference."""
    side, gap, left = 1.55, 0.1, 0.95
    masks = [on_ball(ball_camera(len(c.brute)))[1] for _, c in shown]
    exposure = 0.8 / max(float(c.brute[m].mean()) for (_, c), m in zip(shown, masks, strict=True))
    limit = 0.25
    with style.house_style():
        figure = style.new_figure(left + len(shown) * (side + gap) + 0.15, 3 * (side + gap) + 1.2)
        for column, (title, found) in enumerate(shown):
            inside = masks[column][..., None]
            level = float(found.brute[masks[column]].mean())
            gap_of = (found.split - found.brute).mean(axis=-1) / level
            rows: tuple[tuple[str, Array, dict[str, Any]], ...] = (
                ("path traced", display(np.where(inside, exposure * found.brute, 1.0)), {}),
                ("split sum", display(np.where(inside, exposure * found.split, 1.0)), {}),
                (
                    "difference",
                    np.where(masks[column], gap_of, 0.0),
                    {"norm": style.symmetric_scale(limit), "cmap": style.signed_color_map()},
                ),
            )
            for row, (name, image, options) in enumerate(rows):
                x, y = left + column * (side + gap), 0.35 + row * (side + gap)
                axes = style.place_axes(figure, x, y, side, side)
                axes.imshow(image, **options)
                axes.set_xticks([])
                axes.set_yticks([])
                if row == 0:
                    axes.set_title(title)
                if column == 0:
                    axes.set_ylabel(name)
        style.write_caption(
            figure,
            "A ball in a studio, matte and of metal with four roughnesses: path traced, and by the "
            "split-sum approximation from prefiltered environment maps. The difference (red: split "
            f"sum brighter, blue: darker) saturates at {limit:.0%} of the ball's mean. Matte "
            "surfaces agree, and nearly smooth metal does. At grazing angles the lobe of rougher "
            "metal is long and thin, and the prefiltered lobe is round. The prefiltered lobe leans "
            "from the mirrored direction toward the normal, as the true one does.",
            left=left,
            right=0.15,
        )
    return figure
