"""What a ball of clear glass does to parallel light, by its rays in one plane."""

from __future__ import annotations

import numpy as np


def fresnel(eta: float, cosine: np.ndarray) -> np.ndarray:
    """Reflected part of unpolarised light that enters an index `eta` from 1."""
    inside = np.sqrt(1 - (1 - cosine**2) / eta**2)
    s = (cosine - eta * inside) / (cosine + eta * inside)
    p = (eta * cosine - inside) / (eta * cosine + inside)
    return 0.5 * (s**2 + p**2)


def share_of_ring(radius: np.ndarray, half: float) -> np.ndarray:
    """The part of a circle around the middle of a square of half edge `half` inside of it."""
    corner = np.arccos(np.clip(half / np.maximum(radius, half), 0, 1))
    inside: np.ndarray = np.clip(1 - 4 * corner / np.pi, 0, 1)
    return inside


def flux_below_ball(
    radius: float,
    height: float,
    half: float,
    *,
    eta: float = 1.5,
    orders: int = 24,
    rays: int = 40_000,
) -> float:
    """Watts through a square (2 half)^2 below a ball, for light of 1 W/m^2 from straight above.

    The ball's center is `height` above the middle of the square. A ray that meets the ball at the
    angle a, counted from the top, goes on inside at the angle t; each chord advances its place by
    pi - 2 t, and it always leaves at the angle a to the outward normal. Light that passes beside
    the ball is counted as well: its shadow must lie in the square, or the square in its shadow.
    Nothing is below the square.
    """
    assert half >= radius or half * np.sqrt(2) <= radius
    sine = (np.arange(rays) + 0.5) / rays
    a, t = np.arcsin(sine), np.arcsin(sine / eta)
    reflected = fresnel(eta, np.cos(a))
    ring = 2 * np.pi * radius**2 * sine / rays  # area of the rays of this sine, m^2
    total = max(0.0, 4 * half**2 - np.pi * radius**2)
    for order in range(orders):
        place = a + order * (np.pi - 2 * t)
        way = place + a
        weight = reflected if order == 0 else (1 - reflected) ** 2 * reflected ** (order - 1)
        falling = -np.cos(way)
        down = falling > 1e-9
        far = (height + radius * np.cos(place)) / np.where(down, falling, 1.0)
        landed = np.abs(radius * np.sin(place) + far * np.sin(way))
        total += float((ring * weight * share_of_ring(landed, half))[down].sum())
    return float(total)
