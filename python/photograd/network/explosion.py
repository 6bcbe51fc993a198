"""Learning rates that explode: found at the first step after which a weight is out of bounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from photograd.errors import Error, message
from photograd.network.hash_encoding import HashEncoding
from photograd.network.perceptron import Perceptron
from photograd.types import Array

LIMIT = 1e4
"""Weights and features are of the order of 1; products of several at this limit stay finite."""


def require_bounded(
    function: str, params: Mapping[str, Array], parts: Mapping[str, Perceptron | HashEncoding]
) -> None:
    """Raise Error for weights or features that are not finite, or beyond `LIMIT`.

    Args:
        function: on whose behalf the error speaks.
        params: arrays by name.
        parts: what each array belongs to; the error names its layer or its level.
    """
    for name, part in parts.items():
        if float(np.abs(params[name]).max(initial=0.0)) <= LIMIT:  # false for NaN
            continue
        for part_name, values in _named_parts(part, params[name]):
            largest = float(np.abs(values).max(initial=0.0))
            if not largest <= LIMIT:
                expected = f"numbers within +- {LIMIT:g}"
                remedy = "the descent has exploded: lower the learning rate"
                raise Error(message(function, f"{name}, {part_name}", expected, largest, remedy))


def _named_parts(part: Perceptron | HashEncoding, values: Array) -> Iterator[tuple[str, Array]]:
    if isinstance(part, HashEncoding):
        for number, level in enumerate(part.levels):
            where = f"level {number} ({level.resolution} cells)"
            yield where, values[level.first : level.first + level.rows]
        return
    for number, (W, b) in enumerate(part.layers(values)):
        yield f"layer {number}", W
        yield f"layer {number}", b
