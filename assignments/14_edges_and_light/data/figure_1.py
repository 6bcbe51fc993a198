"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.style import BLUE, GRAY

LETTERS = "PG"


CURVE, WIDTH = np.array([[2.5, 4.0], [10.0, -1.0], [12.0, 12.0]]), 2.2


def close_up(points):
    """Points of a closed line: the first one again at the end."""
    return np.concatenate([points, points[:1]])


def blob(count=80):
    """The outline of a leaf-like shape in a picture of 28 x 28 pixels."""
    angle = np.arange(count) * 2 * np.pi / count
    radius = 8 + 2.2 * np.sin(2 * angle + 0.6) + 1.1 * np.sin(3 * angle + 2)
    return 14 + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def circle(count, radius, center=14.0):
    """A regular polygon."""
    angle = np.arange(count) * 2 * np.pi / count
    return center + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def overlap(module, found, picture):
    """Intersection over union of a polygon and a picture."""
    shown = module.polygon_image(found, *picture.shape)
    return float(np.minimum(shown, picture).sum() / max(np.maximum(shown, picture).sum(), 1e-9))


def likeness(shown, picture):
    """Correlation of two pictures; 0 where one is not finite."""
    if not np.isfinite(shown).all():
        return 0.0
    return float(np.corrcoef(shown.ravel(), picture.ravel())[0, 1])


def draw(module):
    """A caustic of two letters; its lens; a silhouette and a stroke, recovered."""
    target = module.letters_image(LETTERS, 32)
    heights, _ = module.design_caustic(target, 64, 60)
    shown = module.splat(module.landing_points(heights), 32)
    light = module.splat(module.landing_points(module.finer(heights, 3)), 96)
    outline, start = blob(), circle(24, 4.5)
    picture = module.polygon_image(outline, 28, 28)
    found, _ = module.recover_polygon(picture, start, 90, 3, 800, 0.3)
    stroke = module.stroke_image(CURVE, WIDTH, 15, 15)
    guess = CURVE - np.array([[1, -1.5], [1, -1], [1, 1]])
    curve, width = module.recover_stroke(stroke, guess, 1.5, 120)
    coarse = light.reshape(32, 3, 32, 3).mean(axis=(1, 3))
    claims = {
        "the design has the letters": likeness(shown, target),
        "with nine times the rays as well": likeness(coarse, target),
        "the outline overlaps by 0.97 or more": overlap(module, found, picture),
        "the width within 1 %": abs(width / WIDTH - 1),
    }
    figure = Figure(figsize=(7.0, 4.4), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=(1.15, 1.15, 1, 1))
    axes = figure.add_subplot(grid[:, :2])
    glow = np.clip(light / 6, 0, 1) ** (1 / 2.2)
    axes.imshow(np.round(glow * 40) / 40, cmap="gray", vmin=0, vmax=1, interpolation="nearest")
    axes.set(xticks=[], yticks=[], title="light behind the lens")
    axes = figure.add_subplot(grid[0, 2:])
    axes.imshow(picture, cmap="Greys", vmin=0, vmax=1.6, extent=(0, 28, 28, 0))
    axes.plot(*close_up(start).T, color=GRAY)
    axes.plot(*close_up(found).T, "o-", color=BLUE, markersize=2.5)
    axes.set(xticks=[], yticks=[], title="a silhouette")
    axes = figure.add_subplot(grid[1, 2])
    axes.imshow(stroke, cmap="Greys", vmin=0, vmax=1.6, extent=(0, 15, 15, 0))
    t = np.linspace(0, 1, 60)
    axes.plot(*module.bezier(guess, t).T, color=GRAY)
    axes.plot(*module.bezier(curve, t).T, color=BLUE)
    axes.set(xticks=[], yticks=[], title="a stroke", xlim=(0, 15), ylim=(15, 0))
    axes = figure.add_subplot(grid[1, 3])
    axes.imshow(heights - heights.mean(), cmap="viridis")
    axes.set(xticks=[], yticks=[], title="the lens")
    return figure, claims
