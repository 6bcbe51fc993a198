"""Two estimates of one derivative of light transport, and whether they agree.

J(p) = <v, L(p)>: a random cotangent v on a small picture L of the parameter p.

    adjoint       dJ/dp of `render_backward`, paths replayed, their sampling detached
    differences   D(h) = (J(p + h) - J(p - h)) / 2h, pictures of one seed each, whose paths go where
                  p leads them, as anybody would do it from outside

Both are means over batches, each with a seed of its own, and the spread of the batches gives the
error of the mean; they share no seed. Steps are long, since paths that choose another lobe at p + h
than at p - h are noise in proportion to 1 / sqrt(h). What a step costs,

    cut           (4 D(h/2) - D(h)) / 3 - D(h), up to the order h^4

is a property of the mean J, not of its paths: it is estimated with paths held where p puts them,
which has little noise, and added to D(h).
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from photograd.transport import Accumulation, PathOptions, PathTracer

from tests.transport.difference_rows import PATHS, Case, Row

Array = Any
SPP = 512  # of a batch
LEAST = 8  # batches
WAYS = ("adjoint", "differences", "cut", "signs")  # each with random numbers of its own
TOLERANCE = 0.01  # of the derivative
ENOUGH = 0.002  # relative standard error of each estimate: 0.3 % together


@dataclass(frozen=True)
class Estimate:
    """A mean, its standard error and the number of batches it is of."""

    mean: float
    error: float
    batches: int


NONE = Estimate(0.0, 0.0, 0)


def more(known: Estimate, batches: list[float]) -> Estimate:
    """An estimate from its batches so far and new ones."""
    n, m = known.batches, len(batches)
    count = n + m
    mean = (n * known.mean + sum(batches)) / count
    squares = known.error**2 * n * (n - 1) + n * (known.mean - mean) ** 2
    squares += float(((np.array(batches) - mean) ** 2).sum())
    return Estimate(mean, float(np.sqrt(squares / (count * (count - 1)))), count)


def settled(
    draw: Callable[[int], float],
    known: Estimate,
    enough: float,
    most: int,
    size: float = 0.0,
    least: int = LEAST,
) -> Estimate:
    """An estimate of at least so many batches `draw(b)`, going on from what is known.

    Half as many again each time, until the error is at most `enough` of the mean, or of `size`.
    """
    while known.batches < least or known.error > enough * (size or abs(known.mean)):
        count = min(most, max(least, known.batches + (known.batches + 1) // 2))
        if count <= known.batches:
            break
        known = more(known, [draw(b) for b in range(known.batches, count)])
    return known


class Bench:
    """A row of a case, ready to be measured."""

    def __init__(self, case: Case, row: Row, *, spp: int = SPP, paths: PathOptions = PATHS) -> None:
        """Build its scene and draw its cotangent.

        v (H, W, 3) is random between 1/2 and 3/2, with the sign of the derivative in each pixel and
        channel: else what falls cancels what rises, and millions of paths show nothing.
        """
        self.case, self.row, self.spp, self.paths = case, row, spp, paths
        self.number = zlib.crc32(row.name.encode())
        self.tracer = PathTracer(case.scene(), dtype=np.float64, allow_incomplete=case.refused)
        self.start = {key: value.copy() for key, value in self.tracer.params.items()}
        shape = (self.tracer.scene.camera.height, self.tracer.scene.camera.width, 3)
        size = 0.5 + np.random.default_rng(self.number).random(shape)
        ends = [self.moved(sign * row.step, self.seed("signs", 0), SPP) for sign in (-1, 1)]
        self.v = np.where(ends[1] < ends[0], -size, size) / (shape[0] * shape[1])

    def seed(self, way: str, batch: int) -> int:
        """That of no other row, way or batch."""
        return (self.number << 20) + (WAYS.index(way) << 17) + batch

    def moved(self, by: float, seed: int, spp: int, *, held: bool = False) -> Array:
        """L (H, W, 3) at p + by, its paths drawn for that, or `held` where p puts them."""
        value = self.start[self.row.key].copy()
        value[self.row.place] += by
        self.tracer.params = {**self.start, self.row.key: value}
        sums = Accumulation.empty(*self.v.shape[:2]) if held else None
        if sums is None:
            return self.tracer.render(spp=spp, seed=seed, options=self.paths).mean
        self.tracer.add_samples(
            sums, spp, seed=seed, options=self.paths, sampling_params=self.start
        )
        return sums.mean

    def gradient(self, batch: int) -> float:
        """dJ/dp, one batch of the adjoint."""
        self.tracer.params = dict(self.start)
        found = self.tracer.render_backward(
            self.v, spp=self.spp, seed=self.seed("adjoint", batch), options=self.paths
        )
        return float(found[self.row.key][self.row.place])

    def slope(self, h: float, seed: int, *, held: bool = False) -> float:
        """D(h), one batch."""
        ends = [self.moved(sign * h, seed, self.spp, held=held) for sign in (-1, 1)]
        return float((self.v * (ends[1] - ends[0])).sum()) / (2 * h)

    def bend(self, batch: int) -> float:
        """What is to be added to D(h), one batch."""
        held = not self.case.refused  # there, paths that are held lead to another mean
        seed, h = self.seed("cut", batch), self.row.step
        return 4 / 3 * (self.slope(h / 2, seed, held=held) - self.slope(h, seed, held=held))

    def cut(self, known: Estimate, enough: float, most: int, size: float) -> Estimate:
        """The same, to a part of `size`, the derivative."""
        return settled(self.bend, known, enough, most, size, LEAST // 2)

    def adjoint(self, known: Estimate = NONE, enough: float = 0.0, most: int = LEAST) -> Estimate:
        """The derivative that is on trial."""
        return settled(self.gradient, known, enough, most)

    def differences(
        self, known: Estimate = NONE, enough: float = 0.0, most: int = LEAST
    ) -> Estimate:
        """D(h), without its cut."""
        h = self.row.step
        return settled(lambda b: self.slope(h, self.seed("differences", b)), known, enough, most)
