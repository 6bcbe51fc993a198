"""Which results differ between two versions, and by how much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fingerprint_cases.case import Array, Case, computed
from fingerprint_cases.run import AFTER, FAILED, estimates, file_of, load, seeds_file_of


@dataclass(frozen=True)
class Comparison:
    """Names of results, of two versions of the product."""

    same: tuple[str, ...]
    different: tuple[str, ...]
    failed: tuple[str, ...]  # with a message each
    missing: tuple[str, ...]  # known before, no longer computed
    new: tuple[str, ...]  # computed now, not known before

    @property
    def equal(self) -> bool:
        """Whether every result is there in both, with the same hash."""
        return not (self.different or self.failed or self.missing or self.new)

    def __str__(self) -> str:
        found = vars(self)
        lines = [f"{word}: {name}" for word in found for name in found[word] if word != "same"]
        return "\n".join([*lines, ", ".join(f"{len(found[word])} {word}" for word in found)])


def compare(before: Mapping[str, str], after: Mapping[str, str]) -> Comparison:
    """Two sets of hashes by name."""
    failed = {name for name, digest in after.items() if digest.startswith(FAILED)}
    both = [name for name in before if name in after and name not in failed]
    return Comparison(
        same=tuple(name for name in both if before[name] == after[name]),
        different=tuple(name for name in both if before[name] != after[name]),
        failed=tuple(f"{name}: {after[name][len(FAILED) :]}" for name in after if name in failed),
        missing=tuple(name for name in before if name not in after),
        new=tuple(name for name in after if name not in before and name not in failed),
    )


def describe_difference(case: Case, folder: Path) -> str:
    """Lines on how the arrays of a case differ from those kept in `folder`.

    z is the difference of the means of an array over its standard error, as other seeds before and
    after show it: where the expected values agree, it is beyond 4 once in 16,000. "rms" is the root
    mean square of the same ratio of each number; where they agree it is near 1, with K seeds about
    sqrt((K - 1) / (K - 2)).
    """
    path, seeds = file_of(folder, case), seeds_file_of(folder, case)
    if not path.exists():
        return f"{case.name}\n  no arrays in {folder}"
    kept, now = load(path), list(computed(case).items())
    lines = [case.name]
    if len(kept) != len(now):
        lines.append(f"  {len(kept)} arrays before, {len(now)} now")
    random = load(seeds) if seeds.exists() else []
    again = estimates(case, AFTER, len(random[0][1])) if random else {}
    before_seeds = dict(zip(again, (array for _, array in random), strict=False))
    for (old, before), (name, after) in zip(kept, now, strict=False):
        found = array_difference(before, after)
        if not found:
            continue
        if name in before_seeds and before_seeds[name].shape == again[name].shape:
            found += f"; {z_test(before_seeds[name], again[name])}"
        lines.append(f"  {name if old == name else f'{old} -> {name}'}: {found}")
    return "\n".join(lines)


def array_difference(before: Array, after: Array) -> str:
    """How two arrays differ; "" for the same bits."""
    if before.shape != after.shape or before.dtype != after.dtype:
        return f"{before.dtype} {before.shape} before, {after.dtype} {after.shape} now"
    if before.tobytes() == after.tobytes():
        return ""
    a, b = before.astype(np.float64), after.astype(np.float64)
    gap, size = float(np.abs(b - a).max()), float(np.abs(a).max())
    ratio = f"{gap / size:.3g} of the largest" if size > 0 else "all were 0"
    return f"{int((a != b).sum())} of {a.size} numbers differ, by at most {gap:.3g} ({ratio})"


def z_test(before: Array, after: Array) -> str:
    """Whether the means of two versions agree, of estimates (K, ...) of K seeds each."""
    means = [rows.reshape(len(rows), -1).mean(axis=1) for rows in (before, after)]
    z = float(_ratio(means[0], means[1]))
    each = _ratio(before, after)
    known = each[np.isfinite(each)]
    rms = f"{np.sqrt(np.mean(known**2)):.2f}" if known.size else "none"
    return (
        f"means of {len(before)} seeds {means[0].mean():.6g} and {means[1].mean():.6g}, "
        f"z = {z:.2f}, rms {rms}"
    )


def _ratio(before: Array, after: Array) -> Array:
    """Difference of means over its standard error; not a number where nothing varies."""
    a, b = before.astype(np.float64), after.astype(np.float64)
    error = np.sqrt((a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / len(a))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(error > 0, (b.mean(axis=0) - a.mean(axis=0)) / error, np.nan))
