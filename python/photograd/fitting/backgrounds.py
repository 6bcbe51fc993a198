"""What stands behind the scene while it is fitted: random, white, black, or learned with it.

Random backgrounds keep a fit from painting the background into the scene instead of leaving space
empty: only opacity can then explain a pixel. Photographs without alpha have no such freedom; there
one colour for all directions is learned, as sigmoid(raw) so that it stays in (0, 1).
"""

from __future__ import annotations

import numpy as np
from photograd_course.color import srgb_decode
from photograd_course.portable_math import log, sigmoid
from photograd_course.random import uniform

from photograd.types import Array


def background_kind(option: str, *, has_alpha: bool) -> str:
    """What "auto" means: random where the photographs have alpha, else learned."""
    if option == "auto":
        return "random" if has_alpha else "learned"
    return option


def first_background(mean: Array) -> Array:
    """Raw parameter (3,) float32 to start a learned background from.

    `mean` (4,) is the mean pixel: linear premultiplied colour, and alpha.
    """
    return raw_background(np.clip(mean[:3] / max(mean[3], 1e-6), 0.02, 0.98))


def raw_background(color: Array) -> Array:
    """Raw parameter (3,) float32 whose `learned_background` is this linear colour in (0, 1)."""
    return log(color / (1 - color)).astype(np.float32)


def learned_background(raw: Array) -> Array:
    """Linear colour (3,) of the raw parameter (3,): sigmoid(raw)."""
    return sigmoid(raw)


def learned_background_backward(raw: Array, d_color: Array) -> Array:
    """d_raw = d_color * color * (1 - color)."""
    color = learned_background(raw)
    d_raw: Array = d_color * color * (1 - color)
    return d_raw


def random_background(count: int, *, seed: int, step: int, first: int = 0) -> Array:
    """Linear colours (R, 3) float32, uniform in display values, for rays first .. first + R - 1."""
    index = 3 * first + np.arange(3 * count)
    u = uniform(seed, step=step, pixel=index, sample=1, dimension=0)
    return srgb_decode(u.reshape(count, 3)).astype(np.float32)


def constant_background(kind: str) -> Array:
    """Linear (3,) float32 of "white" or "black"."""
    return np.full(3, {"white": 1.0, "black": 0.0}[kind], np.float32)
