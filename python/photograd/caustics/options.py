"""What a caustic design can be told."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from photograd._checks import require_bounds, require_choices
from photograd._typed import typed_call

Start = Literal["transport", "plane"]
RATES: dict[Start, tuple[float, float]] = {"transport": (0.01, 10.0), "plane": (0.3, 300.0)}
"""Learning rate and smoothness for each start."""


@typed_call
@dataclass(frozen=True)
class CausticOptions:
    """How heights are found.

    Attributes:
        start: "transport" begins at the lens of optimal transport (`transport_lens`), "plane" at
            the heights that the lenses have.
        steps: of gradient descent.
        rays: along each axis for each cell of the receiver.
        learning_rate: of Adam: about the slope that a step changes at first. None takes 0.01 from
            transport, 0.3 from a plane.
        smoothness: of a step, squared reach in vertices. None takes 10 and 300.
        final_rate: the part of the learning rate that is left at the last step.
        seed: of the places of rays.

    Raises:
        RangeError: counts below 1, rates that are not positive, or an unknown start.
    """

    start: Start = "transport"
    steps: int = 200
    rays: int = 2
    learning_rate: float | None = None
    smoothness: float | None = None
    final_rate: float = 0.03
    seed: int = 0

    def __post_init__(self) -> None:
        require_choices(self)
        require_bounds(self, "steps", "rays", low=1)
        require_bounds(self, "learning_rate", "final_rate", above=0)
        require_bounds(self, "smoothness", "seed", low=0)

    @property
    def rates(self) -> tuple[float, float]:
        """Learning rate and smoothness."""
        rate, smoothness = RATES[self.start]
        given = self.learning_rate, self.smoothness
        return (
            rate if given[0] is None else given[0],
            smoothness if given[1] is None else given[1],
        )
