"""Task 06.4, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for

from .common import FAITHFUL

check = checks_for(calls=("bloom",), tolerance=FAITHFUL)


def bloomed(t, radiance, *rest):
    """`bloom` of the submission."""
    return t.call("bloom", radiance, *rest, returns=Array(radiance.shape))


def gaussian(sigma):
    """Values of the Gaussian at whole numbers up to 3 sigma, of the sum 1."""
    most = int(np.ceil(3 * sigma))
    values = np.exp(-(np.arange(-most, most + 1.0) ** 2) / (2 * sigma * sigma))
    return values / values.sum()


@check(
    "06.4.impulse",
    points=3,
    hint="handout, equations (16) to (18): a Gaussian of sum 1 in each direction, up to 3 sigma",
    sole="a closed form, one channel at a time",
)
def a_bright_pixel(t):
    """One bright pixel becomes the product of two Gaussians; the pixel itself loses as much."""
    for sigma, (row, column), channel in ((1.2, (8, 9), 0), (2.0, (9, 10), 2), (0.3, (4, 7), 1)):
        picture = np.full((19, 21, 3), 0.5)
        picture[row, column, channel] = 6.0
        k = gaussian(sigma)
        right, most = picture.copy(), len(k) // 2
        rows, columns = slice(row - most, row + most + 1), slice(column - most, column + most + 1)
        right[rows, columns, channel] += 0.4 * 5.0 * np.outer(k, k)
        right[row, column, channel] -= 0.4 * 5.0
        t.close(f"sigma {sigma}", bloomed(t, picture, 1.0, sigma, 0.4), right, reveal=True)


@check(
    "06.4.separable",
    points=3,
    hint="handout, equation (17): two blurs, one along rows, one along columns",
    sole="two passes are the whole kernel, borders included",
)
def two_passes_are_the_full_kernel(t):
    """Any picture: the same as a sum over the full kernel in two dimensions; outside is black."""
    for (height, width), sigma in (((11, 14), 1.5), ((13, 6), 2.4)):
        picture = t.rng.uniform(0.0, 4.0, (height, width, 3))
        bright = np.maximum(picture - 1.5, 0.0)
        k = gaussian(sigma)
        most = len(k) // 2
        full, wide = np.outer(k, k), np.pad(bright, ((most, most), (most, most), (0, 0)))
        spread = np.zeros_like(bright)
        for v, u in np.ndindex(full.shape):
            spread += full[v, u] * wide[v : v + height, u : u + width]
        right = picture + 0.7 * (spread - bright)
        t.close(f"{height} x {width}", bloomed(t, picture, 1.5, sigma, 0.7), right)


@check(
    "06.4.conserved",
    points=2,
    hint="handout, equation (18): what is spread is taken from where it was",
    sole="light is moved; what is not bright stays",
)
def light_is_moved_not_added(t):
    """Far from borders the sum of all light stays; a picture without bright pixels is unchanged."""
    picture = np.zeros((40, 44, 3))
    picture[14:26, 15:29] = t.rng.uniform(0.0, 9.0, (12, 14, 3))
    got = bloomed(t, picture, 2.0, 3.0, 0.8)
    t.close("sum of the light", got.sum(axis=(0, 1)), picture.sum(axis=(0, 1)), reveal=True)
    t.require(bool((np.abs(got - picture) > 1e-3).any()), "bright light is spread")
    dim = t.rng.uniform(0.0, 2.0, (7, 9, 3))
    t.close("a picture without bright pixels", bloomed(t, dim, 2.0, 3.0, 0.8), dim)
