"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.style import signed_color_map


def planet(n):
    """(truth, guess, masks): a planet with a ring; the guess has a moon and no ring."""
    axis = (np.arange(n) + 0.5) / n * 2 - 1
    place = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    pole = np.array([0.32, 0.86, 0.4]) / np.linalg.norm([0.32, 0.86, 0.4])
    light = np.array([-0.6, 0.5, 0.62])
    height = place @ pole
    around = np.sqrt(np.maximum(np.sum(place**2, axis=-1) - height**2, 0))
    ball = np.sum(place**2, axis=-1) < 0.46**2
    ring = (np.abs(around - 0.76) < 0.17) & (np.abs(height) < 1.5 / n) & ~ball
    aside = np.linalg.norm(place - [0.7, -0.72, 0.0], axis=-1)
    truth = np.zeros((n, n, n, 4))
    bands = 0.5 + 0.5 * np.sin(22 * height + 1.5 * np.sin(5 * height))
    lit = 0.12 + 0.88 * np.clip(place @ light / 0.46, 0, 1)
    paint = np.array([0.95, 0.75, 0.45]) + bands[..., None] * [-0.3, -0.38, -0.28]
    grooves = 0.8 + 0.2 * np.cos(37 * (around - 0.76))
    truth[..., :3] = grooves[..., None] * [0.8, 0.72, 0.6]
    inner = np.sum(place**2, axis=-1) < 0.52**2
    truth[inner, :3] = (lit[..., None] * paint)[inner]
    truth[aside < 0.25, :3] = (0.35, 0.5, 0.7)
    truth[ball, 3] = 30.0
    guess = truth.copy()
    truth[ring, 3], guess[aside < 0.18, 3] = 20.0, 8.0
    return truth, guess, [ball, ring, aside < 0.18]


def grown(mask):
    """The mask and all voxels within two of it, whole columns along z."""
    flat = mask.any(axis=2)
    for _ in range(2):
        wide = np.pad(flat, 1)
        flat = wide[:-2, 1:-1] | wide[2:, 1:-1] | wide[1:-1, :-2] | wide[1:-1, 2:] | flat
    return np.repeat(flat[:, :, None], mask.shape[2], axis=2)


def draw(module):
    """A photographed volume, a wrong guess, and the derivative of the loss w.r.t. sigma."""
    truth, guess, (ball, ring, moon) = planet(44)
    pixels, low, high = 132, -np.ones(3), np.ones(3)
    side = (np.arange(pixels) + 0.5) / pixels * 2 - 1
    y, x = np.meshgrid(-side, side, indexing="ij")
    origins = np.stack([x.ravel(), y.ravel(), np.full(pixels**2, 3.0)], axis=1)
    directions = np.tile([0.0, 0.0, -1.0], (pixels**2, 1))
    view = (low, high, origins, directions, 66, np.array([0.02, 0.02, 0.04]))
    photograph, seen = (module.render_rays(volume, *view) for volume in (truth, guess))
    slope = module.render_adjoint(guess, *view, 2 / len(seen) * (seen - photograph))[0][..., 3]
    nowhere = ~grown(ball | ring | moon)
    lacking, excess = slope[ring], slope[moon]
    claims = {
        "over 95 % of the ring's summed |derivative| is negative": -lacking[lacking < 0].sum()
        / max(np.abs(lacking).sum(), 1e-300),
        "over 95 % of the moon's summed |derivative| is positive": excess[excess > 0].sum()
        / max(np.abs(excess).sum(), 1e-300),
        "far from planet, ring and moon it is below a thousandth": np.abs(slope[nowhere]).max()
        / np.abs(slope).max(),
        "photograph and guess differ": np.abs(seen - photograph).max(),
    }
    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2, 1))
    panels = [figure.add_subplot(place) for place in (grid[:, 0], grid[0, 1], grid[1, 1])]
    for axes, values in zip(panels, (photograph, seen), strict=False):
        picture = np.clip(values, 0, 1).reshape(pixels, pixels, 3) ** (1 / 2.2)
        axes.imshow(picture, interpolation="nearest")
    columns = slope.sum(axis=2).T[::-1]
    top = float(np.quantile(np.abs(columns), 0.995))
    image = panels[2].imshow(columns / top, cmap=signed_color_map(), vmin=-1, vmax=1)
    titles = ("a volume, by your renderer", "a guess", "∂L/∂σ, summed along z")
    for axes, title in zip(panels, titles, strict=True):
        axes.set(xticks=[], yticks=[], title=title)
    bar = figure.colorbar(image, ax=panels[2], ticks=[-1, 1], shrink=0.8)
    bar.set_ticklabels(["add", "remove"])
    return figure, claims
