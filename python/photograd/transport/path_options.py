"""Options of the path tracer, and of all that trace paths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from photograd._arrays import Arguments
from photograd._checks import require_bounds, require_choices, require_instance
from photograd._typed import typed_call
from photograd.capture.camera import Camera

Strategy = Literal["light", "bsdf", "mis"]
Heuristic = Literal["balance", "power"]
Sampler = Literal["independent", "sobol"]
# In the core's order.
STRATEGIES: tuple[Strategy, ...] = get_args(Strategy)
HEURISTICS: tuple[Heuristic, ...] = get_args(Heuristic)
SAMPLERS: tuple[Sampler, ...] = get_args(Sampler)
NEVER = 1 << 20  # a vertex that no path reaches


@typed_call
@dataclass(frozen=True)
class PathOptions:
    """How light paths are sampled.

    Attributes:
        strategy: "light" is next event estimation, which samples a light at every vertex; "bsdf"
            samples the BSDF and counts the emitters that paths hit, with next event estimation only
            for those that no path can hit (point, spot, directional lights); "mis" is multiple
            importance sampling of both.
        heuristic: weights of "mis": the "balance" or the "power" heuristic.
        max_depth: segments of the longest path; 1 is emission alone, 2 adds direct light. Passing
            straight through a partly opaque surface (alpha, a mask's hole) ends a segment, too.
        roulette_from: the first vertex with Russian roulette; None for none.
        sampler: "sobol" takes the random numbers of a pixel's samples from scrambled Sobol' points,
            which are most uniform for powers of two of them; "independent" does not stratify. Only
            with the latter is `Accumulation.standard_error` the error; with the former it is an
            upper bound.

    Raises:
        RangeError: none of these.
    """

    strategy: Strategy = "mis"
    heuristic: Heuristic = "power"
    max_depth: int = 64
    roulette_from: int | None = 4
    sampler: Sampler = "sobol"

    def __post_init__(self) -> None:
        require_choices(self)
        require_bounds(self, "max_depth", low=1, high=4096)
        require_bounds(self, "roulette_from", low=0)

    def numbers(self, seed: int) -> tuple[int, int, int, int, int, int]:
        """As the core takes them.

        Args:
            seed: of all random numbers.

        Raises:
            DtypeError, RangeError: no whole number, or none from 0 to 2^64 - 1.
        """
        seed = Arguments("PathTracer").integer("seed", seed, low=0, high=(1 << 64) - 1)
        late = NEVER if self.roulette_from is None else self.roulette_from
        strategy, heuristic = STRATEGIES.index(self.strategy), HEURISTICS.index(self.heuristic)
        sampler = SAMPLERS.index(self.sampler)
        return strategy, heuristic, self.max_depth, late, sampler, seed


DEFAULTS = PathOptions()


def checked_view(function: str, own: Camera, camera: Camera | None, options: PathOptions) -> Camera:
    """The camera of a rendering.

    Args:
        function: on whose behalf the error speaks.
        own: of the scene.
        camera: that was given, or None.
        options: that were given.

    Raises:
        DtypeError: no `Camera`, or no `PathOptions`.
    """
    require_instance(function, "options", options, PathOptions)
    if camera is None:
        return own
    remedy = "pass its .camera" if hasattr(camera, "camera") else None
    require_instance(function, "camera", camera, Camera, remedy)
    return camera
