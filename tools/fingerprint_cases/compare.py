"""Which results differ between two versions, and by how much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fingerprint_cases.case import Array, Case, computed
from fingerprint_cases.run import AFTER, estimates, file_of, load


@dataclass(frozen=True)
class Comparison:
    """Names of results, of two versions of the product."""

    same: tuple[str, ...]
    different: tuple[str, ...]
    missing: tuple[str, ...]  # known before, no longer computed
    new: tuple[str, ...]  # computed now, not known before

    @property
    def equal(self) -> bool:
        """Whether every result is there in both, with the same hash."""
        return not (self.different or self.missing or self.new)

    def __str__(self) -> str:
        lines = [
            f"{word}: {name}"
            for word in ("different", "missing", "new")
            for name in getattr(self, word)
        ]
        counts = [
            f"{len(getattr(self, word))} {word}" for word in ("same", "different", "missing", "new")
        ]
        return "\n".join([*lines, ", ".join(counts)])


def compare(before: Mapping[str, str], after: Mapping[str, str]) -> Comparison:
    """Two sets of hashes by name."""
    both = [name for name in before if name in after]
    return Comparison(
        tuple(name for name in both if before[name] == after[name]),
        tuple(name for name in both if before[name] != after[name]),
        tuple(name for name in before if name not in after),
        tuple(name for name in after if name not in before),
    )


def describe_difference(case: Case, folder: Path) -> str:
    """Lines on how the arrays of a case differ from those kept in `folder`."""
    path = file_of(folder, case)
    if not path.exists():
        return f"{case.name}\n  no arrays in {folder}"
    kept = list(load(path).items())
    now = list(computed(case).items())
    lines = [case.name]
    if len(kept) != len(now):
        lines.append(f"  {len(kept)} arrays before, {len(now)} now")
    for (key, before), (name, after) in zip(kept, now, strict=False):
        lines += _array_lines(key[4:], before, name, after)
    other = path.with_suffix(".seeds.npz")
    if case.estimate and other.exists():
        lines.append("  " + z_test(load(other)["seeds"], case))
    return "\n".join(lines)


def _array_lines(old: str, before: Array, name: str, after: Array) -> list[str]:
    label = name if old == name else f"{old} -> {name}"
    if before.shape != after.shape or before.dtype != after.dtype:
        return [f"  {label}: {before.dtype} {before.shape} before, {after.dtype} {after.shape} now"]
    if before.tobytes() == after.tobytes():
        return []
    a, b = before.astype(np.float64), after.astype(np.float64)
    gap, size = np.abs(b - a), np.abs(a).max()
    changed = int((a != b).sum())
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = float(gap.max() / size)
    return [
        f"  {label}: {changed} of {a.size} numbers, at most {gap.max():.3g} apart, "
        f"{ratio:.3g} of the largest"
    ]


def z_test(before: Array, case: Case) -> str:
    """Whether the means of two versions agree, from pictures (K, ...) of K seeds each.

    z is that of the whole picture's mean: of means that agree it is beyond 4 once in 16,000. The
    root mean square over pixels of the same ratio is about sqrt((K - 1) / (K - 2)) where they
    agree.
    """
    count = len(before)
    after = estimates(case, AFTER, count)
    means = [rows.reshape(count, -1).mean(axis=1) for rows in (before, after)]
    z = _ratio(means[0], means[1])
    each = _ratio(before, after)
    spread = float(np.sqrt(np.nanmean(each**2)))
    return (
        f"z-test over {count} seeds: mean {means[0].mean():.6g} before, {means[1].mean():.6g} now, "
        f"z = {float(z):.2f}; pixels: rms {spread:.2f}, largest {np.nanmax(np.abs(each)):.1f}"
    )


def _ratio(before: Array, after: Array) -> Array:
    """Difference of means over its standard error; not a number where nothing varies."""
    error = np.sqrt(before.var(axis=0, ddof=1) + after.var(axis=0, ddof=1)) / np.sqrt(len(before))
    gap = after.mean(axis=0) - before.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(error > 0, gap / error, np.nan))
