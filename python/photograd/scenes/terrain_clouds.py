"""An island cut out of a sea: mountains, woods, a lighthouse, and clouds above as density.

The clouds are for renderers of volumes; one that knows surfaces only shows the land.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from photograd_course import random

from photograd.scenes.description import Density, Points, SceneDescription
from photograd.scenes.noise import fractal_noise
from photograd.scenes.parts import (
    Color,
    Part,
    as_meshes,
    blue_sky,
    paint,
    paints,
    placed,
    warm_sun,
    within_range,
)
from photograd.scenes.shapes import sphere
from photograd.scenes.surface import joined, land_block, lathe, net_points
from photograd.scenes.textures import bands
from photograd.types import FloatArray


def cloud_layer(
    box: Points,
    *,
    seed: int,
    sigma_t: float = 60.0,
    feature_size: float = 0.3,
    threshold: float = -0.1,
) -> Density:
    """Clouds that fill a box, flat below and billowing above.

        sigma_t * clip(4 (noise(x / feature_size) - threshold) * profile, 0, 1)

    where the profile rises from 0 to 1 within the lowest fifth of the box and falls to 0 at its
    sides and top, so that no cloud is cut off.

    Args:
        box: (2, 3).
        seed: of the noise.
        sigma_t: the largest value, in 1/m.
        feature_size: meters from cloud to cloud.
        threshold: of the noise; with -0.1 two fifths of the layer are cloud, with 0 one fifth.

    Returns:
        A function from points (N, 3) to sigma_t (N,) in 1/m: continuous, 0 outside the box.
    """
    low, high = np.asarray(box, dtype=np.float64)

    def density(points: Points) -> FloatArray:
        share = (np.asarray(points, dtype=np.float64) - low) / (high - low)
        inside = np.all((share > 0.0) & (share < 1.0), axis=-1)
        values = np.zeros(len(share))
        if not bool(inside.any()):
            return values
        share = share[inside]
        sideways = np.minimum(share, 1.0 - share)[:, [0, 2]].min(axis=1)
        base = np.clip(5.0 * share[:, 1], 0.0, 1.0)
        dome = np.clip(6.0 * sideways, 0.0, 1.0) * np.sqrt(1.0 - share[:, 1])
        noise = fractal_noise(points[inside] / feature_size, seed=seed, octaves=5)
        filled = 4.0 * (noise + 0.35 * (dome - 1.0) - threshold) * base * dome
        values[inside] = sigma_t * np.clip(filled, 0.0, 1.0)
        return values

    return density


# An island cut out of a sea: mountains, woods, a lighthouse, and clouds above as density.


_HALF = 0.55
_FLOOR = -0.32
_SEA = -0.16
_NET = 200
_CLOUDS = np.array([[-0.5, 0.22, -0.5], [0.5, 0.42, 0.5]])


def terrain_clouds(seed: int) -> SceneDescription:
    """The island within 0.7 m of the origin; `seed` draws land, woods and clouds."""
    plan = net_points(_NET, _HALF)
    ground = island_heights(plan, seed=seed)
    top, sides = land_block(np.maximum(ground, _SEA), _HALF, _FLOOR)
    parts: list[Part] = [
        (top, ground_colors(plan, ground, seed=seed).reshape(-1, 3)),
        (sides, strata_colors(sides.vertices, seed=seed)),
        *woods(plan, ground, seed=seed),
        *placed(lighthouse(), _building_site(plan, ground)),
    ]
    bounds = np.array([[-0.57, _FLOOR - 0.02, -0.57], [0.57, 0.44, 0.57]])
    clouds = cloud_layer(_CLOUDS, seed=seed)
    return SceneDescription(
        "terrain_clouds", as_meshes(parts), warm_sun(), blue_sky(), bounds, clouds
    )


def island_heights(plan: FloatArray, *, seed: int) -> FloatArray:
    """Heights (M, N) of the ground, sea floor included, at (x, z) positions (M, N, 2).

    Hills and, where they are high, crests; lowered towards the edge so that there is a coast.
    """
    hills = fractal_noise(1.7 * plan, seed=seed, octaves=7)
    crests = fractal_noise(2.6 * plan + 7.3, seed=seed + 1, octaves=6, ridged=True)
    edge = np.hypot(plan[..., 0], plan[..., 1]) / _HALF
    land = 1.0 - 1.15 * edge**2 + 1.1 * hills
    share = np.clip((land - 0.35) / 0.85, 0.0, 1.0)
    mountains = share**2 * (3.0 - 2.0 * share) * np.clip(0.55 + 0.6 * crests, 0.1, None)
    return np.asarray(_SEA + 0.055 * np.clip(land, -2.0, None) + 0.38 * mountains)


def ground_colors(plan: FloatArray, ground: FloatArray, *, seed: int) -> Color:
    """Albedo (M, N, 3) by height, slope and a little noise: sea, sand, grass, woods, rock, snow."""
    step = 2.0 * _HALF / (len(ground) - 1)
    slope = np.hypot(*np.gradient(ground, step))
    speckle = fractal_noise(9.0 * plan, seed=seed + 2, octaves=5)
    height = ground - _SEA + 0.02 * speckle
    stops = [-0.07, -0.03, -0.006, 0.0, 0.008, 0.02, 0.07, 0.14, 0.2, 0.25]
    colors = paints(
        "deep", "blue", "turquoise", "sand", "sand", "lime", "green", "forest", "rock", "snow"
    )
    mixed = np.stack([np.interp(height, stops, channel) for channel in colors.T], axis=-1)
    steep = np.clip((slope - 1.3) / 0.7, 0.0, 1.0) * (height > 0.03)
    rock = (1.0 + 0.5 * speckle)[..., None] * paint("rock")
    return within_range((1.0 - steep[..., None]) * mixed + steep[..., None] * rock)


def strata_colors(points: FloatArray, *, seed: int) -> Color:
    """Albedo (N, 3) of the cut sides: layers of earth that noise has bent."""
    bent = 0.05 * fractal_noise(2.5 * points, seed=seed + 3, octaves=4)
    layer = np.floor((points[:, 1] + bent - _FLOOR) / 0.03).astype(np.int64).clip(min=0)
    layers = paints("slate", "brown", "oak", "rock", "walnut", "sand", "coral")
    return within_range(layers[layer % len(layers)])


def woods(plan: FloatArray, ground: FloatArray, *, seed: int, tries: int = 500) -> list[Part]:
    """Firs where a throw of the dice finds gently rising green land."""
    index = np.arange(tries)
    row, column = (random.uniform_int(seed, _NET, pixel=index, dimension=k) for k in (0, 1))
    step = 2.0 * _HALF / (_NET - 1)
    slope = np.hypot(*np.gradient(ground, step))[row, column]
    above = ground[row, column] - _SEA
    inside = np.abs(plan[row, column]).max(axis=1) < _HALF - 0.03
    grows = np.flatnonzero((above > 0.025) & (above < 0.17) & (slope < 1.1) & inside)
    size = 0.75 + 0.5 * random.uniform(seed, pixel=index, dimension=2)
    profile = np.array([[0, 0.085], [0.018, 0.045], [0.01, 0.045], [0.026, 0.01], [0, 0.01]])
    crowns, trunks, colors = [], [], []
    greens = paints("pine", "forest", "green", "grass")
    for tree in grows:
        x, z = plan[row[tree], column[tree]]
        at = (float(x), float(ground[row[tree], column[tree]]) - 0.003, float(z))
        crowns.append(lathe(size[tree] * profile, columns=10).moved(at))
        trunk = np.array([[0, 0.02], [0.005, 0.02], [0.005, 0.0], [0, 0.0]])
        trunks.append(lathe(size[tree] * trunk, columns=6).moved(at))
        colors.append(np.tile(greens[tree % len(greens)], (len(crowns[-1].vertices), 1)))
    if not crowns:
        return []
    return [(joined(crowns), np.concatenate(colors)), (joined(trunks), paint("brown"))]


def lighthouse() -> list[Part]:
    """A tower in red and white with a lantern, 0.2 m high."""
    profile = [[0, 0.15], [0.026, 0.15], [0.026, 0.142], [0.018, 0.14], [0.03, -0.02], [0, -0.02]]
    tower = lathe(np.array(profile, dtype=np.float64), columns=32)
    stories = bands((128, 4), [0.0], paints("white", "white"))
    height = np.interp(np.linspace(0, 1, 128), np.linspace(0, 1, 6), [p[1] for p in profile])
    stories[np.floor(height / 0.028).astype(int) % 2 == 0] = paint("red")
    lantern = lathe(np.array([[0, 0.175], [0.013, 0.175], [0.013, 0.15], [0, 0.15]]), columns=16)
    roof = sphere(0.019, rows=16, columns=32).moved((0.0, 0.175, 0.0))
    return [(tower, stories), (lantern, paint("yellow")), (roof, paint("navy"))]


def _building_site(plan: FloatArray, ground: npt.NDArray[np.float64]) -> tuple[float, float, float]:
    """The point of low land that is furthest towards the corner (+X, +Z)."""
    above = ground - _SEA
    near_edge = np.abs(plan).max(axis=-1) > _HALF - 0.06
    wanted = np.where((above > 0.015) & (above < 0.06) & ~near_edge, plan.sum(axis=-1), -np.inf)
    row, column = np.unravel_index(int(np.argmax(wanted)), wanted.shape)
    x, z = plan[row, column]
    return float(x), float(ground[row, column]), float(z)
