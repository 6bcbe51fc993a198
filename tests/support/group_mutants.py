"""Mutants that are wrong in one group of parameters, looked at in that group alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from photograd_course.gradcheck import check_gradient
from photograd_course.mutants import Mutant

Groups = Mapping[str, Any]


def survives(
    forward: Callable[[dict[str, Any]], Any], place: Groups, mutant: Mutant, *, seed: int
) -> bool:
    """Whether a wrong backward function passes for right at a place {group: array}.

    There are fewer probes than for the right one: a mutant is wrong everywhere, not in one place.
    """
    group = mutant.name.split()[-1]
    names = [group] if group in place else list(place)
    report = check_gradient(
        lambda part: forward({**place, **part}),
        lambda part, d_output: {
            name: value
            for name, value in mutant.backward({**place, **part}, d_output).items()
            if name in names
        },
        {name: place[name] for name in names},
        seed=seed,
        directions=3,
        coordinates=4,
        steps=(1e-4, 1e-5, 1e-6),
    )
    return bool(report)
