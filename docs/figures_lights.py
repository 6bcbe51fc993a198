"""The picture of lights: `python docs/figures_lights.py` writes it.

What lights do to a white floor, where an environment map's samples go, and what a spot's softness
and one lit point say about the light: the derivatives that a fit follows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from numpy.typing import NDArray
from photograd.lights import (
    EnvironmentMap,
    Light,
    LightSamples,
    PointLight,
    QuadLight,
    SphereLight,
    SpotLight,
    TriangleLight,
)
from photograd_course.color import srgb_encode
from photograd_course.random import uniform
from photograd_course.viz import save_figure, style

Array = NDArray[Any]
IMAGES = Path(__file__).with_name("images")
SIZE = 160
UP = np.array([0.0, 1.0, 0.0])
WARM = np.array([1.0, 0.85, 0.65])
CORNER, EDGE_X, EDGE_Y = np.array([-0.5, 0.25, -0.2]), np.array([1.0, 0, 0]), np.array([0, 0, 0.4])
CORNERS = np.stack([CORNER, CORNER + EDGE_X, CORNER + EDGE_X + EDGE_Y, CORNER + EDGE_Y])
SPOT = SpotLight([-0.7, 0.8, 0.0], [0.9, -1.0, 0.0], 2.4 * WARM, 0.8, 0.4)
HEIGHT = 64


class ByArea:
    """The rectangle again, two triangles: points evenly over its area."""

    halves = tuple(
        TriangleLight(*CORNERS[list(corners)], 3.0 * WARM) for corners in ((0, 1, 2), (0, 2, 3))
    )

    def sample(self, points: Array, u2: Array) -> LightSamples:
        """One of the triangles, by the first number, and a point of it."""
        u2 = np.array(u2) * [2.0, 1.0]
        second = u2[:, :1] >= 1.0
        a, b = (half.sample(points, u2 % 1.0) for half in self.halves)
        pick = [np.where(second, y, x) for x, y in zip(_rows(a), _rows(b), strict=True)]
        direction, distance, radiance, pdf = pick
        return LightSamples(direction, distance[:, 0], radiance, 0.5 * pdf[:, 0], False)


def _rows(samples: LightSamples) -> tuple[Array, ...]:
    s = samples
    return s.direction, s.distance[:, None], s.radiance, s.pdf[:, None]


def floor_points() -> Array:
    """Points (SIZE^2, 3) of a floor of 2 m x 2 m, row 0 far away at -Z."""
    line = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, z = np.meshgrid(line, line)
    return np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)


def lit(light: Light | ByArea, points: Array, normals: Array, samples: int) -> Array:
    """Radiance (N, 3) that white matte points send out, from this many samples each."""
    total = np.zeros((len(points), 3))
    for number in range(samples):
        u2 = uniform(5, step=number, pixel=np.arange(len(points))[:, None], dimension=np.arange(2))
        found = light.sample(points, u2)
        cosine = np.maximum((found.direction * normals).sum(axis=1), 0.0)
        weight = np.where(found.pdf > 0, cosine / np.where(found.pdf > 0, found.pdf, 1.0), 0.0)
        total += found.radiance * weight[:, None]
    return total / (np.pi * samples)


def floor(light: Light | ByArea, samples: int = 64) -> Array:
    """Picture (SIZE, SIZE, 3) of the floor from above."""
    points = floor_points()
    return lit(light, points, np.broadcast_to(UP, points.shape), samples).reshape(SIZE, SIZE, 3)


def sky() -> Array:
    """A made-up map (HEIGHT, 2 HEIGHT, 3): evening sky, low sun, a lit window, a dark ground."""
    v, u = np.meshgrid(
        (np.arange(HEIGHT) + 0.5) / HEIGHT,
        (np.arange(2 * HEIGHT) + 0.5) / (2 * HEIGHT),
        indexing="ij",
    )
    up = np.clip(1.0 - 2.0 * v, 0.0, 1.0)[..., None]
    image = (1 - up) * np.array([0.9, 0.55, 0.35]) + up * np.array([0.15, 0.3, 0.7])
    image = np.where((v > 0.5)[..., None], np.array([0.12, 0.1, 0.08]), image)
    theta, phi = np.pi * (v - 0.36), 2.0 * np.pi * (u - 0.12)
    sun = np.exp(-(theta**2 + (phi * np.sin(np.pi * v)) ** 2) / 0.006)
    image = image + 150.0 * sun[..., None] * np.array([1.0, 0.8, 0.5])
    window = (np.abs(u - 0.72) < 0.05) & (np.abs(v - 0.55) < 0.06)
    return np.where(window[..., None], np.array([3.0, 3.5, 5.0]), image)


def ball(light: Light) -> Array:
    """A white ball (SIZE, SIZE, 3) in a light at infinity, seen along +Z; -X is to the right."""
    line = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(-line, -line)
    inside = x**2 + y**2 < 1.0
    z = -np.sqrt(1.0 - np.where(inside, x**2 + y**2, 0.0))
    normals = np.stack([x, y, z], axis=-1)[inside]
    image = np.ones((SIZE, SIZE, 3))
    image[inside] = lit(light, np.zeros_like(normals), normals, 64)
    return image


def by_softness() -> Array:
    """d(radiance of the floor, mean of the channels)/dsoftness of the spot, pixel by pixel.

    One parameter, many pixels: the forward derivative, in the core for its proofs, is at hand.
    """
    points = floor_points()
    core, (parameters, constants) = SPOT.core_call(np.float64)
    along = np.array([p.name == "softness" for p in SPOT.parameters() for _ in range(p.size)])
    w = SPOT.sample(points, np.full((len(points), 2), 0.5)).direction
    slopes = core.jvp(parameters, constants, along.astype(np.float64), points, w)
    radiance: Array = slopes.mean(axis=1) * np.maximum(w[:, 1], 0.0) / np.pi
    return radiance.reshape(SIZE, SIZE)


def by_texels(light: EnvironmentMap, normal: Array, samples: int = 400_000) -> Array:
    """d(irradiance at `normal`)/dtexels of one channel (HEIGHT, 2 HEIGHT), by samples."""
    points = np.zeros((samples, 3))
    u2 = uniform(6, pixel=np.arange(samples)[:, None], dimension=np.arange(2))
    found = light.sample(points, u2)
    cosine = np.maximum(found.direction @ normal, 0.0) / (found.pdf * samples)
    d = np.repeat(cosine[:, None], 3, axis=1)
    derivative: Array = light.sample_backward(points, found, d)["texels"][..., 0]
    return derivative


def shown(image: Array, exposure: float = 1.0) -> Array:
    """For the screen."""
    return srgb_encode(np.clip(exposure * image, 0.0, 1.0))


def draw(axes: Axes, image: Array, title: str, **options: Any) -> None:
    """A picture without ticks."""
    axes.imshow(image, **options)
    axes.set_title(title)
    axes.axis("off")


def draw_map(axes: Axes, light: EnvironmentMap) -> None:
    """The map, and where 600 samples go."""
    u2 = uniform(7, pixel=np.arange(600)[:, None], dimension=np.arange(2))
    x, y, z = light.sample(np.zeros((600, 3)), u2).direction.T
    draw(axes, shown(light.texels), "an environment map, 600 samples", extent=(0, 2, 1, 0))
    axes.plot(
        1.0 + np.arctan2(-x, z) / np.pi, np.arccos(y) / np.pi, ".", ms=1.6, mew=0, color="#e8006f"
    )
    axes.set(xlim=(0, 2), ylim=(1, 0))


def lights_figure() -> Figure:
    """Five floors above; the map, a ball in it and two derivatives below."""
    light = EnvironmentMap(sky(), uniform_share=0.2)
    by_solid_angle = QuadLight(CORNER, EDGE_X, EDGE_Y, 3.0 * WARM)
    floors: tuple[tuple[str, Light | ByArea, int], ...] = (
        ("point", PointLight([0.0, 0.4, 0.0], 0.35 * WARM), 1),
        ("spot", SPOT, 1),
        ("sphere", SphereLight([0.3, 0.35, 0.2], 0.25, 2.5 * WARM), 16),
        ("1 sample by area", ByArea(), 1),
        ("by solid angle", by_solid_angle, 1),
    )
    side, gap, left = 1.5, 0.16, 0.2
    width = 5 * side + 4 * gap + 2 * left
    with style.house_style():
        figure = style.new_figure(width, 4.65)
        for number, (title, lamp, samples) in enumerate(floors):
            axes = style.place_axes(figure, left + number * (side + gap), 0.35, side, side)
            draw(axes, shown(floor(lamp, samples)), title)
        low = 1.2
        draw_map(style.place_axes(figure, left, 2.35, 2 * low, low), light)
        axes = style.place_axes(figure, left + 2.5, 2.35, low, low)
        draw(axes, shown(ball(light), 0.6), "a matte ball in it")
        colors = style.signed_color_map()
        for at, wide, title, image, extent in (
            (3.85, low, "spot by softness", by_softness(), None),
            (
                5.7,
                1.5,
                "a point by texels",
                by_texels(light, np.array([0.0, 0.6, 0.8])),
                (0, 2, 1, 0),
            ),
        ):
            scale = style.symmetric_scale(float(np.quantile(np.abs(image), 0.999)))
            high = wide if extent is None else wide / 2
            axes = style.place_axes(figure, left + at, 2.35, wide, high)
            draw(axes, image, title, norm=scale, cmap=colors, extent=extent)
            mappable = ScalarMappable(scale, colors)
            box = (left + at + wide + 0.05, 2.35, 0.08, high)
            style.color_bar(figure, box, mappable, "", extend="both")
        style.write_caption(
            figure,
            "Above: a white floor, 2 m x 2 m, under lights. One sample a pixel of a rectangle "
            "close to the floor: uniform over its area, distance and cosine make noise; uniform "
            "over its solid angle, only the floor's own cosine does. Below: samples of an "
            "environment map crowd where it is bright (a fifth goes everywhere), and a ball lit "
            "by them. Where a softer spot would lose light (blue). What one point, facing up and "
            "towards the middle of the map, asks of the texels: the cosine's lobe, by samples.",
            left=left,
            right=left,
        )
    return figure


def main() -> None:
    """Write the picture; the same bytes every time."""
    IMAGES.mkdir(exist_ok=True)
    save_figure(lights_figure(), IMAGES / "lights.png")


if __name__ == "__main__":
    main()
