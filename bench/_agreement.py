"""Did two programs do the same work? Sizes must be equal, results to four digits.

Estimates from random numbers are right on average only: one figure, known well enough, must agree.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

SPEEDS = {"mrays_per_s"}  # figures in a quality row that are no results
ESTIMATES = {"W2": ("mean", 0.005), "W3": ("loss", 0.01), "W9": ("loss", 0.01)}
"""The figure by which estimates are compared, and what part of it they may differ by."""


def flat(row: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, float]]:
    """("primary.mean_t", 1.0) and so on for all numbers of a nested quality row."""
    for name, value in row.items():
        if isinstance(value, Mapping):
            yield from flat(value, f"{prefix}{name}.")
        elif name not in SPEEDS and isinstance(value, int | float):
            yield prefix + name, float(value)


def agree(a: float, b: float) -> bool:
    """To half a unit in the fourth significant digit; what is not finite agrees with nothing."""
    if not (math.isfinite(a) and math.isfinite(b)):
        return False
    largest = max(abs(a), abs(b))
    return largest == 0 or abs(a - b) <= 0.5 * 10.0 ** (math.floor(math.log10(largest)) - 3)


def differences(ours: Mapping[str, Any], theirs: Mapping[str, Any]) -> list[str]:
    """Why two rows must not be compared; empty if they may be."""
    sizes = [
        f"size {name}: {value} and {theirs['size'].get(name)}"
        for name, value in ours["size"].items()
        if theirs["size"].get(name) != value
    ]
    if sizes:
        return sizes  # nothing else can be expected to agree
    mine, other = dict(flat(ours["quality"])), dict(flat(theirs["quality"]))
    if ours.get("workload") in ESTIMATES:
        name, part = ESTIMATES[ours["workload"]]
        if name in mine and name in other:
            near = abs(mine[name] - other[name]) <= part * abs(mine[name])
            return [] if near else [f"{name}: {mine[name]:.6g} and {other[name]:.6g}"]
    shared = [name for name in mine if name in other]
    if not shared:
        return ["quality: no figure in common"]
    return [
        f"{name}: {mine[name]:.6g} and {other[name]:.6g}"
        for name in shared
        if not agree(mine[name], other[name])
    ]
