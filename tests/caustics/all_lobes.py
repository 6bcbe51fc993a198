"""Light behind a glass ball by all lobes up to a depth, without chance, and its derivative."""

from __future__ import annotations

from typing import Any

import numpy as np
from photograd.caustics import SpecularScene, SpecularSphere, trace_chains, trace_chains_backward
from photograd.caustics.chains import ENDED
from photograd.caustics.picture import camera_rays, sky, sky_backward
from photograd.transport import Environment
from photograd.transport.builtin import camera_at

SKY = Environment([1.0, 0.9, 0.8], [0.5, 0.6, 0.7], [0.1, 0.1, 0.1])
LOBES = [[1], *([0, *[1] * k, 0] for k in range(6))]  # 1 reflects; what is left has 1e-5 of light


class Ball:
    """A weighted mean over rays, as a function of the index, the center and the radius."""

    def __init__(self, side: int, field_of_view: float) -> None:
        camera = camera_at([0, 0.2, 4], [0, 0, 0], field_of_view, side, side)
        count = side * side
        self.o, self.d = camera_rays(camera, np.arange(count), np.full((count, 2), 0.5))
        y, x = np.mgrid[0:side, 0:side] / side
        self.weights = np.stack([1 + np.sin(5 * x + 3 * y)] * 3, axis=-1).reshape(-1, 3) / count

    def mean(self, p: Any) -> tuple[float, Any]:
        """The mean at p = (eta, center, radius), and its derivative (5,)."""
        scene = SpecularScene([SpecularSphere(p[1:4], float(p[4]), float(p[0]))])
        total, gradient = 0.0, np.zeros(5)
        for lobes in LOBES:
            u = np.tile(np.where([*lobes, 0], 0.0, 1.0 - 2.0**-53), (len(self.o), 1))
            chains = trace_chains(scene, self.o, self.d, u)
            share = ((chains.state == ENDED) & (chains.count == len(lobes))).astype(np.float64)
            if lobes == [1]:
                share[chains.count == 0] = 1.0  # past the ball, once
            for step in chains.steps:
                share[step.rays] *= step.pmf
            seen = (self.weights * sky(SKY, chains.direction)).sum(axis=1) * share
            total += float((seen * chains.factor).sum())
            d_sky = self.weights * (chains.factor * share)[:, None]
            d_direction = sky_backward(SKY, chains.direction, d_sky)
            given = (np.zeros_like(d_direction), d_direction, seen)
            (found,) = trace_chains_backward(scene, chains, *given)
            gradient += np.array([found.eta, *found.center, found.radius])
        return total, gradient

    def differences(self, p: Any, h: float) -> Any:
        """Central differences (5,) of the mean, with new hits everywhere."""
        ways = h * np.eye(5)
        return np.array([self.mean(p + w)[0] - self.mean(p - w)[0] for w in ways]) / (2 * h)
