"""Where Gaussians begin: at the points that cameras were found with, or anywhere they can be.

Each begins round, as large as the distance to its neighbors, faint, and of one color from all
sides [Kerbl2023].
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from photograd_course.portable_math import log, norm, root
from photograd_course.random import uniform

from photograd import sh
from photograd._arrays import Arguments
from photograd._fit_options import FitOptions
from photograd.capture.bounds import mean_coverage, silhouettes_of
from photograd.capture.camera import Camera
from photograd.capture.capture import Capture
from photograd.capture.view import View, display_color
from photograd.splats.clone_split_prune import CloneSplitPrune
from photograd.splats.density import DensityControl, NoControl, Schedule, logits
from photograd.splats.markov_chain import MarkovChain
from photograd.splats.splatting import Gaussians
from photograd.types import Array

NEIGHBORS = 3
FEWEST_POINTS = 100
"""A capture with fewer sparse points says too little about where the scene is."""

RANDOM_DISTANCE = 0.7524
"""Of points at random, one in a unit of volume: the root mean square distance to the nearest three.

The k-th neighbor's squared distance is (3 / 4 pi)^(2/3) Gamma(k + 2/3) / Gamma(k) on average.
"""

FIRST_OPACITY = 0.1
CARVED = 0.6
"""Silhouettes that cover less of the pictures than this say where the scene is."""

MAX_TRIES = 64
"""A hull that holds less than this share of its box gets fewer points."""

_PAIRS_AT_ONCE = 1 << 18


def start_gaussians(
    capture: Capture,
    box: Array,
    count: int,
    *,
    degree: int,
    seed: int,
    given: tuple[Array, Array] | None = None,
) -> tuple[Gaussians, str]:
    """Gaussians in float32 to begin a fit with, and one sentence on where they come from.

    At the points (N, 3) with display colors (N, 3) that are `given`; else at the capture's sparse
    points if it has a hundred; else at `count` random points of the box (2, 3), where the
    photographs have alpha only those that no silhouette excludes.

    Args:
        capture: the photographs.
        box: (2, 3) of the scene.
        count: of random points.
        degree: of the harmonics.
        seed: of random points.
        given: points and their display colors, or None.

    Raises:
        RangeError: `count` below 1, or a degree that splats do not have.
    """
    Arguments("start_gaussians").integer("count", count, low=1)
    if given is not None:
        points, colors = given
        size = neighbor_distance(points)
        rule = f"{len(points)} points that a fitted model shows"
    elif capture.points is not None and len(capture.points) >= FEWEST_POINTS:
        points, colors = _some_points(capture, count, seed)
        size = neighbor_distance(points)
        rule = f"{len(points)} of the {len(capture.points)} points of the capture"
    else:
        points, volume, rule = random_points(capture, box, count, seed=seed)
        colors = mean_colors(capture.train, points)
        size = np.full(len(points), RANDOM_DISTANCE * root(volume / len(points), 3))
    return around(points, size, colors, degree=degree), rule


def around(points: Array, size: Array, colors: Array, *, degree: int) -> Gaussians:
    """Round, faint Gaussians at points (N, 3) with scales (N,), of display colors (N, 3).

    In float32.

    Args:
        points: (N, 3).
        size: (N,) in meters.
        colors: (N, 3).
        degree: of the harmonics.

    Raises:
        RangeError: a degree that splats do not have.
    """
    harmonics = np.zeros((len(points), sh.count(degree), 3))
    harmonics[:, 0] = (colors - 0.5) / sh.Y_0
    return Gaussians(
        means=np.array(points, np.float64),
        log_scales=np.repeat(log(size)[:, None], 3, axis=1),
        quats=np.tile([1.0, 0.0, 0.0, 0.0], (len(points), 1)),
        opacity_logits=np.full(len(points), float(logits(np.array(FIRST_OPACITY)))),
        sh=harmonics,
    ).astype(np.float32)


def neighbor_distance(points: Array) -> Array:
    """(N,) root mean square distance to the nearest three other points, in meters, exact.

    Points that coincide get a distance of 1e-7 of the whole cloud's size.
    """
    points = np.asarray(points, np.float64)
    if len(points) <= NEIGHBORS:
        spread = float(np.ptp(points, axis=0).max()) if len(points) > 1 else 1.0
        return np.full(len(points), max(spread, 1e-7))
    found = np.empty(len(points))
    rows = max(1, _PAIRS_AT_ONCE // len(points))
    for start in range(0, len(points), rows):
        part = slice(start, start + rows)
        distance = np.zeros((len(points[part]), len(points)))
        for axis in points.T:
            gap = axis[part, None] - axis
            distance += np.multiply(gap, gap, out=gap)
        near = np.partition(distance, NEIGHBORS, axis=1)[:, : NEIGHBORS + 1]
        near.sort(axis=1)
        found[part] = near[:, 1:].mean(axis=1)  # the nearest is the point itself
    reach = np.linalg.norm(points - points.mean(axis=0), axis=1).max()
    min_distance = 1e-7 * max(float(reach), 1e-7)
    return np.maximum(np.sqrt(found), min_distance)


def random_points(
    capture: Capture, box: Array, count: int, *, seed: int
) -> tuple[Array, float, str]:
    """`count` points (N, 3) uniform in the box, or in the visual hull inside of it.

    Also the volume that they fill, in cubic meters, and a sentence on them.

    Args:
        capture: the photographs.
        box: (2, 3) of the scene.
        count: of points.
        seed: of their choice.
    """
    silhouettes = silhouettes_of(capture.train) if capture.has_alpha else []
    carve = bool(silhouettes) and mean_coverage(silhouettes) < CARVED
    silhouettes = _occupied(capture.train) if carve else []
    kept: list[Array] = []
    have = tried = 0
    while have < count and tried < MAX_TRIES * count:
        pixel = np.arange(tried, tried + count)[:, None]
        u = uniform(seed, step=0, pixel=pixel, sample=6, dimension=np.arange(3))
        points = box[0] + u * (box[1] - box[0])
        kept.append(points[_inside(silhouettes, points)])
        have, tried = have + len(kept[-1]), tried + count
    whole = float(np.prod(box[1] - box[0]))
    if have == 0:
        return points, whole, f"{count} random points of the box"
    found = np.concatenate(kept)[:count]
    where = "in the silhouettes of all views" if carve else "of the box"
    return found, whole * have / tried, f"{len(found)} random points {where}"


def mean_colors(views: Sequence[View], points: Array, *, max_views: int = 24) -> Array:
    """(N, 3) display colors: the mean of the pixels that points (N, 3) land on; gray for none.

    Nothing is hidden by anything here, which is good enough to begin with.

    Args:
        views: the photographs.
        points: (N, 3).
        max_views: at most so many, evenly spaced.
    """
    total, weight = np.zeros((len(points), 3)), np.zeros(len(points))
    for view in views[:: max(1, len(views) // max_views)]:
        rows, column, row = _landing(view.camera, points)
        rgba = view.rgba()[row, column].astype(np.float64)
        color = display_color(rgba[:, :3], view.color_space)
        total[rows] += color * rgba[:, 3:]
        weight[rows] += rgba[:, 3]
    found: Array = np.where(weight[:, None] > 0, total / np.maximum(weight, 1e-9)[:, None], 0.5)
    return found


def _occupied(views: Sequence[View]) -> list[tuple[Camera, Array]]:
    """Each camera with its pixels (H, W) that may show the object."""
    return [(view.camera, (view.rgba()[..., 3] > 0) | ~view.valid_mask()) for view in views]


def _inside(silhouettes: Sequence[tuple[Camera, Array]], points: Array) -> Array:
    """(N,) whether every picture that shows a point may show the object there."""
    alive = np.ones(len(points), np.bool_)
    for camera, occupied in silhouettes:
        rows, column, row = _landing(camera, points)
        alive[rows] &= occupied[row, column]
    return alive


def _landing(camera: Camera, points: Array) -> tuple[Array, Array, Array]:
    """Rows of the points that land in the picture, with their pixels' columns and rows."""
    pixels, depth = camera.project(points)
    with np.errstate(invalid="ignore"):
        shown = (depth > 0) & (pixels >= 0).all(axis=1)
        shown &= (pixels < [camera.width, camera.height]).all(axis=1)
    pixel = pixels[shown].astype(np.int64)
    return np.flatnonzero(shown), pixel[:, 0], pixel[:, 1]


