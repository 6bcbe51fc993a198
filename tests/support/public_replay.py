"""Calls public functions with wrong arguments, in a process that may die of it.

    python -m support.public_replay SEED LAST [FIRST]

Prints each call before it is made, and a line that begins with `BAD` after one that ends in
neither a result nor an error of photograd. A line `NET` tells that only `typed_call`, and no check
of the function, has given the error its type.
"""

from __future__ import annotations

import sys
import warnings
from typing import Any

import numpy as np
from photograd.errors import Error

from support.core_replay import MEMORY, NUMBERS, SMALL, WHOLE, damaged_array, short
from support.memory_limit import limit_memory
from support.public_calls import Call, every_call, name_of

AMOUNTS = {"steps", "spp", "samples", "count", "rays", "particles", "surface_points"}
"""Work that a caller asks for: larger numbers take longer, and that is all."""


class Stranger:
    """An object of nobody's."""


def wrong_object(g: np.random.Generator) -> Any:
    """Something of another kind."""
    kinds: list[Any] = [
        None,
        True,
        "",
        "nan",
        b"x",
        -1,
        2.5,
        float("nan"),
        [],
        (),
        {},
        1j,
        Stranger,
    ]
    kinds += [Stranger(), [[1, 2], [3]], np.float32(1), np.array(1.0), np.zeros((0, 3)), "\ud800"]
    kinds += [np.array([None]), np.ma.masked_array([1.0]), np.array("text"), range(3), {1, 2}]
    return kinds[int(g.integers(len(kinds)))]


def wrong(name: str, value: Any, g: np.random.Generator) -> Any:
    """Another value for an argument: often of its kind."""
    if g.random() < 0.4:
        return wrong_object(g)
    if type(value) is np.ndarray and value.dtype.kind in "biuf" and value.ndim:
        return damaged_array(value, g)
    if isinstance(value, int) and not isinstance(value, bool):
        some = SMALL[:5] if name in AMOUNTS else WHOLE
        return some[int(g.integers(len(some)))]
    if isinstance(value, float):
        return float(NUMBERS[int(g.integers(len(NUMBERS)))])
    if isinstance(value, list | tuple) and value:
        entries = list(value)
        at = int(g.integers(len(entries)))
        choice = int(g.integers(4))
        if choice == 0:
            del entries[at]
        elif choice == 1:
            entries.append(entries[at])
        else:
            entries[at] = wrong(name, entries[at], g)
        return tuple(entries) if hasattr(value, "_fields") else type(value)(entries)
    return wrong_object(g)


def damaged(call: Call, g: np.random.Generator) -> tuple[dict[str, Any], str]:
    """Arguments, one or two of them wrong, and what they are."""
    arguments = dict(call[1])
    told = []
    for _ in range(int(g.integers(1, 3)) if arguments else 0):
        name = list(arguments)[int(g.integers(len(arguments)))]
        arguments[name] = wrong(name, arguments[name], g)
        told.append(f"{name}={short(arguments[name])}")
    return arguments, ", ".join(told)


def say(line: str) -> None:
    """A line on stdout, now."""
    sys.stdout.write(line.encode(errors="replace").decode() + "\n")
    sys.stdout.flush()


def main(seed: int, last: int, first: int = 0) -> None:
    """Make the calls from `first` up to `last` of a seed."""
    warnings.simplefilter("ignore")
    calls = every_call()
    limit_memory(MEMORY)
    for number in range(first, last):
        g = np.random.default_rng([seed, number])
        call = calls[number % len(calls)]
        arguments, told = damaged(call, g)
        name = name_of(call[0])
        say(f"{number} {name}({told})")
        try:
            call[0](**arguments)
        except Error as failure:
            if "ones that fit each other and this function" in str(failure):
                say(f"NET {name}: {failure}")
        except Exception as failure:
            said = " ".join(f"{failure}".split())[:200]
            say(f"BAD {type(failure).__name__}: {said}")
    say(f"made {last} calls")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
