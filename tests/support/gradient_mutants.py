"""Wrong gradients against central differences, with the function computed once at each place."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from photograd_course.gradcheck import check_gradient
from photograd_course.gradcheck.probes import Backward, Function, copy_outputs
from photograd_course.mutants import MutantReport, check_mutants


def memoized(function: Function) -> Function:
    """The same function of groups {name: array}, which keeps its outputs.

    A check draws its probes from its seed, so that for each wrong gradient it asks for the function
    at the same places again.
    """
    kept: dict[bytes, Any] = {}

    def call(groups: Mapping[str, Any]) -> Any:
        place = hashlib.blake2b()
        for name, value in groups.items():
            place.update(name.encode() + np.ascontiguousarray(value).tobytes())
        key = place.digest()
        if key not in kept:
            kept[key] = function(dict(groups))
        return copy_outputs(kept[key])

    return call


def check_gradient_mutants(
    function: Function, backward: Backward, place: Mapping[str, Any], cotangent: Any, **options: Any
) -> MutantReport:
    """Whether `check_gradient` with these options kills each automatic mutant of `backward`."""
    once: Callable[..., Any] = memoized(function)
    return check_mutants(
        lambda wrong: check_gradient(once, wrong, place, **options), backward, place, cotangent
    )
