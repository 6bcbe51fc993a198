"""The names of constant factors, such as 1/(2 pi)."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from functools import lru_cache

AGREEMENT = 1e-6  # relative; so far a factor agrees with its name
MAX_TERM = 9  # of numerators and denominators
SYMBOLS = {
    "pi": math.pi,
    "ln 2": math.log(2.0),
    "ln 10": math.log(10.0),
    "sqrt(2)": math.sqrt(2.0),
    "sqrt(pi)": math.sqrt(math.pi),
    "sqrt(2 pi)": math.sqrt(2.0 * math.pi),
}
DEGREES = "180/pi", "pi/180"


def name_of(factor: float) -> str:
    """A factor as one writes it by hand; six digits of one that has no such name."""
    size, sign = abs(factor), "-" if factor < 0 else ""
    for value, name in _known():
        if abs(size - value) <= AGREEMENT * value:
            return sign + name
    return f"{factor:.6g}"


def remark_on(factor: float, lengths: Collection[int]) -> str:
    """What else is to be seen of a factor, in parentheses, or nothing.

    Args:
        factor: not 0.
        lengths: of axes of the arrays that the submission was given, and products of them.
    """
    said = []
    if factor < 0:
        said.append("your sign is reversed" + ("" if name_of(factor) == "-1" else " as well"))
    if name_of(abs(factor)) in DEGREES:
        said.append("180/pi degrees are one radian")
    for n in sorted(set(lengths)):
        if n > 2 and any(abs(abs(factor) - k) <= AGREEMENT * k for k in (n, 1 / n, (n - 1) / n)):
            said.append(f"{n} is a length, or a product of lengths, of the arrays in this call")
            break
    return f" ({'; '.join(said)})" if said else ""


@lru_cache(maxsize=1)
def _known() -> tuple[tuple[float, str], ...]:
    """Values and names, the plainest first."""
    return tuple(_names())


def _names() -> Iterator[tuple[float, str]]:
    for q in range(1, MAX_TERM + 1):
        for p in range(1, MAX_TERM + 1):
            if math.gcd(p, q) == 1:
                yield p / q, str(p) if q == 1 else f"{p}/{q}"
    for power in (100, 255, 256, 1000):
        yield float(power), str(power)
        yield 1.0 / power, f"1/{power}"
    for name, value in SYMBOLS.items():
        for n in (1, 2, 3, 4, 8):
            times = name if n == 1 else f"{n} {name}"
            yield n * value, times
            yield 1.0 / (n * value), f"1/{times}" if times == "pi" else f"1/({times})"
            if n > 1:
                yield value / n, f"{name}/{n}"
                yield n / value, f"{n}/{name}"
    yield 180.0 / math.pi, DEGREES[0]
    yield math.pi / 180.0, DEGREES[1]
