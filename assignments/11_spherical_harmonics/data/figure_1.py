"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

from contextlib import contextmanager

import numpy as np
from photograd_course.metrics import psnr
from photograd_course.viz.handout import subplots


@contextmanager
def rate(module, value, samples=24):
    """Another learning rate, as the teapot is opaque, and more samples on a ray."""
    before = module.RATE, module.SAMPLES
    module.RATE, module.SAMPLES = value, samples
    yield
    module.RATE, module.SAMPLES = before


def recovered_teapot(module, teapot, k):
    """(density, coefficients) with k coefficients, on 16^3 cells, from photographs."""
    rays, target = teapot.photographs(30, 16)
    start = np.full((4, 4, 4), 0.1), np.zeros((4, 4, 4, k, 3))
    start[1][..., 0, :] = 1.8  # gray: black fog before black would change no pixel
    with rate(module, 0.2):
        found = module.fit_plenoxels(*start, rays, target, 3, 12)[:2]
    with rate(module, 0.05):
        return module.fit_plenoxels(*found, rays, target, 1, 16)[:2]


def seen(module, volume, rays):
    return module.render(*volume, module.march(volume[0].shape, rays))


def draw(module, teapot):
    """Views of a teapot that were held out; recovered; and recovered with degree 0."""
    size = 72
    rays, truth = teapot.photographs(3, size, 0.7)
    volumes = [recovered_teapot(module, teapot, k) for k in (9, 1)]
    with rate(module, module.RATE):
        views = [seen(module, each, rays) for each in volumes]
    scores = [psnr(each, truth) for each in views]
    claims = {
        "with harmonics more than 22 dB": scores[0],
        "degree 0 loses more than 0.5 dB": scores[0] - scores[1],
    }
    figure, panels = subplots(6.0, 6.0, 3, 3)
    names = ("held out", f"recovered: {scores[0]:.1f} dB", f"degree 0: {scores[1]:.1f} dB")
    for row, colors, name in zip(panels, (truth, *views), names, strict=True):
        for axes, picture in zip(row, colors.reshape(3, size, size, 3), strict=True):
            axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2), interpolation="nearest")
            axes.set(xticks=[], yticks=[])
        row[0].set_ylabel(name)
    return figure, claims
