"""The final picture of Figure 1: several samples a pixel, averaged as a display shows them."""

import numpy as np


def large(module, height, width, side, settings, tones, samples=4, **options):
    """A picture (H, W, 3) of side x side samples a pixel.

    Bloom is computed from the mean radiance of a pixel, since it is linear; the tone curve is
    not, so each sample is shown before the mean is taken.

    Args:
        module: with the passes.
        height, width, side: of the picture; samples along each axis of a pixel.
        settings: (3,) of the ambient occlusion.
        tones: exposure and white, of the tone curve.
        samples: of the ambient occlusion, for each of the side x side.
        options: of `render`.
    """
    frame = module.render(side * height, side * width, settings, samples=samples, **options)
    radiance, cells = frame["radiance"], (height, side, width, side, 3)
    coarse = radiance.reshape(cells).mean(axis=(1, 3))
    spread = module.bloom(coarse, 2.0, width / 50, 0.6) - coarse
    lens = np.maximum(radiance + np.repeat(np.repeat(spread, side, axis=0), side, axis=1), 0)
    shown = np.clip(module.tone_map(lens, tones, np.zeros_like(lens))[0], 0, 1)
    return module.encode(shown.reshape(cells).mean(axis=(1, 3)))
