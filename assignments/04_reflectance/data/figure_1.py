"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.color import srgb_encode

LIGHTS = (((-0.5, 0.6, 0.62), 1.0), ((0.8, 0.1, 0.35), 0.35), ((0.1, -0.7, 0.5), 0.15))


def unit(v):
    """A vector of length 1."""
    return np.array(v) / np.linalg.norm(v)


def ball(module, size, color, m, r):
    """Radiance (size, size, 3) of a ball under three lights; NaN beside it."""
    inside, frame = module.ball(size)
    wo = frame[:, :, 2]
    n = len(wo)
    total = 0
    for place, strength in LIGHTS:
        wi = frame @ unit(place)
        f = module.gltf(wo, wi, np.tile(color, (n, 1)), np.full(n, m), np.full(n, r))
        total = total + f * np.clip(wi[:, 2:], 0, None) * np.pi * strength
    image = np.full((size, size, 3), np.nan)
    image[inside] = total
    return image


def draw(module):
    """Balls of the material: roughness to the right, metalness downward."""
    color = np.array([0.9, 0.45, 0.12])
    roughs, metals = (0.15, 0.3, 0.45, 0.65, 1.0), (0.0, 0.5, 1.0)
    size = 139
    balls = {(m, r): ball(module, size, color, m, r) for m in metals for r in roughs}
    peak = {
        key: ball[np.unravel_index(np.nanargmax(ball.sum(axis=2)), ball.shape[:2])]
        for key, ball in balls.items()
    }
    off = [np.nanmax(np.abs(balls[0.5, r] - (balls[0.0, r] + balls[1.0, r]) / 2)) for r in roughs]
    gold, white = peak[1.0, 0.3], peak[0.0, 0.15]
    falls = [peak[1.0, r].max() for r in roughs]
    claims = {
        "each pixel of half metal is the mean of those above and below": np.max(off),
        "the metal's highlight has the base color": np.abs(gold / gold[0] - color / color[0]).max(),
        "the coating's highlight is nearly white": white[2] / white[0],
        "the metal's highlight gets darker to the right": (np.diff(falls) < 0).all(),
    }
    figure = Figure(figsize=(7.0, 4.15))
    for row, m in enumerate(metals):
        for column, r in enumerate(roughs):
            axes = figure.add_axes((0.087 + column * 0.183, 0.645 - row * 0.32, 0.181, 0.31))
            picture = np.nan_to_num(srgb_encode(np.clip(balls[m, r], 0, 1)), nan=1.0)
            # Fewer levels make a smaller file.
            axes.imshow(np.round(picture * 42) / 42, interpolation="nearest")
            axes.set_axis_off()
            if row == 0:
                axes.set_title(f"roughness {r:g}", fontsize=8, pad=2)
        figure.text(0.008, 0.78 - row * 0.32, f"metalness\n{m:g}", fontsize=8)
    return figure, claims
