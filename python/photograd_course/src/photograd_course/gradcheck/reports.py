"""What the checks return: frozen records that are true when passed and print as a small table."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class GroupReport:
    """One parameter group of a difference check.

    Attributes:
        name: the group.
        error: norm-relative error at the best step, |fd - g| / max(|fd|, |g|); inf if none worked.
        best_step: that step, in units of the group's root mean square.
        curve: (step, error) of the steps that were tried, coarse to fine; all of them where none
            agrees.
        gradient_norm: Euclidean norm of the gradient under test.
        passed: the verdict.
        reason: why it failed, or an empty string.
    """

    name: str
    error: float
    best_step: float
    curve: tuple[tuple[float, float], ...]
    gradient_norm: float
    passed: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        verdict = "passed" if self.passed else f"FAILED: {self.reason}"
        return (
            f"{self.name}: error {self.error:.1e} at step {self.best_step:.0e}, "
            f"|gradient| {self.gradient_norm:.3g}, {verdict}"
        )


@dataclass(frozen=True)
class GradientReport:
    """All groups of a difference check; true only if there are groups and every one passed."""

    groups: tuple[GroupReport, ...]
    tolerance: float
    seed: int

    @property
    def passed(self) -> bool:
        """Whether there are groups and each of them passed."""
        return len(self.groups) > 0 and all(group.passed for group in self.groups)

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        verdict = "passed" if self.passed else "FAILED"
        head = f"gradient check {verdict} (tolerance {self.tolerance:.0e}, seed {self.seed})"
        return "\n".join([head, *(f"  {group}" for group in self.groups)])


@dataclass(frozen=True)
class TaylorReport:
    """The remainder of the first-order Taylor expansion under halving of the step.

    Attributes:
        steps, remainders: the sweep, coarse to fine.
        slopes: log2 of consecutive ratios, for the steps whose remainder is above rounding.
        slope: mean of the four finest slopes; NaN when there are fewer, or when linear.
        linear: no remainder rose above rounding at any step, the largest included.
        passed: linear, or each of the four finest slopes lies within the tolerance of 2.
    """

    steps: tuple[float, ...]
    remainders: tuple[float, ...]
    slopes: tuple[float, ...]
    slope: float
    linear: bool
    tolerance: float
    passed: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        if self.passed and self.linear:
            return "Taylor check passed: the function is linear here, no remainder above rounding"
        verdict = "passed" if self.passed else f"FAILED: {self.reason}"
        finest = ", ".join(f"{slope:.2f}" for slope in self.slopes[-6:])
        return (
            f"Taylor check {verdict}: slope {self.slope:.3f} (2 expected), finest slopes {finest}"
        )


@dataclass(frozen=True)
class DotProductReport:
    """<Jv, w> against <v, J^T w>: the worst of several random pairs, for each group.

    Attributes:
        errors: (group, relative difference of the two products) for each group.
        error: the largest of them, NaN if any is.
        reason: why it failed, or an empty string.
    """

    errors: tuple[tuple[str, float], ...]
    error: float
    tolerance: float
    passed: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        verdict = "passed" if self.passed else f"FAILED: {self.reason}"
        rows = [f"  {name}: {error:.1e}" for name, error in self.errors]
        return "\n".join([f"dot product check {verdict} (tolerance {self.tolerance:.0e})", *rows])


@dataclass(frozen=True)
class AccumulationReport:
    """Did the second of two equal backward calls add as much as the first?

    Attributes:
        errors: (group, |second sum - twice the first| / |twice the first|) for each group.
    """

    errors: tuple[tuple[str, float], ...]
    tolerance: float
    passed: bool
    reason: str = ""

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        verdict = "passed" if self.passed else f"FAILED: {self.reason}"
        rows = [f"  {name}: {error:.1e}" for name, error in self.errors]
        return "\n".join([f"accumulation check {verdict}", *rows])
