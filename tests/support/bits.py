"""Results that are the same bits on any number of threads and under every instruction set.

A test module registers functions with `same_bits`; it needs no test of its own. The module
tests/registry/test_same_bits.py finds all that register and proves each of their cases.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

from support.tree import ROOT

_SIGN = "from support.bits import same_bits"  # a module with this line registers


@dataclass(frozen=True)
class Case:
    """A function without arguments that returns arrays, and the kernels of the core it runs."""

    results: Callable[[], Iterable[Any]]
    kernels: tuple[str, ...]
    owner: str


_cases: dict[str, Case] = {}


def same_bits(
    name: str, *, kernels: tuple[str, ...] = (), each: Iterable[str] | None = None
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register the decorated function: its results, arrays or numbers, never change a bit.

    None of them may be zero everywhere. The function takes no argument, or one of `each`: then it
    is one case for each of them. `kernels` are names of cpp/kernels/kernels.h; a case that names
    any runs under each instruction set as well.
    """

    def register(function: Callable[..., Any]) -> Callable[..., Any]:
        owner = f"{function.__module__}.{function.__qualname__}"
        for value in [None] if each is None else each:
            full = name if value is None else f"{name}: {value}"
            if full in _cases and _cases[full].owner != owner:
                raise ValueError(f"same_bits: {full!r} is registered by {_cases[full].owner}")
            results = function if value is None else partial(function, value)
            _cases[full] = Case(results, kernels, owner)
        return function

    return register


def cases() -> dict[str, Case]:
    """All registered cases by name, in the order of the names."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        if _SIGN in path.read_text(encoding="utf-8"):
            import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    return dict(sorted(_cases.items()))


def digests(case: Case) -> list[str]:
    """One for each result: of its type, its shape and its bytes."""
    found = []
    for result in case.results():
        array = np.asarray(result)
        assert array.any() or not array.size, f"{case.owner}: a result is zero everywhere"
        header = f"{array.dtype} {array.shape}".encode()
        found.append(hashlib.sha256(header + array.tobytes()).hexdigest())
    assert found, f"{case.owner}: no results"
    return found


def lines_of_kernels() -> list[str]:
    """Name and digests of each case that names kernels, with tabs between them."""
    return ["\t".join([name, *digests(case)]) for name, case in cases().items() if case.kernels]
