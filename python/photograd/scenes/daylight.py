"""The light that the built-in scenes share: a warm, slightly large sun in a blue sky.

With it a white surface that faces the sun reflects a radiance a little below 1, which is display
white: the pictures use their range, and next to nothing is clipped.
"""

from __future__ import annotations

import numpy as np

from photograd.scenes.description import SkyDescription, SunDescription


def warm_sun(*, towards: tuple[float, float, float] = (0.55, 0.75, 0.5)) -> SunDescription:
    """A sun of 0.05 rad, ten times the real one's, so that shadows have soft edges."""
    irradiance = np.array([2.4, 2.0, 1.5])
    return SunDescription.from_irradiance(np.asarray(towards), irradiance, 0.05)


def blue_sky() -> SkyDescription:
    """Blue above, pale at the horizon, and the warm grey of lit ground below."""
    return SkyDescription(
        zenith=np.array([0.3, 0.45, 0.76]),
        horizon=np.array([0.62, 0.7, 0.8]),
        ground=np.array([0.36, 0.31, 0.25]),
    )
