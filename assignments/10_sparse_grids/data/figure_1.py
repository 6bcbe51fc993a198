"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

from contextlib import contextmanager

import numpy as np
from photograd_course.viz.handout import subplots

LEVELS = ((16, 8, 3), (32, 3, 8))  # pixels and voxels along a side, rounds, steps


def rays_of(photos):
    """Rays (2, R, 3) through all pixels, and their colors (R, 3)."""
    ends = [photo.rays() for photo in photos]
    origin, direction = (np.concatenate(each) for each in zip(*ends, strict=True))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    colors = np.concatenate([photo.colors.reshape(-1, 3) for photo in photos])
    return np.stack([origin, direction]), colors


def decibels(a, b):
    return float(-10 * np.log10(max(float(np.mean((a - b) ** 2)), 1e-30)))


def training(photographs, size, every=1):
    """Rays and colors of the photographs to recover from, made smaller."""
    photos = photographs.read(photographs.TRAINING)[::every]
    return rays_of(photographs.smaller(photos, size))


@contextmanager
def faster(module):
    """A higher learning rate of sigma: toys are opaque."""
    before = module.RATES.copy()
    module.RATES[3] = 2.0
    yield
    module.RATES[:] = before


def toys(module, photographs, grow):
    """(n, voxels, values) of the table with toys, recovered coarse to fine."""
    n = 16
    voxels = np.argwhere(np.ones((n, n, n), bool))
    values = np.tile(module.START, (len(voxels), 1))
    with faster(module):
        for size, rounds, steps in LEVELS:
            rays, target = training(photographs, size)
            if size > n:
                n, voxels, values = module.refine(n, voxels, values, rays, 0.05)
            voxels, values, _ = module.fit_sparse(
                n, voxels, values, rays, target, rounds, steps, 0.05, grow
            )
    return n, voxels, values


def show(axes, colors, title):
    """A square image of linear radiance."""
    side = round(len(colors) ** 0.5)
    screen = np.clip(colors, 0, 1).reshape(side, side, 3) ** (1 / 2.2)
    axes.imshow(screen, interpolation="nearest")
    axes.set(xticks=[], yticks=[], title=title)


def draw(module, photographs):
    """A held-out photograph; a sparse grid recovered from others; the same without dilation."""
    photo = photographs.read(photographs.HELD_OUT)[2]
    rays, truth = rays_of([photo])
    shown, scores, counts = [truth], [], []
    for grow in (1, 0):
        n, voxels, values = toys(module, photographs, grow)
        shown.append(module.render(values, module.march(n, voxels, rays)))
        scores.append(decibels(shown[-1], truth))
        counts.append(len(voxels))
    claims = {"with dilation more than 1 dB better": scores[0] - scores[1]}
    figure, panels = subplots(7.0, 2.65, 1, 3)
    titles = (
        "held-out photograph",
        f"recovered, {counts[0]:,} voxels: {scores[0]:.1f} dB",
        f"without dilation: {scores[1]:.1f} dB",
    )
    for axes, colors, title in zip(panels, shown, titles, strict=True):
        show(axes, colors, title)
    return figure, claims
