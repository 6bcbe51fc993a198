"""What a file format can hold of Gaussians, and what a conversion has changed.

Each attribute is compared in units that mean something in a picture: opacities and not logits,
angles and not quaternions, display colors and not coefficients.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from photograd._memory import available_memory
from photograd.errors import IoError, message
from photograd.sh import Y_0
from photograd.splats.splatting import Gaussians
from photograd.types import Array

UNITS = {
    "means": "m",
    "log_scales": "log m",
    "rotation": "degrees",
    "opacity": "of 1",
    "color": "display, of 1",
    "harmonics": "coefficient",
}


@dataclass(frozen=True)
class Coding:
    """How exactly a format holds one attribute.

    Attributes:
        error: largest difference of what is read to what was written, for values inside of the
            limits, in the attribute's unit (`UNITS`).
        low, high: limits of what can be written; what lies outside is moved to them.
    """

    error: float
    low: float = -np.inf
    high: float = np.inf


Codings = dict[str, Coding]


@dataclass(frozen=True)
class Difference:
    """One attribute before and after.

    Attributes:
        attribute, unit: what was compared.
        largest: difference over all rows.
        bound: what the format promises for values inside of its limits.
        clamped: number of values that lay outside of the limits; their differences may exceed the
            bound.
    """

    attribute: str
    unit: str
    largest: float
    bound: float
    clamped: int


def differences(before: Gaussians, after: Gaussians, codings: Codings) -> list[Difference]:
    """Attribute by attribute, rows in the same order; harmonics as far as both have them.

    Args:
        before: Gaussians that were written.
        after: what was read back.
        codings: what the format keeps of each attribute.
    """
    then, now = _attributes(before), _attributes(after)
    found = []
    for name, coding in codings.items():
        a, b = then[name], now[name]
        if name == "rotation":
            found.append(Difference(name, UNITS[name], _largest_angle(a, b), coding.error, 0))
            continue
        if name == "harmonics":
            shared = min(a.shape[1], b.shape[1])
            a, b = a[:, :shared], b[:, :shared]
        with np.errstate(invalid="ignore"):  # infinite on both sides is the same
            difference = np.where(a == b, 0.0, np.abs(a - b))
        largest = float(difference.max(initial=0.0))
        clamped = int(((a < coding.low) | (a > coding.high)).sum())
        found.append(Difference(name, UNITS[name], largest, coding.error, clamped))
    return found


def opacity_of(logits: Array) -> Array:
    """1 / (1 + exp(-logit)) in double, without overflow.

    Args:
        logits: (N,).
    """
    z = np.exp(-np.abs(logits.astype(np.float64)))
    return np.asarray(np.where(logits >= 0, 1.0, z) / (1.0 + z))


def logit_of(opacity: Array) -> Array:
    """Logarithm of opacity / (1 - opacity); infinite for 0 and 1."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(opacity) - np.log1p(-opacity))


def unit_quats(quats: Array) -> Array:
    """(N, 4) in double, of length one; a zero one stands for no rotation.

    Args:
        quats: (N, 4), w first.
    """
    q = quats.astype(np.float64)
    largest = np.abs(q).max(axis=1, keepdims=True, initial=0.0)
    q = np.where(largest > 0, q / np.where(largest > 0, largest, 1.0), [1.0, 0.0, 0.0, 0.0])
    return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))


def turn_of_error(error: float) -> float:
    """Most degrees by which a rotation turns when an error of this length is added to its unit
    quaternion: the quaternion turns by asin(error) at most, the rotation by twice that.
    """
    return float(np.degrees(2.0 * np.arcsin(min(error, 1.0))))


def require_room(function: str, path: Path, count: int, bands: int, limit: int | None) -> None:
    """Refuse a file whose header states more Gaussians than memory holds, before it is taken.

    Args:
        function, path: for the error.
        count: number of Gaussians.
        bands: coefficients of each color channel.
        limit: bytes; what is available by default.

    Raises:
        IoError: with both numbers.
    """
    # The numbers themselves, and as much again while they are decoded in double.
    needed = count * 3 * 4 * (11 + 3 * bands)
    room = available_memory() if limit is None else limit
    if needed > room:
        got = f"{count:,} Gaussians stated, which take {needed / 2**20:,.0f} MiB"
        expected = f"Gaussians that fit into {room / 2**20:,.0f} MiB"
        raise IoError(message(function, f"{path}", expected, got, "raise memory_limit"))


def _attributes(gaussians: Gaussians) -> dict[str, Array]:
    coefficients = gaussians.sh.astype(np.float64)
    return {
        "means": gaussians.means.astype(np.float64),
        "log_scales": gaussians.log_scales.astype(np.float64),
        "rotation": unit_quats(gaussians.quats),
        "opacity": opacity_of(gaussians.opacity_logits),
        "color": 0.5 + Y_0 * coefficients[:, 0],
        "harmonics": coefficients[:, 1:],
    }


def _largest_angle(a: Array, b: Array) -> float:
    """Degrees between rotations; q and -q are the same one."""
    chord = np.minimum(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    # Chord c of the unit sphere: the quaternions stand 2 asin(c / 2) apart.
    return float(np.degrees(4.0 * np.arcsin(0.5 * min(float(chord.max(initial=0.0)), 2.0))))
