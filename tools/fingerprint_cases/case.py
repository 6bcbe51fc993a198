"""One result that is fingerprinted: a name, how it is computed, and its hash."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
import numpy.typing as npt

from fingerprint_cases.zeros import ZEROS

Array = npt.NDArray[Any]
Arrays = dict[str, Array]
PRECISIONS: dict[str, type[np.floating[Any]]] = {"f32": np.float32, "f64": np.float64}


@dataclass(frozen=True)
class Case:
    """One result.

    Attributes:
        name: unique, parts joined by "/"; stays the same when the product renames something.
        run: {name: array} for a seed.
        estimates: patterns of the arrays of which another seed gives another estimate of the same
            mean, so that two versions of the product can be compared by a z-test.
    """

    name: str
    run: Callable[[int], Mapping[str, Array]]
    estimates: tuple[str, ...] = ()


class ZeroResultError(Exception):
    """A result proves nothing: an array of it is empty, zero everywhere or not finite."""


def computed(case: Case, seed: int = 1) -> Arrays:
    """The arrays of a case, contiguous.

    Raises:
        ZeroResultError: an array without a nonzero entry that `zeros.ZEROS` does not list, or
            with an entry that is not finite.
    """
    arrays = {name: np.ascontiguousarray(a) for name, a in case.run(seed).items()}
    empty = [name for name, a in arrays.items() if not a.any()]
    unknown = [name for name in empty if not zero_is_known(case.name, name)]
    wild = [name for name, a in arrays.items() if a.dtype.kind == "f" and not np.isfinite(a).all()]
    if not arrays or len(empty) == len(arrays):
        raise ZeroResultError(f"{case.name}: expected an array that is not zero, got none")
    if unknown:
        raise ZeroResultError(f"{case.name}: zero everywhere: {', '.join(unknown)}")
    if wild:
        raise ZeroResultError(f"{case.name}: not finite: {', '.join(wild)}")
    return arrays


def zero_is_known(case: str, array: str) -> bool:
    """Whether `zeros.ZEROS` says that this array may be zero."""
    return any(fnmatchcase(case, c) and fnmatchcase(array, a) for c, a in ZEROS)


def fingerprint(arrays: Mapping[str, Array]) -> str:
    """The hash of dtypes, shapes and bytes in their order; names may change."""
    found = hashlib.sha256()
    for array in arrays.values():
        found.update(f"{array.dtype.str}{array.shape}".encode())
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def numbers_of(value: Any) -> list[float]:
    """All numbers in nested lists, tuples and dictionaries, in order."""
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return [number for part in value for number in numbers_of(part)]
    return [float(value)]


def unit_rows(count: int, seed: int) -> Array:
    """Random directions (count, 3), float64."""
    rows = np.random.default_rng(seed).standard_normal((count, 3))
    unit: Array = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    return unit