def _some_points(capture: Capture, count: int, seed: int) -> tuple[Array, Array]:
    """At most `count` of the capture's points, and their display colors."""
    assert capture.points is not None
    points = np.asarray(capture.points, np.float64)
    if capture.point_colors is None:
        colors = np.full(points.shape, 0.5)
    else:
        colors = capture.point_colors / 255.0
    if len(points) <= count:
        return points, colors
    key = uniform(seed, step=0, pixel=np.arange(len(points)), sample=7)
    rows = np.sort(np.argsort(key, kind="stable")[:count])
    return points[rows], colors[rows]


# What the options of a fit mean for a scene of Gaussians.


def control_of(options: FitOptions) -> DensityControl:
    """The density control that the options name, from a tenth to three quarters of the steps.

    It acts some thirty times, and in long fits every 100 steps, as the authors' do.
    """
    steps = options.steps
    schedule = Schedule(
        first=min(500, steps // 10), last=3 * steps // 4, every=min(100, max(1, steps // 40))
    )
    if options.density_control == "mcmc":
        return MarkovChain(options.gaussians, seed=options.seed, schedule=schedule)
    if options.density_control == "clone_split_prune":
        return CloneSplitPrune(options.gaussians, schedule=schedule)
    return NoControl()


def scene_extent(capture: Capture, box: Array) -> float:
    """1.1 times the greatest distance of a camera from their mean, in meters [Kerbl2023].

    Cameras that all stand in one place say nothing: then half the diagonal of the box.

    Args:
        capture: whose cameras are asked.
        box: (2, 3) of the scene.
    """
    positions = np.array([view.camera.position for view in capture.train])
    spread = float(np.linalg.norm(positions - positions.mean(axis=0), axis=1).max())
    diagonal = norm(box[1] - box[0])
    return 1.1 * spread if spread > 0.05 * diagonal else 0.5 * diagonal
