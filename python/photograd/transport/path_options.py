"""How paths of light are looked for: the options of all that trace them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from photograd._checks import require_choices
from photograd.errors import RangeError, message

Strategy = Literal["light", "bsdf", "mis"]
Heuristic = Literal["balance", "power"]
Sampler = Literal["independent", "even"]
# In the core's order.
STRATEGIES: tuple[Strategy, ...] = get_args(Strategy)
HEURISTICS: tuple[Heuristic, ...] = get_args(Heuristic)
SAMPLERS: tuple[Sampler, ...] = get_args(Sampler)
NEVER = 1 << 20  # a vertex that no path reaches


@dataclass(frozen=True)
class PathOptions:
    """How light is looked for.

    Attributes:
        strategy: "light" asks a light at every vertex; "bsdf" counts what a path meets by chance,
            and asks only what it cannot meet (point, spot, directional lights); "mis" does both and
            shares out the weight.
        heuristic: how "mis" does so: "balance" or "power".
        max_depth: segments of the longest path; 1 sees lights alone, 2 is direct light. Passing
            straight through what covers only in part (alpha, a mask's hole) ends a segment, too.
        roulette_from: the first vertex at which a path may end by chance; None never ends one.
        sampler: "even" spreads the random numbers of a pixel's samples as scrambled Sobol' points
            do, most evenly for powers of two of them; "independent" does not. Only with the latter
            is `Accumulation.standard_error` the error; with the former it is more than that.

    Raises:
        RangeError: none of these.
    """

    strategy: Strategy = "mis"
    heuristic: Heuristic = "power"
    max_depth: int = 64
    roulette_from: int | None = 4
    sampler: Sampler = "even"

    def __post_init__(self) -> None:
        require_choices(self)
        if not 1 <= self.max_depth <= 4096:
            raise RangeError(message("PathOptions", "max_depth", "1 to 4096", self.max_depth))
        if self.roulette_from is not None and self.roulette_from < 0:
            got = self.roulette_from
            raise RangeError(message("PathOptions", "roulette_from", "at least 0", got))

    def numbers(self, seed: int) -> tuple[int, int, int, int, int, int]:
        """As the core takes them."""
        late = NEVER if self.roulette_from is None else self.roulette_from
        strategy, heuristic = STRATEGIES.index(self.strategy), HEURISTICS.index(self.heuristic)
        sampler = SAMPLERS.index(self.sampler)
        return strategy, heuristic, self.max_depth, late, sampler, seed


DEFAULTS = PathOptions()
